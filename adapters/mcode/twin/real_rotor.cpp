#include "adapters/mcode/twin/real_rotor.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::mcode::twin {
namespace {
constexpr Duration grid = axisgate::Shaft::step;

ShaftFreedoms with_any_force(ShaftFreedoms f) noexcept {
    // The loop of a motor that is only weak has the same stiffness without its limit.
    if (f.follow_ms == 0 && f.most_acceleration != 0) f.follow_ms = 2;
    f.most_acceleration = 0;
    return f;
}
}  // namespace

RealRotor::RealRotor(const MotorManners& m)
    : limited_(m.shaft.most_acceleration != 0), real_(m.shaft, m.seed), strong_(with_any_force(m.shaft), m.seed) {
    if (m.shaft.follow_ms == 0 && !limited_) return;
    const auto period_ms = static_cast<double>(std::max<std::int64_t>(2, m.shaft.follow_ms));
    // The integration acts on the place at the end of each step, which is a millisecond of lead already.
    lead_s_ = 2 * static_cast<double>(m.shaft.damping_percent) / 100 * period_ms / 1000 - seconds(grid);
}

void RealRotor::set(double turns, Instant now) {
    at_ = time_zero + (now - time_zero) / grid * grid;
    real_.set(turns * per_turn, at_);
    strong_.set(turns * per_turn, at_);
    stray_ = 0;
}

void RealRotor::step(double turns, double turns_per_second) {
    at_ += grid;
    const auto field = [&](Instant) { return (turns + lead_s_ * turns_per_second) * per_turn; };
    real_.advance(at_, field);
    if (limited_) strong_.advance(at_, field);
    stray_ = real_.shown() / per_turn - turns;
}

void RealRotor::step_without_power(double turns) {
    at_ += grid;
    real_.advance_without_power(at_);
    if (limited_) strong_.advance_without_power(at_);
    stray_ = real_.shown() / per_turn - turns;
}

bool RealRotor::out_of_step() const noexcept { return limited_ && std::abs(strong_.position() - real_.position()) > pull_out; }

void RealRotor::skip_to(Instant now) noexcept {
    at_ = std::max(at_, time_zero + (now - axisgate::Shaft::longest_gap - time_zero) / grid * grid);
}

}  // namespace axisgate::mcode::twin
