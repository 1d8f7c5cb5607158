// User units of a simulated servo: what its objects say, in increments of the motor and seconds, and what it shows, in its user's units.
// In: objects of CiA 402-2 (608Fh, 6091h, 6092h, 6096h, 607Eh, the profile). Out: places, speeds, ramps. Never moves anything.
#pragma once

#include <utility>

#include "adapters/cia402/twin/axis_objects.hpp"
#include "adapters/cia402/twin/profile.hpp"

namespace axisgate::cia402_drive::twin {

class UserUnits {
public:
    explicit UserUnits(const AxisObjects& objects) : o_(objects) {}
    UserUnits(const UserUnits&) = delete;  // it stands on its neighbours in the servo
    UserUnits& operator=(const UserUnits&) = delete;
    /// Factors and polarity anew. What a dictionary has not is 1.
    void read();
    [[nodiscard]] double zero() const noexcept { return zero_; }
    void set_zero(double place) noexcept { zero_ = place; }

    [[nodiscard]] double in_units(double place) const { return turn_ * (place - zero_) / per_unit_; }
    [[nodiscard]] double speed_in_units(double velocity) const { return turn_speed_ * velocity / per_speed_; }
    [[nodiscard]] double way_in_units(double way) const { return turn_ * way / per_unit_; }
    /// Of an object in user units: a place of the shaft; a way without a sign.
    [[nodiscard]] double place_of(std::uint16_t index, std::uint8_t sub = 0) const { return zero_ + turn_ * way_of(index, sub); }
    [[nodiscard]] double way_of(std::uint16_t index, std::uint8_t sub = 0) const {
        return per_unit_ * static_cast<double>(o_.get(index, sub));
    }
    [[nodiscard]] double velocity_of(std::uint16_t index) const { return turn_speed_ * per_speed_ * static_cast<double>(o_.get(index)); }
    [[nodiscard]] double speed_of(std::uint16_t index, std::uint8_t sub = 0) const { return per_speed_ * o_.rate(index, sub); }
    [[nodiscard]] double rate_of(std::uint16_t index) const { return per_unit_ * o_.rate(index); }
    /// 607Dh as places of the shaft, the lower one first; equal: there are no limits.
    [[nodiscard]] std::pair<double, double> limits() const;
    [[nodiscard]] double fastest() const { return per_speed_ * std::min(o_.rate(0x607F), o_.rate(0x6080)); }
    /// Of the profile: 6081h, 6083h, 6084h within their bounds, in the form of 6086h.
    [[nodiscard]] Ramps ramps() const;
    /// By the option codes 605Ah, 605Dh and 605Eh: 1 and 5 the slow-down ramp, 2 and 6 that of the quick stop, beyond those what current
    /// and voltage give: the most that the drive can.
    [[nodiscard]] Ramps braking(std::int64_t option) const;

private:
    [[nodiscard]] double ratio(std::uint16_t index) const;
    void form(Ramps& ramps) const;
    const AxisObjects& o_;
    double zero_ = 0, per_unit_ = 1, per_speed_ = 1, turn_ = 1, turn_speed_ = 1;
};

}  // namespace axisgate::cia402_drive::twin
