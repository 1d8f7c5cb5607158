// The requests to the CiA 402 state machine. A request is tried on a copy of the state, which is kept only if nothing refused it. States
// that a drive with only on and off does not have (ready, switched on) are kept here. Every order is a return value; nothing is sent from
// here. cia402_feedback.cpp contains the drive's side.
#include "gateway/axis/cia402.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace axisgate {
using namespace cia402;

namespace {
constexpr std::uint16_t so = cw_switch_on, ev = cw_enable_voltage, qs = cw_quick_stop, eo = cw_enable_operation,
                        on_bits = so | ev | qs | eo;

/// The effect of a control word on the power.
enum class Power : std::uint8_t { stays, on, on_by_edge, off, quick_stop, quick_stop_again };
constexpr std::uint16_t same = 0xFFFF;
struct Transition {
    PowerState from;
    std::uint16_t set, clear;  // bits of the word that are 1, and one that is 0
    std::uint16_t step;        // the new virtual_step
    Power power;
};
/// The numbers are those of IEC 61800-7-201; the first matching row applies. A fault is left by the drive, or by the edge of the fault
/// reset.
constexpr Transition transitions[] = {
    {PowerState::switch_on_disabled, ev | qs, so, 1, Power::stays},         // 2
    {PowerState::ready_to_switch_on, 0, ev, 0, Power::stays},               // 7
    {PowerState::ready_to_switch_on, 0, qs, 0, Power::stays},               // 7
    {PowerState::ready_to_switch_on, so | eo, 0, 3, Power::on},             // 3 and 4 together
    {PowerState::ready_to_switch_on, so, eo, 2, Power::stays},              // 3
    {PowerState::switched_on, 0, ev, 0, Power::stays},                      // 10
    {PowerState::switched_on, 0, qs, 0, Power::stays},                      // 10
    {PowerState::switched_on, 0, so, 1, Power::stays},                      // 6
    {PowerState::switched_on, eo, 0, 3, Power::on},                         // 4
    {PowerState::operation_enabled, 0, ev, 0, Power::off},                  // 9
    {PowerState::operation_enabled, 0, qs, same, Power::quick_stop},        // 11
    {PowerState::operation_enabled, 0, so, 1, Power::off},                  // 8
    {PowerState::operation_enabled, 0, eo, 2, Power::off},                  // 5
    {PowerState::quick_stop_active, 0, ev, 0, Power::off},                  // 12
    {PowerState::quick_stop_active, 0, qs, same, Power::quick_stop_again},  // while the axis still moves
    {PowerState::quick_stop_active, on_bits, 0, 3, Power::on_by_edge},      // 16
};
}  // namespace

Cia402Axis::Decision Cia402Axis::refuse(Reason reason, std::string text) const {
    Decision d;
    d.refused = true;
    d.reason = reason;
    d.text = std::move(text);
    return d;
}

Cia402Axis::Decision Cia402Axis::unreceived(const State& s) const {
    return refuse(Reason::no_answer,
                  s.presence == Presence::offline ? "the drive does not answer" : "the drive has not said yet where it is");
}

Cia402Axis::Decision Cia402Axis::in_fault(const State& s) const {
    return refuse(Reason::wrong_state, fmt::format("the axis is in fault (drive's code {}): reset the fault first", s.feedback.error_code));
}

void Cia402Axis::order_on(State& s, Words* own, Decision& d) {
    s.forget(Cause::motion_ends);
    // The actual position becomes the first target, so that enabling never starts a motion. Values that this client has written for the
    // set-point that it is about to give are kept; values that any client wrote or used before are not.
    const bool kept = own && own->enables == s.enables && own->target_pending;
    ++s.enables;
    s.ordered_on = true;
    if (own) {
        own->target_known = own->target_pending = kept;
        own->enables = s.enables;
    }
    if (!kept) s.target_position = static_cast<std::int32_t>(s.feedback.position);
    s.power_pending = 1;
    d.orders.emplace_back(Enable{});
}

/// The order is given even if the drive seems to be off or does not answer.
void Cia402Axis::order_off_blindly(State& s, Decision& d) {
    s.forget(Cause::motion_ends);
    s.virtual_step = 0;
    s.quick_stopped = false;
    d.orders.emplace_back(Disable{});
}

