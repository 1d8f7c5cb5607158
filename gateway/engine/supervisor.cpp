// An axis that exceeds a limit, or has no room left to stop before it, is stopped on the quick-stop ramp, with an alarm. A velocity move
// has no target that could be checked beforehand: while there is room, it is halted early enough to come to rest at the limit, with an
// event; this is normal operation and no alarm. A position move inside its limits is trusted until it is seen beyond them.
#include "gateway/engine/supervisor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"

namespace axisgate::engine {
namespace {
/// If its ramp is unknown, an axis is assumed to need this time to come to rest.
constexpr double worst_stop_s = 1.0;
/// A measured speed that exceeds its limit by no more than this is overshoot of the drive's control.
constexpr double overspeed = 1.1;
constexpr Duration state_limit = std::chrono::seconds(2);
constexpr Duration quick_stop_margin = std::chrono::seconds(1);

double way_to_rest(double speed, std::int64_t ramp) {
    return ramp > 0 ? speed * speed / (2 * static_cast<double>(ramp)) : speed * worst_stop_s / 2;
}
}  // namespace

void Supervisor::look(Axis& a, Instant now) {
    inputs(a, now);
    const AxisFeedback& f = a.profile.feedback();
    if (!f.moving || (a.drive->family.family->uses_dds && !a.motion.runs())) return;
    state(a, now);
    if (f.homing || a.motion.kind == Motion::Kind::homing) return;  // the position is about to be redefined
    if (a.motion.runs() || !a.asked.runs()) limits(a, a.motion, now);
    if (a.asked.runs()) limits(a, a.asked, now);
    speed(a, now);
}

void Supervisor::limits(Axis& a, const Motion& m, Instant now) {
    if (m.kind == Motion::Kind::homing) return;
    const AxisFeedback& f = a.profile.feedback();
    const bool by_speed = m.kind == Motion::Kind::velocity || (m.kind == Motion::Kind::stream && m.stream == SetPoint::Mode::velocity);
    // A drive may report its position before its speed: then the ordered speed is assumed.
    const std::int64_t velocity = f.velocity != 0 ? f.velocity : by_speed ? m.target : 0;
    if (velocity == 0) return;
    const bool up = velocity > 0;
    const auto& limit = up ? a.limits.position_max : a.limits.position_min;
    if (!limit) return;
    const double left = static_cast<double>(up ? *limit - f.position : f.position - *limit);
    const double reported = std::fabs(static_cast<double>(velocity));
    const std::int64_t ramp = m.deceleration > 0 ? m.deceleration : a.deceleration(),
                       quick = f.rates.quick_stop > 0 ? f.rates.quick_stop : ramp;
    const double late = 2 * reported * a.watch.round_s;  // until the next position arrives, and until the stop has reached the drive
    constexpr double settling = 2;                       // increments
    const auto ends_badly = [&](double room) {
        if (left >= room || a.motion.alarmed) return false;
        const std::string place = fmt::format("{} {}", up ? "position_max" : "position_min", in_unit(*limit, a.limits));
        stop(a, "limit", left < 0 ? fmt::format("it is beyond {}", place) : fmt::format("it cannot come to rest before {}", place), now);
        return true;
    };
    const bool to_place = m.kind == Motion::Kind::position || (m.kind == Motion::Kind::stream && m.stream == SetPoint::Mode::position);
    const bool inside = to_place && (!a.limits.position_max || m.target <= *a.limits.position_max) &&
                        (!a.limits.position_min || m.target >= *a.limits.position_min);
    if (a.stops.wanted) {
        // The axis is being stopped already: only a ramp that is too weak requires the stronger stop. The halt was given early by some
        // distance, which may be used, and it was calculated with the assumed ramp if the ramp is unknown.
        if (*a.stops.wanted != Stops::Kind::halt) return;
        const double then = std::max(reported, static_cast<double>(a.stops.speed_then));
        const double way = ramp > 0 ? way_to_rest(reported, ramp) : reported * reported / then * worst_stop_s / 2;
        (void)ends_badly(way - std::max(settling, 2 * then * a.watch.round_s));
        return;
    }
    if (inside) {
        (void)ends_badly(-std::max(settling, late));
        return;
    }
    if (by_speed || m.kind == Motion::Kind::position) {
        // The reported speed may be older than the position, by as much as the guard is early.
        if (ends_badly(std::max(-settling, way_to_rest(reported, ramp) - late))) return;
        // An axis that accelerates is faster when the halt arrives, but never faster than ordered.
        const double gained = reported + 2 * a.watch.round_s * static_cast<double>(m.acceleration);
        const double ordered = std::fabs(static_cast<double>(by_speed ? m.target : m.velocity));
        const double speed = by_speed && (m.target > 0) == up ? std::max(reported, std::min(gained, ordered)) : reported;
        if (left <= 2 * speed * a.watch.round_s + way_to_rest(speed, ramp)) halt(a, up, *limit, now);
        return;
    }
    if (left <= late + way_to_rest(reported, quick) && !a.motion.alarmed)
        stop(a, "limit", fmt::format("it is on its way out at {} {}", up ? "position_max" : "position_min", in_unit(*limit, a.limits)),
             now);
}

void Supervisor::speed(Axis& a, Instant now) {
    const auto& limit = a.limits.velocity_max;
    if (!limit || a.motion.alarmed || a.stops.wanted) return;
    const double measured = std::fabs(static_cast<double>(a.profile.feedback().velocity));
    if (measured <= overspeed * static_cast<double>(*limit) + 1) return;
    stop(a, "limit", fmt::format("its speed is above velocity_max {}", in_unit(*limit, a.limits, "/s")), now);
}

/// The axis moves while its state says that it has no power, or that its quick stop is over.
void Supervisor::state(Axis& a, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    const PowerState shown = a.profile.state();
    const std::int64_t fast = std::llabs(f.velocity);
    if (shown == PowerState::switch_on_disabled || shown == PowerState::ready_to_switch_on || shown == PowerState::switched_on) {
        if (a.moves_since == Instant{}) a.moves_since = now;
        if (now == a.moves_since) a.speed_then = fast;
        // An axis that was switched off runs down; an axis that keeps its speed is driven.
        if (fast * 10 < a.speed_then * 9) {
            a.moves_since = now;
            a.speed_then = fast;
        }
        if (a.contradicts || now - a.moves_since < state_limit) return;
    } else if (shown == PowerState::quick_stop_active && a.stops.first_at != Instant{}) {
        const std::int64_t ramp = f.rates.quick_stop > 0 ? f.rates.quick_stop : a.deceleration();
        const double ramp_s = ramp > 0 ? static_cast<double>(a.stops.speed_then) / static_cast<double>(ramp) : worst_stop_s;
        const auto bound =
            quick_stop_margin + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(1.5 * std::min(ramp_s, 60.0)));
        if (now - a.stops.first_at < bound) return;
        if (a.contradicts) {
            if (!a.stops.wanted || (a.stops.acknowledged && now - a.stops.given_at > quick_stop_margin))
                orders_.give_own(a, QuickStop{}, now);
            return;
        }
    } else if (shown == PowerState::operation_enabled && a.stops.wanted && a.stops.acknowledged) {
        return halted(a, now);
    } else {
        if (a.motion.runs()) a.moves_since = {};
        return;
    }
    a.contradicts = true;
    stop(a, "state", fmt::format("it moves while it is {}", name_of(shown)), now);
}

