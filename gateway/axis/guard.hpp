// Checks commands before they reach a drive: the site's limits, the width of registers, the ranges of the catalogue. A value passes, or is
// refused with the allowed range; it is never clipped. Only values that an order does not name are filled in.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// The limits of one axis in increments; absent: no limit.
struct AxisLimits {
    std::optional<std::int64_t> position_min, position_max, velocity_max, acceleration_max;
    std::optional<std::int64_t> deceleration_min;  ///< the weakest ramp that the axis may have if its drive does not report it
    double increments_per_unit = 1.0;
    std::string unit;

    [[nodiscard]] static AxisLimits of(const AxisSpec& axis);
};

struct Refusal {
    Reason reason = Reason::none;
    std::string text;
};

/// For example "12.5 mm", or increments if the axis has no unit.
[[nodiscard]] std::string in_unit(std::int64_t increments, const AxisLimits& limits, std::string_view per = {});

/// `position` is the actual position in increments, for relative moves and for velocity moves that would lead out of the limits.
[[nodiscard]] std::optional<Refusal> guard_move(const Move& move, const AxisLimits& limits, std::int64_t position);
/// Checks the mode of operation of register 33: the drive must offer it, and it must not be one for streamed set-points. 0 changes nothing.
[[nodiscard]] std::optional<Refusal> guard_mode(std::int16_t mode, std::span<const std::int16_t> offered);
/// Rates that a statement sets for later motions, in either direction; 0: not named. Only the site limits them; the drive checks its own
/// ranges.
[[nodiscard]] std::optional<Refusal> guard_rates(const DriveRates& rates, const AxisLimits& limits);
/// Adds the rates that a move does not name, if the site limits them and the drive's own values are not known to keep the limit.
void name_rates(Move& move, const AxisLimits& limits, const DriveRates& drive);
/// Checks registers 32..47 before they are latched: speeds, accelerations, and the absolute target if a set-point starts with this word.
[[nodiscard]] std::optional<Refusal> guard_process_data(const ProcessData& data, const AxisLimits& limits);

}  // namespace axisgate