void Cia402Axis::order_off(State& s, Decision& d) {
    const bool off = s.feedback.power == AxisFeedback::Power::off && s.power_pending != 1;
    s.forget(Cause::motion_ends);
    s.quick_stopped = false;
    if (off) return;
    s.power_pending = 0;
    d.orders.emplace_back(Disable{});
}

/// Transition 15 ends in switch on disabled: a drive that keeps its power through a fault is switched off together with the reset.
void Cia402Axis::order_reset(State& s, Decision& d) {
    d.orders.emplace_back(ResetFault{});
    if (s.feedback.fault && s.feedback.power == AxisFeedback::Power::on) {
        s.power_pending = 0;
        d.orders.emplace_back(Disable{});
    }
}

bool Cia402Axis::Request::enables_anew() const noexcept {
    return data.controlword && known && (word & on_bits) == on_bits && (before & on_bits) != on_bits;
}

bool Cia402Axis::Request::is_fresh() const noexcept {
    const bool by_word = data.controlword && known && ((rising() & cw_new_setpoint) || (falling() & cw_halt) || enables_anew());
    return by_word || (data.target_velocity && own.velocity_known && own.target_velocity != *data.target_velocity);
}

/// The registers of a client.
Cia402Axis::Client& Cia402Axis::client(const AuthorityClient& who) {
    auto found = std::ranges::find(clients_, who, &Client::who);
    if (found == clients_.end()) {
        if (clients_.size() < most_clients) {
            found = clients_.emplace(clients_.end());
        } else {
            found = std::ranges::min_element(clients_, {}, &Client::used);
        }
        *found = Client{who, {}, 0};
        if (!s_.stopped) found->words.turn = s_.turn;
    }
    // It is unknown which word the client wrote before a stop. If another client has enabled or moved the axis since, the client's words
    // would have been received.
    if (!s_.stopped) {
        if (!found->words.controlword) found->words.controlword = s_.controlword;
        found->words.velocity_known = true;
    }
    found->used = ++uses_;
    return *found;
}

/// The drive is offline or has not reported a position yet, so it may still be moving. A stopping word is sent, and its answer is the
/// drive's; everything else is refused, because no drive could carry it out. Returns false if refused; `d` contains the reason.
bool Cia402Axis::change_unreceived(State& s, const Request& r, Decision& d) const {
    if (!(r.word & cw_enable_voltage)) {
        order_off_blindly(s, d);
    } else if (!(r.word & cw_quick_stop)) {
        s.forget(Cause::motion_ends);
        d.orders.emplace_back(QuickStop{});
    } else if (r.begins(cw_halt)) {
        s.forget(Cause::motion_ends);
        s.halted = true;
        d.orders.emplace_back(Halt{});
    } else {
        d = unreceived(s);
        return false;
    }
    return true;
}

/// The axis is shown without power or in fault, and moves or may move: a word that would end a motion in operation enabled ends it here,
/// too.
void Cia402Axis::stop_in_any_state(State& s, const Request& r, Decision& d) const {
    const bool repeated = r.known && r.before == r.word;
    if (repeated && s.feedback.power == AxisFeedback::Power::off) return;  // the axis was switched off already, and runs down
    if (!(r.word & cw_enable_voltage)) {
        order_off_blindly(s, d);
    } else if (!(r.word & cw_quick_stop)) {
        s.forget(Cause::motion_ends);
        d.orders.emplace_back(QuickStop{});
    } else if (r.stops_by(cw_switch_on) || r.stops_by(cw_enable_operation)) {
        order_off_blindly(s, d);
    } else if (r.begins(cw_halt)) {
        s.forget(Cause::motion_ends);
        s.halted = true;
        d.orders.emplace_back(Halt{});
    }
}

