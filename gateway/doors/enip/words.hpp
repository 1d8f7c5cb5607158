// The name of the clients of EtherNet/IP, the ways by which they set an axis in motion, and the causes of their loss.
#pragma once

#include "gateway/site/ways_in.hpp"

namespace axisgate::enip {

inline constexpr Door clients{2};
inline constexpr LossCause loss_closed{5};           ///< its connection was closed, by its scanner or by the gateway
inline constexpr LossCause loss_timed_out{6};        ///< its connection received nothing for its time-out (interval x multiplier)
inline constexpr LossCause loss_idle{7};             ///< its scanner has signalled program mode (the run/idle bit)
inline constexpr LossCause loss_session_closed{11};  ///< it commanded by messages, and its last session has ended
inline constexpr LossCause loss_silent{12};          ///< its session is open, but no message came for longer than the watchdog time

inline constexpr std::array losses_of_connections{loss_closed, loss_timed_out, loss_idle};
inline constexpr std::array losses_of_messages{loss_session_closed, loss_silent};
inline constexpr std::array ways_of_clients{
    WayIn{.name = "enip_implicit", .door = clients, .losses = losses_of_connections, .by_registers = true},
    WayIn{.name = "enip_messages", .door = clients, .losses = losses_of_messages, .by_registers = true},
};
inline constexpr std::array<LossWords, 5> loss_words{{
    {loss_closed, "enip_closed", "the EtherNet/IP connection of the commanding client was closed",
     "has lost its EtherNet/IP connection: it was closed", ""},
    {loss_timed_out, "enip_timed_out", "the EtherNet/IP connection of the commanding client has timed out (interval x multiplier)",
     "has lost its EtherNet/IP connection: nothing came for its time-out", ""},
    {loss_idle, "enip_idle", "the EtherNet/IP scanner that commands the axis signals idle (program mode)",
     "says that its scanner is idle (program mode)", ""},
    {loss_session_closed, "enip_session_closed", "the client commands by EtherNet/IP messages, and its last session has ended",
     "has closed the EtherNet/IP session by which it commanded", ""},
    {loss_silent, "enip_silent", "the client commands by EtherNet/IP messages, and has sent none for longer than watchdog_ms",
     "has been silent", "has been silent for {} ms"},
}};
inline constexpr DoorWords door_words{
    .door = clients, .name = "ethernet_ip", .ways = ways_of_clients, .losses = loss_words, .silence = loss_silent};
static_assert(law::each_way_has_a_loss(door_words) && law::each_loss_has_a_teller(door_words));

}  // namespace axisgate::enip
