// CiA 402: a change is tried on a copy of the state and kept only if nothing refused it.
// In: words, commands, feedback. Out: orders. States that a drive with mere on and off has not (ready, switched on) are kept here.
// Never sends by itself: every order is a return value.
#include "gateway/axis/cia402.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace axisgate {
using namespace cia402;

namespace {
constexpr Duration reaction_again = std::chrono::seconds(1);
}  // namespace

std::string_view name_of(PowerState state) noexcept {
    constexpr std::array<std::string_view, 8> names{"not_ready_to_switch_on", "switch_on_disabled", "ready_to_switch_on",    "switched_on",
                                                    "operation_enabled",      "quick_stop_active",  "fault_reaction_active", "fault"};
    return names[static_cast<std::size_t>(state)];
}

PowerState power_state_of(std::uint16_t sw) noexcept {
    if ((sw & 0x4F) == 0x00) return PowerState::not_ready_to_switch_on;
    if ((sw & 0x4F) == 0x40) return PowerState::switch_on_disabled;
    if ((sw & 0x6F) == 0x21) return PowerState::ready_to_switch_on;
    if ((sw & 0x6F) == 0x23) return PowerState::switched_on;
    if ((sw & 0x6F) == 0x27) return PowerState::operation_enabled;
    if ((sw & 0x6F) == 0x07) return PowerState::quick_stop_active;
    if ((sw & 0x4F) == 0x0F) return PowerState::fault_reaction_active;
    return PowerState::fault;
}

AxisProfile::Decision AxisProfile::refuse(Reason reason, std::string text) const {
    Decision d;
    d.refused = true;
    d.reason = reason;
    d.text = std::move(text);
    return d;
}

void AxisProfile::forget_motion(State& s) {
    s.active.reset();
    s.buffered.reset();
    s.ordered_velocity = 0;
    s.target_velocity = 0;
    s.setpoint_acknowledged = false;
    s.halted = false;
    leave_stream(s);
}

/// Back to the mode before it, unless somebody has chosen another one since.
void AxisProfile::leave_stream(State& s) {
    if (!std::exchange(s.following, false) || s.mode < mode_cyclic_position || s.mode > mode_cyclic_torque) return;
    s.mode = s.mode_before;
    s.target_velocity = 0;
}

void AxisProfile::order_on(State& s, const AuthorityClient& by, Decision& d) {
    forget_motion(s);
    // The actual position is the first target: nothing moves because something was enabled. What this very client has written for the
    // set-point that it is about to give is kept; what was written or used before by anybody is not.
    bool kept = false;
    for (Written& w : s.written) {
        w.target_known = w.target_pending && w.target_by == by;
        w.target_pending = w.target_known;
        kept = kept || w.target_known;
    }
    if (!kept) s.target_position = static_cast<std::int32_t>(s.feedback.position);
    s.power_pending = 1;
    d.orders.emplace_back(Enable{});
}

/// Said even if the drive seems to be off, or is not heard.
void AxisProfile::order_off_blindly(State& s, Decision& d) {
    forget_motion(s);
    s.virtual_step = 0;
    s.quick_stopped = false;
    d.orders.emplace_back(Disable{});
}

void AxisProfile::order_off(State& s, Decision& d) {
    const bool off = s.feedback.power == AxisFeedback::Power::off && s.power_pending != 1;
    forget_motion(s);
    s.quick_stopped = false;
    if (off) return;
    s.power_pending = 0;
    d.orders.emplace_back(Disable{});
}

/// Transition 15 ends in switch on disabled: a drive that holds its power through a fault is switched off along with the reset.
void AxisProfile::order_reset(State& s, Decision& d) {
    d.orders.emplace_back(ResetFault{});
    if (s.feedback.fault && s.feedback.power == AxisFeedback::Power::on) {
        s.power_pending = 0;
        d.orders.emplace_back(Disable{});
    }
}

