// The drive's side of the state machine: power state, results of orders, the serving side, and the picture of the axis. Requests are judged
// in cia402.cpp.
#include "gateway/axis/cia402.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

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

std::string_view cia402::text_of_mode(std::int16_t mode) noexcept {
    constexpr std::array<std::string_view, 12> names{"none",
                                                     "profile position",
                                                     "velocity",
                                                     "profile velocity",
                                                     "profile torque",
                                                     "reserved",
                                                     "homing",
                                                     "interpolated position",
                                                     "cyclic synchronous position",
                                                     "cyclic synchronous velocity",
                                                     "cyclic synchronous torque",
                                                     "cyclic synchronous torque with commutation angle"};
    if (mode < 0) return "of the maker";
    return static_cast<std::size_t>(mode) < names.size() ? names[static_cast<std::size_t>(mode)] : "reserved";
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

static std::uint16_t coding_of(PowerState state) noexcept {
    constexpr std::array<std::uint16_t, 8> codings{0, sw_switch_on_disabled, 0x21, 0x23, 0x27, 0x07, 0x0F, 0x08};
    return codings[static_cast<std::size_t>(state)];
}

/// Derives the power state from the drive's report and the state that this class keeps for it.
void Cia402Axis::settle(State& s) const {
    if (s.presence == Presence::offline || !s.seen) {
        s.state = PowerState::not_ready_to_switch_on;
        return;
    }
    const auto own = s.feedback.statusword ? std::optional(power_state_of(*s.feedback.statusword)) : std::nullopt;
    if (s.feedback.fault) {
        const bool reported = own == PowerState::fault || own == PowerState::fault_reaction_active;
        if (s.state != PowerState::fault && s.state != PowerState::fault_reaction_active) s.end_turn();
        s.state = reported ? *own : s.feedback.moving ? PowerState::fault_reaction_active : PowerState::fault;
        s.virtual_step = 0;
        s.quick_stopped = false;
        s.forget(Cause::fault);
        return;
    }
    if (s.feedback.power == AxisFeedback::Power::on) {
        if (s.power_pending == 0) return;  // the power will be off soon; the answer decides
        // The drive may have been stopped by its own panel, an input, or another master. This state is left like any quick stop.
        const bool stopping = s.feedback.quick_stopping || own == PowerState::quick_stop_active;
        const bool stopped = s.quick_stopped || (stopping && s.power_pending != 1);
        if (stopped && s.state == PowerState::operation_enabled) {
            s.forget(Cause::motion_ends);
            if (!s.quick_stopped) s.end_turn();
        }
        s.state = stopped ? PowerState::quick_stop_active : PowerState::operation_enabled;
        return;
    }
    if (s.power_pending == 1) return;
    if (s.virtual_step == 3) {  // the axis was on by our order and went off by itself: it returns to the first step
        s.virtual_step = 0;
        s.forget(Cause::motion_ends);
        s.end_turn();
    }
    s.quick_stopped = false;
    s.state = s.state_when_off();
}

/// The drive has ended the motion by itself; repeated words of no client begin it again.
void Cia402Axis::State::end_turn() noexcept {
    ++turn;
    stopped = true;
}

/// Without power: the steps that a control word has taken where the drive knows only on and off. A drive's own state is never shown lower
/// than it is; a step that the drive does not know, and that a control word waits for, is shown above it.
PowerState Cia402Axis::State::state_when_off() const noexcept {
    const PowerState step = virtual_step == 1   ? PowerState::ready_to_switch_on
                            : virtual_step == 2 ? PowerState::switched_on
                                                : PowerState::switch_on_disabled;
    const auto own = feedback.statusword ? power_state_of(*feedback.statusword) : step;
    return own <= PowerState::switched_on ? std::max(own, step) : step;
}

/// True if the motion was ordered while another one ran: then it counts from here on, if the drive has accepted it.
bool Cia402Axis::asked_beside_another(State& s, const CommandBody& order, bool good) {
    if (s.asked_motions == 0) return false;
    --s.asked_motions;
    if (good) s.take_motion(order);
    return true;
}

void Cia402Axis::on_order_result(const CommandBody& order, bool good, Instant now) {
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
            s.end_turn();
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
        const bool beside_another = asked_beside_another(s, order, good);
        if (!beside_another || good) s.homing_refused = !good;
        if (good) s.forget(Cause::homing_taken);
    } else if (std::holds_alternative<SetPosition>(order)) {
        if (good) s.forget(Cause::position_set);
    } else if (const auto* m = std::get_if<Move>(&order)) {
        if (m->kind == Move::Kind::velocity && s.asked_velocity == m->target) s.asked_velocity.reset();
        const bool again = s.repeated_moves > 0;
        if (again) {
            --s.repeated_moves;
        } else {
            (void)asked_beside_another(s, order, good);
        }
        if (!good) return;
        if (!again) ++s.setpoints_accepted;
        const auto shown = [](std::uint32_t& into, const std::optional<std::int64_t>& v) {
            if (v) into = static_cast<std::uint32_t>(*v);
        };
        shown(s.profile_velocity, m->velocity);
        shown(s.profile_acceleration, m->acceleration);
        shown(s.profile_deceleration, m->deceleration);
        // Bit 12 answers bit 4: a client that has not set bit 4 does not wait for bit 12 to fall.
        s.setpoint_acknowledged = (s.controlword & cw_new_setpoint) != 0;
        if (m->kind == Move::Kind::velocity) {
            s.ordered_velocity = m->target;
            s.forget(Cause::velocity_taken);
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

std::optional<CommandBody> Cia402Axis::on_feedback(const AxisFeedback& feedback, Instant now) {
    State& s = s_;
    AxisFeedback f = feedback;
    // This was read before the drive acknowledged a power order, so its power state is out of date.
    if (s.seen && f.at <= s.power_known_at) {
        f.power = s.feedback.power;
        f.quick_stopping = s.feedback.quick_stopping;
    }
    s.feedback = f;
    s.seen = true;
    s.received = s.presence;
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
        if (s.buffered && !s.halted && s.asked_motions == 0) {
            Move next = *s.buffered;
            s.forget(Cause::set_point);
            ++s.repeated_moves;  // counted when it was buffered
            return CommandBody{next};
        }
        if (!s.halted) s.forget(Cause::arrival);
    }
    return std::nullopt;
}

void Cia402Axis::on_presence(Presence presence) {
    if (presence == s_.presence) return;
    s_.presence = presence;
    s_.seen = false;
    // For a silent drive the last values are kept, with their age; its present activity is unknown. Another drive starts with empty values.
    AxisFeedback last;
    if (presence == Presence::offline || presence == s_.received) {
        last.position = s_.feedback.position;
        last.velocity = s_.feedback.velocity;
        last.error_code = s_.feedback.error_code;
        last.native_status = s_.feedback.native_status;
        last.at = s_.feedback.at;
    } else {
        s_.received = Presence::offline;
    }
    s_.feedback = last;
    s_.power_pending = -1;
    s_.power_known_at = {};
    s_.virtual_step = 0;
    s_.quick_stopped = false;
    s_.controlword = 0;
    s_.repeated_moves = 0;
    s_.homing_refused = s_.reacting = false;
    s_.reaction_at = {};
    ++s_.enables;  // targets written earlier become invalid
    s_.ordered_on = false;
    s_.asked_motions = 0;
    s_.forget(Cause::motion_ends);
    s_.end_turn();
    settle(s_);
}

std::optional<std::int64_t> Cia402Axis::active_target() const noexcept {
    if (!s_.active || s_.feedback.target_reached) return std::nullopt;
    return s_.active->target;
}

bool Cia402Axis::commanded() const noexcept {
    return s_.state == PowerState::operation_enabled || s_.state == PowerState::quick_stop_active || s_.power_pending == 1 ||
           s_.feedback.moving;
}

/// The condition for "target reached" in status word and flags: by mode, the axis stands or has its speed.
bool Cia402Axis::State::reached() const noexcept {
    if (mode == mode_homing) return !feedback.moving && !feedback.homing;
    if (mode == mode_profile_velocity && !halted)
        return std::llabs(feedback.velocity - ordered_velocity) * 100 <= std::llabs(ordered_velocity);
    return !feedback.moving && (feedback.target_reached || (halted && !is_streamed(mode)));
}

/// Bits 12 and 13, which have a meaning of their own in each mode.
std::uint16_t Cia402Axis::State::mode_bits() const noexcept {
    if (mode == mode_profile_velocity) return feedback.velocity == 0 ? sw_mode_12 : 0;
    if (is_streamed(mode)) return following ? sw_mode_12 : 0;  // the drive follows the command value
    if (mode != mode_homing) return setpoint_acknowledged || buffered ? sw_mode_12 : 0;
    std::uint16_t bits = feedback.homing_attained && !homing_refused ? sw_mode_12 : 0;
    if (feedback.homing_error || homing_refused) bits |= sw_mode_13;
    return bits;
}

void Cia402Axis::fill(AxisPicture& p) const noexcept {
    const State& s = s_;
    const AxisFeedback& f = s.feedback;
    const bool present = s.presence != Presence::offline, known = present && s.seen, twin = s.presence == Presence::twin;
    const bool arrived = known && s.reached();
    const auto bit = [](bool set, std::uint16_t mask) { return set ? unsigned{mask} : 0u; };
    p.statusword = static_cast<std::uint16_t>(coding_of(s.state) | bit(known, sw_voltage | sw_remote) | bit(f.warning, sw_warning) |
                                              bit(twin, sw_simulated) | bit(f.internal_limit, sw_internal_limit) |
                                              bit(f.referenced, sw_referenced) | bit(arrived, sw_target_reached) | s.mode_bits());
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
    p.ever_seen = s.received != Presence::offline;
    p.current = s.seen;
    p.at = f.at;
    p.flags = static_cast<std::uint16_t>(bit(present, flag_online) | bit(twin, flag_simulated) | bit(f.referenced, flag_referenced) |
                                         bit(f.moving, flag_moving) | bit(arrived, flag_target_reached) | bit(f.fault, flag_fault) |
                                         bit(f.warning, flag_warning));
}

}  // namespace axisgate
