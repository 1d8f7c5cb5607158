// Trends: the last minutes of every axis: position, demand, velocity, state, each time its drive has told them.
// In: pictures with their instants, as they come. Out: a stretch of one axis, whole or thinned to columns of first, least, greatest and
// last. Bounded: rows older than `keep` go, and the oldest of all axes where `bound` bytes are reached. What does not change costs nothing.
// Never asks a drive, and never makes up a value: between two rows the older one holds.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {

/// What was known of an axis at one instant. Increments and increments/s.
struct TrendRow {
    Instant at{};
    std::int64_t position = 0, demand = 0, velocity = 0;
    bool demand_known = false;  ///< else `demand` says nothing, and there is no following error
    std::uint16_t statusword = 0, flags = 0;
    [[nodiscard]] std::int64_t following_error() const noexcept { return demand_known ? demand - position : 0; }
    /// The drive answered and what it had told was not too old; else the numbers are the last ones that were known.
    [[nodiscard]] bool known() const noexcept;
    [[nodiscard]] bool same_values(const TrendRow& o) const noexcept {
        return position == o.position && demand == o.demand && velocity == o.velocity && demand_known == o.demand_known &&
               statusword == o.statusword && flags == o.flags;
    }
};

/// Rows as they lie in memory and on the disk, each as its difference from the one before; and back, of bytes of any origin.
[[nodiscard]] std::string pack_rows(std::span<const TrendRow> rows);
[[nodiscard]] std::optional<std::vector<TrendRow>> unpack_rows(std::span<const char> bytes);
[[nodiscard]] TrendRow trend_row(const PictureRecord& picture, Instant at) noexcept;

/// A column of a thinned stretch. `first` held when it began, at `first.at`; `last` is the last row in it, which holds from `last.at` to
/// the next column. Each member of `low` and `high` is the smallest and greatest of its own, of what was known; their state and flags are
/// the newest ones.
struct TrendColumn {
    TrendRow first, low, high, last;
    std::int64_t least_error = 0, greatest_error = 0;  ///< of following_error()
    bool known = false;                                ///< something was; else `low` and `high` say nothing
    bool demand_known = false;                         ///< a demand was; else the demands of `low` and `high` and the errors say nothing
    bool gap = false;                                  ///< for a part of it nothing was known
};

struct TrendStretch {
    std::vector<TrendColumn> columns;  ///< whole: one row each, which is `first` and `last`
    bool thinned = false;
    double rate_hz = 0;             ///< how often the drive has told its position lately
    std::optional<Instant> oldest;  ///< of what is kept of this axis
    std::optional<Instant> newest;  ///< when it was known last, changed or not; nothing: it never was
};

class Trends {
public:
    static constexpr std::size_t block_bytes = 4096;

    Trends(std::size_t bound, Duration keep) : bound_(bound), keep_(keep) {}
    void add(AxisId axis, const PictureRecord& picture, Instant at);
    /// What was known of an axis of which nothing has been told here yet; in the order of time, before all that comes.
    void restore(AxisId axis, std::span<const TrendRow> rows);
    [[nodiscard]] bool knows(AxisId axis) const noexcept { return axes_.contains(axis); }
    /// Rows from `from` to `to`; the one that holds at `from` comes first, as if it were told then. More than `columns` (0: no bound) are
    /// thinned to so many of equal length.
    [[nodiscard]] TrendStretch read(AxisId axis, Instant from, Instant to, std::size_t columns) const;
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::size_t bound() const noexcept { return bound_; }
    [[nodiscard]] Duration keep() const noexcept { return keep_; }

private:
    struct Block {
        TrendRow head, tail;
        std::string rows;  // behind the head: each what has changed against the one before
        [[nodiscard]] std::size_t size() const noexcept { return sizeof *this + rows.capacity(); }
    };
    struct Axis {
        std::deque<Block> blocks;
        std::optional<Instant> newest;  // of a picture that was known
        Instant reported{};             // of a drive's word
        Instant counted_from{};
        std::uint32_t counted = 0;
        double rate_hz = 0;
    };
    template <class F>
    static void for_each(const Block& block, F&& f);
    void append(Axis& axis, const TrendRow& row);
    void shorten(Axis& axis, Instant now);
    void make_room();

    std::size_t bound_, bytes_ = 0;
    Duration keep_;
    std::map<AxisId, Axis> axes_;
};

}  // namespace axisgate
