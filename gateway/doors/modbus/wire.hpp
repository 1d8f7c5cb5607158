// The numbers of the protocol (Modbus Application Protocol 1.1b3, Modbus Messaging on TCP/IP 1.0b), and the verdicts of the register room
// as exceptions.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gateway/registers/unit_map.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::modbus {

using registers::get16;
using registers::get32;
using registers::put16;
using registers::put32;
using registers::Table;
using registers::UnitMap;
using registers::Verdict;
using registers::WordOrder;

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

/// The exception codes of this door; all except the first are verdicts of the register room with the protocol's numbers.
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
[[nodiscard]] constexpr Exception exception_of(registers::Verdict verdict) noexcept { return static_cast<Exception>(verdict); }

}  // namespace axisgate::modbus
