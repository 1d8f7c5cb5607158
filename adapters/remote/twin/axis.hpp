// Axis of the simulated gateway: CiA 402's states as a gateway shows them, homing at its place, a shaft that can be held.
// In: orders, time. Out: its state, or why an order is refused. Any instant can be asked; nothing runs between the questions.
#pragma once

#include "adapters/cia402/twin/mechanics.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote::twin {

class Axis {
public:
    static constexpr std::uint16_t fault_code = 65535;  ///< the one that a hand can raise

    [[nodiscard]] mirror::Answer order(const mirror::Order& order, Instant now);
    [[nodiscard]] mirror::State state(Instant now) const;
    /// What has happened until then: a velocity move that nobody has renewed.
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
