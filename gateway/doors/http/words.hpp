// The name of the clients of HTTP and the ways by which they set an axis in motion. Requests have no connection that could be lost: their
// clients hold axes by a lease, or move with `hold_ms`. The commands of a recipe are those of the client that started it.
#pragma once

#include "gateway/site/ways_in.hpp"

namespace axisgate::http {

inline constexpr Door clients{3};

inline constexpr std::array losses_of_commands{LossCause::lease_ended};
inline constexpr std::array losses_of_set_points{LossCause::set_points_silent};
inline constexpr std::array ways_of_clients{
    WayIn{.name = "http_commands", .door = clients, .losses = losses_of_commands},
    WayIn{.name = "recipes", .door = clients, .losses = losses_of_commands},
    WayIn{.name = "http_set_points", .door = clients, .streams = true, .losses = losses_of_set_points},
};
inline constexpr DoorWords door_words{.door = clients, .name = "http", .ways = ways_of_clients, .losses = {}, .of_users = true};
static_assert(law::each_way_has_a_loss(door_words) && law::each_loss_has_a_teller(door_words));

}  // namespace axisgate::http
