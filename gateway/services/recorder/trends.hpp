// The last minutes of every axis: position, demand, velocity, state, at each report of its drive. A period can be read as it is, or reduced
// to columns with first, least, greatest and last value. Bounds: rows older than `keep` are dropped, and the oldest rows of all axes when
// `bound` bytes are reached. Unchanged values take no memory. Between two rows the older one is valid; no value is invented.
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

/// The known values of an axis at one instant. Increments and increments/s.
struct TrendRow {
    Instant at{};
    std::int64_t position = 0, demand = 0, velocity = 0;
    bool demand_known = false;  ///< if false, `demand` has no meaning, and there is no following error
    std::uint16_t statusword = 0, flags = 0;
    [[nodiscard]] std::int64_t following_error() const noexcept { return demand_known ? demand - position : 0; }
    /// True if the drive answered with data that were not too old; otherwise the numbers are the last known ones.
    [[nodiscard]] bool known() const noexcept;
    [[nodiscard]] bool same_values(const TrendRow& o) const noexcept {
        return position == o.position && demand == o.demand && velocity == o.velocity && demand_known == o.demand_known &&
               statusword == o.statusword && flags == o.flags;
    }
};

/// Encodes rows for memory and disk, each as its difference from the previous one; and decodes bytes of any origin.
[[nodiscard]] std::string pack_rows(std::span<const TrendRow> rows);
[[nodiscard]] std::optional<std::vector<TrendRow>> unpack_rows(std::span<const char> bytes);
[[nodiscard]] TrendRow trend_row(const PictureRecord& picture, Instant at) noexcept;

/// A column of a reduced period. `first` was valid when it began, at `first.at`; `last` is the last row in it, valid from `last.at` to the
/// next column. Each member of `low` and `high` is the smallest and greatest known value of that member; their state and flags are the
/// newest ones.
struct TrendColumn {
    TrendRow first, low, high, last;
    std::int64_t least_error = 0, greatest_error = 0;  ///< of following_error()
    bool known = false;                                ///< if false, `low` and `high` have no meaning
    bool demand_known = false;                         ///< if false, the demands of `low` and `high` and the errors have no meaning
    bool gap = false;                                  ///< nothing was known for a part of it
};

struct TrendStretch {
    std::vector<TrendColumn> columns;  ///< not reduced: one row each, which is `first` and `last`
    bool thinned = false;
    double rate_hz = 0;             ///< rate at which the drive has reported its position recently
    std::optional<Instant> oldest;  ///< of the stored rows of this axis
    std::optional<Instant> newest;  ///< when it was last known, changed or not; empty: never
};

class Trends {
public:
    static constexpr std::size_t block_bytes = 4096;

    Trends(std::size_t bound, Duration keep) : bound_(bound), keep_(keep) {}
    void add(AxisId axis, const PictureRecord& picture, Instant at);
    /// Adds earlier rows of an axis for which there are no rows yet, in order of time.
    void restore(AxisId axis, std::span<const TrendRow> rows);
    [[nodiscard]] bool knows(AxisId axis) const noexcept { return axes_.contains(axis); }
    /// Rows from `from` to `to`; the row that is valid at `from` comes first, with that instant. If there are more than `columns` (0: no
    /// bound), they are reduced to this number of columns of equal length.
    [[nodiscard]] TrendStretch read(AxisId axis, Instant from, Instant to, std::size_t columns) const;
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::size_t bound() const noexcept { return bound_; }
    [[nodiscard]] Duration keep() const noexcept { return keep_; }

private:
    struct Block {
        TrendRow head, tail;
        std::string rows;  // behind the head: each with its changes against the previous one
        [[nodiscard]] std::size_t size() const noexcept { return sizeof *this + rows.capacity(); }
    };
    struct Axis {
        std::deque<Block> blocks;
        std::optional<Instant> newest;  // of a known picture
        Instant reported{};             // of a drive's report
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
