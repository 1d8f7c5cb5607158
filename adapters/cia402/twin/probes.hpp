// The touch probes of a simulated servo (60B8h to 60BDh): two inputs whose edges store the position of the shaft.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "adapters/cia402/twin/axis_objects.hpp"

namespace axisgate::cia402_drive::twin {

class TouchProbes {
public:
    explicit TouchProbes(AxisObjects& objects) : o_(objects) {}
    TouchProbes(const TouchProbes&) = delete;  // it refers to other members of the servo
    TouchProbes& operator=(const TouchProbes&) = delete;
    void reset() {
        status_ = 0;
        function_ = 0;
        arm();
    }
    [[nodiscard]] std::uint16_t status() const noexcept { return status_; }

    /// Each probe has one byte of 60B8h and of 60B9h: enabled, and which edges count (bit 1: repeatedly).
    void level(unsigned k, bool high, double place_in_units) {
        if (std::exchange(level_.at(k), high) == high) return;
        const unsigned function = static_cast<unsigned>(o_.get(0x60B8)) >> 8 * k, stored = (high ? 2u : 4u) << 8 * k;
        if ((function & 1u) == 0 || (function & (high ? 0x10u : 0x20u)) == 0) return;
        if ((status_ & stored) && (function & 2u) == 0) return;
        o_.put(static_cast<std::uint16_t>(0x60BA + 2 * k + (high ? 0 : 1)), std::llround(place_in_units));
        status_ = static_cast<std::uint16_t>(status_ | stored);
    }
    /// A probe whose byte has changed waits for its edges again; writing 60B8h without a change has no effect.
    void arm() {
        const auto function = static_cast<unsigned>(o_.get(0x60B8)), before = std::exchange(function_, function);
        for (unsigned k = 0; k < 2; ++k)
            if (((function ^ before) >> 8 * k & 0xFFu) != 0)
                status_ = static_cast<std::uint16_t>((status_ & ~(0xFFu << 8 * k)) | (function & 1u << 8 * k));
    }

private:
    AxisObjects& o_;
    std::uint16_t status_ = 0;
    unsigned function_ = 0;
    std::array<bool, 2> level_{};
};

}  // namespace axisgate::cia402_drive::twin
