// Control: the judgements, and what the site has set.
// In: status, error and axes as they were received. Out: words, notices, samples.
// STATUS and ERROR never tell whose trouble it is: the axes' own statuses do.
#include "adapters/pacontrol/drive_control.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration judge_limit = std::chrono::seconds(2);  // for all statuses to be read: sixteen at 9600 baud take 0.7 s
}

DriveOptions drive_options(const DriveSetup& d) {
    DriveOptions o;
    drive::OptionReader read(d.options);
    o.online_auto = read.flag("online", true, "auto", "manual");
    o.give_back_auto = read.flag("give_back", true, "auto", "never");
    o.parameters_wait = read.flag("when", false, "wait", "refuse");
    o.set_by_g26 = read.flag("set_position", false, "g26", "g29");
    o.release = read.flag("reference", false, "release", "keep");
    o.wait_limit = read.milliseconds("when_timeout_ms", 100, 3'600'000, o.wait_limit);
    o.processing_limit = read.milliseconds("processing_timeout_ms", 100, 3'600'000, o.processing_limit);
    std::string_view order = read.text("reference_order");
    while (!order.empty()) {
        int n = 0;
        const auto [p, ec] = std::from_chars(order.data(), order.data() + order.size(), n);
        const auto used = static_cast<std::size_t>(p - order.data());
        if (ec != std::errc{} || n < 1 || n > 16 || (used < order.size() && order[used] != ',')) {
            read.fault("option reference_order: write channels 1 to 16 with commas, as in 3,1,2; the channels' own order is used");
            o.reference_order.clear();
            break;
        }
        o.reference_order.push_back(n);
        order.remove_prefix(std::min(order.size(), used + 1));
    }
    o.faults = read.take_faults();
    return o;
}

Control::Control(Bus& of_line, const DriveSetup& of_site)
    : DriveBase(of_site, of_line.timing, 0, channels, drive::Tickets(channels * (Axis::queue_limit + Axis::wait_limit + 1) + stop_limit)),
      bus(of_line),
      options(drive_options(of_site)),
      axes(channels) {
    for (std::size_t i = 0; i < axes.size(); ++i)
        axes[i].channel = static_cast<int>(i) + 1;
    for (const AxisSetup& a : of_site.axes)
        if (a.channel >= 1 && a.channel <= channels) axes[static_cast<std::size_t>(a.channel) - 1].id = a.id;
}

Axis* Control::axis_of(AxisId id) noexcept {
    const auto it = id == no_axis ? axes.end() : std::ranges::find(axes, id, &Axis::id);
    return it == axes.end() ? nullptr : &*it;
}

void Control::forget() {
    processing = {};
    mode = -1;
    error = 0;
    started_by_us = leaving = give_back_due = system_flags_missing = stop_axis_missing = false;
    busy_until = {};
    for (Axis& a : axes) {
        a.fb = {};
        a.fb.position = a.fb.position_demand = a.counter;
        a.demand = {};
        a.position_known = a.missing = a.on = a.running = a.prepared = a.condition_set = a.extended_missing = a.no_switch = false;
        a.switching_until = a.stopping_until = {};
        a.status = a.limits = -1;
        a.counter_at = a.velocity_at = a.running_at = a.status_at = {};
        a.motion = {};
        a.speed.reset();
        a.acceleration.reset();
        a.renewal.stop();
    }
}

void Control::begin_processing(std::size_t axis, std::uint16_t code, bool foreign, Instant now) {
    processing = {true, foreign, false, false, axis, axis, code, now, now + options.processing_limit};
}

void Control::sample(const Axis& a, Point point, const Value& value, Turn& t) const {
    const Binding* b = bus.elements.binding(point);
    if (!b || !known(value)) return;
    for (const Axis& x : axes) {  // what belongs to the control has one value, whichever axis one looks through
        if (b->drive ? x.used() : &x == &a) t.out.samples.push_back({x.id, point, value, Quality::good, t.now});
    }
}

const Axis* Control::culprit() const noexcept {
    const auto it = std::ranges::find_if(axes, [](const Axis& a) { return a.used() && a.status == 4; });
    return it == axes.end() ? nullptr : &*it;
}

/// Nobody's trouble is everybody's: then none can move.
bool Control::fault_of_all(Instant now) const noexcept {
    if (!in_trouble() || culprit()) return false;
    std::size_t here = 0;
    bool read = true;
    for (const Axis& a : axes) {
        if (!a.here()) continue;
        ++here;
        read = read && a.status >= 0 && a.status_at >= trouble_at;
    }
    return here <= 1 || read || now - trouble_at > judge_limit;
}

std::string Control::mode_text() const { return "operating status " + status_text(mode); }

std::string Control::error_text() const {
    const ErrorCode* of_catalogue = bus.catalogue.error(error, "system");
    return fmt::format("PA-CONTROL error E{}{}{}", error, of_catalogue ? ": " : "", of_catalogue ? of_catalogue->text : "");
}

std::string Control::what_ended(const Axis& a) const {
    if (in_trouble()) {
        const Axis* whose = culprit();
        return fmt::format("{}{}{}", error != 0 ? error_text() + "; " : std::string(), mode_text(),
                           whose && whose != &a ? fmt::format("; it is axis {} that has the malfunction", whose->channel) : std::string());
    }
    if (mode == status::online_stop || mode == status::online_stopped) return "stopped at the control or by its stop input; " + mode_text();
    if (!is_online(mode)) return "ONLINE has ended; " + mode_text();
    return {};
}

std::string Control::why_not_online() const {
    if (is_manual(mode)) return mode_text() + ": an operator has the control; leave manual mode there";
    if (is_automatic(mode)) return mode_text() + ": a program has the axes; automatic.cancel ends it";
    if (in_trouble()) {
        const Axis* whose = culprit();
        return fmt::format("{}, {}: reset the fault{} first", mode_text(), error_text(),
                           whose ? fmt::format(" of axis {}", whose->channel) : std::string());
    }
    return mode_text();
}

std::string Control::why_not_movable(const Axis& a) const {
    if (mode == status::online_stopped || mode == status::online_stop)
        return mode_text() + ": enable the axis again, or let interrupted motions go on with online.start";
    if (mode != status::online) return "axes move in ONLINE alone; " + why_not_online();
    if (a.status == 8) return fmt::format("axis {} is in measuring mode", a.channel);
    if (!a.on) return fmt::format("axis {} is not switched on: enable it first", a.channel);
    return {};
}

/// Out of ONLINE an axis with enable mode 1 has power [L722]; so may one whose mode could not be read.
bool Control::powered_at_home(const Axis& a) const noexcept {
    const AxisDemand::Known& m = a.demand.parameters[AxisDemand::enable_mode];
    return a.here() && (!m.read || !m.value || *m.value == 1);
}

}  // namespace axisgate::pacontrol
