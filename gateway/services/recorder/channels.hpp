// The recorded values of an axis, by the names of the table of points, and their place in a row of trends. Rows are stored in files, so
// their members are fixed and listed here again; a channel of the table that is not listed does not compile. An unknown value is empty.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gateway/axis/points.hpp"
#include "gateway/services/recorder/trends.hpp"

namespace axisgate {

/// Rows of the table that have a channel, in the order of the channels.
template <const auto& rows>
consteval auto rows_of_channels() {
    constexpr auto there = [](const AxisPointRow& row) { return row.channel.place != 0; };
    std::array<const AxisPointRow*, static_cast<std::size_t>(std::ranges::count_if(rows, there))> out{};
    std::size_t n = 0;
    for (const auto& row : rows)
        if (there(row)) out[n++] = &row;
    std::ranges::sort(out, {}, [](const AxisPointRow* row) { return row->channel.place; });
    return out;
}
/// Names of the channels: all of them, or only numeric ones.
template <const auto& rows, bool numbers_alone>
consteval auto channel_names() {
    constexpr auto all = rows_of_channels<rows>();
    constexpr auto wanted = [](const AxisPointRow* row) { return !numbers_alone || !row->word; };
    std::array<std::string_view, static_cast<std::size_t>(std::ranges::count_if(all, wanted))> out{};
    std::size_t n = 0;
    for (const auto* row : all)
        if (wanted(row)) out[n++] = row->channel.name;
    return out;
}

inline constexpr auto trend_points = channel_names<axis_point_table, false>();
/// The points for level triggers, each of which has a column in captures.
inline constexpr auto level_points = channel_names<axis_point_table, true>();

/// The place of a channel: in a row; the least and the greatest of a column. Increments; empty: unknown.
struct ChannelPlace {
    std::string_view name;
    std::optional<std::int64_t> (*of)(const TrendRow&);
    std::optional<std::int64_t> (*least)(const TrendColumn&);
    std::optional<std::int64_t> (*greatest)(const TrendColumn&);
};
inline constexpr auto channel_places = std::to_array<ChannelPlace>({
    {"position", [](const TrendRow& r) { return std::optional(r.position); },
     [](const TrendColumn& c) { return std::optional(c.low.position); },
     [](const TrendColumn& c) { return std::optional(c.high.position); }},
    {"velocity", [](const TrendRow& r) { return std::optional(r.velocity); },
     [](const TrendColumn& c) { return std::optional(c.low.velocity); },
     [](const TrendColumn& c) { return std::optional(c.high.velocity); }},
    {"demand", [](const TrendRow& r) { return r.demand_known ? std::optional(r.demand) : std::nullopt; },
     [](const TrendColumn& c) { return c.demand_known ? std::optional(c.low.demand) : std::nullopt; },
     [](const TrendColumn& c) { return c.demand_known ? std::optional(c.high.demand) : std::nullopt; }},
    {"following_error", [](const TrendRow& r) { return r.demand_known ? std::optional(r.following_error()) : std::nullopt; },
     [](const TrendColumn& c) { return c.demand_known ? std::optional(c.least_error) : std::nullopt; },
     [](const TrendColumn& c) { return c.demand_known ? std::optional(c.greatest_error) : std::nullopt; }},
});
static_assert(std::ranges::equal(channel_places, level_points, {}, &ChannelPlace::name),
              "each channel of the table that is a number has its place in a row of trends, in the order of the table's places");

/// "position, velocity, demand"; with `last` "position, velocity or demand".
[[nodiscard]] std::string listed_points(std::span<const std::string_view> names, std::string_view last = ", ");

}  // namespace axisgate