/// The drive has acknowledged a stop. An axis that has not lost a tenth of its speed in the time for that, and a second more, goes on.
void Supervisor::halted(Axis& a, Instant now) {
    const std::int64_t fast = std::llabs(a.profile.feedback().velocity), ramp = a.deceleration();
    const double tenth_s = ramp > 0 ? static_cast<double>(fast) / static_cast<double>(ramp) / 10 : worst_stop_s / 10;
    const auto bound =
        quick_stop_margin + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(1.5 * std::min(tenth_s, 60.0)));
    const bool begins = a.moves_since < a.stops.given_at;
    if (begins || now - a.moves_since < bound / 2) {  // a single reading may be far off
        a.speed_then = begins ? fast : std::max(a.speed_then, fast);
        if (begins) a.moves_since = now;
        return;
    }
    if (a.contradicts || fast == 0 || now - a.moves_since < bound) return;
    if (fast * 10 < a.speed_then * 9) return void(a.moves_since = {});
    a.contradicts = true;
    stop(a, "state", "it does not slow down although its drive has acknowledged a stop", now);
}

/// When an input has removed the power, the gateway withdraws its enable as well, so that the axis is not enabled when the input is
/// released.
void Supervisor::inputs(Axis& a, Instant now) {
    const bool acts = a.profile.feedback().safe_stop;
    if (std::exchange(a.was_safe_stop, acts) == acts) return;
    Event e;
    e.severity = acts ? Severity::alarm : Severity::info;
    e.kind = "safe_stop";
    e.axis = a.spec.name;
    e.text = acts ? "a safe input has taken its power or motion away: the axis is switched off, and enabled again only by an order"
             : a.profile.commanded() ? "the axis is enabled again after a safe input had taken its power or motion away"
                                     : "the safe input is given back: enable the axis to move it again";
    publisher_.event(std::move(e), now);
    if (!acts) return;
    a.latch.bits = StopLatch::latched | StopLatch::by_safe_input;
    a.latch.by = {};
    if (a.profile.commanded() || a.motion.runs()) orders_.give_own(a, Disable{}, now);
}

void Supervisor::halt(Axis& a, bool up, std::int64_t limit, Instant now) {
    Event e;
    e.severity = Severity::warning;
    e.kind = "limit";
    e.axis = a.spec.name;
    e.text = fmt::format("{} is halted at the axis' {} {}", a.motion.kind == Motion::Kind::position ? "the move" : "the velocity move",
                         up ? "position_max" : "position_min", in_unit(limit, a.limits));
    publisher_.event(std::move(e), now);
    orders_.give_own(a, Halt{}, now);
    a.at_limit = true;
}

void Supervisor::stop(Axis& a, std::string_view kind, std::string_view why, Instant now) {
    a.motion.alarmed = true;
    Event e;
    e.severity = Severity::alarm;
    e.kind = kind;
    e.axis = a.spec.name;
    if (a.motion.runs() && a.motion.who.door != Door::none) e.who = a.motion.who.text();
    e.text = fmt::format("the axis is stopped: {}", why);
    publisher_.event(std::move(e), now);
    a.at_limit = kind == "limit";
    a.latch.bits = StopLatch::latched | StopLatch::by_fail_safe;
    a.latch.by = {};
    orders_.give_own(a, QuickStop{}, now);
    publisher_.publish(a, now);
}

}  // namespace axisgate::engine
