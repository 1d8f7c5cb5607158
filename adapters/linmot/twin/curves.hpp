// Time curves: one that is laid over a place and a time, and the commands that change curves in the drive's RAM.
// In: motion commands of 04h and 05h. Out: places by time, changed curves, errors 0062h and 0089h. Nothing here moves by itself.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "adapters/linmot/twin/cams.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

using Curves = std::map<std::uint16_t, Curve>;
/// One that can be played; nullptr: it is not defined, or has fewer than two points.
[[nodiscard]] const Curve* curve_of(const Curves& curves, std::uint16_t id);

/// A time curve that runs.
struct Play {
    bool active = false;
    std::uint16_t curve = 0;
    double offset = 0, scale = 1, seconds = 0;
    Instant begun{};
    [[nodiscard]] Instant end() const noexcept;
    /// Nothing: its curve has gone.
    [[nodiscard]] std::optional<Point> at(const Curves& curves, Instant now) const;
};

/// Lays a curve by 04h's sub ID 0 to 5 into `play`; with an error nothing is laid. `here`: the demand, 0.1 um.
[[nodiscard]] Fault lay(Play& play, const Curves& curves, std::uint8_t sub, const Bytes& b, double here, Instant now);
/// 05h.
[[nodiscard]] Fault modify(Curves& curves, std::uint8_t sub, const Bytes& b);

}  // namespace axisgate::linmot::twin
