// The name of the clients of DDS, the ways by which they set an axis in motion, and the causes of their loss.
#pragma once

#include "gateway/site/ways_in.hpp"

namespace axisgate::dds {

inline constexpr Door clients{4};
/// Its set-point missed its deadline, or it no longer has a writer (liveliness).
inline constexpr LossCause loss_deadline{10};

inline constexpr std::array losses_of_clients{loss_deadline};
inline constexpr std::array ways_of_clients{
    WayIn{.name = "dds_commands", .door = clients, .losses = losses_of_clients},
    WayIn{.name = "dds_set_points", .door = clients, .streams = true, .losses = losses_of_clients},
};
inline constexpr std::array<LossWords, 1> loss_words{{
    {loss_deadline, "dds_deadline",
     "the client commands over DDS, and its set-points have missed their deadline or its last writer has ended",
     "is gone from the DDS domain: nobody writes for it any more", "has missed the deadline of its set-points over DDS: none for {} ms"},
}};
inline constexpr DoorWords door_words{
    .door = clients, .name = "dds", .ways = ways_of_clients, .losses = loss_words, .unrenewed = loss_deadline};
static_assert(law::each_way_has_a_loss(door_words) && law::each_loss_has_a_teller(door_words));

}  // namespace axisgate::dds
