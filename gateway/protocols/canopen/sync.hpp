// SyncProducer: the SYNC messages of a bus at equal intervals, with an optional counter (CiA 301, 7.2.5; objects 1005h, 1006h, 1019h).
// It returns frames, the next deadline and the number of missed messages. After a late turn it does not send two at once, because nodes
// would take them for two cycles. It does not drift: the next message is due by the schedule, not by the time of the last one.
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
    /// Changes the period from the last message on; the next one is due at once if that time is over, or if SYNC was off.
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
        // A message that is sent in the second half of its cycle counts for the next cycle, too.
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
