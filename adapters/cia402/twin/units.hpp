// UserUnits converts between the user units of a simulated servo's objects (CiA 402-2: 608Fh, 6091h, 6092h, 6096h, 607Eh) and increments of
// the motor and seconds.
#pragma once

#include <utility>

#include "adapters/cia402/twin/axis_objects.hpp"
#include "adapters/cia402/twin/profile.hpp"

namespace axisgate::cia402_drive::twin {

class UserUnits {
public:
    explicit UserUnits(const AxisObjects& objects) : o_(objects) {}
    UserUnits(const UserUnits&) = delete;  // it refers to other members of the servo
    UserUnits& operator=(const UserUnits&) = delete;
    /// Reads factors and polarity again. A missing factor is 1.
    void read();
    [[nodiscard]] double zero() const noexcept { return zero_; }
    void set_zero(double place) noexcept { zero_ = place; }

    [[nodiscard]] double in_units(double place) const { return turn_ * (place - zero_) / per_unit_; }
    [[nodiscard]] double speed_in_units(double velocity) const { return turn_speed_ * velocity / per_speed_; }
    [[nodiscard]] double way_in_units(double way) const { return turn_ * way / per_unit_; }
    /// The value of an object in user units as a position of the shaft, or as a distance without sign.
    [[nodiscard]] double place_of(std::uint16_t index, std::uint8_t sub = 0) const { return zero_ + turn_ * way_of(index, sub); }
    [[nodiscard]] double way_of(std::uint16_t index, std::uint8_t sub = 0) const {
        return per_unit_ * static_cast<double>(o_.get(index, sub));
    }
    [[nodiscard]] double velocity_of(std::uint16_t index) const { return turn_speed_ * per_speed_ * static_cast<double>(o_.get(index)); }
    [[nodiscard]] double speed_of(std::uint16_t index, std::uint8_t sub = 0) const { return per_speed_ * o_.rate(index, sub); }
    [[nodiscard]] double rate_of(std::uint16_t index) const { return per_unit_ * o_.rate(index); }
    /// 607Dh as positions of the shaft, the lower one first; equal: there are no limits.
    [[nodiscard]] std::pair<double, double> limits() const;
    [[nodiscard]] double fastest() const { return per_speed_ * std::min(o_.rate(0x607F), o_.rate(0x6080)); }
    /// Of the profile: 6081h, 6083h, 6084h within their limits, with the shape of 6086h.
    [[nodiscard]] Ramps ramps() const;
    /// By the option codes 605Ah, 605Dh and 605Eh: 1 and 5 use the slow-down ramp, 2 and 6 the quick stop ramp, the others the maximum that
    /// current and voltage permit.
    [[nodiscard]] Ramps braking(std::int64_t option) const;

private:
    [[nodiscard]] double ratio(std::uint16_t index) const;
    void form(Ramps& ramps) const;
    const AxisObjects& o_;
    double zero_ = 0, per_unit_ = 1, per_speed_ = 1, turn_ = 1, turn_speed_ = 1;
};

}  // namespace axisgate::cia402_drive::twin
