// The homing of the simulated servo: the positions that each method of 6098h passes with its switches and index pulses (CiA 402-2). It
// calculates only; the servo moves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace axisgate::cia402_drive::twin {

/// There is an index pulse at each multiple of this, in increments of the motor.
inline constexpr double index_way = 4096;
/// The home switch of methods 7 to 14 and 23 to 30 is a cam from -cam to +cam; that of 3 to 6 and 19 to 22 has one edge, at 0.
inline constexpr double cam = 1024;

struct HomingWay {
    bool possible = false;       ///< false: the method needs a switch that does not exist
    std::vector<double> search;  ///< approached with the speed of 6099h:01, to switches
    double zero = 0;             ///< approached with the speed of 6099h:02
    bool moves = true;           ///< false: the zero is the present position
};

/// The progress of homing: the remaining positions, and its result.
class HomingSearch {
public:
    void forget() { phase_ = Phase::none; }
    void interrupt() {
        if (active()) forget();
    }
    void take(HomingWay way) {
        way_ = std::move(way);
        phase_ = way_.possible ? Phase::to_switch : Phase::error;
    }
    /// Methods below 0 are carried out by the family that defines them.
    void lead() { phase_ = Phase::led; }
    void end(bool attained) { phase_ = attained ? Phase::attained : Phase::error; }
    /// The next switch; empty: the zero comes next.
    [[nodiscard]] std::optional<double> next() {
        if (way_.search.empty()) {
            phase_ = Phase::to_zero;
            return std::nullopt;
        }
        const double place = way_.search.front();
        way_.search.erase(way_.search.begin());
        return place;
    }
    [[nodiscard]] const HomingWay& way() const noexcept { return way_; }
    [[nodiscard]] bool to_switch() const noexcept { return phase_ == Phase::to_switch; }
    [[nodiscard]] bool to_zero() const noexcept { return phase_ == Phase::to_zero; }
    [[nodiscard]] bool led() const noexcept { return phase_ == Phase::led; }
    [[nodiscard]] bool active() const noexcept { return to_switch() || to_zero() || led(); }
    [[nodiscard]] bool attained() const noexcept { return phase_ == Phase::attained; }
    [[nodiscard]] bool failed() const noexcept { return phase_ == Phase::error; }

private:
    enum class Phase : std::uint8_t { none, to_switch, to_zero, led, attained, error } phase_ = Phase::none;
    HomingWay way_;
};

/// All methods that 60E3h offers, in ascending order.
[[nodiscard]] std::span<const int> homing_methods() noexcept;
/// `travel`: the limit switches are at -travel and +travel; 0: there are neither limit switches nor a home switch. `hysteresis`: a switch
/// that the axis leaves is released this many increments behind the place where it is operated.
[[nodiscard]] HomingWay homing_way(int method, double here, double travel, double hysteresis = 0);

}  // namespace axisgate::cia402_drive::twin
