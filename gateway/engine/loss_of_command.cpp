// Decides which client or drive was lost and applies the site's action. One loss causes one action: until the next command to the axis, the
// first cause remains.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/streams.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate::engine {
namespace {
/// `limit`: the time that has passed; 0: the door has told it.
std::string why_lost(LossCause cause, Duration limit) {
    const LossWords* words = words_of(cause);
    if (!words) return "is lost";
    std::string text(limit > Duration::zero() && !words->text_after.empty() ? words->text_after : words->text);
    if (const auto time = text.find("{}"); time != std::string::npos) text.replace(time, 2, std::to_string(milliseconds_of(limit)));
    return text;
}
}  // namespace

void LossOfCommand::on_client_lost(const AuthorityClient& who, LossCause cause, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->client_lost(who, cause, now);
    machine_.now = std::max(machine_.now, now);
    for (const auto& a : machine_.axes) {
        if (!a) continue;
        // A live feed may be one of several connections of its client, whose other motions continue when the feed closes. Set-points with
        // a deadline of their own (DDS) continue while they are renewed, even if another writer of their client ends.
        const bool streams = a->stream.on && a->stream.who == who, feed = cause == LossCause::set_points_silent;
        const bool owns = a->motion.runs() ? a->motion.is_of(who) : a->owner() == who;
        if (feed ? !streams : !owns || (cause == unrenewed_of(who.door) && streams)) continue;
        act(*a, feed ? unrenewed_of(who.door) : cause, now, &who);
        if (a->stream.who == who) streams_.end(*a, Reason::interrupted, who.text() + " is gone", now);
    }
    orphan(who, cause, nullptr);
}

void LossOfCommand::on_lease_ended(Axis& a, const AuthorityClient& holder, Instant now) {
    const bool led = a.motion.runs() ? a.motion.is_of(holder) : holder == a.owner();
    if (led) act(a, LossCause::lease_ended, now, &holder);
    orphan(holder, LossCause::lease_ended, &a);
}

void LossOfCommand::orphan(const AuthorityClient& who, LossCause cause, const Axis* axis) {
    for (auto& [ticket, order] : pending_.orders) {
        if (axis && order.axis != axis->id && order.mover != axis->id) continue;
        if ((order.motion ? order.motion->who : AuthorityClient::of(order.by)) == who) order.owner_lost = cause;
    }
}

AtLoss LossOfCommand::at_loss(const Axis& a) {
    const AxisFeedback& f = a.profile.feedback();
    AtLoss at;
    at.endless = a.motion.endless(f.course);
    at.moving = f.moving || f.homing || (a.motion.runs() && !a.motion.over);
    at.powered = a.profile.commanded();
    return at;
}

void LossOfCommand::act(Axis& a, LossCause cause, Instant now, const AuthorityClient* lost) {
    AtLoss at = at_loss(a);
    if (const auto before = std::exchange(a.lost_line, std::nullopt); before && cause == LossCause::line_lost) {
        at.endless = at.endless || before->endless;  // the drive forgets its motion, or does not report it at once
        at.powered = at.powered || before->powered;
    }
    const auto action = a.spec.fail_safe.action(cause, at);
    if (machine_.closing || action == FailSafeAction::nothing) return;
    // A stop that is at least as strong is in progress already, and is repeated until the drive has accepted it.
    const Stops::Kind kind = action == FailSafeAction::halt         ? Stops::Kind::halt
                             : action == FailSafeAction::quick_stop ? Stops::Kind::quick_stop
                                                                    : Stops::Kind::disable;
    if (a.stops.wanted && *a.stops.wanted >= kind && cause != LossCause::gateway_ends) return;
    // One cause leads to one action on a motion; on an axis at rest to one action until the next command. Another cause may demand a
    // stronger stop.
    const LossCause before = a.motion.runs() ? a.motion.ended_for : a.latch.cause;
    if (before == cause && cause != LossCause::gateway_ends) return;
    a.motion.ended_for = a.latch.cause = cause;
    a.latch.bits = StopLatch::latched | StopLatch::by_fail_safe;
    a.latch.by = {};
    ++losses_.at(static_cast<std::size_t>(cause));
    const CommandBody body = Stops::body(kind);
    Event e;
    e.severity = cause == LossCause::motion_unowned ? Severity::alarm : Severity::warning;
    e.kind = "fail_safe";
    e.axis = a.spec.name;
    e.code = static_cast<std::int32_t>(cause);
    const Duration limit = is_silence(cause) ? a.spec.fail_safe.watchdog(machine_.watchdog)
                           : a.stream.on && cause == unrenewed_of(a.stream.who.door) && now - a.stream.renewed > a.stream.good_for
                               ? a.stream.good_for
                               : Duration::zero();
    const AuthorityClient& who = lost ? *lost : a.stream.on ? a.stream.who : a.owner();
    e.text = fmt::format("{}: {} commanded the axis and {}", name_of(body), who.door == Door::none ? "nobody that is known" : who.text(),
                         why_lost(cause, limit));
    publisher_.event(std::move(e), now);
    orders_.give_own(a, body, now);
    publisher_.publish(a, now);
}

void LossOfCommand::unowned(Axis& a, Instant now) {
    if (a.spec.fail_safe.action(LossCause::motion_unowned, at_loss(a)) != FailSafeAction::nothing)
        return act(a, LossCause::motion_unowned, now);
    Event e;
    e.severity = Severity::warning;
    e.kind = "motion";
    e.axis = a.spec.name;
    e.text = "the axis moves, and no client of this gateway has ordered it; it is left to its end, and stopped at the site's limits";
    publisher_.event(std::move(e), now);
}

/// Called with every housekeeping, so an action is at most one housekeeping period late.
void LossOfCommand::check_watchdog(Axis& a, Instant now) {
    const AuthorityClient& who = a.owner();
    const Duration limit = a.spec.fail_safe.watchdog(machine_.watchdog);
    const DoorWords* door = words_of(who.door);
    if (!door || door->silence == LossCause::none || limit <= Duration::zero() || !(a.profile.commanded() || a.motion.runs())) return;
    const auto received = host_.last_received(who);
    if (FlightTap* tap = publisher_.tap()) tap->last_received(received, now);
    if (received && now - *received > limit) act(a, door->silence, now);
}

void LossOfCommand::shut_down(Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->shut_down(now);
    machine_.now = std::max(machine_.now, now);
    if (machine_.closing) return;
    for (auto& a : machine_.axes) {
        if (!a || a->drive->serving == Presence::offline) continue;
        act(*a, LossCause::gateway_ends, now);
    }
    machine_.closing = true;
}

}  // namespace axisgate::engine