void Cia402Axis::change_power(State& s, const Request& r, Decision& d) const {
    const bool powered = s.state == PowerState::operation_enabled || s.state == PowerState::quick_stop_active;
    if (s.power_pending == 1 && !powered && (r.word & on_bits) != on_bits) {
        // The axis is being switched on: this is reversed without waiting for it.
        s.virtual_step = !(r.word & ev) || !(r.word & qs) ? 0 : !(r.word & so) ? 1 : 2;
        return order_off(s, d);
    }
    if (!powered && (s.feedback.moving || s.feedback.homing || s.recorded)) {
        const auto orders = d.orders.size();
        stop_in_any_state(s, r, d);
        if (d.orders.size() != orders) return;
    }
    const bool may_rise = r.current || r.enables_anew();  // repeated words do not undo what another client has ended
    for (const Transition& t : transitions) {
        if (t.from != s.state || (r.word & t.set) != t.set || (r.word & t.clear)) continue;
        if (t.power == Power::on && !may_rise) continue;
        // An edge is required: a controller that writes the same word again and again does not undo a stop of any client.
        if (t.power == Power::on_by_edge && !r.enables_anew()) continue;
        if (t.power == Power::quick_stop_again && !s.feedback.moving && !s.recorded) continue;
        if (t.step != same) s.virtual_step = t.step;
        switch (t.power) {
            case Power::stays:
                return settle(s);
            case Power::on:
            case Power::on_by_edge:
                // A controller writes its word again and again while the drive comes on; each would be one more order in front of its next.
                if (s.power_pending == 1 && r.known && !r.enables_anew()) return;
                // The order is repeated to the drive, so that a lock that the stop has set is removed or reported
                return order_on(s, &r.own, d);
            case Power::off:
                return order_off(s, d);
            case Power::quick_stop:
                s.forget(Cause::motion_ends);
                [[fallthrough]];
            case Power::quick_stop_again:
                d.orders.emplace_back(QuickStop{});
                return;
        }
    }
    if (s.state >= PowerState::switch_on_disabled && s.state <= PowerState::switched_on) settle(s);
}

/// A rising edge of bit 4 in profile position mode. Returns false if refused; `d` contains the reason.
bool Cia402Axis::new_set_point(State& s, const Request& r, Decision& d) const {
    Words& own = r.own;
    if (s.halted) {
        d = refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it first");
        return false;
    }
    if (own.velocity == 0) {
        d = refuse(Reason::out_of_range,
                   "the profile velocity (registers 36 and 37) is 0 or was never written by this client: write it before the set-point");
        return false;
    }
    Move m;
    m.kind = (r.word & cw_relative) ? Move::Kind::relative : Move::Kind::absolute;
    // A target that this client has not written since the axis was enabled, or since another drive serves it, is not its intention:
    // register 34 may show another client's value, or an old one. The axis stays at its position.
    const std::int64_t here = m.kind == Move::Kind::relative ? 0 : s.feedback.position;
    m.target = own.target_known ? own.target_position : here;
    m.velocity = own.velocity;
    if (own.acceleration) m.acceleration = own.acceleration;
    if (own.deceleration) m.deceleration = own.deceleration;
    own.target_pending = false;
    s.target_position = static_cast<std::int32_t>(m.target);
    const bool under_way = s.active && s.feedback.moving && !s.feedback.target_reached;
    if (!(r.word & cw_change_immediately) && under_way) {
        if (s.buffered) {
            d = refuse(Reason::busy, "one set-point waits already: wait until bit 12 of the status word is 0, or set bit 5");
            return false;
        }
        s.buffered = d.waits = m;
        s.setpoint_acknowledged = true;
        ++s.setpoints_accepted;
    } else {
        s.forget(Cause::set_point);
        d.orders.emplace_back(m);
    }
    return true;
}

/// The axis is not enabled, or the power state changes with this very word, so an edge for a motion has no effect. A word that stops or
/// resets is not refused for this: whether it ends a motion never depends on the bits that would begin one. Returns false if refused; `d`
/// contains the reason.
bool Cia402Axis::change_without_power(State& s, const Request& r, Decision& d) const {
    const auto ends = [](const CommandBody& o) { return is_urgent(o) || std::holds_alternative<ResetFault>(o); };
    if (r.begins(cw_new_setpoint) && std::ranges::none_of(d.orders, ends) && (s.mode == mode_profile_position || s.mode == mode_homing)) {
        d = refuse(Reason::wrong_state, fmt::format("a new set-point needs operation enabled; the axis is {}", name_of(s_.state)));
        return false;
    }
    if (r.data.controlword) s.halted = (r.word & cw_halt) || (s.halted && !(r.falling() & cw_halt));
    return true;
}

/// Bit 8: setting it halts the motion; clearing it lets a motion to a target continue.
void Cia402Axis::change_halt(State& s, const Request& r, Decision& d) const {
    if (r.begins(cw_halt)) {
        s.halted = true;
        s.forget(Cause::halt_bit);
        d.orders.emplace_back(Halt{});
    } else if (r.falling() & cw_halt) {
        s.halted = false;
        if (s.mode == mode_profile_position && s.active && !s.feedback.target_reached && !(r.rising() & cw_new_setpoint)) {
            d.orders.emplace_back(*s.active);
            ++s.repeated_moves;
        }
    }
}

