// Twin: the drive's side of a line: frames in, frames out, with a second door for the tester's hand.
// In: frames, time, the hand. Out: frames; its non-volatile memory as named values.
// Never includes an adapter or its packing code: it is a second reading of the manual. No clock, thread, socket or log.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gateway/core/adapter.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/core/setup.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

/// A drive's non-volatile memory, by the drive's own names. Kept by the store and by `axisgate twin --state`.
using NonVolatile = std::map<std::string, Value>;
/// A whole number of the memory; `fallback` where there is none, or one that is out of the bounds.
[[nodiscard]] inline std::int64_t integer_in(const NonVolatile& memory, const std::string& name, std::int64_t fallback,
                                             std::int64_t low = INT64_MIN, std::int64_t high = INT64_MAX) {
    const auto it = memory.find(name);
    const std::int64_t v = it == memory.end() ? fallback : as_integer(it->second).value_or(fallback);
    return v < low || v > high ? fallback : v;
}

/// One outside condition that a tester can set. The same names serve all families:
///   power (bool), silent (bool: hears, does not answer), stall (bool: the shaft is held), inputs (bit mask), limit_positive,
///   limit_negative, home_switch (bool), temperature (deg C), inject_error (code; 0 clears), position (increments: moved by hand),
///   load (0..1), and what a family adds.
struct HandItem {
    std::string name;
    Value value;
    bool writable = true;
    std::string description;
};

struct TwinSetup {
    std::string address;  ///< in the family's own form
    int axes = 1;         ///< channels that the site uses; a family may build more
    LineKind kind = LineKind::bytes;
    std::uint32_t bit_rate = 0;
    std::map<std::string, std::string> options;
};

/// The true state of the simulated mechanics of one channel, for tests and the page; never a way round the wire.
struct TwinMechanics {
    double position = 0;  ///< increments
    double velocity = 0;  ///< increments/s
    bool powered = false;
};

/// Which frames of a CAN bus a twin listens to at all, as the acceptance filters of a CAN controller: those with (id & mask) == value for
/// one of the filters. Without a filter every frame. It spares a busy bus of many nodes a call per frame and node.
struct Acceptance {
    struct Filter {
        std::uint32_t mask = 0;
        std::uint32_t value = 0;
        bool operator==(const Filter&) const = default;
    };
    std::array<Filter, 3> filters{};
    std::size_t size = 0;

    [[nodiscard]] bool takes(std::uint32_t id) const noexcept {
        for (std::size_t i = 0; i < size; ++i) {
            if ((id & filters[i].mask) == filters[i].value) return true;
        }
        return size == 0;
    }
    bool operator==(const Acceptance&) const = default;
};

/// Evaluates motion in closed form at the asked time: a twin that nobody asks costs nothing.
struct Twin {
    /// Frames of its Out alone are used. The twin hears every frame that its acceptance takes, and ignores what is not for it.
    virtual void on_frame(const Frame& frame, Instant now, Out& out) = 0;
    /// Asked after each call. Never narrower than what the twin answers to.
    [[nodiscard]] virtual Acceptance acceptance() const noexcept { return {}; }
    virtual void on_deadline(Instant now, Out& out) = 0;
    [[nodiscard]] virtual Instant deadline() const = 0;

    /// Power on at `now` with this memory (empty: factory state). Called once before anything else, and to restore.
    virtual void power_on(const NonVolatile& memory, Instant now, Out& out) = 0;
    [[nodiscard]] virtual NonVolatile non_volatile() const = 0;
    /// The site uses this many channels from now on. True: they are there, and nothing else has changed; false: the twin must be built
    /// anew.
    [[nodiscard]] virtual bool fit_axes(int axes, Instant now) { return (void)axes, (void)now, false; }
    /// Grows by one with each change of the non-volatile memory: tells when to save it.
    [[nodiscard]] virtual std::uint64_t non_volatile_revision() const = 0;

    [[nodiscard]] virtual std::vector<HandItem> hand() const = 0;
    /// Sets one condition; the empty string, or what is wrong with it and what would be right.
    [[nodiscard]] virtual std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) = 0;
    [[nodiscard]] virtual TwinMechanics mechanics(int channel, Instant now) const = 0;
    virtual ~Twin() = default;
};

}  // namespace axisgate
