#include "adapters/cia402/twin/servo.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/cia402/twin/objects.hpp"

namespace axisgate::cia402_drive::twin {
namespace {
constexpr int looks_seldom = 8;                 ///< periods between two checks of a following error that is far below its limit
constexpr Ramps coasting{0, 100'000, 100'000};  ///< deceleration of a shaft without power
/// The bit of the error register (1001h) for the class of the code.
std::uint8_t register_of(std::uint16_t code) {
    const unsigned c = code >> 12;
    return static_cast<std::uint8_t>(1u | (c == 2 ? 2u : c == 3 ? 4u : c == 4 ? 8u : c == 8 ? 0x10u : c == 0xF ? 0x80u : 0x20u));
}
}  // namespace

const std::vector<std::uint16_t>& error_codes() {
    static const std::vector<std::uint16_t> codes{0x1000, 0x2310, 0x2320, 0x2330, 0x3110, 0x3120, 0x3210, 0x3220, 0x4210,
                                                  0x4310, 0x5113, 0x5441, 0x5530, 0x6010, 0x6320, 0x7121, 0x7122, 0x7305,
                                                  0x8110, 0x8130, 0x8250, 0x8400, 0x8500, 0x8611, 0x8612, 0x8700};
    return codes;
}

void Servo::power_on(Instant now) {
    const double here = m_.shaft(now).position;
    m_.rest_at(here, now);
    units_.set_zero(here);
    units_.read();
    state_ = State::switch_on_disabled;
    after_stop_.reset();
    cw_ = 0;
    orders_.reset(static_cast<int>(o_.get(0x6060)));
    homing_.forget();
    behind_ = 0;
    probes_.reset();
    o_.clear_error();
    if (cause_ != 0) fail(cause_, now);
}
void Servo::power_off(Instant now) {
    if (powered()) m_.set_power(false, now);
    m_.rest_at(m_.shaft(now).position, now);
    state_ = State::switch_on_disabled;
    after_stop_.reset();
    orders_.forget();
}

bool Servo::keeps(canopen::Address address, const canopen::Entry& entry) const { return is_stored(address, entry); }
canopen::Abort Servo::may_write(canopen::Address a, std::int64_t v, Instant now) const {
    a.index = static_cast<std::uint16_t>(a.index - o_.shift());
    if (a.index == 0x6060) {
        const auto modes = static_cast<std::uint32_t>(o_.get(0x6502));
        return v == 0 || (v >= 1 && v <= 10 && (modes >> (v - 1) & 1u)) ? canopen::Abort::none : canopen::Abort::value;
    }
    if (a.index == 0x6098) {
        for (std::uint8_t i = 1; i <= o_.get(0x60E3); ++i)
            if (o_.get(0x60E3, i) == v) return canopen::Abort::none;
        return canopen::Abort::value;
    }
    if (a.index == 0x6086 && v != 0 && v != 1 && v != 3) return canopen::Abort::value;
    if (a.index == 0x60A3 && v != 1 && v != 2 && v != 4) return canopen::Abort::value;
    if (a.index == 0x607E && (v & 0x3F) != 0) return canopen::Abort::value;
    // A change of the unit of positions and speeds during a motion would be a jump.
    const bool unit = a.index == 0x607E || a.index == 0x608F || a.index == 0x6091 || a.index == 0x6092 || a.index == 0x6096;
    if (unit && powered()) return canopen::Abort::device_state;
    if (a.index == 0x60C2 && m_.moves(now) && powered()) return canopen::Abort::device_state;
    return canopen::Abort::none;
}

void Servo::written(canopen::Address a, Instant now) {
    switch (a.index - o_.shift()) {
        case 0x6040:
            return control(now);
        case 0x6060:
            return set_mode(now);
        case 0x60FF:
        case 0x6071:
            if (state_ == State::enabled && !after_stop_) orders_.act(now);
            return;
        case 0x60B8:
            return probes_.arm();
        case 0x607E:
        case 0x608F:
        case 0x6091:
        case 0x6092:
        case 0x6096:
            return units_.read();
        default:
            return;
    }
}
void Servo::on_sync(Instant now) {
    if (state_ == State::enabled && !after_stop_) orders_.sync(cw_, now);
}

void Servo::control(Instant now) {
    const unsigned cw = static_cast<unsigned>(o_.get(0x6040)), rising = cw & ~cw_, before = std::exchange(cw_, cw);
    if (state_ == State::fault) {
        if ((rising & 0x80u) && cause_ == 0) {
            o_.clear_error();
            reported_.push_back({now, {}});
            enter(State::switch_on_disabled, now);
        }
        return;
    }
    if (state_ == State::fault_reaction) return;
    command(cw, now);
    if (state_ != State::enabled || after_stop_) return;
    if ((cw & 0x10u) == 0) orders_.released();
    if (orders_.mode() == 1 && (rising & 0x10u) && !orders_.acknowledged()) orders_.set_point(cw & 0x40u, (cw & 0x20u) != 0, now);
    if (orders_.mode() == 6 && (rising & 0x10u)) begin_homing(now);
    if (orders_.mode() == 6 && (before & 0x10u) && !(cw & 0x10u) && homing_.active()) {
        homing_.forget();  // resetting the start bit interrupts homing
        const double down = units_.rate_of(0x609A);
        m_.stop({0, down, down}, now);
    }
    if (((cw ^ before) & 0x100u) || ((cw & 0x100u) == 0 && orders_.halted())) {
        orders_.halt((cw & 0x100u) != 0, now);
        if (orders_.halted()) homing_.interrupt();
    }
}

void Servo::command(unsigned cw, Instant now) {
    if ((cw & 2u) == 0) {  // disable voltage: at once
        if (powered()) m_.stop(coasting, now);
        return enter(State::switch_on_disabled, now);
    }
    if (!safe_voltage) return;
    if ((cw & 4u) == 0) {  // quick stop
        if (state_ == State::ready || state_ == State::switched_on) return enter(State::switch_on_disabled, now);
        if (state_ != State::enabled) return;
        enter(State::quick_stop, now);
        const auto option = o_.get(0x605A);
        return stop_then(option >= 5 ? State::quick_stop : State::switch_on_disabled, units_.braking(option), option == 0, now);
    }
    const unsigned bits = cw & 0xFu;
    if (bits == 0xF && state_ == State::quick_stop && o_.get(0x605A) >= 5 && !m_.moves(now)) return enter(State::enabled, now);
    if (state_ == State::quick_stop) return;
    if (bits == 0xF && (state_ == State::ready || state_ == State::switched_on)) return enter(State::enabled, now);
    if (bits == 0xF && state_ == State::enabled) return after_stop_.reset();
    if (bits == 7) {
        if (state_ == State::ready) enter(State::switched_on, now);
        if (state_ == State::enabled) stop_then(State::switched_on, units_.braking(1), o_.get(0x605C) == 0, now);
    }
    if ((cw & 7u) == 6) {
        if (state_ == State::switch_on_disabled || state_ == State::switched_on) enter(State::ready, now);
        if (state_ == State::enabled) stop_then(State::ready, units_.braking(1), o_.get(0x605B) == 0, now);
    }
}

void Servo::stop_then(State state, const Ramps& ramps, bool at_once, Instant now) {
    orders_.forget();
    orders_.set_reached(false);
    homing_.interrupt();
    if (at_once || (!m_.moves(now))) {
        if (m_.moves(now)) m_.stop(coasting, now);
        return enter(state, now);
    }
    m_.stop(ramps, now);
    after_stop_ = state;
}

void Servo::enter(State state, Instant now) {
    const bool was = powered();
    after_stop_.reset();
    if (state == State::enabled) {
        if (!was) {
            m_.rest_at(m_.shaft(now).position, now);
            m_.set_power(true, now);
        }
        orders_.enabled(cw_);
        behind_ = 0;
        checked_ = now;
    }
    state_ = state;
    if (!powered()) {
        if (was) m_.set_power(false, now);
        orders_.taken_off();
        behind_ = 0;
        homing_.interrupt();
    }
    if (state == State::enabled) orders_.act(now);
}

void Servo::set_mode(Instant now) {
    if (!orders_.set_mode(static_cast<int>(o_.get(0x6060)))) return;
    homing_.forget();
    if (state_ != State::enabled || after_stop_) return;
    // A motion of the previous mode ends with the new mode.
    const int mode = orders_.mode();
    if (mode != 3 && mode != 9 && mode != 4 && mode != 10 && m_.moves(now)) m_.stop(units_.braking(1), now);
    orders_.act(now);
}

void Servo::inputs_changed(Instant now) {
    const bool in_fault = state_ == State::fault || state_ == State::fault_reaction;
    if (!safe_voltage && !in_fault && state_ != State::switch_on_disabled) {
        if (powered()) {
            orders_.forget();
            m_.stop(coasting, now);
        }
        enter(State::switch_on_disabled, now);
    }
    for (unsigned k = 0; k < 2; ++k)
        probes_.level(k, (inputs >> (16 + k) & 1u) != 0, units_.in_units(m_.shaft(now).position));
    if (!m_.moves(now) || !powered()) return;
    const double v = m_.demand(now).velocity;
    if (homing_.to_switch() || !((limit_positive && v > 0) || (limit_negative && v < 0))) return;
    orders_.limit_switch();
    m_.stop(units_.braking(2), now);
}

void Servo::hold(bool held, Instant now) {
    checked_ = now;
    m_.hold(held, now);
    behind_ = 0;
}

void Servo::fail(std::uint16_t code, Instant now) {
    o_.note_error(code, register_of(code));
    reported_.push_back({now, {code, register_of(code), {}}});
    if (state_ == State::fault) return;
    orders_.forget();
    if (m_.held()) m_.rest_at(m_.shaft(now).position, now);  // blocked: there is nothing to decelerate
    if (!powered() || !m_.moves(now)) return enter(State::fault, now);
    const auto option = o_.get(0x605E);
    enter(State::fault_reaction, now);
    stop_then(State::fault, units_.braking(option), option == 0, now);
}

void Servo::connection_lost(Instant now) {
    const auto option = o_.of_node(0x6007);
    if (option == 1) fail(0x8130, now);
    if (option == 2) command(0, now);
    if (option == 3) command(0x0A, now);
}

/// A torque has no position that the shaft could be behind, and a drive that brakes because of a fault has reported one.
bool Servo::follows_demand() const noexcept {
    return !m_.differs() || m_.held() || (orders_.mode() != 4 && orders_.mode() != 10 && state_ != State::fault_reaction);
}
/// Following errors are checked only if they are possible: the shaft is blocked, its encoder reports a wrong position, or it is behind its
/// demand. Switches with hysteresis are looked at while the shaft moves.
bool Servo::watches() const {
    if (!powered()) return false;
    if (switches_.hysteresis > 0 && travel_ > 0 && m_.moves(checked_)) return true;
    if (m_.differs() && !m_.held()) return follows_demand() && (m_.moves(checked_) || behind_ > 0);
    if (m_.misreads()) return true;
    if (m_.held()) return m_.moves(checked_) || behind_ > 0;
    return m_.lags() && (m_.moves(checked_) || behind_ > 0);
}
Instant Servo::next_event(Instant now) const {
    Instant next = never;
    if (after_stop_ || homing_.to_switch() || homing_.to_zero()) next = std::max(m_.end(), now);
    if (const auto arrival = orders_.arrival()) next = std::max(*arrival, now);
    if (watches()) next = std::min(next, checked_ + look_after_);
    return next;
}

void Servo::watch(Instant at) {
    checked_ = at;
    look_after_ = watch_every_;
    switches_.look(m_.shaft(at).position, travel_);
    if (orders_.reads()) return;  // no check between two readings of a target window
    if (!follows_demand()) return;
    const double behind = std::fabs(m_.demand(at).position - m_.read(at));
    const auto window = o_.get(0x6065);
    const double most = window == 0xFFFFFFFF ? HUGE_VAL : units_.way_of(0x6065);
    behind_ = behind <= most ? 0 : behind_ + 1;
    // A shaft with freedoms is behind in each motion: as long as it is far from the limit it is looked at less often.
    const bool shows_switches = switches_.hysteresis > 0 && travel_ > 0;
    if (m_.differs() && !m_.held() && !shows_switches && behind <= most / 2)
        look_after_ = (behind <= most / looks_seldom ? looks_seldom : 2) * watch_every_;
    if (behind_ <= std::chrono::milliseconds(o_.get(0x6066)) / watch_every_) return;
    behind_ = 0;
    fail(0x8611, at);
}
void Servo::on_event(Instant at) {
    if (watches() && checked_ + look_after_ <= at) watch(at);
    if (at < m_.end()) return;
    if (after_stop_) return enter(*after_stop_, at);
    if (homing_.to_switch()) return next_search(at);
    if (homing_.to_zero()) return homing_ended(homing_.way().zero + units_.zero() - units_.place_of(0x607C));
    orders_.arrive(cw_, at);
}

void Servo::begin_homing(Instant now) {
    const auto method = o_.get(0x6098);
    orders_.set_reached(false);
    if (method < 0) return homing_.lead();
    homing_.take(homing_way(static_cast<int>(method), m_.demand(now).position, travel_, switches_.hysteresis));
    if (homing_.failed()) return;
    if (!homing_.way().moves) return homing_ended(homing_.way().zero + units_.zero() - units_.place_of(0x607C));
    if (m_.held()) return homing_.end(false);
    next_search(now);
}
/// To the next switch; after the last one slowly to the zero.
void Servo::next_search(Instant now) {
    const double a = units_.rate_of(0x609A);
    const auto place = homing_.next();
    m_.move(place.value_or(homing_.way().zero), {units_.speed_of(0x6099, place ? 1 : 2), a, a}, now);
}
void Servo::homing_ended(std::optional<double> zero) {
    homing_.end(zero.has_value());
    if (!zero) return;
    orders_.set_reached(true);
    units_.set_zero(*zero);
}

bool Servo::stands(Instant now) const {
    if (m_.moves(now)) return false;
    return !m_.differs() || std::fabs(units_.speed_in_units(m_.shaft(now).velocity)) <= static_cast<double>(o_.get(0x606F));
}

std::uint16_t Servo::statusword(Instant now) const {
    static constexpr unsigned states[] = {0x40, 0x21, 0x23, 0x27, 0x07, 0x0F, 0x08};
    const int mode = orders_.mode();
    unsigned sw = states[static_cast<std::size_t>(state_)] | 0x200u | (safe_voltage ? 0x10u : 0u);
    const bool rests = stands(now);
    bool ten = orders_.reached();
    if (mode == 3)
        ten = std::fabs(units_.speed_in_units(m_.shaft(now).velocity) - static_cast<double>(o_.get(0x60FF))) <=
              static_cast<double>(o_.get(0x606D));
    if (orders_.halted() || state_ == State::quick_stop) ten = rests;
    if (ten && powered()) sw |= 0x400u;
    if (orders_.limited()) sw |= 0x800u;
    if (mode == 1 && orders_.acknowledged()) sw |= 0x1000u;
    if (mode == 3 && rests) sw |= 0x1000u;
    if (mode == 6) sw |= homing_.attained() ? 0x1000u : homing_.failed() ? 0x2000u : 0u;
    if (mode >= 7 && state_ == State::enabled && !orders_.halted()) sw |= 0x1000u;
    return static_cast<std::uint16_t>(sw);
}

void Servo::refresh(Instant now) {
    const Motion shaft = m_.shaft(now), demand = m_.demand(now);
    const int mode = orders_.mode();
    o_.put(0x6041, statusword(now));
    o_.put(0x6061, mode);
    o_.put(0x6062, std::llround(units_.in_units(demand.position)));
    const double read = m_.read(now);
    o_.put(0x6063, std::llround(read));
    o_.put(0x6064, std::llround(units_.in_units(read)));
    o_.put(0x606B, std::llround(units_.speed_in_units(demand.velocity)));
    o_.put(0x606C, std::llround(units_.speed_in_units(shaft.velocity)));
    const auto torque = (mode == 4 || mode == 10) && powered() ? std::llround(orders_.torque(now)) : 0;
    o_.put(0x6074, torque);
    o_.put(0x6077, torque);
    o_.put(0x60F4, std::llround(units_.way_in_units(demand.position - read)));
    o_.put(0x60B9, probes_.status());
    // A switch is operated by the simulated hand, or by the shaft if the travel has switches.
    switches_.look(shaft.position, travel_);
    const bool low = limit_negative || switches_.low(), high = limit_positive || switches_.high(), home = home_switch || switches_.home();
    o_.put(0x60FD, static_cast<std::int64_t>((low ? 1u : 0u) | (high ? 2u : 0u) | (home ? 4u : 0u) | (inputs & 0xFFFF0000u)));
}
TwinMechanics Servo::mechanics(Instant now) const {
    const Motion s = m_.shaft(now);
    return {s.position, s.velocity, powered()};
}

}  // namespace axisgate::cia402_drive::twin
