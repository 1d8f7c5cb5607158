// The names of the clients of Modbus/TCP and Modbus RTU, the ways by which they set an axis in motion, and the causes of their loss.
#pragma once

#include "gateway/site/ways_in.hpp"

namespace axisgate::modbus {

inline constexpr Door clients{1};
inline constexpr LossCause loss_closed{1};  ///< its last Modbus connection has ended: by itself, by the network, or closed by the gateway
inline constexpr LossCause loss_silent{2};  ///< connected, but no request for longer than the watchdog time

inline constexpr std::array losses_of_clients{loss_closed, loss_silent};
inline constexpr std::array ways_of_clients{
    WayIn{.name = "modbus_tcp", .door = clients, .losses = losses_of_clients, .by_registers = true},
    WayIn{.name = "modbus_rtu", .door = clients, .losses = losses_of_clients, .by_registers = true},
};
inline constexpr std::span<const WayIn> tcp_ways = std::span(ways_of_clients).first(1), rtu_ways = std::span(ways_of_clients).last(1);
inline constexpr std::array<LossWords, 2> loss_words{{
    {loss_closed, "modbus_closed", "the last Modbus connection of the commanding client has ended", "has closed its last connection", ""},
    {loss_silent, "modbus_silent", "the commanding client is connected over Modbus, and has sent no request for longer than watchdog_ms",
     "has been silent", "has been silent for {} ms"},
}};
inline constexpr DoorWords door_words{
    .door = clients, .name = "modbus", .ways = ways_of_clients, .losses = loss_words, .silence = loss_silent};
static_assert(law::each_way_has_a_loss(door_words) && law::each_loss_has_a_teller(door_words));

}  // namespace axisgate::modbus
