// The values that a motion command leaves to other parts: a motion that begins later, the event that a motion waits for, an error code.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "adapters/linmot/twin/profile.hpp"

namespace axisgate::linmot::twin {

/// A motion command in the buffer: header, then parameters.
using Bytes = std::array<std::uint8_t, 32>;
/// An error code that the drive is to raise; 0: none.
using Fault = std::uint16_t;

constexpr Duration watch_step = std::chrono::milliseconds(1);  ///< period of conditions that have no closed form
/// A number of milliseconds in the range of parameters: 0 to 1e9.
[[nodiscard]] inline Duration span_ms(double n) { return Duration{static_cast<std::int64_t>(std::clamp(n, 0.0, 1e9) * 1e6)}; }

/// A motion of the VA interpolator.
struct Order {
    std::uint8_t sub = 0;  ///< start rule: the reference of the value, and the start of the profile
    double value = 0;      ///< 0.1 um
    Ramps ramps;
};

/// The one armed event and the command that it starts. It stays armed; only 008xh and a loss of the state clear it [L983-989].
struct Armed {
    enum class Kind : std::uint8_t { none, rising, falling, upwards, downwards };
    enum class What : std::uint8_t { vai, table, curve, change, cam };
    Kind kind = Kind::none;
    What what = What::vai;
    Order order;
    double position = 0;  ///< of a crossing, 0.1 um
    Bytes bytes{};        ///< of the command that armed it, if it is read again
    [[nodiscard]] bool crossing() const noexcept { return kind == Kind::upwards || kind == Kind::downwards; }
};

}  // namespace axisgate::linmot::twin
