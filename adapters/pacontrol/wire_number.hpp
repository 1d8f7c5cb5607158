// Number: integers and reals as the text in which they cross the serial port, and axis units as increments.
// In: values, texts. Out: texts, values. One increment is 0.001 axis unit (AE), as in the control's own integer format [L599-L606].
// Never compares by text: 640.0 and 640.0000 are one value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::pacontrol {

/// Decimal with sign, -2147483647..2147483647 [L2060] (and the one below); nothing if it is not one.
[[nodiscard]] std::optional<std::int64_t> integer_of(std::string_view text) noexcept;
/// Decimal with sign and point; any number of decimals. Nothing if it is not one, or not finite.
[[nodiscard]] std::optional<double> real_of(std::string_view text) noexcept;

/// Without sign, decimal or 0x with hexadecimal digits; nothing if it is not one of 32 bits.
[[nodiscard]] std::optional<std::uint32_t> whole_of(std::string_view text) noexcept;
/// Split at spaces, tabs and commas.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view text);

/// The shortest text that is this 32-bit float, with a point and at least one decimal: 200.0, -0.25. Never an exponent.
[[nodiscard]] std::string real_text(double value);

/// 5552000 -> "5552.0", -1 -> "-0.001".
[[nodiscard]] std::string axis_text(std::int64_t increments);
/// Axis units as increments, rounded half away from zero; clamped to what a position register carries (32 bits).
[[nodiscard]] std::int64_t increments_of(double axis_units) noexcept;

}  // namespace axisgate::pacontrol
