// Checks each streamed set-point and passes it to its adapter, or refuses it with one reason. A stream that was ended does not begin again
// before its client has paused.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/engine/command_authority.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/motions.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/routing.hpp"
#include "gateway/engine/streams.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate::engine {
namespace {
/// The mode in which the drive follows set-points of this kind: the cyclic mode, or the older one that is closest to it; empty if there is
/// none.
std::int16_t stream_mode(const Catalogue& catalogue, SetPoint::Mode kind) {
    for (const std::int16_t m : {cia402::mode_of(kind), cia402::older_mode_of(kind)})
        if (m != cia402::mode_none && catalogue.offers_mode(m)) return m;
    return cia402::mode_none;
}
constexpr Duration refusal_published_again = std::chrono::seconds(1);
}  // namespace

std::optional<Refusal> Streams::on_set_point(const SetPoint& p, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->set_point(p, now);
    machine_.now = machine_.last_stir = std::max(machine_.now, now);
    Axis* a = machine_.axis(p.axis);
    if (!a || machine_.closing) return Refusal{Reason::line_down, a ? "the gateway is stopping" : "there is no such axis"};
    Axis::Stream& s = a->stream;
    const auto who = AuthorityClient::of(p.origin);
    auto no = against(*a, p, who, now);
    if (!s.on && s.ended_by == who) {
        s.ended_received = now;
        if (no && no->reason != s.ended_for) {  // a later refusal counts like an end
            s.ended_for = no->reason;
            s.ended_why = no->text;
        }
    }
    if (no) {
        ++s.refused;
        s.unpublished = std::exchange(s.refusal, no->reason) != no->reason || s.unpublished;
        if (s.unpublished && now >= s.tell_again_at) {
            s.unpublished = false;
            s.tell_again_at = now + refusal_published_again;
            tell(*a, p.origin, Severity::warning, fmt::format("a set-point of {} is refused: {}", who.text(), no->text), now);
        }
        publisher_.publish(*a, now);
        return no;
    }
    if (!s.on) begin(*a, p, who, now);
    s.mode = p.mode;
    s.good_for = p.good_for;
    s.renewed = now;
    s.value = p.value;
    s.refusal = Reason::none;
    s.unpublished = false;
    ++s.taken;
    a->profile.follow(p, stream_mode(*a->drive->catalogue, p.mode));
    Motion& m = a->motion;
    m.stream = p.mode;
    m.target = p.value;
    m.velocity = p.velocity.value_or(0);
    m.acceleration = p.acceleration.value_or(0);
    if (p.deceleration) m.deceleration = a->last_deceleration = *p.deceleration;
    publisher_.publish(*a, now);
    Speaker& by = Machine::speaker_of(*machine_.side_of(*a->drive), *a->drive);
    routing_.ask(by, now, [&](Out& out) { by.adapter->on_set_point(p, now, out); });
    if (!s.on) return Refusal{s.ended_for, s.ended_why};  // the stream has not even begun
    return std::nullopt;
}

/// The reason why this set-point is refused; empty if it is passed on.
std::optional<Refusal> Streams::against(const Axis& a, const SetPoint& p, const AuthorityClient& who, Instant now) const {
    const Axis::Stream& s = a.stream;
    if (p.good_for < SetPoint::good_for_min || p.good_for > SetPoint::good_for_max)
        return Refusal{Reason::out_of_range, fmt::format("a set-point is good for {} to {} ms", milliseconds_of(SetPoint::good_for_min),
                                                         milliseconds_of(SetPoint::good_for_max))};
    if (now - p.at > p.good_for) return Refusal{Reason::interrupted, "it came too late: it is older than the time for which it is good"};
    if (now < a.leaving_until) return Refusal{Reason::busy, "a change of the site takes the axis away or makes it anew"};
    if (s.on && !(s.who == who))
        return Refusal{Reason::authority, fmt::format("{} streams set-points to the axis; stop it, or wait until it ends", s.who.text())};
    if (p.origin.door != Door::internal) {
        if (auto v = a.authority.may(who, now); !v.allowed) return Refusal{Reason::authority, std::move(v.text)};
    }
    // Whatever has ended a stream remains in force: a client that does not notice it and continues must not begin another stream with its
    // next cycle.
    const Duration pause = std::max(p.good_for, s.good_for);
    if (!s.on && s.ended_by == who && now - s.ended_received <= pause)
        return Refusal{s.ended_for, fmt::format("the stream is over ({}); send nothing for {} ms before a new one", s.ended_why,
                                                milliseconds_of(pause))};
    if (stream_mode(*a.drive->catalogue, p.mode) == cia402::mode_none) {
        return Refusal{Reason::not_supported,
                       fmt::format("the drive does not follow streamed set-points of {} (mode {}); it has the modes {}", name_of(p.mode),
                                   cia402::mode_of(p.mode), fmt::join(a.drive->catalogue->modes(), ", "))};
    }
    if (p.mode != SetPoint::Mode::torque) {
        if (auto no = orders_.beyond_limits(a, p.as_move())) return no;
    } else if (p.value < -32767 || p.value > 32767) {
        return Refusal{Reason::out_of_range, fmt::format("torque {} is outside -32767..32767 thousandths", p.value)};
    }
    if (a.motions_asked > 0) return Refusal{Reason::busy, "another motion is on its way to the drive"};
    if (a.stops.bars_motion()) return Refusal{Reason::wrong_state, "a quick stop is on its way to the drive: wait for its answer"};
    if (auto d = a.profile.may_follow(); d.refused) return Refusal{d.reason, std::move(d.text)};
    const Side* side = machine_.side_of(*a.drive);
    if (!side || !side->up) return Refusal{Reason::line_down, "its line is down"};
    return too_far(a, p, Machine::speaker_of(*side, *a.drive));
}

