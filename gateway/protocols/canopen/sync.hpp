// SyncProducer: the SYNC messages of a bus at even distances, with a counter if it has one (CiA 301, 7.2.5; objects 1005h, 1006h, 1019h).
// In: period, time. Out: frames, the next deadline, how many were missed. Never sends two at once to make up for a late turn: nodes would
// take them for two cycles; and never drifts: the next one is due by the plan and not by when the last was sent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {

class SyncProducer {
public:
    explicit SyncProducer(std::uint32_t id = sync_id) noexcept : id_(id) {}
    /// `period` 0: off. `overflow` 2..240: the message carries a counter 1..overflow; 0: it is empty.
    void set(Duration period, std::uint8_t overflow, Instant now) noexcept {
        period_ = period;
        overflow_ = overflow;
        counter_ = 0;
        next_ = period_ > Duration{} ? now + period_ : never;
    }
    /// Another period from the last message on, at once if that is over; one that was off begins at once.
    void set_period(Duration period, Instant now) noexcept {
        if (period == period_) return;
        period_ = period;
        next_ = period_ > Duration{} ? std::max(now, last_ + period_) : never;
    }
    [[nodiscard]] Duration period() const noexcept { return period_; }
    [[nodiscard]] Instant deadline() const noexcept { return next_; }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }  ///< cycles that went by before their message could be sent
    [[nodiscard]] std::optional<Frame> on_deadline(Instant now) noexcept {
        if (now < next_) return std::nullopt;
        // One that comes in the second half of its cycle stands for the next one, too.
        const auto behind = (now - next_ + period_ / 2 - Duration(1)) / period_;
        missed_ += static_cast<std::uint64_t>(behind);
        last_ = next_ + period_ * behind;
        next_ = last_ + period_;
        if (overflow_ == 0) return data_frame(id_, {});
        counter_ = counter_ >= overflow_ ? std::uint8_t{1} : static_cast<std::uint8_t>(counter_ + 1);
        return data_frame(id_, std::array<std::uint8_t, 1>{counter_});
    }

private:
    std::uint32_t id_;
    Duration period_{};
    std::uint8_t overflow_ = 0, counter_ = 0;
    Instant next_ = never, last_{};
    std::uint64_t missed_ = 0;
};

}  // namespace axisgate::canopen
