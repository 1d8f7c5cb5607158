// BytePace: the wire time of one direction of a line that has no rate of its own: which bytes have arrived by now.
// In: instants and byte counts. Out: how many bytes may pass, and when the next ones may.
// Never lets the last byte of a burst pass earlier than its first by less than the bytes between them take; being called late costs
// nothing: the bytes that are due by then pass together, as out of the buffer of a serial port.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "gateway/core/instant.hpp"

namespace axisgate {

class BytePace {
public:
    /// `byte_time` zero or less: everything passes at once. `grain`: at least this much passes together, so that a fast line does not cost
    /// a timer for each byte.
    explicit BytePace(Duration byte_time = {}, Duration grain = std::chrono::milliseconds(1)) noexcept
        : byte_time_(byte_time), step_(byte_time > Duration::zero() ? std::max<std::int64_t>(1, grain / byte_time) : 0) {}

    [[nodiscard]] bool active() const noexcept { return step_ != 0; }
    /// Bytes that may pass now. On a quiet wire this begins a burst: the first byte passes one byte time from now.
    [[nodiscard]] std::size_t room(Instant now) noexcept {
        if (!active()) return std::numeric_limits<std::size_t>::max();
        if (!busy_) {
            busy_ = true;
            origin_ = now;
            passed_ = 0;
        }
        const std::int64_t due = (now - origin_) / byte_time_ - passed_;
        // The first bytes of a burst never catch up: what comes after them is timed from when they really passed.
        return static_cast<std::size_t>(std::max<std::int64_t>(0, passed_ == 0 ? std::min(due, step_) : due));
    }
    /// So many bytes have passed; `more`: others wait behind them, else the wire is quiet again.
    void pass(std::size_t bytes, bool more, Instant now) noexcept {
        if (!active()) return;
        const auto n = static_cast<std::int64_t>(bytes);
        if (passed_ == 0 && n > 0) origin_ = now - byte_time_ * n;
        passed_ += n;
        busy_ = more;
    }
    /// When the last of the bytes that have passed in this burst had crossed: at `now` at the latest, and earlier for who asks late.
    [[nodiscard]] Instant crossed(Instant now) const noexcept { return active() ? std::min(now, origin_ + byte_time_ * passed_) : now; }
    [[nodiscard]] Duration byte_time() const noexcept { return byte_time_; }
    /// Bytes that pass together; 0: no pace.
    [[nodiscard]] std::size_t grain() const noexcept { return static_cast<std::size_t>(step_); }
    /// Until the next bytes may pass; zero: now.
    [[nodiscard]] Duration pause(Instant now) const noexcept {
        if (!active() || !busy_) return {};
        return std::max(Duration{}, origin_ + byte_time_ * (passed_ + step_) - now);
    }
    /// What was on its way is lost.
    void stop() noexcept { busy_ = false; }

private:
    Duration byte_time_;
    std::int64_t step_;  ///< bytes that pass together; 0: no pace
    bool busy_ = false;
    Instant origin_{};  ///< when the first bit of this burst was on the wire
    std::int64_t passed_ = 0;
};

}  // namespace axisgate