/// A drive that follows each set-point within its interpolation time could exceed the site's limits, whatever the client's period is. The
/// step from the previous set-point (for the first one, from the position of the axis) must not exceed the distance that the limit allows
/// in that time.
std::optional<Refusal> Streams::too_far(const Axis& a, const SetPoint& p, const Speaker& speaker) {
    const Duration period = speaker.adapter->interpolation_time(a.id);
    const bool position = p.mode == SetPoint::Mode::position;
    const auto limit = position ? a.limits.velocity_max : a.limits.acceleration_max;
    if (period <= Duration::zero() || !limit || p.mode == SetPoint::Mode::torque) return std::nullopt;
    const AxisFeedback& f = a.profile.feedback();
    const std::int64_t from = a.stream.on && a.stream.mode == p.mode ? a.stream.value : position ? f.position : f.velocity;
    const double most = static_cast<double>(*limit) * seconds(period);
    const double step = std::fabs(static_cast<double>(p.value) - static_cast<double>(from));
    if (step <= std::max(most, 1.0)) return std::nullopt;
    return Refusal{Reason::out_of_range,
                   fmt::format("a step of {} is more than the {} that {} allows in the drive's interpolation time of {} us",
                               in_unit(std::llround(step), a.limits, position ? "" : "/s"),
                               in_unit(std::llround(most), a.limits, position ? "" : "/s"), position ? "velocity_max" : "acceleration_max",
                               std::chrono::duration_cast<std::chrono::microseconds>(period).count())};
}

/// Events that end a commanded motion end the stream here, too.
void Streams::begin(Axis& a, const SetPoint& p, const AuthorityClient& who, Instant now) {
    authority_.note_commander(a, p.origin, now);
    Motion m;
    m.kind = Motion::Kind::stream;
    m.who = who;
    m.origin = p.origin;
    motions_.acknowledged(a, std::move(m), MotionOrder::in_turn, 0, "streamed set-points", now);
    a.latch.cause = LossCause::none;
    a.prepared.reset();
    machine_.image.picture(a.id).motion_ticket = no_ticket;
    a.stream.on = true;
    a.stream.who = who;
    a.stream.origin = p.origin;
    tell(a, p.origin, Severity::info, fmt::format("streamed set-points begin ({})", name_of(p.mode)), now);
}

void Streams::end(Axis& a, Reason reason, const std::string& why, Instant now) {
    Axis::Stream& s = a.stream;
    if (!s.on) return;
    s.on = false;
    s.refusal = s.ended_for = reason;
    s.ended_by = s.who;
    s.ended_received = now;
    s.ended_why = why;
    a.profile.end_following();
    Motion& m = a.motion;
    const bool pushes = m.stream != SetPoint::Mode::position && m.target != 0;  // the axis may still begin to move
    if (m.kind == Motion::Kind::stream && a.profile.at_rest() && !pushes) m.over = true;
    tell(a, s.origin, reason == Reason::none ? Severity::info : Severity::warning, fmt::format("streamed set-points end: {}", why), now);
    publisher_.publish(a, now);
}

/// The drive has not accepted a set-point. Its motion is not what the client requests, so the client is treated as lost.
void Streams::refused(const Side& side, const Out::StreamEnd& by_drive, Instant now) {
    Axis* a = machine_.axis(by_drive.axis);
    if (!a || !a->stream.on || a->drive->serving != (side.twin ? Presence::twin : Presence::device)) return;
    end(*a, by_drive.reason, by_drive.text, now);
    if (a->motion.kind == Motion::Kind::stream && !a->motion.over) orders_.give_own(*a, Halt{}, now);
}

/// Called with every housekeeping, so an end is at most one housekeeping period late.
void Streams::check(Axis& a, Instant now) {
    if (!a.stream.on) return;
    if (now - a.stream.renewed > a.stream.good_for) {
        loss_.act(a, unrenewed_of(a.stream.who.door), now);
        return end(a, Reason::interrupted,
                   fmt::format("{} has not renewed them for {} ms", a.stream.who.text(), milliseconds_of(a.stream.good_for)), now);
    }
    authority_.note_commander(a, a.stream.origin, now);  // a client that streams is commanding, so its lease is renewed
}

void Streams::tell(const Axis& a, const Origin& by, Severity severity, std::string text, Instant now) {
    Event e;
    e.severity = severity;
    e.kind = "set_points";
    e.axis = a.spec.name;
    e.text = std::move(text);
    e.who = by.who ? *by.who : "";
    e.door = std::string(name_of(by.door));
    publisher_.event(std::move(e), now);
}

}  // namespace axisgate::engine
