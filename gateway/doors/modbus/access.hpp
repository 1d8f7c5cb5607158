// Access: the locks of the Modbus door: who may connect, which functions are served, and whether anything may be written.
// In: the configuration's texts, a peer's address, a function code. Out: yes or no.
// Never looks a name up: addresses and networks only.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace axisgate::modbus {

/// "192.168.1.0/24", "192.168.1.20", "fd00::/8". IPv4 is kept as IPv4 in IPv6 (::ffff:a.b.c.d), so that both compare in one way.
struct Network {
    std::array<std::uint8_t, 16> address{};
    unsigned bits = 128;
    [[nodiscard]] bool holds(const std::array<std::uint8_t, 16>& peer) const noexcept;
};
[[nodiscard]] std::optional<Network> parse_network(std::string_view text);
/// Address of an endpoint's text ("192.0.2.7:502", "[fd00::1]:502"); nothing if it is none.
[[nodiscard]] std::optional<std::array<std::uint8_t, 16>> address_of(std::string_view endpoint);

struct Access {
    std::vector<Network> allow;  ///< empty: everybody
    std::bitset<128> functions;  ///< none set: all that there are
    bool read_only = false;      ///< what writes is answered with exception 1; a pure stop alone is taken, see stops_only

    [[nodiscard]] bool admits(std::string_view endpoint) const;
    /// `pdu`: of at least one byte. Functions that `functions` leaves out are not served, whatever they say.
    [[nodiscard]] bool serves(std::uint8_t unit, std::span<const std::uint8_t> pdu) const noexcept;
};
[[nodiscard]] bool is_write(std::uint8_t function) noexcept;
/// Whether a request can do nothing but stop: function 6, or 16 with one register, to the control word of an axis of the standard map, with
/// a word that in every state of CiA 402 means quick stop, and has neither a fault reset nor a new set-point in it. To disable the voltage
/// is none: what hangs on an axis without brake falls. Nor is a halt: with an axis that stands ready, the same word switches it on.
[[nodiscard]] bool stops_only(std::uint8_t unit, std::span<const std::uint8_t> pdu) noexcept;

}  // namespace axisgate::modbus
