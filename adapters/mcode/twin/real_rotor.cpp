#include "adapters/mcode/twin/real_rotor.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::mcode::twin {
namespace {
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
    lead_s_ = 2 * static_cast<double>(m.shaft.damping_percent) / 100 * period_ms / 1000;
}

void RealRotor::set(double turns, Instant now) {
    real_.set(turns * per_turn, now);
    strong_.set(turns * per_turn, now);
}

void RealRotor::drift(Instant until) {
    real_.advance_without_power(until);
    if (limited_) strong_.advance_without_power(until);
}

}  // namespace axisgate::mcode::twin