/// Sets the power state from what the drive says and what this class keeps for it.
void AxisProfile::settle(State& s) const {
    if (s.presence == Presence::offline || !s.seen) {
        s.state = PowerState::not_ready_to_switch_on;
        return;
    }
    const auto own = s.feedback.statusword ? std::optional(power_state_of(*s.feedback.statusword)) : std::nullopt;
    if (s.feedback.fault) {
        const bool told = own == PowerState::fault || own == PowerState::fault_reaction_active;
        s.state = told ? *own : s.feedback.moving ? PowerState::fault_reaction_active : PowerState::fault;
        s.virtual_step = 0;
        s.quick_stopped = false;
        s.active.reset();
        s.buffered.reset();
        return;
    }
    if (s.feedback.power == AxisFeedback::Power::on) {
        if (s.power_pending == 0) return;  // it will be off soon; the answer decides
        // The drive may have been stopped at itself: by its own panel, an input, or another master. It is left like any quick stop.
        const bool stopping = s.feedback.quick_stopping || own == PowerState::quick_stop_active;
        const bool stopped = s.quick_stopped || (stopping && s.power_pending != 1);
        if (stopped && s.state == PowerState::operation_enabled) forget_motion(s);
        s.state = stopped ? PowerState::quick_stop_active : PowerState::operation_enabled;
        return;
    }
    if (s.power_pending == 1) return;
    if (s.virtual_step == 3) {  // it was on by our order and went off by itself: back to the first step
        s.virtual_step = 0;
        forget_motion(s);
    }
    s.quick_stopped = false;
    s.state = state_when_off(s);
}

/// Without power: the steps that a control word has gone where the drive knows on and off alone. A drive's own state is never shown lower
/// than it is; a step that it does not know, and that a control word waits for, is shown above it.
PowerState AxisProfile::state_when_off(const State& s) noexcept {
    const PowerState step = s.virtual_step == 1   ? PowerState::ready_to_switch_on
                            : s.virtual_step == 2 ? PowerState::switched_on
                                                  : PowerState::switch_on_disabled;
    const auto own = s.feedback.statusword ? power_state_of(*s.feedback.statusword) : step;
    return own <= PowerState::switched_on ? std::max(own, step) : step;
}

/// Nobody answers, or nobody has said yet where the axis is: it may be moving all the same. What stops is sent, and its answer is the
/// drive's; everything else is refused, for there is nobody who could do it. False: refused, and `d` says why.
bool AxisProfile::change_unheard(State& s, std::uint16_t before, std::uint16_t cw, Decision& d) const {
    if (!(cw & cw_enable_voltage)) {
        order_off_blindly(s, d);
    } else if (!(cw & cw_quick_stop)) {
        forget_motion(s);
        d.orders.emplace_back(QuickStop{});
    } else if ((cw & cw_halt) && !(before & cw_halt)) {
        forget_motion(s);
        s.halted = true;
        d.orders.emplace_back(Halt{});
    } else {
        d = refuse(Reason::no_answer,
                   s.presence == Presence::offline ? "the drive does not answer" : "the drive has not said yet where it is");
        return false;
    }
    return true;
}

void AxisProfile::change_power(State& s, std::uint16_t before, std::uint16_t cw, const AuthorityClient& by, Decision& d) const {
    const bool so = cw & cw_switch_on, ev = cw & cw_enable_voltage, qs = cw & cw_quick_stop, eo = cw & cw_enable_operation;
    constexpr std::uint16_t on_bits = cw_switch_on | cw_enable_voltage | cw_quick_stop | cw_enable_operation;
    const bool off_by_word = !ev || !qs || !so || !eo;
    if (s.power_pending == 1 && off_by_word && s.state != PowerState::operation_enabled && s.state != PowerState::quick_stop_active) {
        // On its way to being switched on: that is taken back, not waited for.
        s.virtual_step = !ev || !qs ? 0 : !so ? 1 : 2;
        return order_off(s, d);
    }
    switch (s.state) {
        case PowerState::not_ready_to_switch_on:
        case PowerState::fault_reaction_active:
        case PowerState::fault:
            return;  // left by the drive, or by the fault reset's edge
        case PowerState::switch_on_disabled:
            if (ev && qs && !so) s.virtual_step = 1;  // transition 2: shutdown
            return settle(s);
        case PowerState::ready_to_switch_on:
            if (!ev || !qs) {
                s.virtual_step = 0;  // 7
            } else if (so && eo) {
                s.virtual_step = 3;
                order_on(s, by, d);  // 3 and 4 together
                return;
            } else if (so) {
                s.virtual_step = 2;  // 3
            }
            return settle(s);
        case PowerState::switched_on:
            if (!ev || !qs) {
                s.virtual_step = 0;  // 10
            } else if (!so) {
                s.virtual_step = 1;  // 6
            } else if (eo) {
                s.virtual_step = 3;
                order_on(s, by, d);  // 4
                return;
            }
            return settle(s);
        case PowerState::operation_enabled:
            if (!ev) {
                s.virtual_step = 0;  // 9
                order_off(s, d);
            } else if (!qs) {
                forget_motion(s);
                d.orders.emplace_back(QuickStop{});  // 11
            } else if (!so) {
                s.virtual_step = 1;  // 8
                order_off(s, d);
            } else if (!eo) {
                s.virtual_step = 2;  // 5
                order_off(s, d);
            }
            return;
        case PowerState::quick_stop_active:
            if (!ev) {
                s.virtual_step = 0;  // 12
                order_off(s, d);
            } else if (qs && so && eo && (before & on_bits) != on_bits) {
                // An edge: a controller that writes the same word again and again does not undo a stop that was made at the drive.
                s.virtual_step = 3;
                order_on(s, by, d);  // 16: the drive is told again, so that a lock that the stop has set is gone or is reported
            }
            return;
    }
}

