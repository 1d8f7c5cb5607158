// CANopen data types (CiA 301, 7.4.7): their numbers, names and widths, and values of them as bytes.
// In: type numbers, bytes of a dictionary entry, values. Out: values of gateway/core, bytes low byte first.
// Never cuts a value to fit: what does not fit its type is refused.
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
/// Nothing for numbers that CiA 301 has not given to a simple type (records, a maker's own).
[[nodiscard]] std::optional<DataType> data_type_of(std::uint64_t number) noexcept;
/// "INTEGER16", as EDS files and the standard write it.
[[nodiscard]] std::string_view name_of(DataType type) noexcept;

/// On the wire by SDO: 1 byte for a BOOLEAN; nothing for strings and domains, which have any length.
[[nodiscard]] std::optional<std::size_t> bytes_of(DataType type) noexcept;
/// In a PDO: 1 bit for a BOOLEAN; nothing for what has no fixed length.
[[nodiscard]] std::optional<std::size_t> bits_of(DataType type) noexcept;
[[nodiscard]] bool is_signed(DataType type) noexcept;
/// Smallest and largest whole number; the upper end of UNSIGNED64 is cut at 2^63 - 1, as a Value has no more. Nothing for other types.
[[nodiscard]] std::optional<IntegerRange> range_of(DataType type) noexcept;

/// Nothing if the length is not the type's, or an UNSIGNED64 is above 2^63 - 1. Numbers become int64 or double, VISIBLE_STRING text (up to
/// its first zero), all other types hex pairs.
[[nodiscard]] std::optional<Value> decode(DataType type, std::span<const std::uint8_t> bytes);
/// Nothing if the value is none of the type.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> encode(DataType type, const Value& value);

}  // namespace axisgate::canopen
