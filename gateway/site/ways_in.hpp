// Ways in: each way by which somebody can set an axis in motion, with the losses by which what was begun so comes to its end.
// In: nothing. Out: the table of which doors name their own entries. A way without a loss does not compile, and a door without an answer to
// ways_in() neither; every family is rehearsed for each way (tests/conformance).
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "gateway/core/command.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

struct WayIn {
    std::string_view name;
    Door door = Door::none;             ///< of the client, as leases and events have it
    bool streams = false;               ///< by set-points that are renewed, not by commands
    std::span<const LossCause> losses;  ///< that end it; their teller is the door, or the engine where a lease or the gateway ends
};

namespace losses_of {
inline constexpr std::array modbus{LossCause::modbus_closed, LossCause::modbus_silent};
inline constexpr std::array enip_implicit{LossCause::enip_closed, LossCause::enip_timed_out, LossCause::enip_idle};
inline constexpr std::array enip_messages{LossCause::enip_session_closed, LossCause::enip_silent};
inline constexpr std::array http_commands{LossCause::lease_ended};
inline constexpr std::array http_set_points{LossCause::set_points_silent};
inline constexpr std::array dds{LossCause::dds_deadline};
}  // namespace losses_of

inline constexpr std::array modbus_tcp_ways{WayIn{"modbus_tcp", Door::modbus, false, losses_of::modbus}};
inline constexpr std::array modbus_rtu_ways{WayIn{"modbus_rtu", Door::modbus, false, losses_of::modbus}};
inline constexpr std::array enip_ways{WayIn{"enip_implicit", Door::ethernet_ip, false, losses_of::enip_implicit},
                                      WayIn{"enip_messages", Door::ethernet_ip, false, losses_of::enip_messages}};
/// Requests have no connection that could be lost: who commands so holds his axes by a lease, or moves with `hold_ms`. Recipes are their
/// starter's commands.
inline constexpr std::array http_ways{WayIn{"http_commands", Door::http, false, losses_of::http_commands},
                                      WayIn{"recipes", Door::http, false, losses_of::http_commands},
                                      WayIn{"http_set_points", Door::http, true, losses_of::http_set_points}};
inline constexpr std::array dds_ways{WayIn{"dds_commands", Door::dds, false, losses_of::dds},
                                     WayIn{"dds_set_points", Door::dds, true, losses_of::dds}};

inline constexpr std::array<std::span<const WayIn>, 5> ways_of_all_doors{modbus_tcp_ways, modbus_rtu_ways, enip_ways, http_ways, dds_ways};
/// Losses of whomever: the engine sees them by itself.
inline constexpr std::array losses_of_anybody{LossCause::line_lost, LossCause::gateway_ends, LossCause::motion_unowned};

[[nodiscard]] constexpr bool tells(const WayIn& way, LossCause cause) {
    return std::find(way.losses.begin(), way.losses.end(), cause) != way.losses.end();
}
/// Whose client is lost by it; http where anybody's may be.
[[nodiscard]] constexpr Door door_that_tells(LossCause cause) {
    for (const auto& door : ways_of_all_doors) {
        for (const WayIn& way : door) {
            if (tells(way, cause)) return way.door;
        }
    }
    return Door::http;
}
/// It can only be missed by who streams set-points.
[[nodiscard]] constexpr bool of_streams_alone(LossCause cause) {
    bool streams = false;
    for (const auto& door : ways_of_all_doors) {
        for (const WayIn& way : door) {
            if (!tells(way, cause)) continue;
            if (!way.streams) return false;
            streams = true;
        }
    }
    return streams;
}

namespace law {
constexpr bool each_way_has_a_loss() {
    for (const auto& door : ways_of_all_doors) {
        if (door.empty()) return false;
        for (const WayIn& way : door) {
            if (way.losses.empty()) return false;
        }
    }
    return true;
}
constexpr bool each_loss_has_a_teller() {
    for (const LossCause cause : loss_causes) {
        bool told = std::find(losses_of_anybody.begin(), losses_of_anybody.end(), cause) != losses_of_anybody.end();
        for (const auto& door : ways_of_all_doors) {
            for (const WayIn& way : door)
                told = told || tells(way, cause);
        }
        if (!told) return false;
    }
    return true;
}
}  // namespace law
static_assert(law::each_way_has_a_loss(), "for every way in that can start motion there is a loss that ends it");
static_assert(law::each_loss_has_a_teller(), "no cause stands in the matrix that nobody tells");

}  // namespace axisgate
