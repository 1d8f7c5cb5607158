// Ticket table: which answer waits for which Command of this door.
// In: who waits and until when. Out: a ticket; later, who it was. Bounded; a full table is told, and nothing is allocated after start.
// Never gives a ticket twice: a late result of a forgotten ticket finds nobody.
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

/// Who asked, told when one of its commands has ended.
struct WriteOwner {
    virtual void on_written(std::uint8_t slot, AxisId axis, Verdict verdict) = 0;
    virtual ~WriteOwner() = default;
};

class TicketTable {
public:
    struct Waiting {
        WriteOwner* owner = nullptr;  ///< nullptr with map nullptr: the one who asked has gone
        UnitMap* map = nullptr;
        bool own = false;        ///< asked by the map: the client does not wait for it
        std::uint32_t note = 0;  ///< for the map
        std::uint8_t slot = 0;   ///< for the owner
        AxisId axis = no_axis;
        std::shared_ptr<const std::string> who;  ///< of a client's write; else nobody is told that it was refused
        RequestNote request;
    };

    explicit TicketTable(std::size_t capacity);
    /// Number of the door whose tickets these are; before the first open().
    void use_number(DoorNumber number) noexcept { number_ = number; }

    [[nodiscard]] std::size_t free() const noexcept { return entries_.size() - used_; }
    [[nodiscard]] std::size_t used() const noexcept { return used_; }
    /// There must be a free place. Looks at the open ones with a later deadline, of which there should be few.
    [[nodiscard]] Ticket open(const Waiting& waiting, Instant deadline);
    /// Takes the entry out; nothing if the ticket is not (or no longer) known.
    [[nodiscard]] std::optional<Waiting> close(Ticket ticket);
    /// Takes out the entry with the earliest deadline if that has come.
    [[nodiscard]] std::optional<Waiting> expired(Instant now);
    [[nodiscard]] Instant next_deadline() const noexcept { return oldest_ == none ? never : entries_[oldest_].deadline; }
    /// The results of everything that `owner` or `map` waits for go to nobody.
    void forget(const WriteOwner* owner) noexcept;
    void forget(const UnitMap* map) noexcept;

private:
    static constexpr std::uint16_t none = 0xFFFF;
    struct Entry {
        std::uint64_t generation = 0;  // counts up with each use of the place; odd while it is used
        Waiting waiting;
        Instant deadline{};
        std::uint16_t older = none, younger = none;  // by deadline while used; `younger` chains the free places
    };
    Waiting take(std::uint16_t index);

    DoorNumber number_ = 0;
    std::vector<Entry> entries_;
    std::size_t used_ = 0;
    std::uint16_t free_ = none;
    std::uint16_t oldest_ = none, youngest_ = none;
};

}  // namespace axisgate::registers
