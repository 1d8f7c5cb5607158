// CANopen data types (CiA 301, 7.4.7): their numbers, names and widths, and the conversion between values and bytes.
// Bytes are in little-endian order. A value that does not fit its type is refused, never truncated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gateway/core/value.hpp"

namespace axisgate::canopen {

enum class DataType : std::uint16_t {
    boolean = 0x01,
    integer8 = 0x02,
    integer16 = 0x03,
    integer32 = 0x04,
    unsigned8 = 0x05,
    unsigned16 = 0x06,
    unsigned32 = 0x07,
    real32 = 0x08,
    visible_string = 0x09,
    octet_string = 0x0A,
    unicode_string = 0x0B,
    time_of_day = 0x0C,
    time_difference = 0x0D,
    domain = 0x0F,
    integer24 = 0x10,
    real64 = 0x11,
    integer40 = 0x12,
    integer48 = 0x13,
    integer56 = 0x14,
    integer64 = 0x15,
    unsigned24 = 0x16,
    unsigned40 = 0x18,
    unsigned48 = 0x19,
    unsigned56 = 0x1A,
    unsigned64 = 0x1B
};
/// Nothing for numbers that CiA 301 does not assign to a simple type (records, manufacturer types).
[[nodiscard]] std::optional<DataType> data_type_of(std::uint64_t number) noexcept;
/// "INTEGER16", as it is spelled in EDS files and in the standard.
[[nodiscard]] std::string_view name_of(DataType type) noexcept;

/// Length in an SDO: 1 byte for a BOOLEAN; nothing for strings and domains, which have any length.
[[nodiscard]] std::optional<std::size_t> bytes_of(DataType type) noexcept;
/// Length in a PDO: 1 bit for a BOOLEAN; nothing for types without a fixed length.
[[nodiscard]] std::optional<std::size_t> bits_of(DataType type) noexcept;
[[nodiscard]] bool is_signed(DataType type) noexcept;
/// Smallest and largest whole number; the maximum of UNSIGNED64 is cut to 2^63 - 1, the largest number of a Value. Nothing for other types.
[[nodiscard]] std::optional<IntegerRange> range_of(DataType type) noexcept;

/// Nothing if the length is not that of the type, or if an UNSIGNED64 is above 2^63 - 1. Numbers become int64 or double, VISIBLE_STRING
/// becomes text (up to its first zero), all other types become hex pairs.
[[nodiscard]] std::optional<Value> decode(DataType type, std::span<const std::uint8_t> bytes);
/// Nothing if the value does not belong to the type.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> encode(DataType type, const Value& value);

}  // namespace axisgate::canopen
