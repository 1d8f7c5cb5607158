// Checks each command against the lease of its axis. The end of a lease is always reported before the next lease begins.
#include <fmt/core.h>

#include "gateway/engine/command_authority.hpp"
#include "gateway/engine/publisher.hpp"

namespace axisgate::engine {
namespace {
bool is_asked(const Origin& origin) { return origin.door != Door::internal && origin.door != Door::none; }
}  // namespace

AxisAuthority::Verdict CommandAuthority::may_command(const Axis& a, const Command& c, Instant now) const {
    if (!is_asked(c.origin)) return {};
    const auto who = AuthorityClient::of(c.origin);
    const auto ask = [&](const Axis& x) {
        auto v = x.authority.may(who, now);
        if (!v.allowed && &x != &a) v.text = fmt::format("axis {}: {}", x.spec.name, v.text);
        return v;
    };
    if (const auto* together = std::get_if<StartTogether>(&c.body)) {
        for (const AxisId id : together->axes) {
            if (const Axis* x = machine_.axis(id)) {
                if (auto v = ask(*x); !v.allowed) return v;
            }
        }
    }
    return ask(a);
}

bool CommandAuthority::only_stops(const Axis& a, const CommandBody& body) {
    if (is_urgent(body)) return true;
    const auto* data = std::get_if<ProcessData>(&body);
    if (!data || !data->controlword) return false;
    const std::uint16_t word = *data->controlword;
    if (word & cia402::cw_fault_reset) return false;
    if (!(word & cia402::cw_enable_voltage) || !(word & cia402::cw_quick_stop)) return true;
    if (a.profile.state() != PowerState::operation_enabled) return false;  // the same control word would switch the axis on
    return !(word & cia402::cw_enable_operation) || ((word & cia402::cw_halt) && !(word & cia402::cw_new_setpoint));
}

std::optional<Refusal> CommandAuthority::ask(Axis& a, const Command& c, Instant now) {
    if (!is_asked(c.origin)) return std::nullopt;
    if (const auto v = may_command(a, c, now); !v.allowed) return Refusal{Reason::authority, v.text};
    if (const auto* together = std::get_if<StartTogether>(&c.body)) {
        for (const AxisId id : together->axes) {
            if (Axis* x = machine_.axis(id); x && x != &a) note_commander(*x, c.origin, now);
        }
    }
    note_commander(a, c.origin, now);
    return std::nullopt;
}

/// A client that may command takes or renews the lease, if the axis is configured for leases.
void CommandAuthority::note_commander(Axis& x, const Origin& origin, Instant now) {
    if (!is_asked(origin)) return;
    changed(x, x.authority.expire(now), nullptr, now);  // the end of a lease is reported before the next one begins
    const auto v = x.authority.command(AuthorityClient::of(origin), x.spec.authority_mode, machine_.lease, now);
    changed(x, v, &origin, now);
}

void CommandAuthority::hold(Axis& a, const Command& c, const HoldAxis& wish, Instant now) {
    const auto who = AuthorityClient::of(c.origin);
    const Duration lease = std::chrono::seconds(wish.lease_s);
    if (wish.lease_s < 1 || wish.lease_s > 3600) return publisher_.refuse(c, Reason::out_of_range, "a lease has 1 to 3600 s");
    changed(a, a.authority.expire(now), nullptr, now);
    const AuthorityClient before = a.authority.holder();
    const AxisAuthority::Verdict v = wish.kind == HoldAxis::Kind::take      ? a.authority.take(who, lease, wish.take_over, now)
                                     : wish.kind == HoldAxis::Kind::release ? a.authority.release(who, now)
                                                                            : a.authority.hand_over(who, wish.to, lease, now);
    if (!v.allowed) return publisher_.refuse(c, Reason::authority, fmt::format("axis {}: {}", a.spec.name, v.text));
    using Authority = AxisAuthority::Change;
    const bool passed = v.change == Authority::taken_over || v.change == Authority::handed_over;
    if (passed && a.motion.runs() && a.motion.is_of(before)) a.motion.keeper = a.authority.holder();
    changed(a, v, &c.origin, now);
    publisher_.publish(a, now);
    Result r;
    r.ticket = c.ticket;
    r.axis = c.axis;
    r.text = v.text;
    publisher_.answer(r);
}

void CommandAuthority::changed(Axis& a, const AxisAuthority::Verdict& v, const Origin* by, Instant now) {
    using Authority = AxisAuthority::Change;
    if (v.change == Authority::none) {
        return;  // a lease that a command prolongs is published together with that command
    }
    publisher_.publish(a, now);
    if (v.change == Authority::renewed) return;
    Event e;
    e.kind = "authority";
    e.axis = a.spec.name;
    e.text = v.text;
    if (v.change == Authority::taken_over) e.severity = Severity::warning;
    if (by) {
        e.who = by->who ? *by->who : "";
        e.door = std::string(name_of(by->door));
    }
    publisher_.event(std::move(e), now);
}

}  // namespace axisgate::engine
