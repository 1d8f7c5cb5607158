// Turns: whose turn it is on one line: how many exchanges may be on their way, who waits for a place, who has to be looked at, and when.
// In: what each drive wants, exchanges that begin and end, the passing of time. Out: the next drive that may send; the line's deadline.
// One place (RS-485, serial, a TCP connection) or many (CAN). Never sends; never lets silent drives, or polls, or commands starve the
// others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "gateway/core/instant.hpp"
#include "gateway/drive/overtaken.hpp"
#include "gateway/drive/schedule.hpp"

namespace axisgate::drive {

/// What a drive would send if it were given a place now, in the order in which places are given.
enum class Want : std::uint8_t {
    nothing,
    urgent,   ///< a stop: before all that waits. Where a stop need not wait for the exchange in progress (CAN), its family sends it at once
    command,  ///< before polls, but every ninth place is a poll's or a probe's while one waits
    quick_poll,  ///< of an axis that moves: before those of axes that stand, three in a row at most while one of them waits
    poll,
    probe  ///< of a drive that does not answer: in turn with polls, and only within `probe_window`
};

struct TurnRules {
    std::size_t window = 1;        ///< exchanges on their way at once, 1..slot_limit
    std::size_t probe_window = 1;  ///< of these to drives that do not answer, 1..window
    Duration pause{};              ///< silence kept after an answer (`heard`); 0: none
    /// Where the bus and not the order of sending decides who is answered first (CAN): no poll begins while an exchange has been overtaken
    /// by so many others (overtaken.hpp). 0: never held up.
    std::uint32_t overtaken_limit = 0;
    Duration overtaken_grace{};
};

class Turns {
public:
    static constexpr int commands_in_a_row = 8, quick_in_a_row = 3;

    void set(const TurnRules& rules) noexcept;
    [[nodiscard]] const TurnRules& rules() const noexcept { return rules_; }
    /// Nobody wants anything and nothing is on its way: the line went down or came up, or the drives changed (then each is settled anew).
    void forget_wishes() noexcept;
    void line_changed(Instant now) noexcept;
    /// The drive was removed. Its exchange, if there was one, holds no place any more.
    void remove(std::size_t slot) noexcept;

    /// After anything has happened to a drive: what it wants, when it is to be looked at for its own sake (its exchange's deadline), and
    /// when it will want something without being asked (its next poll or probe). The last counts only while it wants nothing and no
    /// exchange of its is on the way.
    void settle(std::size_t slot, Want want, Instant deadline, Instant wish) noexcept;
    /// Who may send now, if anybody: it is to send, or to say that it wants nothing any more, and to be settled.
    [[nodiscard]] std::optional<std::size_t> next(Instant now) noexcept;
    /// The next drive whose deadline has come; it is to be looked at and settled.
    [[nodiscard]] std::optional<std::size_t> due(Instant now) const noexcept;
    /// Of the whole line; `never`: only when something arrives.
    [[nodiscard]] Instant deadline() const noexcept;

    /// An exchange holds a place from here on; one per drive. `probe`: to a drive that does not answer.
    void began(std::size_t slot, bool probe) noexcept;
    void ended(std::size_t slot) noexcept;
    /// Something has arrived: the line's pause begins.
    void received(Instant now) noexcept {
        if (rules_.pause > Duration::zero()) quiet_until_ = now + rules_.pause;
    }
    [[nodiscard]] std::size_t on_their_way() const noexcept { return in_flight_; }

private:
    enum RingOf : std::uint8_t { urgents, commands, quicks, polls, probes, rings };
    enum class Place : std::uint8_t { none, ordinary, probe };
    [[nodiscard]] bool waits(RingOf ring) const noexcept { return !ring_[ring].empty(); }
    [[nodiscard]] bool may_probe() const noexcept { return waits(probes) && probes_in_flight_ < rules_.probe_window; }
    [[nodiscard]] std::optional<RingOf> choose(Instant now) noexcept;
    [[nodiscard]] static bool right(RingOf ring, Want want) noexcept;

    TurnRules rules_;
    DeadlineHeap heap_;
    std::array<Ring, rings> ring_;
    std::array<Want, slot_limit> want_{};
    std::array<std::uint8_t, slot_limit> in_ring_{};  ///< a bit for each ring
    std::array<Place, slot_limit> place_{};
    Overtaken overtaken_;
    std::size_t in_flight_ = 0, probes_in_flight_ = 0;
    Instant quiet_until_{}, now_{};
    int commands_run_ = 0, quick_run_ = 0;
    bool probed_last_ = false;
};

}  // namespace axisgate::drive
