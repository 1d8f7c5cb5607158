// A new order continues from the state that the previous one has reached, without a jump.
#include "adapters/example/twin/axis.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::example::twin {

Axis::Axis(const FreedomValues& f, std::uint64_t seed)
    : shaft_(shaft_freedoms(f), seed),
      state_late_(std::chrono::milliseconds(freedom(f, "state_late_ms"))),
      power_delay_(std::chrono::milliseconds(freedom(f, "power_delay_ms"))),
      start_(static_cast<double>(freedom(f, "start_position_increments"))),
      all_registers_(freedom(f, "optional_registers", 1) != 0),
      retargets_(freedom(f, "new_target_in_motion", 1) != 0),
      settings_at_rest_(freedom(f, "settings_at_rest") != 0),
      zero_(-start_) {}

Axis::State Axis::planned(Instant now) const {
    const double t = seconds(now - since_);
    const Piece* p = &pieces_.front();
    for (const Piece& x : pieces_)
        if (x.begin <= t) p = &x;
    const double d = std::max(0.0, t - p->begin);
    return {p->position + d * (p->velocity + d * p->acceleration / 2), p->velocity + d * p->acceleration};
}
void Axis::begin(Instant now) {
    at_ = planned(now);
    since_ = checked_ = now;
    end_ = 0;
    pieces_.clear();
}
void Axis::add(double s, double a) {
    pieces_.push_back({end_, at_.position, at_.velocity, a});
    at_ = {at_.position + s * (at_.velocity + s * a / 2), at_.velocity + s * a};
    end_ += s;
}
void Axis::rest() { pieces_.push_back({end_, at_.position, 0, 0}); }

void Axis::move(double target, Instant now) {
    begin(now);
    const double a = rate(1), b = rate(2);
    double way = target - at_.position;
    if (at_.velocity != 0 && (way - at_.velocity * std::fabs(at_.velocity) / (2 * b)) * at_.velocity < 0) {  // it cannot stop in time
        add(std::fabs(at_.velocity) / b, -std::copysign(b, at_.velocity));
        at_.velocity = 0;
        way = target - at_.position;
    }
    const double side = std::copysign(1.0, way), v = std::fabs(at_.velocity);
    const double peak = std::min(rate(0), std::sqrt((2 * a * b * std::fabs(way) + b * v * v) / (a + b)));
    if (peak > 0) {
        add(std::fabs(peak - v) / (peak > v ? a : b), side * (peak > v ? a : -b));
        at_.velocity = side * peak;
        add(std::max(0.0, (side * (target - at_.position) - peak * peak / (2 * b)) / peak), 0);
        add(peak / b, -side * b);
    }
    at_.position = target;
    rest();
}
void Axis::run(double velocity, double deceleration, Instant now) {
    begin(now);
    const double change = velocity - at_.velocity, r = std::fabs(velocity) > std::fabs(at_.velocity) ? rate(1) : deceleration;
    if (change != 0) add(std::fabs(change) / r, std::copysign(r, change));
    at_.velocity = velocity;
    pieces_.push_back({end_, at_.position, velocity, 0});
}
bool Axis::moves(Instant now) const { return seconds(now - since_) < end_ || pieces_.back().velocity != 0; }

/// Without and with the specimen's mechanics; in increments of the shaft, whose zero is that of its first power-on.
double Axis::place(Instant now) const { return held_ ? held_at_ : shaft_.differs() ? shaft_.load() : planned(now).position; }
double Axis::shown_place(Instant now) const { return held_ || !shaft_.differs() ? place(now) : shaft_.shown(); }

/// The drive checks each millisecond whether the shaft follows its demand.
void Axis::advance(Instant now) {
    if (shaft_.differs()) return advance_shaft(now);
    while (held_ && fault_ == 0 && on_ && checked_ < now && moves(checked_)) {
        checked_ = std::min(now, checked_ + std::chrono::milliseconds(1));
        if (std::fabs(planned(checked_).position - held_at_) > rate(6)) fail(3, checked_);
    }
}
void Axis::advance_shaft(Instant now) {
    if (now - checked_ > Shaft::longest_gap) checked_ = now - Shaft::longest_gap;
    while (on_) {
        const Instant next = time_zero + ((checked_ - time_zero) / Shaft::step + 1) * Shaft::step;
        if (next > now) return;
        checked_ = next;
        if (held_)
            shaft_.set(held_at_, next);
        else
            shaft_.advance(next, [&](Instant t) { return planned(t).position; });
        if (std::fabs(held_ ? planned(next).position - held_at_ : shaft_.following_error()) > rate(6)) fail(3, next);
    }
    if (was_on_ && !held_) shaft_.advance_without_power(now);
    checked_ = std::max(checked_, now);
}
void Axis::hold(bool held, Instant now) {
    advance(now);
    note(now);
    if (!held_ || !shaft_.differs()) held_at_ = shaft_.differs() ? shaft_.position() : planned(now).position;
    checked_ = now;
    held_ = held;
}
void Axis::fail(int code, Instant now) {
    note(now);
    fault_ = code;
    if (code == 0) return;
    const double here = held_ ? held_at_ : shaft_.differs() ? shaft_.position() : planned(now).position;
    begin(now);
    at_ = {here, 0};
    rest();
    on_ = to_target_ = false;
}
void Axis::power_off(Instant now) {
    fail(99, now);
    zero_ = at_.position - start_;
    referenced_ = false;
    fault_ = 0;
}
TwinMechanics Axis::mechanics(Instant now) {
    advance(now);
    const double velocity = held_ ? 0 : shaft_.differs() ? shaft_.velocity() : planned(now).velocity;
    return {place(now), velocity, powered(now)};
}

