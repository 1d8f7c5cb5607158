// Profile: planning (which pieces, how long) and evaluation (which piece, where in it).
// In: kinematics. Out: pieces.
// Never iterates over time: only crossings are searched, by halving one monotone piece.
#include "adapters/mcode/twin/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace axisgate::mcode::twin {
namespace {

constexpr double forever = std::numeric_limits<double>::infinity();
/// Beyond this no instant is computed: 200 years would leave the 64-bit nanoseconds.
constexpr double far_future = 6e9;

double sign_of(double v) noexcept { return v < 0 ? -1.0 : 1.0; }

Instant later(Instant start, double s) noexcept {
    if (!(s < far_future)) return never;
    return start + Duration{static_cast<std::int64_t>(std::ceil(s * 1e9))};
}

}  // namespace

RampTable::RampTable(int type, int half_flat) noexcept {
    const int rise = points / 2 - half_flat;  // points from an end to the flat part
    const double unit = 2.0 / (points * (1 + 2.0 * half_flat / points));
    for (int i = 0; i < points; ++i) {
        const double from_end = std::min(i, points - 1 - i) + 0.5;
        const double part = std::min(from_end / rise, 1.0);
        const double level = type == 3 ? (1 - std::cos(std::numbers::pi * part)) / 2 : part;
        const auto k = static_cast<std::size_t>(i);
        speed_[k + 1] = speed_[k] + level * unit;
        travel_[k + 1] = travel_[k] + (speed_[k] + speed_[k + 1]) / (2.0 * points);
    }
    // The sums are 1 and 1/2; what rounding left of that is taken out.
    const double whole = speed_[points];
    for (auto& v : speed_)
        v /= whole;
    for (auto& v : travel_)
        v /= whole;
}

double RampTable::speed(double u) const noexcept {
    const double x = std::clamp(u, 0.0, 1.0) * points;
    const auto k = std::min<std::size_t>(static_cast<std::size_t>(x), points - 1);
    return speed_[k] + (speed_[k + 1] - speed_[k]) * (x - static_cast<double>(k));
}

double RampTable::travel(double u) const noexcept {
    const double x = std::clamp(u, 0.0, 1.0) * points;
    const auto k = std::min<std::size_t>(static_cast<std::size_t>(x), points - 1);
    const double r = x - static_cast<double>(k);
    return travel_[k] + (speed_[k] * r + (speed_[k + 1] - speed_[k]) * r * r / 2) / points;
}

Profile Profile::rest(double position) noexcept {
    Profile p;
    p.end_position_ = position;
    return p;
}

void Profile::begin(Instant now, Travel from, const Kinematics& k) {
    start_ = now;
    last_ = from;
    if (k.up.type != 1) up_ = std::make_shared<const RampTable>(k.up.type, k.up.half_flat);
    if (k.down.type != 1) down_ = std::make_shared<const RampTable>(k.down.type, k.down.half_flat);
}

void Profile::ramp_to(double speed, bool up, const Kinematics& k) noexcept {
    const double change = speed - last_.velocity;
    if (change == 0 || count_ == capacity) return;
    const double duration = std::abs(change) / (up ? k.up : k.down).mean();
    pieces_[count_++] = {length_, duration, last_.position, last_.velocity, change, up ? up_.get() : down_.get()};
    last_.position += (last_.velocity + speed) / 2 * duration;
    last_.velocity = speed;
    length_ += duration;
}

void Profile::cruise(double duration) noexcept {
    if (!(duration > 0) || count_ == capacity) return;
    pieces_[count_++] = {length_, duration, last_.position, last_.velocity, 0, nullptr};
    last_.position += last_.velocity * duration;
    length_ += duration;
}

/// Down to VI, and from there to 0 without a ramp.
void Profile::brake(const Kinematics& k) noexcept {
    const double v = last_.velocity;
    if (std::abs(v) > k.vi) ramp_to(sign_of(v) * k.vi, false, k);
    last_.velocity = 0;
}

void Profile::finish(double end_position) noexcept {
    end_position_ = end_position;
    end_ = later(start_, length_);
}

