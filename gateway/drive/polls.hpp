// Polls decides what is read periodically, and when: PollTimer for one value, Polls for many. A poll that was missed is not made up for,
// and the item that is longest overdue comes first, so that no item is delayed for ever by another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/setup.hpp"

namespace axisgate::drive {

/// The time of one periodic poll. The period is kept as long as the polls are sent in time.
class PollTimer {
public:
    void stop() noexcept { next_ = never; }
    void soon(Instant now) noexcept { next_ = now; }
    /// Makes the poll due now, if it is active.
    void hurry() noexcept {
        if (next_ != never) next_ = Instant{};
    }
    /// Delays the first poll by a part of the period that depends on `place`, so that drives that start together are not polled together.
    void begin(Instant now, Duration period, std::size_t place) noexcept {
        next_ = now + period * static_cast<std::int64_t>(place % 16) / 16;
    }
    /// The poll is being sent. The next one is due one period after this one was due, but not more than one period from now.
    void asked(Instant now, Duration period) noexcept;
    [[nodiscard]] bool due(Instant now) const noexcept { return now >= next_; }
    /// True if the poll is overdue by a whole period.
    [[nodiscard]] bool late(Instant now, Duration period) const noexcept { return next_ != never && now >= next_ + period; }
    [[nodiscard]] Instant deadline() const noexcept { return next_; }

private:
    Instant next_ = never;
};

/// The poll period of a drive: that of its line, or a shorter one while a client observes one of its axes closely.
class Pace {
public:
    static constexpr int rested = 4;  ///< an axis at standstill is polled every `rested` periods

    /// Returns true if the drive is now observed more closely than before.
    bool take(const DriveSetup& setup) noexcept {
        Duration closest{};
        for (const AxisSetup& a : setup.axes)
            if (a.look_period > Duration::zero() && (closest == Duration::zero() || a.look_period < closest)) closest = a.look_period;
        const bool closer = closest > Duration::zero() && (own_ == Duration::zero() || closest < own_);
        own_ = closest;
        return closer;
    }
    [[nodiscard]] bool close() const noexcept { return own_ > Duration::zero(); }
    /// `line` is the line's poll period for a moving axis.
    [[nodiscard]] Duration period(Duration line, bool moves = true) const noexcept {
        if (close()) return std::min(own_, line);
        return moves ? line : rested * line;
    }

private:
    Duration own_{};
};

/// The periodic reads of one drive, or of the channels of one drive. `Item` is the family's number for a value of an axis.
class Polls {
public:
    using Item = std::uint32_t;
    static constexpr std::size_t limit = 256;  ///< a further item is not accepted
    static constexpr int quick_in_a_row = 3;   ///< then one of the other items is polled

    /// Polls `item` every `period`, beginning at `first`. An item that is known gets the new period, and keeps its next time if that is
    /// earlier. False: the list is full.
    bool every(Item item, Duration period, Instant first);
    /// Reads `item` once, before all others that are due. An item that is known keeps its period. False: the list is full.
    bool soon(Item item, Instant now);
    /// Makes all items due now.
    void hurry() noexcept {
        for (Entry& e : entries_)
            e.timer.hurry();
    }
    /// Items of a moving axis are polled before those of an axis at standstill.
    void quick(Item item, bool on) noexcept;
    void drop(Item item) noexcept;
    void clear() noexcept;

    /// The item to read now; its next time is set. Empty if no item is due.
    [[nodiscard]] std::optional<Item> next(Instant now);
    [[nodiscard]] bool due(Instant now) const noexcept { return deadline() <= now; }
    [[nodiscard]] Instant deadline() const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

private:
    struct Entry {
        Item item = 0;
        Duration period{};  ///< 0: read once
        PollTimer timer;
        bool quick = false, first = false;
        std::uint64_t asked = 0;  ///< value of the counter when the item was read last: of the items due at one instant, the one that has
                                  ///< waited longest comes first
    };
    [[nodiscard]] Entry* find(Item item) noexcept;
    std::vector<Entry> entries_;
    std::uint64_t count_ = 0;
    int quick_run_ = 0;
};

/// The values that are read one after the other after a drive was found: first those that commands need, then the others.
class Reading {
public:
    static constexpr int tries = 2;  ///< time-outs after which a value is skipped and remains unknown

    /// The first `core` of `all` values are those that commands need.
    void begin(std::size_t core, std::size_t all) noexcept { *this = Reading(core, all); }
    Reading() noexcept = default;
    [[nodiscard]] bool pending() const noexcept { return at_ < all_; }
    [[nodiscard]] bool core_pending() const noexcept { return at_ < core_; }
    [[nodiscard]] std::size_t at() const noexcept { return at_; }
    /// True if this value could not be read although the drive answers other requests.
    [[nodiscard]] bool given_up() const noexcept { return silent_ >= tries; }
    void silent() noexcept { ++silent_; }
    /// The value was read, refused or skipped. Returns true if it was the last one that commands need.
    bool done() noexcept {
        silent_ = 0;
        if (at_ < all_) ++at_;
        return at_ == core_;
    }

private:
    Reading(std::size_t core, std::size_t all) noexcept : core_(core), all_(all) {}
    std::size_t core_ = 0, all_ = 0, at_ = 0;
    int silent_ = 0;
};

}  // namespace axisgate::drive
