// A short period of some axes with each report of their drives, from a little before a trigger to some time behind it. Bounds: `most_rows`
// in all; the armed part is a ring, and the capture ends when the rest is full. Drives are not polled from here, and there is no clock.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/recorder/trends.hpp"

namespace axisgate {

/// An index in `level_points`; points that the program uses itself have names.
enum class CapturePoint : std::uint8_t { position, velocity, demand, following_error };
[[nodiscard]] std::string_view name_of(CapturePoint point) noexcept;
[[nodiscard]] std::optional<CapturePoint> capture_point_named(std::string_view name) noexcept;

/// States by which a capture may begin: the flags that are triggers in the table of points, such as "moving". 0 if the name does not exist.
[[nodiscard]] std::uint16_t capture_state_named(std::string_view name) noexcept;
[[nodiscard]] std::string_view capture_state_name(std::uint16_t state) noexcept;
[[nodiscard]] std::string capture_state_names();

struct CaptureTrigger {
    enum class Kind : std::uint8_t {
        at_once,
        level,   ///< the point crosses `level` in the direction of `rising`
        state,   ///< the flag of `state` is set (`rising`) or cleared
        command  ///< a moving command is given to the axis
    } kind = Kind::at_once;
    AxisId axis = no_axis;  ///< one of the capture's axes
    CapturePoint point = CapturePoint::position;
    std::int64_t level = 0;  ///< increments, increments/s
    std::uint16_t state = 0;
    bool rising = true;
};

struct CaptureWish {
    static constexpr std::size_t most_axes = 8;
    static constexpr Duration longest = std::chrono::seconds(120);  ///< `before` and `after` together
    static constexpr Duration longest_wait = std::chrono::minutes(5);

    std::vector<AxisId> axes;
    Duration period = std::chrono::milliseconds(1);  ///< requested; the line decides what is possible
    Duration before{}, after = std::chrono::seconds(1);
    Duration wait = std::chrono::minutes(1);  ///< for the trigger; then it is given up
    CaptureTrigger trigger;
    /// Number of rows that it may need; the receiver of the request refuses more than Capture::most_rows.
    [[nodiscard]] std::size_t rows() const noexcept {
        return axes.size() * static_cast<std::size_t>((before + after) / std::max<Duration>(period, std::chrono::milliseconds(1)) + 1);
    }
};

class Capture {
public:
    static constexpr std::size_t most_rows = 120'000;
    enum class State : std::uint8_t { armed, triggered, done, cancelled };

    Capture(CaptureWish wish, Instant now);
    /// `at` is the instant of the record; the row has the instant of the drive's report.
    void on_picture(AxisId axis, const PictureRecord& picture, Instant at);
    void on_command(AxisId axis, Instant at);
    /// Ends a capture that has waited or run long enough. Records arrive a little late: `late` is the maximum.
    void on_time(Instant now, Duration late);
    void cancel(std::string why);
    /// It was done and could not be stored: the rows are discarded.
    void lose(std::string why);

    [[nodiscard]] const CaptureWish& wish() const noexcept { return wish_; }
    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool over() const noexcept { return state_ == State::done || state_ == State::cancelled; }
    [[nodiscard]] const std::string& why() const noexcept { return why_; }  ///< the reason why it was cancelled, or ended early
    [[nodiscard]] Instant armed_at() const noexcept { return armed_at_; }
    [[nodiscard]] std::optional<Instant> triggered_at() const noexcept { return triggered_at_; }
    /// In the order of the requested axes; each in order of time.
    [[nodiscard]] const std::deque<TrendRow>& rows(std::size_t axis) const { return rows_[axis]; }
    [[nodiscard]] std::size_t rows() const noexcept { return count_; }
    /// The rate of reports of an axis in Hz, over its captured period.
    [[nodiscard]] double rate_hz(std::size_t axis) const;

private:
    void trigger(Instant at);
    void shorten(Instant now);
    [[nodiscard]] std::optional<Instant> fires(const TrendRow& was, const TrendRow& is) const;

    CaptureWish wish_;
    State state_ = State::armed;
    std::string why_;
    Instant armed_at_;
    std::optional<Instant> triggered_at_;
    std::vector<std::deque<TrendRow>> rows_;
    std::size_t count_ = 0;
};
[[nodiscard]] std::string_view name_of(Capture::State state) noexcept;

}  // namespace axisgate
