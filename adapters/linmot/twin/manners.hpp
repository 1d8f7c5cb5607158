// Manners are the freedoms of a simulated LinMot drive that are its own: the contents and the lateness of its response, the count of motion
// commands after a start, the duration of its internal jobs. schema/families/linmot.json describes them; the defaults are the drive as the
// manual shows it.
#pragma once

#include "gateway/core/freedom.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::linmot::twin {

/// The contents of the response after the status word.
enum class Content : std::uint8_t { standard, with_demand, with_all, without_position };
/// The answer to the request for the warn word (00h, sub ID 03h): with two bytes of unknown meaning, without them, or none.
enum class WarnAnswer : std::uint8_t { long_form, short_form, none };

struct Manners {
    Content content = Content::standard;
    WarnAnswer warn_answer = WarnAnswer::long_form;
    bool ram_access = true;            ///< main ID 03h is answered
    bool parameter_info = true;        ///< usage, type, limits and default of a parameter are told
    bool exact_length = false;         ///< a request with surplus bytes is not answered
    bool clears_count = false;         ///< enabling sets the count of the last command to 0
    std::uint8_t first_count = 0;      ///< 1..15: the count after power-on; 0: none was written
    int homing_phases = 0;             ///< sub states that state 9 shows before it has finished
    std::int64_t home_hysteresis = 0;  ///< 0.1 um
    Duration restart = std::chrono::seconds(3), hardware_test = std::chrono::milliseconds(300);
    Duration status_late{}, motion_late{}, in_target_late{}, warn_late{};
    Duration request_pause{}, table_write{}, save{}, homing_check{}, current_rise{};
    Duration foreign{}, unsolicited{};  ///< periods; 0: off
    ShaftFreedoms shaft;

    Manners() = default;
    explicit Manners(const FreedomValues& of) {
        const auto number = [&](std::string_view name, std::int64_t fallback = 0) { return freedom(of, name, fallback); };
        const auto ms = [&](std::string_view name, std::int64_t fallback = 0) {
            return Duration(std::chrono::milliseconds(number(name, fallback)));
        };
        content = static_cast<Content>(number("response_content"));
        warn_answer = static_cast<WarnAnswer>(number("warn_answer"));
        ram_access = number("ram_access", 1) != 0;
        parameter_info = number("parameter_info", 1) != 0;
        exact_length = number("exact_length") != 0;
        clears_count = number("count_at_enable") != 0;
        first_count = static_cast<std::uint8_t>(number("first_count") & 0x0F);
        homing_phases = static_cast<int>(number("homing_phases"));
        home_hysteresis = number("switch_hysteresis_increments");
        restart = ms("restart_ms", 3000);
        hardware_test = ms("hardware_test_ms", 300);
        status_late = ms("status_late_ms");
        motion_late = ms("motion_active_late_ms");
        in_target_late = ms("in_target_late_ms");
        warn_late = ms("warn_late_ms");
        request_pause = ms("request_pause_ms");
        table_write = ms("table_write_ms");
        save = ms("save_ms");
        homing_check = ms("homing_check_ms");
        current_rise = ms("current_rise_ms");
        foreign = ms("foreign_ms");
        unsolicited = ms("unsolicited_ms");
        shaft = shaft_freedoms(of);
    }
};

}  // namespace axisgate::linmot::twin
