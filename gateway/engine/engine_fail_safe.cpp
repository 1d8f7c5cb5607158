// Engine, loss of command: an axis whose commander is gone, or silent for too long, is halted, stopped or switched off as its site entry
// says. In: doors' word that a client is gone, and the instant at which a client was heard last. Out: the action, an event, register 22, a
// count. Never touches an axis that somebody else has commanded since.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {
namespace {
std::string why_lost(LossCause cause, Duration limit) {
    switch (cause) {
        case LossCause::modbus_silent:
            return fmt::format("has been silent for {} ms", milliseconds_of(limit));
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
        case LossCause::none:
        case LossCause::modbus_closed:
            break;
    }
    return "has closed its last connection";
}
}  // namespace

void Engine::on_client_lost(const AuthorityClient& who, LossCause cause, Instant now) {
    if (tap_) tap_->client_lost(who, cause, now);
    now_ = std::max(now_, now);
    for (const auto& a : axes_) {
        if (!a) continue;
        // A feed that is closed was one of perhaps several connections of its client: what it commanded otherwise goes on. And set-points
        // over DDS have a deadline of their own: they go on while they are renewed, whoever else does not write for their client any more.
        const bool streams = a->stream.on && a->stream.who == who, feed = cause == LossCause::set_points_silent;
        if (feed ? !streams : a->authority.commander() != who || (cause == LossCause::dds_deadline && streams)) continue;
        fail_safe(*a, feed ? silence_of(who) : cause, now);
        if (a->stream.who == who) end_stream(*a, Reason::interrupted, who.text() + " is gone", now);
    }
}

AtLoss Engine::at_loss(const Axis& a) {
    const AxisFeedback& f = a.profile.feedback();
    AtLoss at;
    at.endless = a.run.velocity != 0 || a.stream.on;  // set-points have no end of their own
    at.moving = f.moving || f.homing || a.profile.active_target().has_value() || a.run.velocity != 0;
    at.powered = a.profile.commanded();
    return at;
}

void Engine::fail_safe(Axis& a, LossCause cause, Instant now) {
    AtLoss at = at_loss(a);
    if (const auto before = std::exchange(a.lost_line, std::nullopt); before && cause == LossCause::line_lost) {
        at.endless = at.endless || before->endless;  // it forgets, or does not say at once, what it was about
        at.powered = at.powered || before->powered;
    }
    const auto action = a.spec.fail_safe.action(cause, at);
    if (closing_ || action == FailSafeAction::nothing || a.loss != LossCause::none) return;
    a.loss = cause;
    ++losses_[static_cast<std::size_t>(cause)];
    const CommandBody body = action == FailSafeAction::halt         ? CommandBody{Halt{}}
                             : action == FailSafeAction::quick_stop ? CommandBody{QuickStop{}}
                                                                    : CommandBody{Disable{}};
    Event e;
    e.severity = Severity::warning;
    e.kind = "fail_safe";
    e.axis = a.spec.name;
    e.code = static_cast<std::int32_t>(cause);
    const Duration limit = cause == LossCause::modbus_silent ? a.spec.fail_safe.watchdog(watchdog_)
                           : a.stream.on && cause == silence_of(a.stream.who) && now - a.stream.renewed > a.stream.good_for
                               ? a.stream.good_for
                               : Duration::zero();
    const AuthorityClient& who = a.stream.on ? a.stream.who : a.authority.commander();
    e.text = fmt::format("{}: {} commanded the axis and {}", name_of(body), who.door == Door::none ? "nobody that is known" : who.text(),
                         why_lost(cause, limit));
    event(std::move(e), now);
    auto decision = a.profile.on_command(body);
    for (auto& o : decision.orders)
        give_order(a, nullptr, std::move(o), {}, now);
    publish(a, now);
}

/// Looked at with every housekeeping, so an action comes at most one of its periods late.
void Engine::check_watchdog(Axis& a, Instant now) {
    const AuthorityClient& who = a.authority.commander();
    const Duration limit = a.spec.fail_safe.watchdog(watchdog_);
    if (who.door != Door::modbus || limit <= Duration::zero() || !a.profile.commanded()) return;
    const auto heard = host_.heard(who);
    if (tap_) tap_->heard(heard, now);
    if (heard && now - *heard > limit) fail_safe(a, LossCause::modbus_silent, now);
}

}  // namespace axisgate
