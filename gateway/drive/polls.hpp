// Polls: what is asked again and again, and when: a timer for one thing, a list for many.
// In: periods, the passing of time. Out: what is due, the longest overdue first; when the next will be.
// Never asks twice for what was missed: who is late goes on from now. Never starves one for another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/setup.hpp"

namespace axisgate::drive {

/// The instant of one poll that comes back. It keeps its rhythm while it is asked in time.
class PollTimer {
public:
    void stop() noexcept { next_ = never; }
    void soon(Instant now) noexcept { next_ = now; }
    /// Now, if it is asked at all.
    void hurry() noexcept {
        if (next_ != never) next_ = Instant{};
    }
    /// First at a share of the period by place, so that many drives that start together are not asked together.
    void begin(Instant now, Duration period, std::size_t place) noexcept {
        next_ = now + period * static_cast<std::int64_t>(place % 16) / 16;
    }
    /// It is being asked: again a period after it was due, and never more than a period from now.
    void asked(Instant now, Duration period) noexcept;
    [[nodiscard]] bool due(Instant now) const noexcept { return now >= next_; }
    /// Overdue by a whole period.
    [[nodiscard]] bool late(Instant now, Duration period) const noexcept { return next_ != never && now >= next_ + period; }
    [[nodiscard]] Instant deadline() const noexcept { return next_; }

private:
    Instant next_ = never;
};

/// How often a drive is asked: in its line's rhythm, or in one of its own while an axis of it is looked at closely.
class Pace {
public:
    static constexpr int rested = 4;  ///< an axis that stands waits so many periods

    /// True: it is looked at more closely than before.
    bool take(const DriveSetup& setup) noexcept {
        Duration closest{};
        for (const AxisSetup& a : setup.axes)
            if (a.look_period > Duration::zero() && (closest == Duration::zero() || a.look_period < closest)) closest = a.look_period;
        const bool closer = closest > Duration::zero() && (own_ == Duration::zero() || closest < own_);
        own_ = closest;
        return closer;
    }
    [[nodiscard]] bool close() const noexcept { return own_ > Duration::zero(); }
    /// `line`: the line's period of an axis that moves.
    [[nodiscard]] Duration period(Duration line, bool moves = true) const noexcept {
        if (close()) return std::min(own_, line);
        return moves ? line : rested * line;
    }

private:
    Duration own_{};
};

/// Several things of one drive, or of the channels of one. `Item` is the family's number for "this question about that axis".
class Polls {
public:
    using Item = std::uint32_t;
    static constexpr std::size_t limit = 256;  ///< one more is not taken
    static constexpr int quick_in_a_row = 3;   ///< then one of the others has its turn

    /// Asks `item` every `period`, first at `first`; known ones get the new period and keep their instant if it comes sooner. False: full.
    bool every(Item item, Duration period, Instant first);
    /// Once, before everything else that is due; a known one keeps its period. False: full.
    bool soon(Item item, Instant now);
    /// All of them as soon as there is a place.
    void hurry() noexcept {
        for (Entry& e : entries_)
            e.timer.hurry();
    }
    /// Those of an axis that moves go before those of axes that stand.
    void quick(Item item, bool on) noexcept;
    void drop(Item item) noexcept;
    void clear() noexcept;

    /// What to ask now; its next instant is set. Nothing: nothing is due.
    [[nodiscard]] std::optional<Item> next(Instant now);
    [[nodiscard]] bool due(Instant now) const noexcept { return deadline() <= now; }
    [[nodiscard]] Instant deadline() const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

private:
    struct Entry {
        Item item = 0;
        Duration period{};  ///< 0: once
        PollTimer timer;
        bool quick = false, first = false;
        std::uint64_t asked = 0;  ///< count at which it was asked last: of those due at one instant the one that waited longest
    };
    [[nodiscard]] Entry* find(Item item) noexcept;
    std::vector<Entry> entries_;
    std::uint64_t count_ = 0;
    int quick_run_ = 0;
};

/// The values that are read one after the other when a drive was found: first those that commands rest on, then the rest.
class Reading {
public:
    static constexpr int tries = 2;  ///< silences after which one is given up and stays unknown

    /// `core` of `all` first.
    void begin(std::size_t core, std::size_t all) noexcept { *this = Reading(core, all); }
    Reading() noexcept = default;
    [[nodiscard]] bool pending() const noexcept { return at_ < all_; }
    [[nodiscard]] bool core_pending() const noexcept { return at_ < core_; }
    [[nodiscard]] std::size_t at() const noexcept { return at_; }
    /// This one could not be had, although the drive answers others.
    [[nodiscard]] bool given_up() const noexcept { return silent_ >= tries; }
    void silent() noexcept { ++silent_; }
    /// Read, refused or given up. True: it was the last of the core.
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
