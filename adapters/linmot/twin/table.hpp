// The sequence of the command table: which entry runs, what it waits for, where it goes on.
// In: entries of 64 bytes, waits, branches, what the axis does. Out: the command of the next entry at its instant.
// Never more than one sequence; an entry takes a cycle. It carries out no command.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>

#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

/// One entry of the command table: 64 bytes as the wire has them.
using TableEntry = std::array<std::uint8_t, 64>;
using TableEntries = std::map<std::uint16_t, TableEntry>;

/// What waits and branches look at. Positions are what the drive calls them, in 0.1 um.
struct Watched {
    Point demand, actual;
    double current = 0;  ///< mA
    bool moves = false, in_target = false;
    /// The value of a sub ID of 22h; nothing: there is none, and a wait for it is over.
    [[nodiscard]] std::optional<double> value(std::uint8_t sub) const;
};

class Table {
public:
    static constexpr Duration cycle = std::chrono::nanoseconds(312'500);  ///< of the interpreter and of conditions that are watched
    static constexpr int most_starts =
        16;  ///< entries that start one another at one instant; the next one waits a cycle, as one that is linked

    Table(TableEntries& entries, const Memory& memory) : entries_(entries), memory_(memory) {}

    [[nodiscard]] bool runs() const noexcept { return entry_ != 0; }
    void end() noexcept { entry_ = 0, waiting_ = 0; }

    /// The command of an entry, which runs from here on; nothing: there is none, and the sequence has ended.
    [[nodiscard]] std::optional<Bytes> begin(std::uint16_t id, std::uint16_t last);
    /// Its command is carried out; if it runs still, the next one comes a cycle later.
    void begun(std::uint16_t id, Instant now) noexcept;
    [[nodiscard]] bool may_start() const noexcept { return starts_ < most_starts; }
    /// The entry after this one by branch or link; nothing: it was the last, and the sequence has ended.
    [[nodiscard]] std::optional<std::uint16_t> next();
    void branch(std::uint16_t to) noexcept { branch_ = to; }
    /// 208h, 209h: bytes of an entry from `at` on, as many as it has; false: there is no such entry.
    [[nodiscard]] bool change(std::uint16_t id, std::size_t at, std::span<const std::uint8_t> bytes);

    /// 21h and 22h.
    void wait(std::uint16_t header, const Bytes& b, Instant now);
    void edge(bool rising) noexcept { edge_ = edge_ || waiting_ == (rising ? 0x2130 : 0x2140); }
    /// Whether the running entry is over.
    [[nodiscard]] bool over(const Watched& seen, Instant now) const;
    /// When it is to be looked at; `motion_end`: when the axis stands, `never` while that is not known. While one runs.
    [[nodiscard]] Instant due(Instant now, Instant motion_end) const noexcept;

private:
    TableEntries& entries_;
    const Memory& memory_;
    std::uint16_t entry_ = 0;  ///< that runs; 0: none
    Instant step_at_ = never;
    std::uint16_t waiting_ = 0;  ///< header of the wait that holds it; 0: none
    Bytes wait_bytes_{};
    Instant wait_until_ = never;
    bool edge_ = false;         ///< that it waits for has come
    std::uint16_t branch_ = 0;  ///< entry that a branch has chosen
    int starts_ = 0;            ///< of entries by one another, at this instant
};

}  // namespace axisgate::linmot::twin