/// Halt, new set-points, homing start. False: refused, and `d` says why.
bool AxisProfile::change_motion(State& s, std::uint16_t before, std::uint16_t cw, const ProcessData& data, Written& own,
                                Decision& d) const {
    const std::uint16_t rising = cw & static_cast<std::uint16_t>(~before), falling = before & static_cast<std::uint16_t>(~cw);
    const bool enabled = s.state == PowerState::operation_enabled && s.power_pending != 0;
    const auto ends = [](const CommandBody& o) { return is_urgent(o) || std::holds_alternative<ResetFault>(o); };
    if (falling & cw_new_setpoint) s.setpoint_acknowledged = false;
    if (!enabled || d.orders.size() > 0) {
        // Not enabled, or the power state changes with this very word: an edge for a motion has nothing to act on. A word that stops or
        // resets is not refused for it: what ends a motion never depends on the bits that would begin one.
        if ((rising & cw_new_setpoint) && std::ranges::none_of(d.orders, ends) &&
            (s.mode == mode_profile_position || s.mode == mode_homing)) {
            d = refuse(Reason::wrong_state, fmt::format("a new set-point needs operation enabled; the axis is {}", name_of(s_.state)));
            return false;
        }
        s.halted = cw & cw_halt;
        return true;
    }
    if (rising & cw_halt) {
        s.halted = true;
        s.ordered_velocity = 0;
        d.orders.emplace_back(Halt{});
    } else if (falling & cw_halt) {
        s.halted = false;
        if (s.mode == mode_profile_position && s.active && !s.feedback.target_reached && !(rising & cw_new_setpoint)) {
            d.orders.emplace_back(*s.active);
            ++s.told_again;
        }
    }
    if (s.mode == mode_profile_position && (rising & cw_new_setpoint) && !(rising & cw_halt)) {
        if (s.halted) {
            d = refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it first");
            return false;
        }
        if (own.velocity == 0) {
            d = refuse(Reason::out_of_range,
                       "the profile velocity (registers 36 and 37) is 0 or was never written by this door: write it before the set-point");
            return false;
        }
        Move m;
        m.kind = (cw & cw_relative) ? Move::Kind::relative : Move::Kind::absolute;
        m.target = own.target_known ? own.target_position : s.target_position;
        m.velocity = own.velocity;
        if (own.acceleration) m.acceleration = own.acceleration;
        if (own.deceleration) m.deceleration = own.deceleration;
        own.target_pending = false;
        s.target_position = static_cast<std::int32_t>(m.target);
        const bool under_way = s.active && s.feedback.moving && !s.feedback.target_reached;
        if (!(cw & cw_change_immediately) && under_way) {
            if (s.buffered) {
                d = refuse(Reason::busy, "one set-point waits already: wait until bit 12 of the status word is 0, or set bit 5");
                return false;
            }
            s.buffered = d.waits = m;
            s.setpoint_acknowledged = true;
            ++s.setpoints_accepted;
        } else {
            s.buffered.reset();
            d.orders.emplace_back(m);
        }
    }
    if (s.mode == mode_homing) {
        if ((rising & cw_new_setpoint) && !(rising & cw_halt)) d.orders.emplace_back(Home{s.homing_method});
        const bool under_way = s.feedback.homing || (s.feedback.moving && !s.feedback.homing_attained);
        if ((falling & cw_new_setpoint) && under_way) d.orders.emplace_back(Halt{});
    }
    if (s.mode == mode_profile_velocity && !s.halted) {
        const bool released = falling & cw_halt;
        if ((data.target_velocity || released) && s.target_velocity != s.ordered_velocity) {
            Move m;
            m.kind = Move::Kind::velocity;
            m.target = s.target_velocity;
            if (own.acceleration) m.acceleration = own.acceleration;
            if (own.deceleration) m.deceleration = own.deceleration;
            d.orders.emplace_back(m);
        }
    }
    return true;
}

