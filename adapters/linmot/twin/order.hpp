// What a motion command leaves behind: a motion that begins later, the event that one waits for, an error code.
// In: what the interpreter reads from a command. Out: plain values. Nothing here acts.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "adapters/linmot/twin/profile.hpp"

namespace axisgate::linmot::twin {

/// A motion command as the buffer has it: header, then parameters.
using Bytes = std::array<std::uint8_t, 32>;
/// An error code that the drive is to raise; 0: none.
using Fault = std::uint16_t;

constexpr Duration watch_step = std::chrono::milliseconds(1);  ///< how often a condition is looked at that has no closed form
/// A number of milliseconds as parameters have them: 0 to 1e9.
[[nodiscard]] inline Duration span_ms(double n) { return Duration{static_cast<std::int64_t>(std::clamp(n, 0.0, 1e9) * 1e6)}; }

/// A motion of the VA interpolator.
struct Order {
    std::uint8_t sub = 0;  ///< start rule: what the value is relative to, and from where the profile begins
    double value = 0;      ///< 0.1 um
    Ramps ramps;
};

/// The one event that is armed, and what it starts. It stays armed; only 008xh and a loss of the state end it [L983-989].
struct Armed {
    enum class Kind : std::uint8_t { none, rising, falling, upwards, downwards };
    enum class What : std::uint8_t { vai, table, curve, change, cam };
    Kind kind = Kind::none;
    What what = What::vai;
    Order order;
    double position = 0;  ///< of a crossing, 0.1 um
    Bytes bytes{};        ///< of the command that armed it, where it is read again
    [[nodiscard]] bool crossing() const noexcept { return kind == Kind::upwards || kind == Kind::downwards; }
};

}  // namespace axisgate::linmot::twin
