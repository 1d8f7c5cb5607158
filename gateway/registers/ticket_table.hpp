// Assigns results to the requests of a door that wait for them. The table is bounded, reports when it is full, and allocates nothing after
// the start. A ticket is never used twice, so a late result of a closed ticket finds no entry.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/engine/door.hpp"
#include "gateway/registers/refusals.hpp"
#include "gateway/registers/unit_map.hpp"

namespace axisgate::registers {

/// The writer of a request, which is informed when one of its commands has ended.
struct WriteOwner {
    virtual void on_written(std::uint8_t slot, AxisId axis, Verdict verdict) = 0;
    virtual ~WriteOwner() = default;
};

class TicketTable {
public:
    struct Waiting {
        WriteOwner* owner = nullptr;  ///< nullptr with map nullptr: the writer has gone
        UnitMap* map = nullptr;
        bool own = false;        ///< a command of the map itself, for which the client does not wait
        std::uint32_t note = 0;  ///< for the map
        std::uint8_t slot = 0;   ///< for the owner
        AxisId axis = no_axis;
        std::shared_ptr<const std::string> who;  ///< the client of a write; empty: a refusal is not reported
        RequestNote request;
    };

    explicit TicketTable(std::size_t capacity);
    /// The number of the door whose tickets these are; must be set before the first open().
    void use_number(DoorNumber number) noexcept { number_ = number; }

    [[nodiscard]] std::size_t free() const noexcept { return entries_.size() - used_; }
    [[nodiscard]] std::size_t used() const noexcept { return used_; }
    /// Requires a free place. Searches the open entries with a later deadline, of which there should be few.
    [[nodiscard]] Ticket open(const Waiting& waiting, Instant deadline);
    /// Removes and returns the entry; empty if the ticket is unknown or closed.
    [[nodiscard]] std::optional<Waiting> close(Ticket ticket);
    /// Removes and returns the entry with the earliest deadline, if it has passed.
    [[nodiscard]] std::optional<Waiting> expired(Instant now);
    [[nodiscard]] Instant next_deadline() const noexcept { return oldest_ == none ? never : entries_[oldest_].deadline; }
    /// Discards the results for which `owner` or `map` waits.
    void forget(const WriteOwner* owner) noexcept;
    void forget(const UnitMap* map) noexcept;

private:
    static constexpr std::uint16_t none = 0xFFFF;
    struct Entry {
        std::uint64_t generation = 0;  // increases with each use of the place; odd while it is used
        Waiting waiting;
        Instant deadline{};
        std::uint16_t older = none, younger = none;  // by deadline while used; `younger` links the free places
    };
    Waiting take(std::uint16_t index);

    DoorNumber number_ = 0;
    std::vector<Entry> entries_;
    std::size_t used_ = 0;
    std::uint16_t free_ = none;
    std::uint16_t oldest_ = none, youngest_ = none;
};

}  // namespace axisgate::registers