/// Bit 4 in homing mode: its rising edge starts homing, its falling edge ends it. Returns false if refused; `d` contains the reason.
bool Cia402Axis::change_homing(State& s, const Request& r, bool starts, Decision& d) const {
    if (starts) {
        if (Decision no = may_home(s); no.refused) {
            d = std::move(no);
            return false;
        }
        d.orders.emplace_back(Home{s.homing_method});
    }
    const bool under_way = s.feedback.homing || (s.feedback.moving && !s.feedback.homing_attained);
    if ((r.falling() & cw_new_setpoint) && under_way) d.orders.emplace_back(Halt{});
    return true;
}

/// The target velocity in profile velocity mode: it was written, or the end of a halt releases it.
void Cia402Axis::change_velocity(State& s, const Request& r, Decision& d) const {
    if (s.halted || (!r.current && !r.fresh)) return;
    const bool released = (r.falling() & cw_halt) && r.own.velocity_forgotten == s.forgotten;
    if (!r.data.target_velocity && !released) return;
    // A speed whose order has no answer yet is not ordered again because the client repeats it.
    if (r.own.target_velocity == s.asked_velocity.value_or(s.ordered_velocity)) return;
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = r.own.target_velocity;
    if (r.own.acceleration) m.acceleration = r.own.acceleration;
    if (r.own.deceleration) m.deceleration = r.own.deceleration;
    d.orders.emplace_back(m);
    s.asked_velocity = m.target;
}

/// Halt, new set-points, start of homing. Returns false if refused; `d` contains the reason.
bool Cia402Axis::change_motion(State& s, const Request& r, Decision& d) const {
    if (r.falling() & cw_new_setpoint) s.setpoint_acknowledged = false;
    const bool enabled = s.state == PowerState::operation_enabled && s.power_pending != 0;
    if (!enabled || !d.orders.empty()) return change_without_power(s, r, d);
    change_halt(s, r, d);
    const bool starts = (r.rising() & cw_new_setpoint) && !r.begins(cw_halt);
    if (s.mode == mode_profile_position && starts && !new_set_point(s, r, d)) return false;
    if (s.mode == mode_homing && !change_homing(s, r, starts, d)) return false;
    if (s.mode == mode_profile_velocity) change_velocity(s, r, d);
    return true;
}

/// The values of the block without the control word: targets, profile and mode.
void Cia402Axis::latch_values(State& s, const Request& r, Decision& d) const {
    const ProcessData& data = r.data;
    Words& own = r.own;
    if (own.enables != s.enables) own.target_known = own.target_pending = false;
    own.enables = s.enables;
    if (data.target_position) {
        s.target_position = own.target_position = *data.target_position;
        own.target_known = own.target_pending = true;
    }
    if (data.profile_velocity) s.profile_velocity = own.velocity = *data.profile_velocity;
    if (data.profile_acceleration) s.profile_acceleration = own.acceleration = *data.profile_acceleration;
    if (data.profile_deceleration) s.profile_deceleration = own.deceleration = *data.profile_deceleration;
    if (data.homing_method) s.homing_method = *data.homing_method;
    // A repeated mode does not end the activity of another client in another mode. At rest it is accepted; a mode that was written
    // meanwhile and not since is accepted with the next fresh edge of the same client's words.
    const bool busy = s.feedback.moving || s.feedback.homing || s.recorded || s.ordered_velocity != 0;
    const bool returns = !data.mode && !busy && !s.following && r.is_fresh();
    const std::optional<std::int16_t> mode = returns ? own.mode : data.mode;
    if (!mode) return;
    const bool repeated = own.mode ? *own.mode == *mode : !r.known;
    own.mode = *mode;
    if (*mode == s.mode || (busy && repeated && !r.current)) return;
    if (s.mode == mode_profile_velocity && s.ordered_velocity != 0) {
        s.forget(Cause::mode_left);
        d.orders.emplace_back(Halt{});
    }
    s.mode = *mode;
    if (s.following) s.mode_before = s.mode;
    s.forget(Cause::new_mode);
}

