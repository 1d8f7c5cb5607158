// Follower is the slider: its mechanical place, the position that the drive reports, and its lag behind the demand. It follows the demand
// while it is powered, and a hand while it is not. position = place + offset. A weak motor, a soft machine or a noisy encoder is the Shaft
// of the core, which is advanced with the drive.
#pragma once

#include "adapters/linmot/twin/demand.hpp"
#include "adapters/linmot/twin/setup.hpp"

namespace axisgate::linmot::twin {

/// All values in 0.1 um.
class Follower {
public:
    Follower(const Memory& memory, const Demand& demand, const Outside& outside, const DriveSetup& setup)
        : memory_(memory),
          demand_(demand),
          outside_(outside),
          standing_(setup.series == Series::b1100 ? 0x1473 : 0x1475),
          friction_(static_cast<double>(setup.manners.shaft.friction_increments)),
          shaft_(setup.manners.shaft, setup.seed) {}

    /// The slider follows the demand of the time since the last call; called before each change of the demand. If the lag is `watched`, it
    /// ends at the first millisecond at which the lag exceeds its limit, and returns it; otherwise `never`.
    Instant advance(Instant now, bool watched = false);
    /// The slider is not yet where it will come to rest.
    [[nodiscard]] bool swings(Instant now) const;
    /// The mechanical place.
    [[nodiscard]] Point place(Instant now) const;
    /// The position that the drive reports.
    [[nodiscard]] Point actual(Instant now) const;
    [[nodiscard]] double rest() const noexcept {
        return (shaft_.differs() && !controlled_ ? shaft_.position() : place_) + offset_;
    }  ///< position while nothing controls it
    [[nodiscard]] double offset() const noexcept { return offset_; }
    [[nodiscard]] bool homed() const noexcept { return homed_; }
    [[nodiscard]] bool controlled() const noexcept { return controlled_; }
    [[nodiscard]] double captured() const noexcept { return captured_; }
    [[nodiscard]] bool in_target(Instant now) const;

    void power_on() noexcept { homed_ = false, offset_ = 0; }
    void lose_home() noexcept { homed_ = false; }
    /// Defines the present position; returns the demand after the change.
    double home(double position, Instant now);
    /// Adds `shift` to the present position.
    void rename(double shift) noexcept { offset_ += shift, homed_ = true; }

    /// Stores the place for the time without power.
    void keep(Instant now) { place_ = controlled_ ? place(now).position : place_; }
    /// From now on the demand controls the slider, or nothing does.
    void control(bool on) noexcept;
    /// A hand holds the slider where it is.
    void hold(Instant now) { held_at_ = place(now).position; }
    void push(double place, Instant now) {
        place_ = held_at_ = place;
        if (controlled_) return;
        shaft_.set(place, now);
        was_controlled_ = false;
    }
    void capture(Instant now) { captured_ = actual(now).position; }

    /// While the slider is held, the demand moves away until the lag exceeds its limit (1473h). `never`: it does not; crossings count from
    /// `after` on.
    [[nodiscard]] Instant lag_limit(Instant now, Instant after) const;
    /// When the position leaves the range of 146Eh and 146Fh.
    [[nodiscard]] Instant range_limit(Instant now, Instant after) const;

private:
    const Memory& memory_;
    const Demand& demand_;
    const Outside& outside_;
    std::uint16_t standing_;  ///< the parameter that limits the lag at standstill; a B1100 has one limit for both
    double friction_;
    double place_ = 0;  ///< while nothing controls it
    double offset_ = 0;
    double held_at_ = 0;
    double captured_ = 0;
    bool homed_ = false;
    bool controlled_ = false;
    bool was_controlled_ = false;  ///< a slider drifts only from where it was held
    Shaft shaft_;                  ///< in the coordinates of the mechanical place
};

}  // namespace axisgate::linmot::twin
