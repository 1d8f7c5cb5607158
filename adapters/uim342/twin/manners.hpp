// Manners: the specimen's values of the freedoms that this family has beyond the common ones, as the page schema/families/uim342.json
// names them. The defaults are the drive as the manual shows it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "gateway/core/freedom.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::uim342::twin {

struct Manners {
    explicit Manners(const FreedomValues& values = {}, std::uint64_t specimen_seed = 0)
        : seed(specimen_seed), shaft(shaft_freedoms(values)) {
        const auto flag = [&](std::string_view name, bool fallback) { return freedom(values, name, fallback ? 1 : 0) != 0; };
        const auto ms = [&](std::string_view name) { return std::chrono::milliseconds(freedom(values, name)); };
        broadcast_acknowledge = flag("broadcast_acknowledge", true);
        unasked_errors = flag("unasked_errors", true);
        error_keeps_bit7 = flag("error_keeps_bit7", true);
        notification_first = flag("notification_first", false);
        notifications_at_factory = flag("notifications_at_factory", true);
        short_values = flag("short_values", true);
        settings_at_rest = flag("settings_at_rest", false);
        restore_restarts = flag("restore_restarts", false);
        boot_notice = flag("boot_notice", false);
        notification_late = ms("notification_late_ms");
        in_position = ms("in_position_ms");
        status_late = ms("status_late_ms");
        input_late = ms("input_late_ms");
        driver_on = ms("driver_on_ms");
        restart = ms("restart_ms");
        unasked_status = ms("unasked_status_ms");
        notification_lost = freedom(values, "notification_lost_per_mille");
        notification_to = static_cast<std::uint8_t>(freedom(values, "notification_to", 4));
        error_slots = static_cast<std::uint8_t>(freedom(values, "error_slots", 9));
        firmware = static_cast<std::uint16_t>(freedom(values, "firmware_version"));
        counter_start = static_cast<std::int32_t>(freedom(values, "counter_start_increments"));
    }

    std::uint64_t seed;
    ShaftFreedoms shaft;
    bool broadcast_acknowledge, unasked_errors, error_keeps_bit7, notification_first, notifications_at_factory, short_values;
    bool settings_at_rest, restore_restarts, boot_notice;
    Duration notification_late, in_position, status_late, input_late, driver_on, restart, unasked_status;
    std::int64_t notification_lost;
    std::uint8_t notification_to, error_slots;
    std::uint16_t firmware;
    std::int32_t counter_start;
};

}  // namespace axisgate::uim342::twin
