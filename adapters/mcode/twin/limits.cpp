// Motor: limits (switches and LS) with the six answers of LM, and switches that stand beside the axis.
// In: positions, edges. Out: stops, codes 82, 83, 84.
// Never stops a motion away from a limit [L3943-3944].
#include <algorithm>
#include <cmath>
#include <limits>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
/// Length of the home switch that the hand puts beside the axis, in turns.
constexpr double home_length = 0.05;
/// A switch opens this much behind the place where it has closed, in turns: less than a thousandth of a step.
constexpr double switch_gap = 1e-8;

}  // namespace

int Motor::set_soft_limit(std::span<const std::int64_t> f) {
    if (f.size() != 3 || f[0] < 0 || f[0] > 1 || f[2] < 0 || f[2] > 1) return err::bad_value;
    if (f[1] < -2147483648LL || f[1] > 2147483647LL) return err::bad_value;
    auto limit = soft_limit_;
    auto on = soft_on_;
    const auto n = static_cast<std::size_t>(f[0]);
    limit[n] = static_cast<double>(f[1]);
    on[n] = f[2] == 1;
    if (on[0] && on[1] && limit[0] >= limit[1]) return err::bad_value;  // minus must lie below plus [L4029]
    soft_limit_ = limit;
    soft_on_ = on;
    return 0;
}

int Motor::held_limit(int way, Instant now) const noexcept {
    const double p = position(now).position;
    if (way > 0 && (inputs_.active(InputType::limit_plus) || (soft_on_[1] && p >= soft_limit_[1]))) return err::plus_limit;
    if (way < 0 && (inputs_.active(InputType::limit_minus) || (soft_on_[0] && p <= soft_limit_[0]))) return err::minus_limit;
    return 0;
}

void Motor::limit_met(int way, Instant now) {
    const double v = command_.at(now).velocity;
    if (phase_ != Phase::steps || v * way <= 0) return;
    const std::int64_t mode = whole(Word::LM);
    const bool at_once = mode >= 4;
    const bool homing = task_ == Task::homing && home_.word == Word::HM && (mode == 1 || mode == 4) && !braking_;
    if (homing && home_.stage == Homing::Stage::seek && !home_.reversed) {
        home_.reversed = true;
        if (at_once) {
            command_ = Profile::rest(std::round(command_.at(now).position));
            seek(-home_.way, now);
        } else {
            home_.stage = Homing::Stage::back;
            command(Profile::slew(now, command_.at(now), 0, kinematics()), now);
        }
        return;
    }
    if (homing && home_.stage == Homing::Stage::back) return;  // the same limit again, while braking at it
    if (braking_ && !at_once) return;
    raise(homing && home_.reversed ? err::both_limits : way > 0 ? err::plus_limit : err::minus_limit);
    aborted_ = true;
    if (task_ == Task::homing || task_ == Task::calibration || task_ == Task::torque) task_ = Task::slew;
    hmt_.torque_runs = false;
    after_pause_.reset();
    if (at_once) {
        freeze(now);
    } else {
        brake(now);
    }
    if (mode == 3 || mode == 6) emit({MotorEvent::Kind::end_program, 0, {}});
}

namespace {
struct Region {
    double low, high;
};

Region region_of(std::size_t cam, double x) noexcept {
    constexpr double far = std::numeric_limits<double>::infinity();
    if (cam == 0) return {-far, x};
    if (cam == 1) return {x, far};
    return {x, x + home_length};
}

constexpr std::array cam_types{InputType::limit_minus, InputType::limit_plus, InputType::home};

}  // namespace

bool Motor::cam_active(std::size_t cam, Instant now) const noexcept {
    const Region r = region_of(cam, *cams_[cam].turns);
    const double t = turns(now), slack = cams_[cam].was ? switch_gap : switch_gap / 10;
    return t >= r.low - slack && t <= r.high + slack;
}

void Motor::judge_cams(Instant now) {
    for (std::size_t i = 0; i < cams_.size(); ++i) {
        if (!cams_[i].turns) continue;
        const bool active = cam_active(i, now);
        if (active == cams_[i].was) continue;
        cams_[i].was = active;
        (void)inputs_.drive(cam_types[i], active, now);
    }
}

/// Switches that stand beside the axis hold their input from now on, also where an open one would be active.
void Motor::place_switches(Instant now) {
    for (std::size_t i = 0; i < cams_.size(); ++i) {
        if (cams_[i].turns) cams_[i].was = !cam_active(i, now);
    }
    judge_cams(now);
}

Instant Motor::cam_crossing(Instant now) const noexcept {
    Instant t = never;
    for (std::size_t i = 0; i < cams_.size(); ++i) {
        if (!cams_[i].turns) continue;
        const Region r = region_of(i, *cams_[i].turns);
        const double gap = cams_[i].was ? 2 * switch_gap : 0;
        for (const double edge : {r.low - gap, r.high + gap}) {
            if (std::isfinite(edge)) t = std::min(t, shaft_crossing(edge, now));
        }
    }
    return t;
}

Instant Motor::shaft_crossing(double t, Instant now) const noexcept {
    return rotor_crossing(shaft_.at + direction() * (t - shaft_.base) * units_per_turn(), now);
}

Instant Motor::rotor_crossing(double x, Instant now, int way) const noexcept {
    switch (rotor_state_) {
        case Rotor::held:
            return never;
        case Rotor::catching_up: {
            const Instant t = catch_up_.crossing(now, x, way);
            return t <= meeting_ ? t : meeting_ == never ? never : command_.crossing(meeting_, x, way);
        }
        default:
            return command_.crossing(now, x + slip_, way);
    }
}

}  // namespace axisgate::mcode::twin