AxisProfile::Decision AxisProfile::on_process_data(const ProcessData& data, const Origin& by) {
    State s = s_;
    Decision d;
    const AuthorityClient who = AuthorityClient::of(by);
    Written& own = s.written[std::min(static_cast<std::size_t>(by.door), doors - 1)];
    if (data.mode && *data.mode != mode_none && *data.mode != mode_profile_position && *data.mode != mode_profile_velocity &&
        *data.mode != mode_homing) {
        return refuse(
            Reason::out_of_range,
            fmt::format("mode of operation {} is not offered; use 1 (profile position), 3 (profile velocity) or 6 (homing)", *data.mode));
    }
    if (data.target_position) {
        s.target_position = own.target_position = *data.target_position;
        own.target_known = own.target_pending = true;
        own.target_by = who;
    }
    if (data.profile_velocity) s.profile_velocity = own.velocity = *data.profile_velocity;
    if (data.profile_acceleration) s.profile_acceleration = own.acceleration = *data.profile_acceleration;
    if (data.profile_deceleration) s.profile_deceleration = own.deceleration = *data.profile_deceleration;
    if (data.target_velocity) s.target_velocity = *data.target_velocity;
    if (data.homing_method) s.homing_method = *data.homing_method;
    if (data.mode && *data.mode != s.mode) {
        if (s.mode == mode_profile_velocity && s.ordered_velocity != 0) {
            s.ordered_velocity = 0;
            d.orders.emplace_back(Halt{});
        }
        s.mode = *data.mode;
        if (s.following) s.mode_before = s.mode;
        s.setpoint_acknowledged = false;
        s.buffered.reset();
        if (!data.target_velocity) s.target_velocity = 0;  // an old speed must not start the axis in its new mode
    }
    const std::uint16_t before = s.controlword;
    const std::uint16_t cw = data.controlword.value_or(before);
    s.controlword = cw;
    Decision power;
    if (data.controlword) {
        if (s.state == PowerState::not_ready_to_switch_on) {
            if (!change_unheard(s, before, cw, power)) return power;
            for (auto& o : power.orders)
                d.orders.push_back(std::move(o));
            s_ = std::move(s);
            return d;
        }
        if ((cw & cw_fault_reset) && !(before & cw_fault_reset)) order_reset(s, power);
        change_power(s, before, cw, who, power);
    }
    const bool homes = s.mode == mode_homing && (cw & cw_new_setpoint) && !(before & cw_new_setpoint);
    if (!change_motion(s, before, cw, data, own, power)) {
        s_.homing_refused = s_.homing_refused || homes;
        return power;
    }
    for (auto& o : power.orders)
        d.orders.push_back(std::move(o));
    d.waits = power.waits;
    s_ = std::move(s);
    return d;
}

