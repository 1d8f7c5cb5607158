// Modbus wire: the numbers of the protocol and the two byte orders, shared by the door's files.
// In: nothing. Out: constants (Modbus Application Protocol 1.1b3, Modbus Messaging on TCP/IP 1.0b), big-endian get and put.
// Never holds state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gateway/core/command.hpp"

namespace axisgate::modbus {

inline constexpr std::size_t mbap_size = 7;                       ///< transaction, protocol, length, unit
inline constexpr std::size_t max_pdu = 253;                       ///< function code and data
inline constexpr std::size_t max_adu = mbap_size + max_pdu;       ///< 260 bytes
inline constexpr std::uint16_t min_length = 2, max_length = 254;  ///< of the MBAP length field: unit and PDU

namespace function {
inline constexpr std::uint8_t read_coils = 1, read_discrete_inputs = 2, read_holding_registers = 3, read_input_registers = 4,
                              write_single_coil = 5, write_single_register = 6, diagnostics = 8, write_multiple_coils = 15,
                              write_multiple_registers = 16, report_server_id = 17, mask_write_register = 22,
                              read_write_multiple_registers = 23, encapsulated_interface = 43;
inline constexpr std::uint8_t device_identification = 14;  ///< MEI type of function 43
inline constexpr std::uint8_t exception_bit = 0x80;
}  // namespace function

namespace limit {
inline constexpr std::uint16_t read_bits = 2000, read_registers = 125, write_bits = 1968, write_registers = 123, read_write_read = 125,
                               read_write_write = 121;
}

/// The exception codes that this door gives. `none`: a good answer.
enum class Exception : std::uint8_t {
    none = 0,
    illegal_function = 1,
    illegal_address = 2,  ///< not mapped, not writable, or beyond 65535
    illegal_value = 3,    ///< count, length or value out of range, half of a 32-bit value
    device_failure = 4,   ///< the drive refused or failed
    busy = 6,
    no_path = 0x0A,   ///< no such unit, the axis is not configured, or its line is down
    no_answer = 0x0B  ///< the drive did not answer in time
};

/// The exception that tells a client why its write did not succeed.
[[nodiscard]] constexpr Exception exception_of(Reason reason) noexcept {
    switch (reason) {
        case Reason::out_of_range:
            return Exception::illegal_value;
        case Reason::unknown_point:
        case Reason::not_writable:
            return Exception::illegal_address;
        case Reason::busy:
        case Reason::authority:
            return Exception::busy;
        case Reason::line_down:
            return Exception::no_path;
        case Reason::no_answer:
            return Exception::no_answer;
        case Reason::none:
        case Reason::wrong_state:
        case Reason::not_supported:
        case Reason::drive_refused:
        case Reason::interrupted:
        case Reason::not_stored:
        case Reason::internal:
            break;
    }
    return Exception::device_failure;
}
/// `none` for a good result; a bad result is never `none`, whatever its reason says.
[[nodiscard]] inline Exception exception_of(const Result& result) noexcept {
    return good(result) ? Exception::none : exception_of(result.reason);
}

/// Which of the two registers of a 32-bit value comes first. Bytes within a register are always big-endian.
enum class WordOrder : std::uint8_t { high_first, low_first };

/// "high_first" or "low_first", the values of `[modbus] word_order`.
[[nodiscard]] constexpr std::optional<WordOrder> word_order_named(std::string_view name) noexcept {
    if (name == "high_first") return WordOrder::high_first;
    if (name == "low_first") return WordOrder::low_first;
    return std::nullopt;
}
[[nodiscard]] constexpr std::string_view name_of(WordOrder order) noexcept {
    return order == WordOrder::high_first ? "high_first" : "low_first";
}

[[nodiscard]] constexpr std::uint16_t get16(const std::uint8_t* p) noexcept {
    return static_cast<std::uint16_t>((std::uint32_t{p[0]} << 8) | p[1]);
}
constexpr void put16(std::uint8_t* p, std::uint16_t v) noexcept {
    p[0] = static_cast<std::uint8_t>(v >> 8);
    p[1] = static_cast<std::uint8_t>(v);
}
[[nodiscard]] constexpr std::uint32_t get32(const std::uint8_t* p, WordOrder order) noexcept {
    const std::uint32_t a = get16(p);
    const std::uint32_t b = get16(p + 2);
    return order == WordOrder::high_first ? (a << 16) | b : (b << 16) | a;
}
constexpr void put32(std::uint8_t* p, std::uint32_t v, WordOrder order) noexcept {
    const auto high = static_cast<std::uint16_t>(v >> 16);
    const auto low = static_cast<std::uint16_t>(v);
    put16(p, order == WordOrder::high_first ? high : low);
    put16(p + 2, order == WordOrder::high_first ? low : high);
}

}  // namespace axisgate::modbus
