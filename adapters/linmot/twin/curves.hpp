// Time curves: a curve that is started at a position and an instant (04h), and the commands that change curves in the drive's RAM (05h).
// Errors 0062h and 0089h.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "adapters/linmot/twin/cams.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

using Curves = std::map<std::uint16_t, Curve>;
/// A curve that can be started; nullptr: it is not defined, or has fewer than two points.
[[nodiscard]] const Curve* curve_of(const Curves& curves, std::uint16_t id);

/// A time curve in progress.
struct Play {
    bool active = false;
    std::uint16_t curve = 0;
    double offset = 0, scale = 1, seconds = 0;
    Instant begun{};
    [[nodiscard]] Instant end() const noexcept;
    /// Empty: its curve was deleted.
    [[nodiscard]] std::optional<Point> at(const Curves& curves, Instant now) const;
};

/// Starts a curve by the sub IDs 0 to 5 of 04h in `play`; an error changes nothing. `here`: the demand, 0.1 um.
[[nodiscard]] Fault lay(Play& play, const Curves& curves, std::uint8_t sub, const Bytes& b, double here, Instant now);
/// 05h.
[[nodiscard]] Fault modify(Curves& curves, std::uint8_t sub, const Bytes& b);

}  // namespace axisgate::linmot::twin