int Axis::refusal(int n, std::int64_t v, Instant now) const {
    if (n >= 6 && n < 6 + static_cast<int>(settings)) {
        if (!has(n)) return 11;
        const bool speed = n <= 9;
        if (v < (speed ? 1 : 0) || v > (speed ? 10'000'000 : 100'000)) return 12;
        return settings_at_rest_ && moves(now) ? 13 : 0;
    }
    if (std::llabs(v) > 2'000'000'000) return 12;
    if ((n == 21 || n == 22 || (n == 20 && v == 1)) && fault_ != 0) return 14;
    if ((n == 21 || n == 22) && !powered(now)) return 14;
    if ((n == 25 || (!retargets_ && (n == 21 || n == 22))) && moves(now)) return 13;
    return n >= 20 && n <= 26 ? 0 : 11;
}
int Axis::write(int n, std::int64_t v, Instant now) {
    advance(now);
    if (const int refused = refusal(n, v, now); refused != 0) return refused;
    if (n < 20) {
        values[static_cast<std::size_t>(n) - 6] = v;
        return 0;
    }
    note(now);
    to_target_ = to_target_ && n != 22 && n != 23 && n != 20;
    if (n == 20 && v == 0) fail(99, now), fault_ = 0;
    if (n == 20 && v != 0 && !on_) {
        if (was_on_ && !held_ && shaft_.differs()) {  // it has drifted: where it is now is its demand
            begin(now);
            at_ = {shaft_.position(), 0};
            rest();
        }
        on_ = was_on_ = true;
        on_from_ = now + power_delay_;
    }
    if (n == 21) to_target_ = true, move(static_cast<double>(v) + zero_, now);
    if (n == 22) run(static_cast<double>(v), rate(2), now);
    if (n == 23 && moves(now)) run(0, rate(v == 0 ? 2 : 3), now);
    if (n == 24) fault_ = 0;
    if (n == 25) zero_ = (shaft_.differs() ? place(now) : planned(now).position) - static_cast<double>(v), referenced_ = true;
    return 0;
}
int Axis::read(int n, std::int64_t& v) const {
    if (n >= 1 && n <= 3) v = n == 1 ? 100 : n == 2 ? 7 : 48;  // model, firmware, supply in V
    if (n == 5) v = fault_;
    const bool setting = n >= 6 && n < 6 + static_cast<int>(settings) && has(n);
    if (setting) v = values[static_cast<std::size_t>(n) - 6];
    return (n >= 1 && n <= 3) || n == 5 || setting ? 0 : 11;
}

int Axis::bits(Instant now) const {
    const bool moving = moves(now);
    const bool near = !shaft_.differs() || std::fabs(place(now) - pieces_.back().position) <= rate(7);
    return (powered(now) ? 1 : 0) | (moving ? 2 : 0) | (to_target_ && !moving && !held_ && near ? 4 : 0) | (referenced_ ? 8 : 0);
}
/// A specimen refreshes them late: until then it shows the bits from before the last change.
int Axis::shown_bits(Instant now) const {
    const Instant then = now - state_late_;
    return then < changed_ && state_late_ != Duration::zero() ? bits_before_ : bits(then);
}
void Axis::note(Instant now) {
    bits_before_ = shown_bits(now);
    changed_ = now;
}
std::string Axis::state(Instant now) {
    const TwinMechanics m = mechanics(now);
    std::string s = std::to_string(shown_bits(now));
    for (const double v : {shown_place(now) - zero_, m.velocity, planned(now).position - zero_, static_cast<double>(fault_)})
        s += "," + std::to_string(std::llround(v));
    return s;
}

}  // namespace axisgate::example::twin
