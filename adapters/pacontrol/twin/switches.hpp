// Limit and home switches of one axis: actuated by the place of the shaft, or by a hand.
// In: the shaft, parameters, the hand. Out: which of them are actuated; when the shaft comes onto the next one.
// Never stops anything.
#pragma once

#include "adapters/pacontrol/twin/parameters.hpp"
#include "adapters/pacontrol/twin/shaft.hpp"
#include "adapters/pacontrol/twin/state.hpp"

namespace axisgate::pacontrol::twin {

inline constexpr double switch_share = 0.01;  ///< of a turn of a rotary axis, on which its switch is actuated

class Switches {
public:
    Switches(const AxisModel& model, const AxisParameters& parameters, const Shaft& shaft) : model_(model), p_(parameters), shaft_(shaft) {}
    Switches(const Switches&) = delete;
    Switches& operator=(const Switches&) = delete;

    /// At the instant of the last advance: by the place of the shaft, or by the hand.
    [[nodiscard]] bool limit(bool positive) const noexcept;
    [[nodiscard]] bool home() const noexcept;
    /// The edge of the home switch from which a reference run counts.
    [[nodiscard]] double edge_below(double place) const noexcept;
    /// When the running shaft comes onto the switch in its way; `never`.
    [[nodiscard]] Instant passed() const noexcept;

    /// What stays closed until the shaft is away from it, after the last advance.
    void follow() noexcept;
    void set_limit(bool positive, bool actuated) noexcept { (positive ? positive_ : negative_) = actuated; }
    void set_home(bool actuated) noexcept { home_ = actuated; }
    [[nodiscard]] bool limit_by_hand(bool positive) const noexcept { return positive ? positive_ : negative_; }
    [[nodiscard]] bool home_by_hand() const noexcept { return home_; }

private:
    [[nodiscard]] bool at_shaft(bool positive) const noexcept;
    /// Of a straight axis: `way` is how far the shaft is beyond the edge of the switch, AE.
    [[nodiscard]] bool closed(double way, bool was) const noexcept { return way >= 0 || (was && way > -model_.hysteresis); }

    const AxisModel& model_;
    const AxisParameters& p_;
    const Shaft& shaft_;
    bool positive_ = false, negative_ = false;
    bool home_ = false;
    bool was_positive_ = false, was_negative_ = false, was_home_ = false;
};

}  // namespace axisgate::pacontrol::twin
