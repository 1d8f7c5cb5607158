// Engine, loss of command: an axis whose commander is gone, or silent for too long, is halted, stopped or switched off as its site entry
// says. In: doors' word that a client is gone, and the instant at which a client was heard last. Out: the action, an event, register 22, a
// count. Never touches an axis that somebody else has commanded since.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"

namespace axisgate {

void Engine::on_client_lost(const AuthorityClient& who, LossCause cause, Instant now) {
    now_ = std::max(now_, now);
    for (const auto& a : axes_) {
        // A feed that is closed was one of perhaps several connections of its client: what it commanded otherwise goes on.
        const bool meant =
            a && (cause == LossCause::set_points_silent ? a->stream.on && a->stream.who == who : a->authority.commander() == who);
        if (!meant) continue;
        fail_safe(*a, cause, now);
        if (a->stream.who == who) end_stream(*a, Reason::interrupted, who.text() + " is gone", now);
    }
}

void Engine::fail_safe(Axis& a, LossCause cause, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    const bool moving = f.moving || f.homing || a.profile.active_target().has_value();
    const bool endless = a.run.velocity != 0 || a.stream.on;  // set-points have no end of their own
    const auto action = a.spec.fail_safe.action(cause, endless, moving || a.run.velocity != 0, a.profile.commanded());
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
    const auto ms = [](Duration d) { return milliseconds_of(d); };
    const std::string what =
        cause == LossCause::modbus_silent       ? fmt::format("has been silent for {} ms", ms(a.spec.fail_safe.watchdog(watchdog_)))
        : cause == LossCause::set_points_silent ? now - a.stream.renewed > a.stream.good_for
                                                      ? fmt::format("has not renewed its set-points for {} ms", ms(a.stream.good_for))
                                                      : "has closed the connection by which it gave set-points"
                                                : "has closed its last connection";
    e.text = fmt::format("{}: {} commanded the axis and {}", name_of(body),
                         a.stream.on ? a.stream.who.text() : a.authority.commander().text(), what);
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
    if (heard && now - *heard > limit) fail_safe(a, LossCause::modbus_silent, now);
}

}  // namespace axisgate