Cia402Axis::Decision Cia402Axis::on_process_data(const ProcessData& data, const Origin& by, const Look& look) {
    State s = s_;
    Decision d;
    Client& me = client(AuthorityClient::of(by));
    Words own = me.words;
    Request r{data, own};
    r.known = own.controlword.has_value();
    r.word = data.controlword.value_or(own.controlword.value_or(s.controlword));
    r.before = own.controlword.value_or(r.word);
    r.current = own.turn == s.turn;
    latch_values(s, r, d);
    r.fresh = r.is_fresh();
    if (data.target_velocity) {
        s.target_velocity = own.target_velocity = *data.target_velocity;
        own.velocity_known = true;
        own.velocity_forgotten = s.forgotten;
    }
    if (data.controlword) own.controlword = s.controlword = r.word;
    const auto keep = [&] {
        const bool acts = !d.orders.empty() || d.waits;
        if (acts) ++s.turn;
        if (acts || r.fresh) own.turn = s.turn;
        if (std::ranges::any_of(d.orders, [](const CommandBody& o) { return is_urgent(o); })) {
            s.stopped = true;
        } else if (acts) {
            s.stopped = false;
        }
        s_ = std::move(s);
        me.words = own;
    };
    Decision power;
    if (data.controlword) {
        if (s.state == PowerState::not_ready_to_switch_on) {
            if (!change_unreceived(s, r, power)) return power;
            for (auto& o : power.orders)
                d.orders.push_back(std::move(o));
            keep();
            return d;
        }
        if ((r.word & cw_fault_reset) && (!r.known || !(r.before & cw_fault_reset))) order_reset(s, power);
        change_power(s, r, power);
    }
    const bool homes = s.mode == mode_homing && (r.rising() & cw_new_setpoint);
    if (!change_motion(s, r, power)) {
        s_.homing_refused = s_.homing_refused || homes;
        return power;
    }
    for (auto& o : power.orders)
        d.orders.push_back(std::move(o));
    d.waits = power.waits;
    if (look) {
        if (auto no = look(d)) return refuse(no->reason, std::move(no->text));
    }
    keep();
    return d;
}

Cia402Axis::Decision Cia402Axis::may_home(const State& s) const {
    if (s.halted) return refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it before homing");
    if (s.state == PowerState::quick_stop_active)
        return refuse(Reason::wrong_state, "the axis is in quick stop: enable it again before homing");
    return {};
}

/// A motion by command: the mode and targets that it shows, and the values that it discards. While another motion runs, both wait until the
/// drive has accepted the order: a refused order leaves the motion of another client, its mode and its waiting set-point as they are.
void Cia402Axis::ask_motion(State& s, const CommandBody& body) {
    if (s.runs()) {
        ++s.asked_motions;
    } else {
        s.take_motion(body);
    }
}

bool Cia402Axis::State::runs() const noexcept {
    return feedback.moving || feedback.homing || recorded || ordered_velocity != 0 || following || active || buffered;
}

void Cia402Axis::State::take_motion(const CommandBody& body) {
    if (const auto* home = std::get_if<Home>(&body)) {
        forget(Cause::homing_asked);
        mode = mode_homing;
        homing_method = home->method;
        return;
    }
    forget(Cause::motion_asked);
    if (const auto* move = std::get_if<Move>(&body); move && move->kind == Move::Kind::velocity) {
        mode = mode_profile_velocity;
        target_velocity = static_cast<std::int32_t>(move->target);
    } else if (move) {
        mode = mode_profile_position;
        const std::int64_t from = move->kind == Move::Kind::relative ? feedback.position : 0;
        target_position = static_cast<std::int32_t>(from + move->target);
    }
}

/// Homing by command.
void Cia402Axis::enable(State& s, Words* own, Decision& d) {
    s.ordered_on = true;
    // An axis that is enabled already keeps the other bits: a word that a controller repeats must not become an edge by this command.
    const bool already = s.state == PowerState::operation_enabled && s.power_pending != 0;
    const unsigned kept = already ? s.controlword & ~unsigned{cw_halt} : 0;
    s.controlword = static_cast<std::uint16_t>(kept | cw_switch_on | cw_enable_voltage | cw_quick_stop | cw_enable_operation);
    if (!already) {
        s.virtual_step = 3;
        order_on(s, own, d);
    } else if (s.halted) {
        s.forget(Cause::motion_ends);  // a halt bit that its client has left set ends here, and no motion continues because of that
    }
}

