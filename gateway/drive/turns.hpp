// Turns decides which drive of a line may send next. A line has one place for exchanges (RS-485, serial, a TCP connection) or several
// (CAN). Stops come first; the rules below make sure that silent drives, polls and commands cannot delay each other for ever. Turns also
// holds the deadlines of the drives.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "gateway/core/instant.hpp"
#include "gateway/drive/overtaken.hpp"
#include "gateway/drive/schedule.hpp"

namespace axisgate::drive {

/// The request that a drive would send next, in the order of priority.
enum class Want : std::uint8_t {
    nothing,
    urgent,   ///< a stop: before all waiting requests. If it need not wait for the exchange in progress (CAN), the family sends it at once
    command,  ///< before polls, but every ninth place goes to a poll or probe if one waits
    quick_poll,  ///< poll of a moving axis: before axes at standstill, at most three in succession while one of those waits
    poll,
    probe  ///< of a drive that does not answer: alternates with polls, and only within `probe_window`
};

struct TurnRules {
    std::size_t window = 1;        ///< exchanges in progress at once, 1..slot_limit
    std::size_t probe_window = 1;  ///< of these, exchanges with drives that do not answer, 1..window
    Duration pause{};              ///< silence after an answer (`received`); 0: none
    /// For buses on which arbitration decides which drive is answered first (CAN): no poll begins while a request has been overtaken by
    /// this number of newer ones (overtaken.hpp). 0: polls are never delayed.
    std::uint32_t overtaken_limit = 0;
    Duration overtaken_grace{};
};

class Turns {
public:
    static constexpr int commands_in_a_row = 8, quick_in_a_row = 3;

    void set(const TurnRules& rules) noexcept;
    [[nodiscard]] const TurnRules& rules() const noexcept { return rules_; }
    /// Forgets all wishes and exchanges: the line went down or came up, or the drives changed (then each of them is settled again).
    void forget_wishes() noexcept;
    void line_changed(Instant now) noexcept;
    /// The drive was removed; its exchange, if there was one, no longer occupies a place.
    void remove(std::size_t slot) noexcept;

    /// To be called after each change of a drive: the kind of request that it would send, the deadline of its exchange, and the time of its
    /// next poll or probe (`wish`). `wish` counts only while `want` is nothing and the drive has no exchange in progress.
    void settle(std::size_t slot, Want want, Instant deadline, Instant wish) noexcept;
    /// The drive that may send now, if any. The caller lets it send and then settles it.
    [[nodiscard]] std::optional<std::size_t> next(Instant now) noexcept;
    /// The next drive whose deadline has expired. The caller calls it and then settles it.
    [[nodiscard]] std::optional<std::size_t> due(Instant now) const noexcept;
    /// The earliest deadline of the line; `never`: only a received frame can change anything.
    [[nodiscard]] Instant deadline() const noexcept;

    /// An exchange occupies a place from now on; at most one per drive. `probe`: the drive does not answer at present.
    void began(std::size_t slot, bool probe) noexcept;
    void ended(std::size_t slot) noexcept;
    /// A frame was received: the pause of the line begins.
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
    std::array<std::uint8_t, slot_limit> in_ring_{};  ///< one bit for each ring
    std::array<Place, slot_limit> place_{};
    Overtaken overtaken_;
    std::size_t in_flight_ = 0, probes_in_flight_ = 0;
    Instant quiet_until_{}, now_{};
    int commands_run_ = 0, quick_run_ = 0;
    bool probed_last_ = false;
};

}  // namespace axisgate::drive
