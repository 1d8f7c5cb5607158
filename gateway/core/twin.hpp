// The drive's side of a line: frames in, frames out, and the tester's hand. A twin never includes an adapter or its packing code, because
// it is a second reading of the manual. It has no clock, thread, socket or log.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gateway/core/adapter.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/core/freedom.hpp"
#include "gateway/core/setup.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

/// A drive's non-volatile memory, by the drive's own names. The store and `axisgate twin --state` keep it.
using NonVolatile = std::map<std::string, Value>;
/// A whole number of the memory; `fallback` if it is absent or out of the bounds.
[[nodiscard]] inline std::int64_t integer_in(const NonVolatile& memory, const std::string& name, std::int64_t fallback,
                                             std::int64_t low = INT64_MIN, std::int64_t high = INT64_MAX) {
    const auto it = memory.find(name);
    const std::int64_t v = it == memory.end() ? fallback : as_integer(it->second).value_or(fallback);
    return v < low || v > high ? fallback : v;
}

/// One external condition that a tester can set. The same names apply to all families:
///   power (bool), silent (bool: receives, does not answer), stall (bool: the shaft is held), inputs (bit mask), limit_positive,
///   limit_negative, home_switch (bool), temperature (deg C), inject_error (code; 0 clears), position (increments: moved by hand),
///   load (0..1), and conditions that a family adds.
struct HandItem {
    std::string name;
    Value value;
    bool writable = true;
    std::string description;
};

struct TwinSetup {
    std::string address;  ///< in the family's own form
    int axes = 1;         ///< number of channels that the site uses; a family may build more
    LineKind kind = LineKind::bytes;
    std::uint32_t bit_rate = 0;
    std::map<std::string, std::string> options;
    FreedomValues freedoms{};  ///< the specimen that the twin is; an absent freedom has the page's default
    std::uint64_t seed = 0;    ///< for behaviour that changes from message to message (specimen_draw)
};

/// The true state of the simulated mechanics of one channel, for tests and the page; adapters must not use it.
struct TwinMechanics {
    double position = 0;  ///< increments
    double velocity = 0;  ///< increments/s
    bool powered = false;
};

/// The frames of a CAN bus that a twin receives, like the acceptance filters of a CAN controller: those with (id & mask) == value for one
/// of the filters; without a filter every frame. On a busy bus with many nodes this saves a call per frame and node.
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

/// Motion is evaluated in closed form at the requested time, so a twin that is not asked costs nothing.
struct Twin {
    /// Only the frames of Out are used. The twin receives every frame that its acceptance includes, and ignores those for others.
    virtual void on_frame(const Frame& frame, Instant now, Out& out) = 0;
    /// Read after each call. It must include every frame that the twin answers.
    [[nodiscard]] virtual Acceptance acceptance() const noexcept { return {}; }
    virtual void on_deadline(Instant now, Out& out) = 0;
    [[nodiscard]] virtual Instant deadline() const = 0;

    /// Power on at `now` with this memory (empty: factory state). Called once before anything else, and for a restore.
    virtual void power_on(const NonVolatile& memory, Instant now, Out& out) = 0;
    [[nodiscard]] virtual NonVolatile non_volatile() const = 0;
    /// The site uses this number of channels from now on. True: they exist, and nothing else has changed; false: the twin must be built
    /// anew.
    [[nodiscard]] virtual bool fit_axes(int axes, Instant now) { return (void)axes, (void)now, false; }
    /// Increases by one with each change of the non-volatile memory, so that it is saved.
    [[nodiscard]] virtual std::uint64_t non_volatile_revision() const = 0;

    [[nodiscard]] virtual std::vector<HandItem> hand() const = 0;
    /// Sets one condition; an empty text, or the fault and the remedy.
    [[nodiscard]] virtual std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) = 0;
    [[nodiscard]] virtual TwinMechanics mechanics(int channel, Instant now) const = 0;
    virtual ~Twin() = default;
};

}  // namespace axisgate