AxisProfile::Decision AxisProfile::on_command(const CommandBody& body, const Origin& by) {
    State s = s_;
    Decision d;
    const bool present = s.presence != Presence::offline && s.seen;
    const auto faulty = [&] {
        return refuse(Reason::wrong_state,
                      fmt::format("the axis is in fault (drive's code {}): reset the fault first", s.feedback.error_code));
    };
    if (!present && !is_urgent(body))
        return refuse(Reason::no_answer,
                      s.presence == Presence::offline ? "the drive does not answer" : "the drive has not said yet where it is");
    if (std::holds_alternative<Enable>(body)) {
        if (s.feedback.fault) return faulty();
        s.controlword = cw_switch_on | cw_enable_voltage | cw_quick_stop | cw_enable_operation;
        if (s.state != PowerState::operation_enabled || s.power_pending == 0) {
            s.virtual_step = 3;
            order_on(s, AuthorityClient::of(by), d);
        }
    } else if (std::holds_alternative<Disable>(body)) {
        s.controlword = 0;
        s.power_pending = 0;
        order_off_blindly(s, d);
    } else if (std::holds_alternative<QuickStop>(body)) {
        s.controlword &= static_cast<std::uint16_t>(~cw_quick_stop);
        forget_motion(s);
        d.orders.emplace_back(QuickStop{});
    } else if (std::holds_alternative<Halt>(body)) {
        s.active.reset();
        s.buffered.reset();
        s.ordered_velocity = 0;
        s.target_velocity = 0;
        d.orders.emplace_back(Halt{});
    } else if (std::holds_alternative<ResetFault>(body)) {
        order_reset(s, d);
    } else if (const auto* home = std::get_if<Home>(&body)) {
        if (s.feedback.fault) {
            s_.homing_refused = true;
            return faulty();
        }
        s.buffered.reset();
        s.active.reset();
        s.mode = mode_homing;
        s.homing_method = home->method;
        d.orders.emplace_back(*home);
    } else if (const auto* set = std::get_if<SetPosition>(&body)) {
        if (s.buffered)
            return refuse(Reason::wrong_state,
                          "a set-point waits behind the running one: set the position when it has ended, or halt first");
        d.orders.emplace_back(*set);
    } else if (const auto* move = std::get_if<Move>(&body)) {
        if (s.feedback.fault) return faulty();
        if (s.state != PowerState::operation_enabled || s.power_pending == 0) {
            return refuse(Reason::wrong_state, fmt::format("the axis is {}: enable it first", name_of(s.state)));
        }
        if (s.halted) return refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it first");
        s.buffered.reset();
        if (move->kind == Move::Kind::velocity) {
            s.mode = mode_profile_velocity;
            s.target_velocity = static_cast<std::int32_t>(move->target);
        } else {
            s.mode = mode_profile_position;
            const std::int64_t from = move->kind == Move::Kind::relative ? s.feedback.position : 0;
            s.target_position = static_cast<std::int32_t>(from + move->target);
        }
        d.orders.emplace_back(*move);
        if (move->kind == Move::Kind::velocity) std::get<Move>(d.orders.back()).velocity.reset();
    } else if (const auto* together = std::get_if<StartTogether>(&body)) {
        d.orders.emplace_back(*together);
    } else {
        return refuse(Reason::not_supported, "this is not a command of the axis profile");
    }
    s_ = std::move(s);
    return d;
}

void AxisProfile::on_order_result(const CommandBody& order, bool good, Instant now) {
    State& s = s_;
    if (std::holds_alternative<Enable>(order)) {
        s.power_pending = -1;
        if (good) {
            s.quick_stopped = s.feedback.quick_stopping = false;
            s.feedback.power = AxisFeedback::Power::on;
            s.power_known_at = now;
        } else {
            s.virtual_step = 0;
            s.controlword &= static_cast<std::uint16_t>(~cw_enable_operation);
        }
        settle(s);
    } else if (std::holds_alternative<Disable>(order)) {
        s.power_pending = -1;
        if (good) {
            s.feedback.power = AxisFeedback::Power::off;
            s.power_known_at = now;
        }
        settle(s);
    } else if (std::holds_alternative<QuickStop>(order)) {
        if (good && s.feedback.power == AxisFeedback::Power::on) s.quick_stopped = true;
        if (!good) s.reacting = false;
        settle(s);
    } else if (std::holds_alternative<Home>(order)) {
        s.homing_refused = !good;
    } else if (std::holds_alternative<SetPosition>(order)) {
        if (good) s.active.reset();  // its target was a place by the old count
    } else if (const auto* m = std::get_if<Move>(&order)) {
        const bool again = s.told_again > 0;
        if (again) --s.told_again;
        if (!good) return;
        if (!again) ++s.setpoints_accepted;
        const auto shown = [](std::uint32_t& into, const std::optional<std::int64_t>& v) {
            if (v) into = static_cast<std::uint32_t>(*v);
        };
        shown(s.profile_velocity, m->velocity);
        shown(s.profile_acceleration, m->acceleration);
        shown(s.profile_deceleration, m->deceleration);
        // Bit 12 answers bit 4: whoever has not set it does not wait for it to fall.
        s.setpoint_acknowledged = (s.controlword & cw_new_setpoint) != 0;
        if (m->kind == Move::Kind::velocity) {
            s.ordered_velocity = m->target;
            s.active.reset();
        } else {
            s.ordered_velocity = 0;
            s.active = *m;
            if (m->kind == Move::Kind::relative) {
                s.active->kind = Move::Kind::absolute;
                s.active->target += s.feedback.position;
            }
        }
    }
}

