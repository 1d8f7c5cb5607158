// The slider: where it is, what the drive calls that place, how far it is behind the demand.
// In: the demand, the tester's hand. Out: position, lag, the instants at which lag or position pass their limits.
// Never moves by itself: it follows the demand while it is powered, and a hand while it is not. position = place + offset.
#pragma once

#include "adapters/linmot/twin/demand.hpp"
#include "adapters/linmot/twin/setup.hpp"

namespace axisgate::linmot::twin {

/// Places in 0.1 um.
class Follower {
public:
    Follower(const Memory& memory, const Demand& demand, const Outside& outside) : memory_(memory), demand_(demand), outside_(outside) {}

    /// The place of the mechanics.
    [[nodiscard]] Point place(Instant now) const;
    /// The same as the drive calls it.
    [[nodiscard]] Point actual(Instant now) const;
    [[nodiscard]] double rest() const noexcept { return place_ + offset_; }  ///< position while nothing controls it
    [[nodiscard]] double offset() const noexcept { return offset_; }
    [[nodiscard]] bool homed() const noexcept { return homed_; }
    [[nodiscard]] bool controlled() const noexcept { return controlled_; }
    [[nodiscard]] double captured() const noexcept { return captured_; }
    [[nodiscard]] bool in_target(Instant now) const;

    void power_on() noexcept { homed_ = false, offset_ = 0; }
    void lose_home() noexcept { homed_ = false; }
    /// The present place is called so; returns where the demand is then.
    double home(double position, Instant now);
    /// It is called `shift` more than before.
    void rename(double shift) noexcept { offset_ += shift, homed_ = true; }

    /// What stands here now is kept for the time without power.
    void keep(Instant now) { place_ = controlled_ ? place(now).position : place_; }
    /// From here on the demand leads it, or nothing does.
    void control(bool on) noexcept;
    /// A hand takes hold of it where it is.
    void hold(Instant now) { held_at_ = place(now).position; }
    void push(double place) noexcept { place_ = held_at_ = place; }
    void capture(Instant now) { captured_ = actual(now).position; }

    /// While it is held the demand runs away until the lag is too big (1473h). `never`: it does not; `after`: where crossings count from.
    [[nodiscard]] Instant lag_limit(Instant now, Instant after) const;
    /// The position leaves the range of 146Eh and 146Fh.
    [[nodiscard]] Instant range_limit(Instant now, Instant after) const;

private:
    const Memory& memory_;
    const Demand& demand_;
    const Outside& outside_;
    double place_ = 0;  ///< while nothing controls it
    double offset_ = 0;
    double held_at_ = 0;
    double captured_ = 0;
    bool homed_ = false;
    bool controlled_ = false;
};

}  // namespace axisgate::linmot::twin
