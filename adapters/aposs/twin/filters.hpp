// Filters of a MACS: the PT element in its uses: master velocity, marker distances, squared current. Constants as the manual has them.
// In: samples, one each ms or one each marker. Out: what is filtered. Never knows a clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace axisgate::aposs {

/// One step of a PT element; `tau` in steps. Below one step it passes everything.
[[nodiscard]] inline double pt(double old, double in, double tau) { return old + (in - old) / std::max(tau, 1.0); }

/// SYNCVFTIME: the time constant in us: its size, or for -999 to 999 that of the table of master resolutions (counts per turn)
/// [L4690-4730].
[[nodiscard]] double velocity_filter_us(std::int64_t syncvftime, std::int64_t resolution);

/// Velocity filter of the synchronisation (SYNCVFTIME, SYNCVFLIMIT): in the position modes what it withholds is added up and given back
/// with 1000/(tau*10) of it each ms [L4668-4685]; a sum above the limit fades the filter out, 1 ms each ms, down to 5 ms, one below a fifth
/// of it fades it in again [L5975-5984].
class VelocityFilter {
public:
    void reset() { *this = {}; }
    /// `limit` 0: it stays in. `gives_back`: SYNCP and SYNCM. Without it the sum is not kept.
    double step(double velocity, double tau_us, double limit, bool gives_back);
    [[nodiscard]] double error() const noexcept { return error_; }
    void forget_error() noexcept { error_ = 0; }
    /// As it is now, in ms.
    [[nodiscard]] double tau_ms() const noexcept { return tau_; }

private:
    double old_ = 0, error_ = 0, tau_ = -1;
    bool begun_ = false, fading_ = false;
};

/// MarkerFilter: how many markers the time constant is [L2490-2510].
[[nodiscard]] double marker_filter(std::int64_t syncmfpar, std::int64_t syncmftime, double velocity, std::int64_t syncmpulsm);

/// Distances of markers, averaged: MMarkerDist over at least 100 of them (from firmware 6.7.16), the sum of their errors and that sum
/// filtered [L2570-2580].
class MarkerAverage {
public:
    void reset(double distance) { distance_ = distance, sum_ = filtered_sum_ = 0; }
    void add(double distance, double nominal, double markers);
    [[nodiscard]] double distance() const noexcept { return distance_; }
    /// MMarkCorr: (nominal - MMarkerDist) / MMarkerDist.
    [[nodiscard]] double gear_correction(double nominal) const { return distance_ > 0 ? (nominal - distance_) / distance_ : 0; }
    /// What of the last positions is chance: the sum of errors without its filtered part.
    [[nodiscard]] double deviation() const { return sum_ - filtered_sum_; }

private:
    double distance_ = 0, sum_ = 0, filtered_sum_ = 0;
};

/// I2T [L6169-6240]: every ms the square of the current, mA^2/1000, through a PT element of I2TFTIME. 0 ms: it is not watched.
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
