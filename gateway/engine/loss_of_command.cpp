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

namespace axisgate::engine {
namespace {
std::string why_lost(LossCause cause, Duration limit) {
    switch (cause) {
        case LossCause::modbus_silent:
        case LossCause::enip_silent:
            return fmt::format("has been silent for {} ms", milliseconds_of(limit));
        case LossCause::enip_session_closed:
            return "has closed the EtherNet/IP session by which it commanded";
        case LossCause::set_points_silent:
            return limit > Duration::zero() ? fmt::format("has not renewed its set-points for {} ms", milliseconds_of(limit))
                                            : "has closed the connection by which it gave set-points";
        case LossCause::lease_ended:
            return "has let its lease expire";
        case LossCause::enip_closed:
            return "has lost its EtherNet/IP connection: it was closed";
        case LossCause::enip_timed_out:
            return "has lost its EtherNet/IP connection: nothing came for its time-out";
        case LossCause::enip_idle:
            return "says that its scanner is idle (program mode)";
        case LossCause::line_lost:
            return "the drive could not be reached meanwhile";
        case LossCause::gateway_ends:
            return "the gateway ends";
        case LossCause::dds_deadline:
            return limit > Duration::zero()
                       ? fmt::format("has missed the deadline of its set-points over DDS: none for {} ms", milliseconds_of(limit))
                       : "is gone from the DDS domain: nobody writes for it any more";
        case LossCause::motion_unowned:
            return "the axis moves all the same";
        case LossCause::none:
        case LossCause::modbus_closed:
            break;
    }
    return "has closed its last connection";
}
}  // namespace

void LossOfCommand::on_client_lost(const AuthorityClient& who, LossCause cause, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->client_lost(who, cause, now);
    machine_.now = std::max(machine_.now, now);
    for (const auto& a : machine_.axes) {
        if (!a) continue;
        // A live feed may be one of several connections of its client, whose other motions continue when the feed closes. Set-points over
        // DDS have a deadline of their own and continue while they are renewed, even if another writer of their client ends.
        const bool streams = a->stream.on && a->stream.who == who, feed = cause == LossCause::set_points_silent;
        const bool owns = a->motion.runs() ? a->motion.is_of(who) : a->owner() == who;
        if (feed ? !streams : !owns || (cause == LossCause::dds_deadline && streams)) continue;
        act(*a, feed ? silence_of(who) : cause, now, &who);
        if (a->stream.who == who) streams_.end(*a, Reason::interrupted, who.text() + " is gone", now);
    }
    for (auto& [ticket, order] : pending_.orders) {  // orders that the drive accepts from now on begin without their owner
        if (order.motion && order.motion->who == who) order.owner_lost = cause;
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
    ++losses_[static_cast<std::size_t>(cause)];
    const CommandBody body = Stops::body(kind);
    Event e;
    e.severity = cause == LossCause::motion_unowned ? Severity::alarm : Severity::warning;
    e.kind = "fail_safe";
    e.axis = a.spec.name;
    e.code = static_cast<std::int32_t>(cause);
    const Duration limit =
        cause == LossCause::modbus_silent || cause == LossCause::enip_silent ? a.spec.fail_safe.watchdog(machine_.watchdog)
        : a.stream.on && cause == silence_of(a.stream.who) && now - a.stream.renewed > a.stream.good_for ? a.stream.good_for
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
    const bool by_messages = who.door == Door::ethernet_ip;  // the owner of an implicit connection is monitored by that connection, not
                                                             // here
    if ((who.door != Door::modbus && !by_messages) || limit <= Duration::zero() || !(a.profile.commanded() || a.motion.runs())) return;
    const auto received = host_.last_received(who);
    if (FlightTap* tap = publisher_.tap()) tap->last_received(received, now);
    if (received && now - *received > limit) act(a, by_messages ? LossCause::enip_silent : LossCause::modbus_silent, now);
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