AxisProfile::Decision AxisProfile::may_follow() const {
    const State& s = s_;
    if (s.presence == Presence::offline || !s.seen)
        return refuse(Reason::no_answer,
                      s.presence == Presence::offline ? "the drive does not answer" : "the drive has not said yet where it is");
    if (s.feedback.fault)
        return refuse(Reason::wrong_state,
                      fmt::format("the axis is in fault (drive's code {}): reset the fault first", s.feedback.error_code));
    if (s.state != PowerState::operation_enabled || s.power_pending == 0)
        return refuse(Reason::wrong_state, fmt::format("the axis is {}: enable it first", name_of(s.state)));
    if (s.halted) return refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it first");
    return {};
}

void AxisProfile::follow(const SetPoint& p) {
    State& s = s_;
    if (!s.following) {
        forget_motion(s);
        s.following = true;
        s.mode_before = s.mode;
    }
    s.mode = mode_of(p.mode);
    if (p.mode == SetPoint::Mode::position) s.target_position = static_cast<std::int32_t>(p.value);
    s.target_velocity = p.mode == SetPoint::Mode::velocity ? static_cast<std::int32_t>(p.value) : 0;
}

void AxisProfile::end_following() { leave_stream(s_); }

std::optional<CommandBody> AxisProfile::on_feedback(const AxisFeedback& feedback, Instant now) {
    State& s = s_;
    AxisFeedback f = feedback;
    // Read before the drive acknowledged a power order: that part is already known better.
    if (s.seen && f.at <= s.power_known_at) {
        f.power = s.feedback.power;
        f.quick_stopping = s.feedback.quick_stopping;
    }
    s.feedback = f;
    s.seen = true;
    s.heard = s.presence;
    settle(s);
    if (s.state == PowerState::fault_reaction_active && s.feedback.moving) {
        if (s.reacting || (s.reaction_at != Instant{} && now - s.reaction_at < reaction_again)) return std::nullopt;
        s.reacting = true;
        s.reaction_at = now;
        return CommandBody{QuickStop{}};
    }
    s.reacting = false;
    s.reaction_at = {};
    if (s.state != PowerState::operation_enabled) return std::nullopt;
    if (f.target_reached && !f.moving) {
        if (s.buffered && !s.halted) {
            Move next = *s.buffered;
            s.buffered.reset();
            ++s.told_again;  // counted when it was buffered
            return CommandBody{next};
        }
        if (!s.halted) s.active.reset();
    }
    return std::nullopt;
}

void AxisProfile::on_presence(Presence presence) {
    if (presence == s_.presence) return;
    s_.presence = presence;
    s_.seen = false;
    // Of a drive that is silent the last values are kept, with their age; what it is doing now is not known. Another drive begins anew.
    AxisFeedback last;
    if (presence == Presence::offline || presence == s_.heard) {
        last.position = s_.feedback.position;
        last.velocity = s_.feedback.velocity;
        last.error_code = s_.feedback.error_code;
        last.native_status = s_.feedback.native_status;
        last.at = s_.feedback.at;
    } else {
        s_.heard = Presence::offline;
    }
    s_.feedback = last;
    s_.power_pending = -1;
    s_.power_known_at = {};
    s_.virtual_step = 0;
    s_.quick_stopped = false;
    s_.controlword = 0;
    s_.told_again = 0;
    s_.homing_refused = s_.reacting = false;
    s_.reaction_at = {};
    for (Written& w : s_.written)
        w.target_known = w.target_pending = false;
    forget_motion(s_);
    settle(s_);
}

