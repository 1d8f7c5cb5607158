// BytePace: spreads the bytes of one direction over time as a serial wire would, for a line that has no bit rate of its own.
// It is given instants and byte counts, and returns how many bytes may pass now and when the next ones may. The last byte of a burst
// never passes earlier than the transmission time of the burst allows. A late call loses nothing: all bytes that are due by then pass
// together, as if they were read from the buffer of a serial port.
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
        // The first bytes of a burst never catch up: the bytes after them are timed from the instant at which they really passed.
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
    /// The instant at which the last byte that passed in this burst had crossed the wire: `now` at the latest, earlier if the call comes
    /// late.
    [[nodiscard]] Instant crossed(Instant now) const noexcept { return active() ? std::min(now, origin_ + byte_time_ * passed_) : now; }
    [[nodiscard]] Duration byte_time() const noexcept { return byte_time_; }
    /// Bytes that pass together; 0: no pace.
    [[nodiscard]] std::size_t grain() const noexcept { return static_cast<std::size_t>(step_); }
    /// Until the next bytes may pass; zero: now.
    [[nodiscard]] Duration pause(Instant now) const noexcept {
        if (!active() || !busy_) return {};
        return std::max(Duration{}, origin_ + byte_time_ * (passed_ + step_) - now);
    }
    /// Discards the burst: bytes that were on the wire are lost.
    void stop() noexcept { busy_ = false; }

private:
    Duration byte_time_;
    std::int64_t step_;  ///< bytes that pass together; 0: no pace
    bool busy_ = false;
    Instant origin_{};  ///< when the first bit of this burst was on the wire
    std::int64_t passed_ = 0;
};

}  // namespace axisgate
