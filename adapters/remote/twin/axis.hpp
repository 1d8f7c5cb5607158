// Axis is the axis of the simulated gateway: the CiA 402 states as a gateway shows them, homing at the present position, and a shaft that
// can be held. The state is calculated for any instant.
#pragma once

#include "adapters/cia402/twin/mechanics.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote::twin {

class Axis {
public:
    static constexpr std::uint16_t fault_code = 65535;  ///< the fault that the hand can cause

    [[nodiscard]] mirror::Answer order(const mirror::Order& order, Instant now);
    [[nodiscard]] mirror::State state(Instant now) const;
    /// Carries out events until then: the end of a velocity move that was not renewed.
    void advance(Instant now);
    void hold(bool held, Instant now);
    void fail(bool failed, Instant now);
    void power_off(Instant now);
    [[nodiscard]] TwinMechanics mechanics(Instant now) const;

private:
    [[nodiscard]] mirror::Answer move(const mirror::Order& order, Instant now);
    void rest(Instant now);

    cia402_drive::twin::Mechanics shaft_;
    cia402_drive::twin::Ramps ramps_{4000, 20000, 20000};
    double zero_ = 0;
    std::int16_t mode_ = 1;
    Instant held_until_ = never;  ///< a velocity move ends then
    bool on_ = false, quick_ = false, fault_ = false, referenced_ = false, to_target_ = false, homed_ = false;
};

}  // namespace axisgate::remote::twin
