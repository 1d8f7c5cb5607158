// Overtaken keeps a full CAN bus fair: it delays polls while an outstanding request has been overtaken by several newer ones. It never
// delays commands or stops, and delays polls only until the bus has shown that the drive does not answer.
#pragma once

#include <array>
#include <cstdint>

#include "gateway/core/instant.hpp"
#include "gateway/drive/schedule.hpp"

namespace axisgate::drive {

/// CAN transmits the frame with the lowest identifier first. On a full bus the answers with high identifiers would never be transmitted,
/// and their exchanges would occupy all places but one. Therefore an adapter starts no poll while an outstanding request has been overtaken
/// by `limit` newer ones. If the request is still open after the bus was free of other exchanges for `grace`, the drive is silent and the
/// bus is not the cause; other polls then need not wait for its time-out.
class Overtaken {
public:
    void set(std::uint32_t limit, Duration grace) noexcept {
        limit_ = limit;
        grace_ = grace;
    }
    void began(std::size_t slot) noexcept {
        ++started_;
        alone_since_ = never;
        if (size_ < open_.size()) open_[size_++] = {started_, static_cast<std::uint16_t>(slot), false};
    }
    void ended(std::size_t slot) noexcept {
        for (std::size_t i = 0; i < size_; ++i) {
            if (open_[i].slot != slot) continue;
            open_[i] = open_[--size_];
            return;
        }
    }
    void clear() noexcept {
        size_ = 0;
        alone_since_ = never;
    }

    /// True if an exchange that can wait may begin at `now`.
    [[nodiscard]] bool may_begin(Instant now) noexcept {
        std::size_t behind = 0, had_their_chance = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            if (open_[i].had_its_chance) {
                ++had_their_chance;
            } else if (started_ - open_[i].number >= limit_) {
                ++behind;
            }
        }
        if (behind == 0 || behind + had_their_chance < size_) {
            alone_since_ = never;  // the overtaken exchange has ended or is not alone any more; an expired deadline must not remain
            return behind == 0;    // if false: the caller asks again when another exchange ends
        }
        if (alone_since_ == never) alone_since_ = now;
        if (now < alone_since_ + grace_) return false;
        for (std::size_t i = 0; i < size_; ++i)
            open_[i].had_its_chance = true;
        alone_since_ = never;
        return true;
    }
    /// When to call may_begin again even if no exchange has ended; `never`: only after one has ended.
    [[nodiscard]] Instant deadline() const noexcept { return alone_since_ == never ? never : alone_since_ + grace_; }

private:
    struct Open {
        std::uint64_t number;
        std::uint16_t slot;
        bool had_its_chance;
    };
    std::array<Open, slot_limit> open_{};
    std::size_t size_ = 0;
    std::uint64_t started_ = 0;
    std::uint32_t limit_ = 16;
    Duration grace_ = std::chrono::milliseconds(2);
    Instant alone_since_ = never;
};

}  // namespace axisgate::drive
