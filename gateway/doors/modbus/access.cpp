// Addresses are compared as IPv6 (IPv4 as ::ffff:a.b.c.d); a pure stop is recognized by function, register and bits of the control word.
#include "gateway/doors/modbus/access.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <string>

#include "gateway/axis/cia402.hpp"
#include "gateway/doors/modbus/wire.hpp"
#include "gateway/registers/register_map.hpp"

namespace axisgate::modbus {
namespace {
struct Parsed {
    std::array<std::uint8_t, 16> bytes{};
    bool is_v4 = false;
};
std::optional<Parsed> parse_address(std::string_view text) {
    const std::string s(text);
    Parsed p;
    if (::inet_pton(AF_INET6, s.c_str(), p.bytes.data()) == 1) return p;
    if (::inet_pton(AF_INET, s.c_str(), p.bytes.data() + 12) != 1) return std::nullopt;
    std::fill_n(p.bytes.begin(), 10, std::uint8_t{0});
    p.bytes[10] = p.bytes[11] = 0xFF;
    p.is_v4 = true;
    return p;
}
}  // namespace

bool Network::holds(const std::array<std::uint8_t, 16>& peer) const noexcept {
    const std::size_t whole = bits / 8;
    if (!std::equal(address.begin(), address.begin() + static_cast<std::ptrdiff_t>(whole), peer.begin())) return false;
    const unsigned rest = bits % 8;
    return rest == 0 || ((address[whole] ^ peer[whole]) >> (8 - rest)) == 0;
}

std::optional<Network> parse_network(std::string_view text) {
    const auto slash = text.find('/');
    const auto parsed = parse_address(text.substr(0, slash));
    if (!parsed) return std::nullopt;
    Network n;
    n.address = parsed->bytes;
    if (slash == std::string_view::npos) return n;
    const auto digits = text.substr(slash + 1);
    unsigned bits = 0;
    const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
    if (digits.empty() || ec != std::errc{} || end != digits.data() + digits.size() || bits > (parsed->is_v4 ? 32u : 128u))
        return std::nullopt;
    n.bits = parsed->is_v4 ? bits + 96 : bits;
    return n;
}

std::optional<std::array<std::uint8_t, 16>> address_of(std::string_view endpoint) {
    std::string_view host = endpoint.substr(0, endpoint.rfind(':'));
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    const auto parsed = parse_address(host);
    if (!parsed) return std::nullopt;
    return parsed->bytes;
}

bool is_write(std::uint8_t f) noexcept {
    switch (f) {
        case function::write_single_coil:
        case function::write_single_register:
        case function::write_multiple_coils:
        case function::write_multiple_registers:
        case function::mask_write_register:
        case function::read_write_multiple_registers:
            return true;
        default:
            return false;
    }
}

bool Access::admits(std::string_view endpoint) const {
    if (allow.empty()) return true;
    const auto peer = address_of(endpoint);
    return peer && std::ranges::any_of(allow, [&](const Network& n) { return n.holds(*peer); });
}

bool stops_only(std::uint8_t unit, std::span<const std::uint8_t> pdu) noexcept {
    if (unit > 1 && unit != 255) return false;  // user maps may scale values, and map anything anywhere
    std::size_t value = 0;
    if (pdu.size() == 5 && pdu[0] == function::write_single_register) {
        value = 3;
    } else if (pdu.size() == 8 && pdu[0] == function::write_multiple_registers && get16(pdu.data() + 3) == 1 && pdu[5] == 2) {
        value = 6;
    } else {
        return false;
    }
    if (get16(pdu.data() + 1) % registers::registers_per_axis != registers::reg::controlword) return false;
    const std::uint16_t word = get16(pdu.data() + value);
    if ((word & (cia402::cw_fault_reset | cia402::cw_new_setpoint)) != 0) return false;
    return (word & cia402::cw_enable_voltage) != 0 && (word & cia402::cw_quick_stop) == 0;
}

bool Access::serves(std::uint8_t unit, std::span<const std::uint8_t> pdu) const noexcept {
    const std::uint8_t f = pdu[0];
    if (functions.any() && !(f < functions.size() && functions[f])) return false;
    return !read_only || !is_write(f) || stops_only(unit, pdu);
}

}  // namespace axisgate::modbus
