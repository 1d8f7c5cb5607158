#include "adapters/pacontrol/twin/freedoms_read.hpp"

#include "gateway/core/text.hpp"

namespace axisgate::pacontrol::twin {
namespace {

class Source {
public:
    explicit Source(const TwinSetup& setup) : setup_(setup) {}

    [[nodiscard]] std::int64_t number(const char* name, std::int64_t fallback, std::int64_t least, std::int64_t largest) const {
        std::int64_t n = fallback;
        if (setup_.freedoms.contains(name)) {
            n = freedom(setup_.freedoms, name, fallback);
        } else if (const auto given = setup_.options.find(name); given != setup_.options.end()) {
            n = parse_whole(given->second, least, largest).value_or(fallback);
        }
        return n < least || n > largest ? fallback : n;
    }
    [[nodiscard]] Duration ms(const char* name, std::int64_t fallback = 0) const {
        return std::chrono::milliseconds(number(name, fallback, 0, longest_ms));
    }
    [[nodiscard]] bool flag(const char* name, bool fallback) const { return number(name, fallback ? 1 : 0, 0, 1) != 0; }
    /// One of `count` choices, numbered from 0.
    template <class E>
    [[nodiscard]] E choice(const char* name, E fallback, int count) const {
        return static_cast<E>(number(name, static_cast<std::int64_t>(fallback), 0, count - 1));
    }
    [[nodiscard]] bool has_option(const char* name) const { return setup_.options.contains(name); }

private:
    static constexpr std::int64_t longest_ms = 60'000;
    const TwinSetup& setup_;
};

void take_axis(const Source& from, AxisModel& a) {
    if (!from.has_option("model")) a.ep = from.flag("ep_functions", true);
    if (!from.has_option("measuring")) a.measuring = from.flag("measuring_mode", true);
    a.motion_start = from.ms("motion_start_ms");
    a.axis_on = from.ms("axis_on_ms");
    a.status_behind = from.ms("status_late_ms");
    a.position_every = from.ms("position_every_ms");
    a.reference_shown = from.flag("reference_status", true);
    a.measured_position = from.flag("measured_position", false);
    a.hysteresis = static_cast<double>(from.number("switch_hysteresis_increments", 0, 0, 5000)) / 1000;
}

void take_control(const Source& from, ControlFreedoms& c) {
    c.busy = from.ms("busy_ms");
    c.io_scan = from.ms("io_scan_ms");
    c.error_shown = from.ms("error_shown_ms");
    c.error_cleared = from.ms("error_cleared_ms");
    c.reference_at_once = from.flag("reference_acknowledged", false);
    c.axis_on_awaited = from.flag("axis_on_acknowledged", false);
    c.null_references = from.flag("null_references", true);
    c.online_resumes = from.flag("online_resumes", true);
    c.reference_outlives = from.flag("reference_outlives", true);
    c.excluded_unanswered = from.flag("excluded_command", false);
    c.system_elements = from.flag("system_elements", true);
    c.switching = from.choice("switching_commands", Switching::known, 3);
    c.wrong_mode = static_cast<std::uint16_t>(from.number("wrong_mode_error", 0x14, 0x14, 0x15));
}

void take_answers(const Source& from, DeviceSetup& d) {
    AnswerFreedoms& a = d.answers;
    if (!from.has_option("reply_check")) d.reply_check = from.choice("reply_check_form", ReplyCheck::with_etx, 3);
    if (!from.has_option("request_check")) a.frames.check = from.choice("request_check_form", RequestCheck::text, 3);
    a.frames.silence = from.ms("frame_silence_ms", 1000);
    a.silence_answered = from.flag("frame_silence_answer", false);
    a.reals = from.choice("real_form", RealForm::seven_digits, 3);
    a.idle_poll = from.choice("idle_poll", IdlePoll::last, 3);
    a.at_power_on = from.choice("power_on_message", Announcement::none, 3);
    a.errors_announced = from.flag("error_message", false);
    a.parameter_store = from.ms("parameter_store_ms");
}

}  // namespace

void take_freedoms(const TwinSetup& setup, DeviceSetup& d) {
    const Source from(setup);
    take_axis(from, d.control.axis);
    d.control.axis.mechanics = shaft_freedoms(setup.freedoms);
    d.control.axis.seed = setup.seed;
    take_control(from, d.control.freedoms);
    d.control.times.start = from.ms("start_ms", 8);
    d.control.times.home = from.ms("home_ms");
    d.control.times.initialise = from.ms("initialise_ms");
    if (!from.has_option("absolute")) d.control.absolute = from.flag("absolute_system", true);
    take_answers(from, d);
}

}  // namespace axisgate::pacontrol::twin