Profile Profile::move(Instant now, Travel from, double target, const Kinematics& k, bool go_on) {
    Profile p;
    p.begin(now, from, k);
    const double a = k.up.mean(), d = k.down.mean();
    const auto stopping = [&](double s) { return s > k.vi ? (s * s - k.vi * k.vi) / (2 * d) : 0.0; };
    if (from.velocity != 0) {
        const double ahead = (target - from.position) * sign_of(from.velocity);
        if (ahead <= 0 || (!go_on && stopping(std::abs(from.velocity)) > ahead)) p.brake(k);
    }
    const double distance = target - p.last_.position;
    if (std::abs(distance) < 1e-6) {
        p.finish(target);
        return p;
    }
    const double way = sign_of(distance), length = std::abs(distance);
    const double s = p.last_.velocity != 0 ? std::abs(p.last_.velocity) : std::min(k.vi, k.vm);
    p.last_.velocity = way * s;
    if (go_on) {
        p.ramp_to(way * k.vm, s < k.vm, k);
        p.cruise(forever);
        p.end_ = never;
        p.end_position_ = target;
        return p;
    }
    const double last = std::min(k.vi, s);
    if (s > k.vm) {
        const double used = (s * s - k.vm * k.vm) / (2 * d) + (k.vm * k.vm - last * last) / (2 * d);
        p.ramp_to(way * k.vm, false, k);
        p.cruise(std::max(0.0, length - used) / k.vm);
    } else {
        const double peak = std::clamp(std::sqrt((2 * length * a * d + s * s * d + last * last * a) / (a + d)), s, k.vm);
        const double used = (peak * peak - s * s) / (2 * a) + (peak * peak - last * last) / (2 * d);
        p.ramp_to(way * peak, true, k);
        p.cruise(std::max(0.0, length - used) / peak);
    }
    p.ramp_to(way * last, false, k);
    p.last_.velocity = 0;
    p.finish(target);
    return p;
}

Profile Profile::slew(Instant now, Travel from, double velocity, const Kinematics& k) {
    Profile p;
    p.begin(now, from, k);
    if (p.last_.velocity != 0 && (velocity == 0 || sign_of(velocity) != sign_of(from.velocity))) p.brake(k);
    if (velocity == 0) {
        p.finish(std::round(p.last_.position));
        return p;
    }
    const double speed = std::abs(velocity), way = sign_of(velocity);
    if (p.last_.velocity == 0) p.last_.velocity = way * std::min(k.vi, speed);
    p.ramp_to(velocity, std::abs(p.last_.velocity) < speed, k);
    p.cruise(forever);
    p.end_ = never;
    p.end_position_ = 0;
    return p;
}

Profile Profile::creep(Instant now, double from, double target, double speed) noexcept {
    Profile p;
    p.start_ = now;
    p.last_ = {from, target < from ? -speed : speed};
    p.cruise(std::abs(target - from) / speed);
    p.finish(target);
    return p;
}

Travel Profile::in_piece(const Piece& p, double t) noexcept {
    const double x = t - p.begin;
    if (p.change == 0) return {p.position + p.velocity * x, p.velocity};
    const double u = x / p.duration;
    if (p.table == nullptr) return {p.position + (p.velocity + p.change * u / 2) * x, p.velocity + p.change * u};
    return {p.position + p.velocity * x + p.change * p.duration * p.table->travel(u), p.velocity + p.change * p.table->speed(u)};
}

const Profile::Piece* Profile::piece_at(double t) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        if (t < pieces_[i].begin + pieces_[i].duration) return &pieces_[i];
    }
    return nullptr;
}

Travel Profile::at(Instant now) const noexcept {
    if (now >= end_) return {end_position_, 0};
    const double t = std::max(0.0, time_of(now));
    const Piece* p = piece_at(t);
    return p == nullptr ? Travel{end_position_, 0} : in_piece(*p, t);
}

int Profile::changing(Instant now) const noexcept {
    if (now >= end_) return 0;
    const Piece* p = piece_at(std::max(0.0, time_of(now)));
    if (p == nullptr || p->change == 0) return 0;
    return p->change * sign_of(p->velocity + p->change / 2) > 0 ? 1 : -1;
}

Instant Profile::crossing(Instant from, double x, int direction) const noexcept {
    if (from >= end_ || count_ == 0) return never;
    const double t0 = std::max(0.0, time_of(from));
    for (std::size_t i = 0; i < count_; ++i) {
        const Piece& p = pieces_[i];
        double low = std::max(t0, p.begin), high = p.begin + p.duration;
        if (low >= high) continue;
        const double way = sign_of(p.velocity + p.change / 2);
        if (direction != 0 && direction != static_cast<int>(way)) continue;
        const double begins = in_piece(p, low).position;
        if ((x - begins) * way <= 0) continue;
        if (p.duration == forever) return later(start_, low + (x - begins) / p.velocity);
        if ((x - in_piece(p, high).position) * way > 0) {
            // A whole end position that rounding has put just behind the last piece is still reached at the end.
            if (i + 1 == count_ && end_ != never && (x - end_position_) * way <= 0 && std::abs(x - end_position_) < 1) return end_;
            continue;
        }
        for (int n = 0; n < 64 && high - low > 1e-10; ++n) {
            const double middle = (low + high) / 2;
            ((x - in_piece(p, middle).position) * way > 0 ? low : high) = middle;
        }
        return std::max(later(start_, high), from + Duration{1});
    }
    return never;
}

void Profile::shift(double by) noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        pieces_[i].position += by;
    end_position_ += by;
}

}  // namespace axisgate::mcode::twin
