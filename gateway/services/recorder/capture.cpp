// An armed ring, a trigger, and a period behind it. No value between two reports of a drive is invented, except the instant of the trigger.
#include "gateway/services/recorder/capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/axis/points.hpp"
#include "gateway/services/recorder/channels.hpp"

namespace axisgate {
static_assert(level_points[static_cast<std::size_t>(CapturePoint::position)] == "position" &&
              level_points[static_cast<std::size_t>(CapturePoint::following_error)] == "following_error");
namespace {
/// Empty if it is unknown.
std::optional<std::int64_t> value_of(const TrendRow& r, CapturePoint point) {
    return channel_places[static_cast<std::size_t>(point)].of(r);
}
}  // namespace

std::string_view name_of(CapturePoint point) noexcept { return level_points[static_cast<std::size_t>(point)]; }
std::optional<CapturePoint> capture_point_named(std::string_view name) noexcept {
    const auto it = std::ranges::find(level_points, name);
    return it == level_points.end() ? std::nullopt : std::optional(static_cast<CapturePoint>(it - level_points.begin()));
}
std::uint16_t capture_state_named(std::string_view name) noexcept {
    const auto* row = point_named(name);
    return row && row->trigger ? row->flag : std::uint16_t{0};
}
std::string_view capture_state_name(std::uint16_t state) noexcept {
    const auto it = std::ranges::find_if(axis_point_table, [state](const AxisPointRow& row) { return row.trigger && row.flag == state; });
    return it == axis_point_table.end() ? std::string_view() : it->name;
}
std::string capture_state_names() {
    std::vector<std::string_view> names;
    for (const auto& row : axis_point_table)
        if (row.trigger) names.push_back(row.name);
    return listed_points(names);
}
std::string_view name_of(Capture::State state) noexcept {
    constexpr std::array<std::string_view, 4> names{"armed", "triggered", "done", "cancelled"};
    return names[static_cast<std::size_t>(state)];
}

Capture::Capture(CaptureWish wish, Instant now) : wish_(std::move(wish)), armed_at_(now), rows_(wish_.axes.size()) {
    if (wish_.trigger.kind == CaptureTrigger::Kind::at_once) trigger(now);
}

void Capture::trigger(Instant at) {
    triggered_at_ = at;
    state_ = State::triggered;
}

std::optional<Instant> Capture::fires(const TrendRow& was, const TrendRow& is) const {
    const CaptureTrigger& t = wish_.trigger;
    if (t.kind == CaptureTrigger::Kind::state) {
        const bool before = (was.flags & t.state) != 0, now = (is.flags & t.state) != 0;
        return before != now && now == t.rising ? std::optional(is.at) : std::nullopt;
    }
    if (t.kind != CaptureTrigger::Kind::level) return std::nullopt;
    const auto a = value_of(was, t.point), b = value_of(is, t.point);
    if (!a || !b) return std::nullopt;
    if (!(t.rising ? *a < t.level && *b >= t.level : *a > t.level && *b <= t.level)) return std::nullopt;
    const double share = static_cast<double>(t.level - *a) / static_cast<double>(*b - *a);
    return was.at + Duration(static_cast<std::int64_t>(share * static_cast<double>((is.at - was.at).count())));
}

void Capture::on_picture(AxisId axis, const PictureRecord& p, Instant at) {
    if (over() || !p.current) return;
    const auto it = std::ranges::find(wish_.axes, axis);
    if (it == wish_.axes.end()) return;
    auto& rows = rows_[static_cast<std::size_t>(it - wish_.axes.begin())];
    TrendRow row = trend_row(p, at - p.age);
    if (row.at < armed_at_) row.at = armed_at_;  // the earlier report is valid when the capture begins
    const std::optional<TrendRow> was = rows.empty() ? std::nullopt : std::optional(rows.back());
    if (was) row.at = std::max(row.at, was->at);
    if (triggered_at_ && row.at > *triggered_at_ + wish_.after) return;
    if (was && was->at == row.at) {
        rows.back() = row;
    } else {
        if (count_ >= most_rows) {
            if (state_ == State::triggered) {
                why_ = fmt::format("{} rows are full: it ends earlier than was wished", most_rows);
                state_ = State::done;
                return;
            }
            auto& longest = *std::ranges::max_element(rows_, {}, [](const auto& r) { return r.size(); });
            longest.pop_front();
            --count_;
        }
        rows.push_back(row);
        ++count_;
    }
    if (state_ != State::armed) return;
    if (axis == wish_.trigger.axis && was) {
        if (const auto when = fires(*was, row)) trigger(*when);
    }
    shorten(row.at);
}

/// Keeps for each axis the row that is valid at the begin of the capture.
void Capture::shorten(Instant now) {
    const Instant from = triggered_at_.value_or(now) - wish_.before;
    for (auto& rows : rows_) {
        while (rows.size() > 1 && rows[1].at <= from) {
            rows.pop_front();
            --count_;
        }
    }
}

void Capture::on_command(AxisId axis, Instant at) {
    if (state_ != State::armed || wish_.trigger.kind != CaptureTrigger::Kind::command || axis != wish_.trigger.axis) return;
    trigger(at);
    shorten(at);
}

void Capture::on_time(Instant now, Duration late) {
    if (state_ == State::triggered && now >= *triggered_at_ + wish_.after + late) state_ = State::done;
    if (state_ == State::armed && now >= armed_at_ + wish_.wait + late)
        cancel(fmt::format("the trigger did not come within {} s", std::chrono::duration_cast<std::chrono::seconds>(wish_.wait).count()));
}

void Capture::cancel(std::string why) {
    if (over()) return;
    why_ = std::move(why);
    state_ = State::cancelled;
}

void Capture::lose(std::string why) {
    for (auto& rows : rows_)
        rows.clear();
    count_ = 0;
    why_ = std::move(why);
    state_ = State::cancelled;
}

double Capture::rate_hz(std::size_t axis) const {
    const auto& rows = rows_[axis];
    if (rows.size() < 3) return 0;
    const double span = std::chrono::duration<double>(rows.back().at - rows[1].at).count();
    return span > 0 ? static_cast<double>(rows.size() - 2) / span : 0;
}

}  // namespace axisgate
