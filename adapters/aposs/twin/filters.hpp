// The PT1 filters of a MACS for master velocity, marker distances and squared current, with the constants of the manual. One step per ms or
// per marker.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace axisgate::aposs {

/// One step of a PT element; `tau` in steps. Below one step the filter has no effect.
[[nodiscard]] inline double pt(double old, double in, double tau) { return old + (in - old) / std::max(tau, 1.0); }

/// SYNCVFTIME: the time constant in us: its absolute value, or for -999 to 999 the value of the table by master resolution (counts per
/// turn) [L4690-4730].
[[nodiscard]] double velocity_filter_us(std::int64_t syncvftime, std::int64_t resolution);

/// The velocity filter of the synchronisation (SYNCVFTIME, SYNCVFLIMIT). In the position modes, the withheld counts are summed and
/// returned, 1000/(tau*10) of the sum per ms [L4668-4685]. A sum above the limit fades the filter out, 1 ms per ms, down to 5 ms; a sum
/// below one fifth of it fades it in again [L5975-5984].
class VelocityFilter {
public:
    void reset() { *this = {}; }
    /// `limit` 0: no fading. `gives_back`: SYNCP and SYNCM; otherwise there is no sum.
    double step(double velocity, double tau_us, double limit, bool gives_back);
    [[nodiscard]] double error() const noexcept { return error_; }
    void forget_error() noexcept { error_ = 0; }
    /// The present time constant in ms.
    [[nodiscard]] double tau_ms() const noexcept { return tau_; }

private:
    double old_ = 0, error_ = 0, tau_ = -1;
    bool begun_ = false, fading_ = false;
};

/// MarkerFilter: the time constant as a number of markers [L2490-2510].
[[nodiscard]] double marker_filter(std::int64_t syncmfpar, std::int64_t syncmftime, double velocity, std::int64_t syncmpulsm);

/// Averages of marker distances: MMarkerDist over at least 100 of them (from firmware 6.7.16), the sum of their errors, and the filtered
/// sum [L2570-2580].
class MarkerAverage {
public:
    void reset(double distance) { distance_ = distance, sum_ = filtered_sum_ = 0; }
    void add(double distance, double nominal, double markers);
    [[nodiscard]] double distance() const noexcept { return distance_; }
    /// MMarkCorr: (nominal - MMarkerDist) / MMarkerDist.
    [[nodiscard]] double gear_correction(double nominal) const { return distance_ > 0 ? (nominal - distance_) / distance_ : 0; }
    /// The random part of the last positions: the sum of errors without its filtered part.
    [[nodiscard]] double deviation() const { return sum_ - filtered_sum_; }

private:
    double distance_ = 0, sum_ = 0, filtered_sum_ = 0;
};

/// I2T [L6169-6240]: every ms the square of the current, mA^2/1000, is filtered by a PT element with I2TFTIME. 0 ms: no monitoring.
class CurrentWatch {
public:
    void step(double milliamperes, std::int64_t i2tftime) {
        value_ = i2tftime > 0 ? pt(value_, milliamperes * milliamperes / 1000, static_cast<double>(i2tftime)) : 0;
    }
    [[nodiscard]] std::int64_t value() const { return std::llround(value_); }  ///< AMP_I2TVALUE, 1/1000 A^2
    [[nodiscard]] bool exceeds(std::int64_t i2tftime, std::int64_t i2tlimit) const { return i2tftime > 0 && value() > i2tlimit; }

private:
    double value_ = 0;
};

}  // namespace axisgate::aposs
