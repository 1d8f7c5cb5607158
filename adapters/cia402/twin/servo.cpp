// Servo: states, orders and what happens by itself.
// In: control words and targets by the dictionary. Out: states, plans, EMCY. Never moves because it was switched on.
#include "adapters/cia402/twin/servo.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/cia402/twin/homing.hpp"
#include "adapters/cia402/twin/objects.hpp"

namespace axisgate::cia402_drive::twin {
namespace {
constexpr double coasting = 100'000;  ///< increments/s^2, of a shaft without power
/// Error register (1001h) of a code's class.
std::uint8_t register_of(std::uint16_t code) {
    const unsigned c = code >> 12;
    return static_cast<std::uint8_t>(1u | (c == 2 ? 2u : c == 3 ? 4u : c == 4 ? 8u : c == 8 ? 0x10u : c == 0xF ? 0x80u : 0x20u));
}
}  // namespace

const std::vector<std::uint16_t>& Servo::error_codes() {
    static const std::vector<std::uint16_t> codes{0x1000, 0x2310, 0x2320, 0x2330, 0x3110, 0x3120, 0x3210, 0x3220,
                                                  0x4210, 0x4310, 0x5113, 0x5441, 0x5530, 0x6010, 0x6320, 0x7121,
                                                  0x7122, 0x7305, 0x8110, 0x8130, 0x8400, 0x8500, 0x8611, 0x8612};
    return codes;
}

void Servo::power_on(Instant now) {
    const double here = m_.shaft(now).position;
    m_.rest_at(here, now);
    zero_ = here;
    state_ = State::switch_on_disabled;
    after_stop_.reset();
    cw_ = 0;
    mode_ = static_cast<int>(get(0x6060));
    halted_ = reached_ = acknowledged_ = limited_ = false;
    target_.reset();
    buffered_.reset();
    homing_ = Homing::none;
    behind_since_.reset();
    probe_status_ = 0;
    probe_function_ = 0;
    read_units();
    arm_probes();
    put(0x603F, 0);
    put(0x1001, 0);
    if (cause_ != 0) fail(cause_, now);
}
void Servo::power_off(Instant now) {
    m_.rest_at(m_.shaft(now).position, now);
    state_ = State::switch_on_disabled;
    after_stop_.reset();
    target_.reset();
    buffered_.reset();
}

/// User units: increments of the motor for one unit of position, and increments/s for one of velocity. What a dictionary has not is 1.
void Servo::read_units() {
    per_unit_ = ratio(0x608F) * ratio(0x6091) / ratio(0x6092);
    per_speed_ = per_unit_ * ratio(0x6096);
}
double Servo::ratio(std::uint16_t index) const {
    const auto over = static_cast<double>(get(index, 1)), under = static_cast<double>(get(index, 2));
    return over > 0 && under > 0 ? over / under : 1;
}

Ramps Servo::ramps() const {
    return {std::min(per_speed_ * static_cast<double>(get(0x6081)), fastest()), per_unit_ * std::min(rate(0x6083), rate(0x60C5)),
            per_unit_ * std::min(rate(0x6084), rate(0x60C6))};
}
/// By the option codes 605Ah, 605Dh and 605Eh: 1 and 5 the slow-down ramp, 2 and 6 that of the quick stop, beyond those what current and
/// voltage give: the most that the drive can.
double Servo::braking(std::int64_t option) const {
    return per_unit_ * rate(option == 1 || option == 5 ? 0x6084 : option == 2 || option == 6 ? 0x6085 : 0x60C6);
}

bool Servo::keeps(canopen::Address address, const canopen::Entry& entry) const { return is_stored(address, entry); }
canopen::Abort Servo::may_write(canopen::Address a, std::int64_t v) const {
    a.index = static_cast<std::uint16_t>(a.index - shift_);
    if (a.index == 0x6060) {
        const auto modes = static_cast<std::uint32_t>(get(0x6502));
        return v == 0 || (v >= 1 && v <= 10 && (modes >> (v - 1) & 1u)) ? canopen::Abort::none : canopen::Abort::value;
    }
    if (a.index == 0x6098) {
        for (std::uint8_t i = 1; i <= get(0x60E3); ++i)
            if (get(0x60E3, i) == v) return canopen::Abort::none;
        return canopen::Abort::value;
    }
    // Another measure of all places and speeds while it is led by them would be a jump.
    const bool unit = a.index == 0x608F || a.index == 0x6091 || a.index == 0x6092 || a.index == 0x6096;
    if (unit && powered()) return canopen::Abort::device_state;
    if (a.index == 0x60C2 && m_.moves(checked_) && powered()) return canopen::Abort::device_state;
    return canopen::Abort::none;
}

void Servo::written(canopen::Address a, Instant now) {
    switch (a.index - shift_) {
        case 0x6040:
            return control(now);
        case 0x6060:
            return set_mode(now);
        case 0x60FF:
        case 0x6071:
            return act(now);
        case 0x60B8:
            return arm_probes();
        case 0x608F:
        case 0x6091:
        case 0x6092:
        case 0x6096:
            return read_units();
        default:
            return;
    }
}

void Servo::control(Instant now) {
    const unsigned cw = static_cast<unsigned>(get(0x6040)), rising = cw & ~cw_, before = std::exchange(cw_, cw);
    if (state_ == State::fault) {
        if ((rising & 0x80u) && cause_ == 0) {
            put(0x603F, 0);
            put(0x1001, 0);
            told_.push_back({now, {}});
            enter(State::switch_on_disabled, now);
        }
        return;
    }
    if (state_ == State::fault_reaction) return;
    command(cw, now);
    if (state_ != State::enabled || after_stop_) return;
    if ((cw & 0x10u) == 0) acknowledged_ = buffered_.has_value();
    if (mode_ == 1 && (rising & 0x10u) && !acknowledged_) set_point(cw & 0x40u, (cw & 0x20u) != 0, now);
    if (mode_ == 6 && (rising & 0x10u)) begin_homing(now);
    if (mode_ == 6 && (before & 0x10u) && !(cw & 0x10u) && (homing_ == Homing::to_switch || homing_ == Homing::to_zero)) {
        homing_ = Homing::none;  // the start bit taken back interrupts it
        m_.stop(per_unit_ * rate(0x609A), now);
    }
    if (((cw ^ before) & 0x100u) || ((cw & 0x100u) == 0 && halted_)) halt((cw & 0x100u) != 0, now);
}

void Servo::command(unsigned cw, Instant now) {
    if ((cw & 2u) == 0) {  // disable voltage: at once
        if (powered()) m_.stop(coasting, now);
        return enter(State::switch_on_disabled, now);
    }
    if ((cw & 4u) == 0) {  // quick stop
        if (state_ == State::ready || state_ == State::switched_on) return enter(State::switch_on_disabled, now);
        if (state_ != State::enabled) return;
        enter(State::quick_stop, now);
        const auto option = get(0x605A);
        return stop_then(option >= 5 ? State::quick_stop : State::switch_on_disabled, braking(option), option == 0, now);
    }
    const unsigned bits = cw & 0xFu;
    if (bits == 0xF && state_ == State::quick_stop && get(0x605A) >= 5 && !m_.moves(now)) return enter(State::enabled, now);
    if (state_ == State::quick_stop) return;
    if (bits == 0xF && (state_ == State::ready || state_ == State::switched_on)) return enter(State::enabled, now);
    if (bits == 0xF && state_ == State::enabled) return after_stop_.reset();
    if (bits == 7) {
        if (state_ == State::ready) enter(State::switched_on, now);
        if (state_ == State::enabled) stop_then(State::switched_on, braking(1), get(0x605C) == 0, now);
    }
    if ((cw & 7u) == 6) {
        if (state_ == State::switch_on_disabled || state_ == State::switched_on) enter(State::ready, now);
        if (state_ == State::enabled) stop_then(State::ready, braking(1), get(0x605B) == 0, now);
    }
}

void Servo::stop_then(State state, double down, bool at_once, Instant now) {
    target_.reset();
    buffered_.reset();
    reached_ = false;
    if (homing_ == Homing::to_switch || homing_ == Homing::to_zero) homing_ = Homing::none;
    if (at_once || (!m_.moves(now))) {
        if (m_.moves(now)) m_.stop(coasting, now);
        return enter(state, now);
    }
    m_.stop(down, now);
    after_stop_ = state;
}

void Servo::enter(State state, Instant now) {
    const bool was = powered();
    after_stop_.reset();
    if (state == State::enabled) {
        if (!was) m_.rest_at(m_.shaft(now).position, now);
        halted_ = (cw_ & 0x100u) != 0;
        acknowledged_ = (cw_ & 0x10u) != 0;
        reached_ = false;
        behind_since_.reset();
        checked_ = now;
    }
    state_ = state;
    if (!powered()) {
        target_.reset();
        buffered_.reset();
        halted_ = false;
        behind_since_.reset();
        if (homing_ == Homing::to_switch || homing_ == Homing::to_zero) homing_ = Homing::none;
    }
    if (state == State::enabled) act(now);
}

void Servo::set_mode(Instant now) {
    const int mode = static_cast<int>(get(0x6060));
    if (mode == mode_ || mode == 0) return;
    mode_ = mode;
    target_.reset();
    buffered_.reset();
    reached_ = acknowledged_ = false;
    homing_ = Homing::none;
    if (state_ != State::enabled || after_stop_) return;
    // What moved by another mode is ended by the new one.
    if (mode_ != 3 && mode_ != 9 && mode_ != 4 && mode_ != 10 && m_.moves(now)) m_.stop(braking(1), now);
    act(now);
}

void Servo::act(Instant now) {
    if (state_ != State::enabled || after_stop_ || halted_) return;
    limited_ = false;
    if (mode_ == 3 || mode_ == 9) {
        const double low = place_of(0x607D, 1), high = place_of(0x607D, 2), most = fastest();
        const double v = std::clamp(per_speed_ * static_cast<double>(get(0x60FF)), -most, most);
        Ramps r = ramps();
        if (mode_ == 9) r.up = r.down = 1e7;
        r.velocity = std::fabs(v);
        if (low < high && v != 0) {  // towards a limit of position it is a way to that limit
            const double end = v > 0 ? high : low;
            if ((end - m_.demand(now).position) * v <= 0) return limited_ = true, m_.stop(r.down, now);
            return m_.move(end, r, now);
        }
        m_.run(v, r, now);
    }
    if (mode_ == 4 || mode_ == 10) {
        const auto most = std::min<std::int64_t>(get(0x6072), 5000);
        m_.push(static_cast<double>(std::clamp<std::int64_t>(get(0x6071), -most, most)) * 50,
                std::min(per_speed_ * rate(0x6080), 100'000.0), now);
    }
}

void Servo::sync(Instant now) {
    if ((mode_ != 8 && mode_ != 7) || state_ != State::enabled || after_stop_ || halted_) return;
    if (mode_ == 7 && (cw_ & 0x10u) == 0) return;
    const double low = place_of(0x607D, 1), high = place_of(0x607D, 2);
    double to = mode_ == 8 ? place_of(0x607A) : place_of(0x60C1, 1);
    limited_ = low < high && (to < low || to > high);
    if (low < high) to = std::clamp(to, low, high);
    m_.step_to(to, static_cast<double>(get(0x60C2, 1)) * std::pow(10.0, static_cast<double>(get(0x60C2, 2))), now);
}

void Servo::set_point(bool relative, bool at_once, Instant now) {
    double to = place_of(0x607A);
    if (relative) to += buffered_.value_or(target_.value_or(m_.demand(now).position)) - zero_;
    const double low = place_of(0x607D, 1), high = place_of(0x607D, 2);
    limited_ = low < high && (to < low || to > high);
    if (low < high) to = std::clamp(to, low, high);
    acknowledged_ = true;
    reached_ = false;
    if (!at_once && target_ && m_.moves(now)) {
        buffered_ = to;
        return;
    }
    target_ = to;
    go(now);
}
void Servo::go(Instant now) {
    const Ramps r = ramps();
    if (target_ && r.velocity > 0 && !halted_) m_.move(*target_, r, now);
}

void Servo::halt(bool on, Instant now) {
    halted_ = on;
    if (on) {
        if (m_.moves(now)) m_.stop(braking(get(0x605D)), now);
        if (homing_ == Homing::to_switch || homing_ == Homing::to_zero) homing_ = Homing::none;
        return;
    }
    if (mode_ == 1 && target_ && !reached_) go(now);
    act(now);
}

void Servo::limit(Instant now) {
    if (!m_.moves(now) || !powered()) return;
    const double v = m_.demand(now).velocity;
    if (homing_ != Homing::to_switch && ((limit_positive && v > 0) || (limit_negative && v < 0))) {
        limited_ = true;
        target_.reset();
        m_.stop(braking(2), now);
    }
}
void Servo::inputs_changed(Instant now) {
    for (unsigned k = 0; k < 2; ++k)
        probe(k, (inputs >> (16 + k) & 1u) != 0, now);
    limit(now);
}
/// Each probe has a byte of 60B8h and of 60B9h: enabled, and whether each edge counts (again and again: bit 1).
void Servo::probe(unsigned k, bool high, Instant now) {
    if (std::exchange(probe_level_[k], high) == high) return;
    const unsigned function = static_cast<unsigned>(get(0x60B8)) >> 8 * k, stored = (high ? 2u : 4u) << 8 * k;
    if ((function & 1u) == 0 || (function & (high ? 0x10u : 0x20u)) == 0) return;
    if ((probe_status_ & stored) && (function & 2u) == 0) return;
    put(static_cast<std::uint16_t>(0x60BA + 2 * k + (high ? 0 : 1)), std::llround(in_units(m_.shaft(now).position)));
    probe_status_ = static_cast<std::uint16_t>(probe_status_ | stored);
}
/// The probe whose byte was changed waits for its edges anew; 60B8h written as it was begins nothing.
void Servo::arm_probes() {
    const auto function = static_cast<unsigned>(get(0x60B8)), before = std::exchange(probe_function_, function);
    for (unsigned k = 0; k < 2; ++k)
        if (((function ^ before) >> 8 * k & 0xFFu) != 0)
            probe_status_ = static_cast<std::uint16_t>((probe_status_ & ~(0xFFu << 8 * k)) | (function & 1u << 8 * k));
}

void Servo::hold(bool held, Instant now) {
    checked_ = now;
    m_.hold(held, now);
    behind_since_.reset();
}
void Servo::place(double position, Instant now) {
    if (!powered()) m_.rest_at(position + zero_, now);
}

void Servo::fail(std::uint16_t code, Instant now) {
    put(0x603F, code);
    put(0x1001, register_of(code));
    for (std::uint8_t i = 4; i > 1; --i)
        (void)d_.set({0x1003, i}, Value{get(0x1003, static_cast<std::uint8_t>(i - 1))});
    (void)d_.set({0x1003, 1}, Value{std::int64_t{code}});
    (void)d_.set_bytes({0x1003, 0}, std::vector<std::uint8_t>{0});
    told_.push_back({now, {code, register_of(code), {}}});
    if (state_ == State::fault) return;
    target_.reset();
    buffered_.reset();
    if (m_.held()) m_.rest_at(m_.shaft(now).position, now);  // held: there is nothing to brake
    if (!powered() || !m_.moves(now)) return enter(State::fault, now);
    const auto option = get(0x605E);
    enter(State::fault_reaction, now);
    stop_then(State::fault, braking(option), option == 0, now);
}

void Servo::connection_lost(Instant now) {
    const auto option = d_.integer({0x6007, 0}).value_or(0);  // of the node, whichever of its axes this is
    if (option == 1) fail(0x8130, now);
    if (option == 2) command(0, now);
    if (option == 3) command(0x0A, now);
}

Instant Servo::next_event(Instant now) const {
    Instant next = never;
    if (after_stop_ || homing_ == Homing::to_switch || homing_ == Homing::to_zero) next = std::max(m_.end(), now);
    // A halted positioning waits for its halt to be taken back, and for nothing of its own.
    if (target_ && !reached_ && !halted_ && settles()) next = std::max(m_.end() + (buffered_ ? Duration{} : window_time()), now);
    if (powered() && m_.held() && (m_.moves(checked_) || behind_since_)) next = std::min(next, checked_ + std::chrono::milliseconds(1));
    return next;
}

void Servo::on_event(Instant at) {
    if (powered() && m_.held() && checked_ + std::chrono::milliseconds(1) <= at) {
        checked_ = at;
        const double behind = std::fabs(m_.demand(at).position - m_.shaft(at).position);
        const auto window = get(0x6065);
        if (window == 0xFFFFFFFF || behind <= per_unit_ * static_cast<double>(window)) {
            behind_since_.reset();
        } else if (!behind_since_) {
            behind_since_ = at;
        }
        if (behind_since_ && at - *behind_since_ >= std::chrono::milliseconds(get(0x6066))) {
            behind_since_.reset();
            fail(0x8611, at);
        }
    }
    if (at < m_.end()) return;
    if (after_stop_) return enter(*after_stop_, at);
    if (homing_ == Homing::to_switch) return next_search(at);
    if (homing_ == Homing::to_zero) return homed();
    if (halted_) return;
    if (target_ && !reached_ && settles() && m_.demand(at).position == *target_) {
        if (buffered_) {
            target_ = std::exchange(buffered_, std::nullopt);
            acknowledged_ = (cw_ & 0x10u) != 0;
            return go(at);
        }
        reached_ = at >= m_.end() + window_time();
    } else if (target_ && !reached_ && !m_.held()) {
        target_.reset();  // stopped before it: halted, or the speed is 0
    }
}

void Servo::begin_homing(Instant now) {
    HomingWay way = homing_way(static_cast<int>(get(0x6098)), m_.demand(now).position, travel_);
    reached_ = false;
    homing_ = Homing::error;
    if (!way.possible) return;
    homing_zero_ = way.zero;
    if (!way.moves) return homed();
    if (m_.held()) return;
    search_ = std::move(way.search);
    homing_ = Homing::to_switch;
    next_search(now);
}
/// To the next switch; after the last one, slowly, to the zero.
void Servo::next_search(Instant now) {
    const double a = per_unit_ * rate(0x609A);
    if (search_.empty()) {
        homing_ = Homing::to_zero;
        return m_.move(homing_zero_, {speed(0x6099, 2), a, a}, now);
    }
    m_.move(search_.front(), {speed(0x6099, 1), a, a}, now);
    search_.erase(search_.begin());
}
void Servo::homed() {
    homing_ = Homing::attained;
    reached_ = true;
    zero_ = homing_zero_ - per_unit_ * static_cast<double>(get(0x607C));
}

/// At the end of its way the shaft stands within the position window (6067h; FFFFFFFFh: there is none).
bool Servo::settles() const {
    const auto window = get(0x6067);
    if (!m_.held() || window == 0xFFFFFFFF) return true;
    return std::fabs(m_.shaft(m_.end()).position - m_.demand(m_.end()).position) <= per_unit_ * static_cast<double>(window);
}

std::uint16_t Servo::statusword(Instant now) const {
    static constexpr unsigned states[] = {0x40, 0x21, 0x23, 0x27, 0x07, 0x0F, 0x08};
    unsigned sw = states[static_cast<std::size_t>(state_)] | 0x210u;
    const bool stands = !m_.moves(now);
    bool ten = reached_ && (!m_.held() || settles());
    if (mode_ == 3)
        ten = std::fabs(m_.shaft(now).velocity / per_speed_ - static_cast<double>(get(0x60FF))) <= static_cast<double>(get(0x606D));
    if (halted_ || state_ == State::quick_stop) ten = stands;
    if (ten && powered()) sw |= 0x400u;
    if (limited_) sw |= 0x800u;
    if (mode_ == 1 && acknowledged_) sw |= 0x1000u;
    if (mode_ == 3 && stands) sw |= 0x1000u;
    if (mode_ == 6) sw |= homing_ == Homing::attained ? 0x1000u : homing_ == Homing::error ? 0x2000u : 0u;
    if (mode_ >= 7 && state_ == State::enabled && !halted_) sw |= 0x1000u;
    return static_cast<std::uint16_t>(sw);
}

void Servo::refresh(Instant now) {
    const Motion shaft = m_.shaft(now), demand = m_.demand(now);
    put(0x6041, statusword(now));
    put(0x6061, mode_);
    put(0x6062, std::llround(in_units(demand.position)));
    put(0x6063, std::llround(shaft.position));
    put(0x6064, std::llround(in_units(shaft.position)));
    put(0x606B, std::llround(demand.velocity / per_speed_));
    put(0x606C, std::llround(shaft.velocity / per_speed_));
    put(0x6077, (mode_ == 4 || mode_ == 10) && powered() ? get(0x6071) : 0);
    put(0x60F4, std::llround((demand.position - shaft.position) / per_unit_));
    put(0x60B9, probe_status_);
    // A switch is pressed by the hand, or by the shaft where the travel has switches.
    const bool low = limit_negative || (travel_ > 0 && shaft.position < -travel_),
               high = limit_positive || (travel_ > 0 && shaft.position > travel_);
    const bool home = home_switch || (travel_ > 0 && std::fabs(shaft.position) < cam);
    put(0x60FD, static_cast<std::int64_t>((low ? 1u : 0u) | (high ? 2u : 0u) | (home ? 4u : 0u) | (inputs & 0xFFFF0000u)));
}
TwinMechanics Servo::mechanics(Instant now) const {
    const Motion s = m_.shaft(now);
    return {s.position, s.velocity, powered()};
}

}  // namespace axisgate::cia402_drive::twin
