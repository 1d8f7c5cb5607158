// Table is the sequence of the command table (entries of 64 bytes): the entry in progress, the condition that it waits for, and the next
// entry. There is at most one sequence, and an entry takes one cycle. Its commands are carried out by the interpreter.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>

#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

/// One entry of the command table: 64 bytes as on the line.
using TableEntry = std::array<std::uint8_t, 64>;
using TableEntries = std::map<std::uint16_t, TableEntry>;

/// The values that waits and branches compare. Positions are those that the drive reports, in 0.1 um.
struct Watched {
    Point demand, actual;
    double current = 0;  ///< mA
    bool moves = false, in_target = false;
    /// The value for a sub ID of 22h; empty: there is none, and a wait for it ends at once.
    [[nodiscard]] std::optional<double> value(std::uint8_t sub) const;
};

class Table {
public:
    static constexpr Duration cycle = std::chrono::nanoseconds(312'500);  ///< of the interpreter and of monitored conditions
    static constexpr int most_starts =
        16;  ///< entries that start each other at one instant; the next one waits for a cycle, like a linked one

    Table(TableEntries& entries, const Memory& memory) : entries_(entries), memory_(memory) {}

    [[nodiscard]] bool runs() const noexcept { return entry_ != 0; }
    void end() noexcept { entry_ = 0, waiting_ = 0; }

    /// The command of an entry, which is in progress from now on; empty: the entry does not exist, and the sequence has ended.
    [[nodiscard]] std::optional<Bytes> begin(std::uint16_t id, std::uint16_t last);
    /// Its command was carried out; the next entry comes one cycle later.
    void begun(std::uint16_t id, Instant now) noexcept;
    [[nodiscard]] bool may_start() const noexcept { return starts_ < most_starts; }
    /// The next entry by branch or link; empty: this was the last one, and the sequence has ended.
    [[nodiscard]] std::optional<std::uint16_t> next();
    void branch(std::uint16_t to) noexcept { branch_ = to; }
    /// 208h, 209h: writes the bytes of an entry from `at` on; false: the entry does not exist.
    [[nodiscard]] bool change(std::uint16_t id, std::size_t at, std::span<const std::uint8_t> bytes);

    /// 21h and 22h.
    void wait(std::uint16_t header, const Bytes& b, Instant now);
    void edge(bool rising) noexcept { edge_ = edge_ || waiting_ == (rising ? 0x2130 : 0x2140); }
    /// Whether the entry in progress has ended.
    [[nodiscard]] bool over(const Watched& seen, Instant now) const;
    /// When the entry must be checked; `motion_end`: when the axis stands still, `never` while that is not known. Only while an entry is in
    /// progress.
    [[nodiscard]] Instant due(Instant now, Instant motion_end) const noexcept;

private:
    TableEntries& entries_;
    const Memory& memory_;
    std::uint16_t entry_ = 0;  ///< the entry in progress; 0: none
    Instant step_at_ = never;
    std::uint16_t waiting_ = 0;  ///< header of the wait in progress; 0: none
    Bytes wait_bytes_{};
    Instant wait_until_ = never;
    bool edge_ = false;         ///< the edge that it waits for has occurred
    std::uint16_t branch_ = 0;  ///< the entry that a branch has selected
    int starts_ = 0;            ///< entries that have started each other at this instant
};

}  // namespace axisgate::linmot::twin
