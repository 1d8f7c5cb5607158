// Overtaken: keeps a full bus fair: who has waited for an answer while many others got theirs?
// In: exchanges that begin and end, time. Out: whether something that can wait may be sent now, and when to ask again.
// Never holds up commands or stops, and never for longer than the bus needs to show that nobody answers.
#pragma once

#include <array>
#include <cstdint>

#include "gateway/core/instant.hpp"
#include "gateway/drive/schedule.hpp"

namespace axisgate::drive {

/// A CAN bus serves the lowest identifier first, and on a full one that goes on without end: the answers of high IDs would never come, and
/// their exchanges would hold all places but one. So no poll begins while an exchange has been overtaken by `limit` others. If it is still
/// open when nothing else is, and the bus was left to it for `grace`, then it is not the bus that holds it up (its drive is silent), and
/// the others need not wait for its time-out.
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

    /// May something that can wait begin at `now`?
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
            alone_since_ = never;  // whose grace it was has ended, or is not alone any more: a deadline that is over must not stay
            return behind == 0;    // else asked again when one of the others ends
        }
        if (alone_since_ == never) alone_since_ = now;
        if (now < alone_since_ + grace_) return false;
        for (std::size_t i = 0; i < size_; ++i)
            open_[i].had_its_chance = true;
        alone_since_ = never;
        return true;
    }
    /// When to ask may_begin again although nothing has ended; `never`: only then.
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
