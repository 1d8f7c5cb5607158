// Limits and Cams: soft limits, limit inputs, switches that stand beside the axis.
// In: fields, places. Out: codes 82 and 83, edges of inputs.
// Never closes a direction away from a limit [L3943-3944].
#include "adapters/mcode/twin/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
/// Length of the home switch that the hand puts beside the axis, in turns.
constexpr double home_length = 0.05;
/// The least by which a switch opens behind the place where it has closed, in turns: less than a thousandth of a step.
constexpr double switch_gap = 1e-8;

struct Region {
    double low, high;
};

Region region_of(std::size_t cam, double x) noexcept {
    constexpr double far = std::numeric_limits<double>::infinity();
    if (Cams::types[cam] == InputType::limit_minus) return {-far, x};
    if (Cams::types[cam] == InputType::limit_plus) return {x, far};
    return {x, x + home_length};
}

}  // namespace

int Limits::set_up(std::span<const std::int64_t> f) {
    if (f.size() != 3 || f[0] < 0 || f[0] > 1 || f[2] < 0 || f[2] > 1) return err::bad_value;
    if (f[1] < -2147483648LL || f[1] > 2147483647LL) return err::bad_value;
    auto soft = soft_;
    soft[static_cast<std::size_t>(f[0])] = {static_cast<double>(f[1]), f[2] == 1};
    if (soft[0].on && soft[1].on && soft[0].position >= soft[1].position) return err::bad_value;  // minus must lie below plus [L4029]
    soft_ = soft;
    return 0;
}

std::string Limits::text() const {
    std::string s;
    for (std::size_t i = 0; i < soft_.size(); ++i) {
        s += (i == 0 ? "LS=" : "\r\nLS=") + std::to_string(i) + ", " + std::to_string(std::llround(soft_[i].position)) + ", " +
             (soft_[i].on ? "1" : "0");
    }
    return s;
}

void Limits::save(NonVolatile& m) const {
    for (std::size_t i = 0; i < soft_.size(); ++i) {
        m["LS." + std::to_string(i) + ".position"] = Value{std::int64_t{std::llround(soft_[i].position)}};
        m["LS." + std::to_string(i) + ".on"] = Value{std::int64_t{soft_[i].on ? 1 : 0}};
    }
}

void Limits::load(const NonVolatile& m) {
    for (std::size_t i = 0; i < soft_.size(); ++i) {
        const std::string name = "LS." + std::to_string(i);
        soft_[i].position = static_cast<double>(integer_in(m, name + ".position", std::llround(soft_[i].position)));
        soft_[i].on = integer_in(m, name + ".on", soft_[i].on ? 1 : 0) == 1;
    }
}

int Limits::held(int way, Instant now) const noexcept {
    const double p = shaft_.shown_position(now).position;
    if (way > 0 && (inputs_.active(InputType::limit_plus) || (soft_[1].on && p >= soft_[1].position))) return err::plus_limit;
    if (way < 0 && (inputs_.active(InputType::limit_minus) || (soft_[0].on && p <= soft_[0].position))) return err::minus_limit;
    return 0;
}

Instant Limits::crossing(Instant now) const noexcept {
    const Instant minus = soft_[0].on ? shaft_.position_crossing(soft_[0].position, now, -1) : never;
    return soft_[1].on ? std::min(minus, shaft_.position_crossing(soft_[1].position, now, 1)) : minus;
}

Cams::Cams(const Shaft& shaft, Inputs& inputs, double hysteresis)
    : shaft_(shaft), inputs_(inputs), gap_(std::max(hysteresis, switch_gap)) {}

void Cams::place(std::size_t cam, std::optional<double> turns, Instant now) {
    cams_[cam] = {turns, false};
    hold(now);
}

bool Cams::active(std::size_t cam, Instant now) const noexcept {
    const Region r = region_of(cam, *cams_[cam].turns);
    const double t = shaft_.turns(now), slack = cams_[cam].was ? gap_ : switch_gap / 10;
    return t >= r.low - slack && t <= r.high + slack;
}

void Cams::judge(Instant now) {
    for (std::size_t i = 0; i < cams_.size(); ++i) {
        if (!cams_[i].turns) continue;
        const bool closed = active(i, now);
        if (closed == cams_[i].was) continue;
        cams_[i].was = closed;
        (void)inputs_.drive(types[i], closed, now);
    }
}

void Cams::hold(Instant now) {
    for (std::size_t i = 0; i < cams_.size(); ++i) {
        if (cams_[i].turns) cams_[i].was = !active(i, now);
    }
    judge(now);
}

void Cams::anew(Instant now) {
    for (Cam& c : cams_)
        c.was = false;
    judge(now);
}

Instant Cams::crossing(Instant now) const noexcept {
    Instant t = never;
    for (std::size_t i = 0; i < cams_.size(); ++i) {
        if (!cams_[i].turns) continue;
        const Region r = region_of(i, *cams_[i].turns);
        const double gap = cams_[i].was ? gap_ + switch_gap : 0;
        for (const double edge : {r.low - gap, r.high + gap}) {
            if (std::isfinite(edge)) t = std::min(t, shaft_.turns_crossing(edge, now));
        }
    }
    return t;
}

}  // namespace axisgate::mcode::twin
