// Compares in increments, and writes its refusals in the axis' own unit. Values are never clipped.
#include "gateway/axis/guard.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gateway/axis/cia402.hpp"

namespace axisgate {
namespace {
std::optional<std::int64_t> increments(const std::optional<double>& v, double scale) {
    if (!v) return std::nullopt;
    const double x = *v * scale;
    return std::llround(std::clamp(x, -9.2e18, 9.2e18));  // a limit beyond the range of numbers stays a limit
}

std::optional<Refusal> check_position(std::int64_t target, const AxisLimits& l) {
    constexpr std::int64_t low = std::numeric_limits<std::int32_t>::min(), high = std::numeric_limits<std::int32_t>::max();
    if (target < low || target > high) {
        return Refusal{Reason::out_of_range,
                       fmt::format("target {} is outside the 32 bits of a position ({}..{} increments)", target, low, high)};
    }
    if (l.position_min && target < *l.position_min) {
        return Refusal{Reason::out_of_range,
                       fmt::format("target {} is below the axis' position_min {}", in_unit(target, l), in_unit(*l.position_min, l))};
    }
    if (l.position_max && target > *l.position_max) {
        return Refusal{Reason::out_of_range,
                       fmt::format("target {} is above the axis' position_max {}", in_unit(target, l), in_unit(*l.position_max, l))};
    }
    return std::nullopt;
}

std::optional<Refusal> check_limit(std::string_view what, std::int64_t value, std::optional<std::int64_t> max, const AxisLimits& l,
                                   std::string_view per) {
    if (!max || value <= *max) return std::nullopt;
    return Refusal{Reason::out_of_range,
                   fmt::format("{} {} is above the axis' limit of {}", what, in_unit(value, l, per), in_unit(*max, l, per))};
}

std::optional<Refusal> check_rate(std::string_view what, std::optional<std::int64_t> value, std::optional<std::int64_t> max,
                                  const AxisLimits& l, std::string_view per) {
    if (!value) return std::nullopt;
    constexpr std::int64_t high = std::numeric_limits<std::uint32_t>::max();
    if (*value < 1 || *value > high)
        return Refusal{Reason::out_of_range, fmt::format("{} {} is outside 1..{} increments{}", what, *value, high, per)};
    return check_limit(what, *value, max, l, per);
}
}  // namespace

std::string in_unit(std::int64_t increments, const AxisLimits& l, std::string_view per) {
    if (l.unit.empty()) return fmt::format("{} increments{}", increments, per);
    return fmt::format("{:.6g} {}{}", static_cast<double>(increments) / l.increments_per_unit, l.unit, per);
}

AxisLimits AxisLimits::of(const AxisSpec& a) {
    AxisLimits l;
    l.increments_per_unit = a.increments_per_unit;
    l.unit = a.unit;
    l.position_min = increments(a.position_min, a.increments_per_unit);
    l.position_max = increments(a.position_max, a.increments_per_unit);
    l.velocity_max = increments(a.velocity_max, a.increments_per_unit);
    l.acceleration_max = increments(a.acceleration_max, a.increments_per_unit);
    l.deceleration_min = increments(a.deceleration_min, a.increments_per_unit);
    return l;
}

std::optional<Refusal> guard_move(const Move& m, const AxisLimits& l, std::int64_t position) {
    if (m.kind == Move::Kind::velocity) {
        constexpr std::int64_t high = std::numeric_limits<std::int32_t>::max();
        if (m.target < -high || m.target > high)
            return Refusal{Reason::out_of_range, fmt::format("velocity {} is outside -{}..{} increments/s", m.target, high, high)};
        if (l.velocity_max && std::llabs(m.target) > *l.velocity_max) {
            return Refusal{Reason::out_of_range, fmt::format("velocity {} is above the axis' limit of {}", in_unit(m.target, l, "/s"),
                                                             in_unit(*l.velocity_max, l, "/s"))};
        }
        if ((m.target > 0 && l.position_max && position >= *l.position_max) ||
            (m.target < 0 && l.position_min && position <= *l.position_min)) {
            const bool up = m.target > 0;
            return Refusal{Reason::out_of_range,
                           fmt::format("the axis is at {}, its {} is {}: it may only move the other way", in_unit(position, l),
                                       up ? "position_max" : "position_min", in_unit(up ? *l.position_max : *l.position_min, l))};
        }
    } else {
        std::int64_t target = m.target;
        if (m.kind == Move::Kind::relative && __builtin_add_overflow(position, m.target, &target))
            target = std::numeric_limits<std::int64_t>::max();
        if (auto r = check_position(target, l)) return r;
    }
    if (auto r = check_rate("velocity", m.velocity, l.velocity_max, l, "/s")) return r;
    if (auto r = check_rate("acceleration", m.acceleration, l.acceleration_max, l, "/s^2")) return r;
    return check_rate("deceleration", m.deceleration, l.acceleration_max, l, "/s^2");
}

std::optional<Refusal> guard_rates(const DriveRates& r, const AxisLimits& l) {
    if (auto no = check_limit("velocity", std::llabs(r.velocity), l.velocity_max, l, "/s")) return no;
    if (auto no = check_limit("acceleration", std::llabs(r.acceleration), l.acceleration_max, l, "/s^2")) return no;
    return check_limit("deceleration", std::llabs(r.deceleration), l.acceleration_max, l, "/s^2");
}

void name_rates(Move& m, const AxisLimits& l, const DriveRates& drive) {
    const auto name = [](std::optional<std::int64_t>& named, const std::optional<std::int64_t>& max, std::int64_t own) {
        if (!named && max && *max > 0 && (own == 0 || own > *max))
            named = std::min<std::int64_t>(*max, std::numeric_limits<std::uint32_t>::max());
    };
    if (m.kind != Move::Kind::velocity) name(m.velocity, l.velocity_max, drive.velocity);
    name(m.acceleration, l.acceleration_max, drive.acceleration);
    name(m.deceleration, l.acceleration_max, drive.deceleration);
}

std::optional<Refusal> guard_mode(std::int16_t mode, std::span<const std::int16_t> offered) {
    if (mode == cia402::mode_none) return std::nullopt;
    std::string chosen;  // the allowed modes
    for (const std::int16_t m : offered) {
        if (cia402::is_streamed(m)) continue;
        if (m == mode) return std::nullopt;
        chosen += fmt::format("{}{} ({})", chosen.empty() ? "" : ", ", m, cia402::text_of_mode(m));
    }
    if (std::ranges::find(offered, mode) == offered.end())
        return Refusal{Reason::out_of_range, fmt::format("mode of operation {} ({}) is not offered by this drive; use {}", mode,
                                                         cia402::text_of_mode(mode), chosen)};
    return Refusal{Reason::out_of_range,
                   fmt::format("mode of operation {} ({}) begins with the first streamed set-point and is not written; use {}", mode,
                               cia402::text_of_mode(mode), chosen)};
}

std::optional<Refusal> guard_process_data(const ProcessData& d, const AxisLimits& l) {
    const auto rate = [&](std::string_view what, std::optional<std::uint32_t> v, std::optional<std::int64_t> max,
                          std::string_view per) -> std::optional<Refusal> {
        if (!v || *v == 0) return std::nullopt;  // 0: the drive's own value
        return check_rate(what, static_cast<std::int64_t>(*v), max, l, per);
    };
    if (auto r = rate("profile velocity", d.profile_velocity, l.velocity_max, "/s")) return r;
    if (auto r = rate("profile acceleration", d.profile_acceleration, l.acceleration_max, "/s^2")) return r;
    if (auto r = rate("profile deceleration", d.profile_deceleration, l.acceleration_max, "/s^2")) return r;
    if (d.target_velocity) {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = *d.target_velocity;
        AxisLimits rates = l;  // the position is checked when it moves the axis
        rates.position_min = rates.position_max = std::nullopt;
        return guard_move(m, rates, 0);
    }
    return std::nullopt;
}

}  // namespace axisgate
