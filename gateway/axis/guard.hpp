// Guard: what is refused before it reaches a drive: values outside the site's limits, the registers' width, the catalogue's ranges.
// In: a command, the axis' place in the site, its position. Out: nothing if it may pass, else the reason in words with the range.
// A value is never clipped: it passes, or is refused with the range. Only values that an order does not name are filled in.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// The limits of one axis in increments; absent: none.
struct AxisLimits {
    std::optional<std::int64_t> position_min, position_max, velocity_max, acceleration_max;
    std::optional<std::int64_t> deceleration_min;  ///< the weakest ramp that the axis may have where its drive does not tell it
    double increments_per_unit = 1.0;
    std::string unit;

    [[nodiscard]] static AxisLimits of(const AxisSpec& axis);
};

struct Refusal {
    Reason reason = Reason::none;
    std::string text;
};

/// "12.5 mm", or increments where the axis has no unit.
[[nodiscard]] std::string in_unit(std::int64_t increments, const AxisLimits& limits, std::string_view per = {});

/// `position`: the axis' actual position in increments, for relative moves and for velocity moves that would lead out of the limits.
[[nodiscard]] std::optional<Refusal> guard_move(const Move& move, const AxisLimits& limits, std::int64_t position);
/// The mode of operation of register 33: one that the drive offers, and that is not entered by streaming set-points. 0 changes nothing.
[[nodiscard]] std::optional<Refusal> guard_mode(std::int16_t mode, std::span<const std::int16_t> offered);
/// Rates that a statement sets for later motions, in either direction; 0: not these. Only the site bounds them: what else a drive takes is
/// its own.
[[nodiscard]] std::optional<Refusal> guard_rates(const DriveRates& rates, const AxisLimits& limits);
/// Gives a move the rates that it does not name where the site limits them and the drive's own are not known to keep the limit.
void name_rates(Move& move, const AxisLimits& limits, const DriveRates& drive);
/// Registers 32..47 before they are latched: speeds, accelerations and the absolute target when a set-point starts with this word.
[[nodiscard]] std::optional<Refusal> guard_process_data(const ProcessData& data, const AxisLimits& limits);

}  // namespace axisgate
