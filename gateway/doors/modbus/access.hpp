// The locks of the Modbus door: which hosts may connect, which functions are served, and whether writing is possible. Only addresses and
// networks are used, no names.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace axisgate::modbus {

/// "192.168.1.0/24", "192.168.1.20", "fd00::/8". IPv4 is stored as IPv4 in IPv6 (::ffff:a.b.c.d), so that both are compared in one way.
struct Network {
    std::array<std::uint8_t, 16> address{};
    unsigned bits = 128;
    [[nodiscard]] bool holds(const std::array<std::uint8_t, 16>& peer) const noexcept;
};
[[nodiscard]] std::optional<Network> parse_network(std::string_view text);
/// Address in an endpoint's text ("192.0.2.7:502", "[fd00::1]:502"); empty if there is none.
[[nodiscard]] std::optional<std::array<std::uint8_t, 16>> address_of(std::string_view endpoint);

struct Access {
    std::vector<Network> allow;  ///< empty: all hosts
    std::bitset<128> functions;  ///< none set: all functions
    bool read_only = false;      ///< writes are answered with exception 1, except pure stops, see stops_only

    [[nodiscard]] bool admits(std::string_view endpoint) const;
    /// `pdu` has at least one byte. Functions that `functions` leaves out are not served, whatever the request is.
    [[nodiscard]] bool serves(std::uint8_t unit, std::span<const std::uint8_t> pdu) const noexcept;
};
[[nodiscard]] bool is_write(std::uint8_t function) noexcept;
/// True if a request can only stop: function 6, or 16 with one register, to the control word of an axis of the standard map, with a word
/// that means quick stop in every state of CiA 402, without fault reset and new set-point. Disabling the voltage is not a stop, because an
/// axis without a brake would fall. A halt is not one either: the same word switches on an axis that is ready.
[[nodiscard]] bool stops_only(std::uint8_t unit, std::span<const std::uint8_t> pdu) noexcept;

}  // namespace axisgate::modbus
