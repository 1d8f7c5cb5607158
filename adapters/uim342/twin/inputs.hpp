// The three inputs as the drive sees them: sampled on the 1 ms grid, then passed through one of three trigger modes [L956-988].
// In: levels from the tester's hand, trigger modes, time. Out: latched levels and edges, one at a time.
// Never runs an action or sends a notification: the device does that with the edges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/core/instant.hpp"

namespace axisgate::uim342::twin {

inline constexpr std::size_t input_count = 3;
inline constexpr std::uint16_t trigger_continuous = 0;    ///< TG: every change counts at once
inline constexpr std::uint16_t trigger_one_time = 60001;  ///< TG: the first change acts, later ones only notify; 1..60000 filter, ms

struct Edge {
    std::size_t input = 0;  ///< 0..2
    bool rising = false;
};

class Inputs {
public:
    /// What the hand applies; seen by the drive at the next instant of the grid, `now` included.
    void apply(std::uint8_t levels, Instant now) noexcept;
    [[nodiscard]] std::uint8_t applied() const noexcept { return applied_; }

    /// A level must stand this long before the drive sees it: the filter in front of its inputs.
    void set_late(Duration late) noexcept { late_ = late; }
    /// At boot: the present levels are the latched ones, without an edge.
    void restart(const std::array<std::uint16_t, input_count>& modes) noexcept;
    /// A new TG[i]; a change that was being filtered is judged anew from the next sample on.
    void set_mode(std::size_t input, std::uint16_t mode, Instant now) noexcept;
    void set_modes(const std::array<std::uint16_t, input_count>& modes, Instant now) noexcept {
        for (std::size_t i = 0; i < input_count; ++i)
            set_mode(i, modes[i], now);
    }

    /// Bits 0..2: what MS, DI and the logic see.
    [[nodiscard]] std::uint8_t latched() const noexcept { return latched_; }
    [[nodiscard]] Instant deadline() const noexcept { return deadline_; }
    /// To be called at `deadline()` until it says nothing: samples, and gives the next edge that is due, IN1 first.
    [[nodiscard]] std::optional<Edge> step(Instant at) noexcept;

private:
    void plan(Instant now) noexcept;

    std::uint8_t applied_ = 0;
    std::uint8_t sampled_ = 0;
    std::uint8_t latched_ = 0;
    std::array<std::uint16_t, input_count> modes_{};
    std::array<Instant, input_count> since_{never, never, never};  // sampled level differs from the latched one since then
    Duration late_{};
    Instant applied_at_{};
    Instant sample_at_ = never;
    Instant deadline_ = never;
};

}  // namespace axisgate::uim342::twin