std::optional<std::int64_t> AxisProfile::active_target() const noexcept {
    if (!s_.active || s_.feedback.target_reached) return std::nullopt;
    return s_.active->target;
}

bool AxisProfile::commanded() const noexcept {
    return s_.state == PowerState::operation_enabled || s_.state == PowerState::quick_stop_active || s_.power_pending == 1 ||
           s_.feedback.moving;
}

void AxisProfile::fill(AxisPicture& p) const noexcept {
    const State& s = s_;
    const AxisFeedback& f = s.feedback;
    std::uint16_t sw = 0;
    switch (s.state) {
        case PowerState::not_ready_to_switch_on:
            sw = 0;
            break;
        case PowerState::switch_on_disabled:
            sw = sw_switch_on_disabled;
            break;
        case PowerState::ready_to_switch_on:
            sw = 0x21;
            break;
        case PowerState::switched_on:
            sw = 0x23;
            break;
        case PowerState::operation_enabled:
            sw = 0x27;
            break;
        case PowerState::quick_stop_active:
            sw = 0x07;
            break;
        case PowerState::fault_reaction_active:
            sw = 0x0F;
            break;
        case PowerState::fault:
            sw = 0x08;
            break;
    }
    const bool present = s.presence != Presence::offline;
    if (present && s.seen) sw |= sw_voltage | sw_remote;
    if (f.warning) sw |= sw_warning;
    if (s.presence == Presence::twin) sw |= sw_simulated;
    if (f.internal_limit) sw |= sw_internal_limit;
    if (f.referenced) sw |= sw_referenced;
    bool reached = f.target_reached && !f.moving;
    switch (s.mode) {
        case mode_profile_velocity:
            reached = s.halted ? !f.moving : std::llabs(f.velocity - s.ordered_velocity) * 100 <= std::llabs(s.ordered_velocity);
            if (f.velocity == 0) sw |= sw_mode_12;
            break;
        case mode_homing:
            reached = !f.moving && !f.homing;
            if (f.homing_attained && !s.homing_refused) sw |= sw_mode_12;
            if (f.homing_error || s.homing_refused) sw |= sw_mode_13;
            break;
        case mode_cyclic_position:
        case mode_cyclic_velocity:
        case mode_cyclic_torque:
            if (s.following) sw |= sw_mode_12;  // the drive follows the command value
            break;
        default:
            if (s.halted) reached = !f.moving;
            if (s.setpoint_acknowledged || s.buffered) sw |= sw_mode_12;
            break;
    }
    if (present && s.seen && reached) sw |= sw_target_reached;
    p.statusword = sw;
    p.mode_display = s.mode;
    p.position = f.position;
    p.demand_source = f.demand_source;
    p.position_demand = p.following_error_known() ? f.position_demand : f.position;
    p.velocity = f.velocity;
    p.native_status = f.native_status;
    p.error_code = f.error_code;
    p.controlword = s.controlword;
    p.mode = s.mode;
    p.target_position = s.target_position;
    p.profile_velocity = s.profile_velocity;
    p.profile_acceleration = s.profile_acceleration;
    p.profile_deceleration = s.profile_deceleration;
    p.target_velocity = s.target_velocity;
    p.homing_method = s.homing_method;
    p.setpoints_accepted = s.setpoints_accepted;
    p.presence = s.presence;
    p.ever_seen = s.heard != Presence::offline;
    p.current = s.seen;
    p.at = f.at;
    std::uint16_t flags = 0;
    if (present) flags |= flag_online;
    if (s.presence == Presence::twin) flags |= flag_simulated;
    if (f.referenced) flags |= flag_referenced;
    if (f.moving) flags |= flag_moving;
    if (present && s.seen && reached) flags |= flag_target_reached;
    if (f.fault) flags |= flag_fault;
    if (f.warning) flags |= flag_warning;
    p.flags = flags;
}

}  // namespace axisgate
