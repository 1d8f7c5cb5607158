// Reads address, count and data of each function that reads or writes, as far as the PDU contains them.
#include "gateway/doors/modbus/request_note.hpp"

#include <algorithm>

#include "gateway/doors/modbus/access.hpp"
#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

RequestNote note_of(std::uint8_t unit, std::span<const std::uint8_t> pdu) noexcept {
    RequestNote n;
    n.unit = unit;
    n.code = pdu[0];
    n.write = is_write(pdu[0]);
    switch (n.code) {
        case function::read_coils:
        case function::write_single_coil:
        case function::write_multiple_coils:
            n.table = Table::coils;
            break;
        case function::read_discrete_inputs:
            n.table = Table::discrete_inputs;
            break;
        case function::read_input_registers:
            n.table = Table::input_registers;
            break;
        default:
            break;
    }
    const auto word = [&](std::size_t at) { return at + 2 <= pdu.size() ? get16(pdu.data() + at) : std::uint16_t{0}; };
    const bool both = n.code == function::read_write_multiple_registers;
    if (pdu.size() < (both ? 9u : 5u)) return n;
    const bool one =
        n.code == function::write_single_coil || n.code == function::write_single_register || n.code == function::mask_write_register;
    n.address = word(both ? 5 : 1);
    n.count = one ? std::uint16_t{1} : word(both ? 7 : 3);
    if (!n.write) return n;
    const std::size_t data = both ? 10 : one ? 3 : 6;
    if (n.code == function::write_single_coil || n.code == function::write_multiple_coils) {
        const std::uint8_t bits = data < pdu.size() ? pdu[data] : std::uint8_t{0};
        n.values[0] = (n.code == function::write_single_coil ? bits != 0 : (bits & 1) != 0) ? std::uint16_t{1} : std::uint16_t{0};
        return n;
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(n.count, RequestNote::most_shown); ++i)
        n.values[i] = word(data + 2 * i);
    return n;
}

}  // namespace axisgate::modbus
