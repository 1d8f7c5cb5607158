// A new order continues from the state that the previous one has reached, without a jump.
#include "adapters/example/twin/axis.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::example::twin {

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

/// The drive checks each millisecond whether the shaft follows its demand.
void Axis::advance(Instant now) {
    while (held_ && fault_ == 0 && on_ && checked_ < now && moves(checked_)) {
        checked_ = std::min(now, checked_ + std::chrono::milliseconds(1));
        if (std::fabs(planned(checked_).position - held_at_) > rate(6)) fail(3, checked_);
    }
}
void Axis::hold(bool held, Instant now) {
    advance(now);
    held_at_ = planned(now).position;
    checked_ = now;
    held_ = held;
}
void Axis::fail(int code, Instant now) {
    fault_ = code;
    if (code == 0) return;
    const double here = held_ ? held_at_ : planned(now).position;
    begin(now);
    at_ = {here, 0};
    rest();
    on_ = to_target_ = false;
}
void Axis::power_off(Instant now) {
    fail(99, now);
    zero_ = at_.position;
    referenced_ = false;
    fault_ = 0;
}
TwinMechanics Axis::mechanics(Instant now) {
    advance(now);
    const State s = planned(now);
    return {held_ ? held_at_ : s.position, held_ ? 0 : s.velocity, on_};
}

int Axis::write(int n, std::int64_t v, Instant now) {
    advance(now);
    if (n >= 6 && n < 6 + static_cast<int>(settings)) {
        const bool speed = n <= 9;
        if (v < (speed ? 1 : 0) || v > (speed ? 10'000'000 : 100'000)) return 12;
        values[static_cast<std::size_t>(n) - 6] = v;
        return 0;
    }
    if (std::llabs(v) > 2'000'000'000) return 12;
    if ((n == 21 || n == 22 || (n == 20 && v == 1)) && fault_ != 0) return 14;
    if ((n == 21 || n == 22) && !on_) return 14;
    if (n == 25 && moves(now)) return 13;
    to_target_ = to_target_ && n != 22 && n != 23 && n != 20;
    if (n == 20 && v == 0) fail(99, now), fault_ = 0;
    if (n == 20 && v != 0) on_ = true;
    if (n == 21) to_target_ = true, move(static_cast<double>(v) + zero_, now);
    if (n == 22) run(static_cast<double>(v), rate(2), now);
    if (n == 23 && moves(now)) run(0, rate(v == 0 ? 2 : 3), now);
    if (n == 24) fault_ = 0;
    if (n == 25) zero_ = planned(now).position - static_cast<double>(v), referenced_ = true;
    return n >= 20 && n <= 26 ? 0 : 11;
}
int Axis::read(int n, std::int64_t& v) const {
    if (n >= 1 && n <= 3) v = n == 1 ? 100 : n == 2 ? 7 : 48;  // model, firmware, supply in V
    if (n == 5) v = fault_;
    if (n >= 6 && n < 6 + static_cast<int>(settings)) v = values[static_cast<std::size_t>(n) - 6];
    return (n >= 1 && n <= 3) || (n >= 5 && n < 6 + static_cast<int>(settings)) ? 0 : 11;
}
std::string Axis::state(Instant now) {
    const TwinMechanics m = mechanics(now);
    const bool moving = moves(now);
    const int bits = (on_ ? 1 : 0) | (moving ? 2 : 0) | (to_target_ && !moving && !held_ ? 4 : 0) | (referenced_ ? 8 : 0);
    std::string s = std::to_string(bits);
    for (const double v : {m.position - zero_, m.velocity, planned(now).position - zero_, static_cast<double>(fault_)})
        s += "," + std::to_string(std::llround(v));
    return s;
}

}  // namespace axisgate::example::twin