Cia402Axis::Decision Cia402Axis::on_command(const CommandBody& body, const Origin& by) {
    State s = s_;
    Decision d;
    const AuthorityClient who = AuthorityClient::of(by);
    Words* const own = has_clients(who.door) ? &client(who).words : nullptr;
    const bool present = s.presence != Presence::offline && s.seen;
    if (!present && !is_urgent(body)) return unreceived(s);
    if (std::holds_alternative<Enable>(body)) {
        if (s.feedback.fault) return in_fault(s);
        enable(s, own, d);
    } else if (std::holds_alternative<Disable>(body)) {
        s.controlword = 0;
        s.power_pending = 0;
        order_off_blindly(s, d);
    } else if (std::holds_alternative<QuickStop>(body)) {
        s.controlword &= static_cast<std::uint16_t>(~cw_quick_stop);
        s.forget(Cause::motion_ends);
        d.orders.emplace_back(QuickStop{});
    } else if (std::holds_alternative<Halt>(body)) {
        s.forget(Cause::halt_command);
        d.orders.emplace_back(Halt{});
    } else if (std::holds_alternative<ResetFault>(body)) {
        order_reset(s, d);
    } else if (const auto* home = std::get_if<Home>(&body)) {
        if (s.feedback.fault) {
            s_.homing_refused = true;
            return in_fault(s);
        }
        if (Decision no = may_home(s); no.refused) return no;
        ask_motion(s, body);
        d.orders.emplace_back(*home);
    } else if (const auto* set = std::get_if<SetPosition>(&body)) {
        if (s.buffered)
            return refuse(Reason::wrong_state,
                          "a set-point waits behind the running one: set the position when it has ended, or halt first");
        if (s.feedback.moving || s.feedback.homing) return refuse(Reason::wrong_state, "the axis moves: set its position when it stands");
        d.orders.emplace_back(*set);
    } else if (const auto* move = std::get_if<Move>(&body)) {
        if (s.feedback.fault) return in_fault(s);
        if (s.state != PowerState::operation_enabled || s.power_pending == 0) {
            return refuse(Reason::wrong_state, fmt::format("the axis is {}: enable it first", name_of(s.state)));
        }
        if (s.halted)
            return refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it, or enable the axis again, first");
        ask_motion(s, body);
        d.orders.emplace_back(*move);
        if (move->kind == Move::Kind::velocity) std::get<Move>(d.orders.back()).velocity.reset();
    } else if (const auto* together = std::get_if<StartTogether>(&body)) {
        d.orders.emplace_back(*together);
    } else {
        return refuse(Reason::not_supported, "this is not a command of the axis profile");
    }
    const bool moves =
        std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) || std::holds_alternative<StartTogether>(body);
    const bool enables = std::holds_alternative<Enable>(body);
    if (moves || enables || is_urgent(body)) {
        ++s.turn;
        s.stopped = is_urgent(body);
        if (own) own->turn = s.turn;
    }
    s_ = std::move(s);
    return d;
}

Cia402Axis::Decision Cia402Axis::may_follow() const {
    const State& s = s_;
    if (s.presence == Presence::offline || !s.seen) return unreceived(s);
    if (s.feedback.fault) return in_fault(s);
    if (s.state != PowerState::operation_enabled || s.power_pending == 0)
        return refuse(Reason::wrong_state, fmt::format("the axis is {}: enable it first", name_of(s.state)));
    if (!s.ordered_on)
        return refuse(Reason::wrong_state,
                      "the axis was enabled already when this gateway found it: enable it anew before it is streamed to");
    if (s.halted) return refuse(Reason::wrong_state, "halt (bit 8 of the control word) is set: clear it, or enable the axis again, first");
    return {};
}

void Cia402Axis::follow(const SetPoint& p, std::int16_t mode) {
    State& s = s_;
    if (!s.following) {
        s.forget(Cause::motion_ends);
        ++s.turn;
        s.stopped = false;
        s.following = true;
        s.mode_before = s.mode;
    }
    s.mode = mode;
    if (p.mode == SetPoint::Mode::position) s.target_position = static_cast<std::int32_t>(p.value);
    s.target_velocity = p.mode == SetPoint::Mode::velocity ? static_cast<std::int32_t>(p.value) : 0;
}

void Cia402Axis::end_following() { s_.leave_stream(); }

}  // namespace axisgate
