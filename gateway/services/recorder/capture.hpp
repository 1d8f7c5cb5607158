// Capture: a short stretch of some axes, each word of their drives, from a little before a trigger to some time behind it.
// In: what shall be caught; pictures and commands with their instants, as they come; the passing of time. Out: rows, and how far it is.
// Bounded: `most_rows` in all; the armed part is a ring, and where the rest is full it is over. Never asks a drive and never looks at a
// clock.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/recorder/trends.hpp"

namespace axisgate {

/// A place in `level_points`; those that the program speaks of itself have names.
enum class CapturePoint : std::uint8_t { position, velocity, demand, following_error };
[[nodiscard]] std::string_view name_of(CapturePoint point) noexcept;
[[nodiscard]] std::optional<CapturePoint> capture_point_named(std::string_view name) noexcept;

/// Words of an axis' state by which a capture may begin: the flags that are triggers in the table of points, such as "moving". 0: there is
/// none of that name.
[[nodiscard]] std::uint16_t capture_state_named(std::string_view name) noexcept;
[[nodiscard]] std::string_view capture_state_name(std::uint16_t state) noexcept;
[[nodiscard]] std::string capture_state_names();

struct CaptureTrigger {
    enum class Kind : std::uint8_t {
        at_once,
        level,   ///< the point crosses `level` in the direction of `rising`
        state,   ///< the flag of `state` comes (`rising`) or goes
        command  ///< a command that moves is given to the axis
    } kind = Kind::at_once;
    AxisId axis = no_axis;  ///< one of the capture's
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
    Duration period = std::chrono::milliseconds(1);  ///< wished; the wire says what there is
    Duration before{}, after = std::chrono::seconds(1);
    Duration wait = std::chrono::minutes(1);  ///< for the trigger; then it is given up
    CaptureTrigger trigger;
    /// Rows that it may need; more than Capture::most_rows is refused by who takes the wish.
    [[nodiscard]] std::size_t rows() const noexcept {
        return axes.size() * static_cast<std::size_t>((before + after) / std::max<Duration>(period, std::chrono::milliseconds(1)) + 1);
    }
};

class Capture {
public:
    static constexpr std::size_t most_rows = 120'000;
    enum class State : std::uint8_t { armed, triggered, done, cancelled };

    Capture(CaptureWish wish, Instant now);
    /// `at`: of the record; the row stands at the instant at which the drive has said it.
    void on_picture(AxisId axis, const PictureRecord& picture, Instant at);
    void on_command(AxisId axis, Instant at);
    /// Ends what has waited or run long enough. Records come a little behind the time: `late` is how much at most.
    void on_time(Instant now, Duration late);
    void cancel(std::string why);
    /// It was done and could not be kept: what was caught goes.
    void lose(std::string why);

    [[nodiscard]] const CaptureWish& wish() const noexcept { return wish_; }
    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool over() const noexcept { return state_ == State::done || state_ == State::cancelled; }
    [[nodiscard]] const std::string& why() const noexcept { return why_; }  ///< why it was cancelled, or ended early
    [[nodiscard]] Instant armed_at() const noexcept { return armed_at_; }
    [[nodiscard]] std::optional<Instant> triggered_at() const noexcept { return triggered_at_; }
    /// In the order of the wish's axes; each in the order of time.
    [[nodiscard]] const std::deque<TrendRow>& rows(std::size_t axis) const { return rows_[axis]; }
    [[nodiscard]] std::size_t rows() const noexcept { return count_; }
    /// How often an axis was told, in Hz, over what was caught of it.
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
