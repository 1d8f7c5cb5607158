// Axis is the axis of the simulated gateway: the CiA 402 states as a gateway shows them, homing at the present position, and a shaft that
// can be held. The state is calculated for any instant. A specimen's shaft follows its demand as its mechanics permit.
#pragma once

#include "adapters/cia402/twin/mechanics.hpp"
#include "gateway/core/shaft.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote::twin {

class Axis {
public:
    explicit Axis(const FreedomValues& freedoms = {}, std::uint64_t seed = 0);

    static constexpr std::uint16_t fault_code = 65535;  ///< the fault that the hand can cause

    [[nodiscard]] mirror::Answer order(const mirror::Order& order, Instant now);
    [[nodiscard]] mirror::State state(Instant now) const;
    /// Carries out events until then: the end of a velocity move that was not renewed, a following error.
    void advance(Instant now);
    void hold(bool held, Instant now);
    void fail(bool failed, Instant now);
    void power_off(Instant now);
    [[nodiscard]] TwinMechanics mechanics(Instant now) const;

private:
    [[nodiscard]] mirror::Answer move(const mirror::Order& order, Instant now);
    void rest(Instant now);
    void follow(Instant now);
    [[nodiscard]] Instant follow_demand(Instant now);
    [[nodiscard]] Instant held_behind(Instant now);
    [[nodiscard]] bool powered(Instant now) const { return on_ && now >= on_from_; }
    /// Of the load; without mechanics of a specimen the demand.
    [[nodiscard]] double place(Instant now) const { return real_.differs() ? real_.load() : shaft_.demand(now).position; }
    [[nodiscard]] bool beyond_limit(double position) const;

    // The specimen.
    Shaft real_;
    Duration power_delay_;
    double start_, most_error_, limit_;
    bool homes_, sets_position_, reports_demand_;

    cia402_drive::twin::Mechanics shaft_;
    cia402_drive::twin::Ramps ramps_{4000, 20000, 20000};
    double zero_ = 0;
    std::int16_t mode_ = 1;
    Instant held_until_ = never;  ///< a velocity move ends then
    Instant on_from_{}, followed_{};
    bool was_on_ = false;
    bool on_ = false, quick_ = false, fault_ = false, referenced_ = false, to_target_ = false, homed_ = false;
};

}  // namespace axisgate::remote::twin
