// VirtualMaster is the virtual master of a MACS: PULSACC, PULSVEL, VMENCTYP, VMENCRES [L6832-6934]: a calculated master encoder with whole
// quad counts, one step per ms. Its position never jumps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "adapters/aposs/twin/coded.hpp"

namespace axisgate::aposs {

class VirtualMaster {
public:
    /// qc/s^2; 0: it is off, and the encoder of VMENCTYP counts.
    void accelerate(std::int64_t pulsacc) {
        acceleration_ = std::max<std::int64_t>(0, pulsacc);
        if (acceleration_ == 0) runs_ = false;
    }
    /// qc/s; a changed VMENCTYP is in force from now on, not from its SET [L6862]. If an axis is the source, the value has no effect.
    void run(std::int64_t pulsvel, const VirtualMasterCode& code) {
        target_ = static_cast<double>(pulsvel);
        code_ = code;
        runs_ = acceleration_ > 0;
    }
    void off() { *this = {}; }
    [[nodiscard]] bool on() const noexcept { return runs_; }
    [[nodiscard]] bool drives_masters() const noexcept { return runs_ && !code_.no_output; }
    [[nodiscard]] int axis() const noexcept { return code_.axis; }
    [[nodiscard]] std::int64_t place() const { return std::llround(place_); }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }
    /// One millisecond; `axis_velocity`: command velocity of the source axis, qc/s, if there is one.
    void step(double axis_velocity) {
        if (!runs_) return;
        const double to = code_.axis > 0 ? axis_velocity : target_, rate = static_cast<double>(acceleration_) / 1000, was = velocity_;
        velocity_ += std::clamp(to - velocity_, -rate, rate);
        place_ += (was + velocity_) / 2000;
    }
    /// The position no longer changes.
    [[nodiscard]] bool stands() const { return !runs_ || (code_.axis == 0 && velocity_ == 0 && target_ == 0); }

private:
    std::int64_t acceleration_ = 0;
    double target_ = 0, velocity_ = 0, place_ = 0;
    VirtualMasterCode code_;
    bool runs_ = false;
};

}  // namespace axisgate::aposs
