// Check: the check digits at the end of every frame of the serial port.
// In: the text between STX and ETX, the digits that were received. Out: the digits to send, and what received ones prove.
// Never decides what to do about a wrong one: that is the reader's.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate::pacontrol {

/// "XOR sum of the digits" [L1047]. The manual gives no formula; its printed frames prove two, which differ by the ETX (03h) [L1220-L1495].
enum class CheckForm : std::uint8_t {
    text,      ///< XOR of the bytes strictly between STX and ETX: what requests carry
    with_etx,  ///< the same and ETX: what acknowledgements carry
    zero       ///< `0`: not used; legal in both directions [L1047]
};
[[nodiscard]] std::string_view name_of(CheckForm form) noexcept;

/// Option `check` of the line.
enum class CheckMode : std::uint8_t {
    compute,  ///< requests carry the computed digits
    zero,     ///< requests carry `0`
    learn     ///< computed, until the control answers "check wrong" (10h) to it: then the other form, then `0`
};
[[nodiscard]] std::optional<CheckMode> check_mode_named(std::string_view name) noexcept;

[[nodiscard]] std::uint8_t check_of(std::string_view text, CheckForm form) noexcept;

/// Which form received digits have. A sum that is 0 by itself counts as computed. Nothing: they fit no form, or are no number 0..255.
/// `expected` is looked at first.
[[nodiscard]] std::optional<CheckForm> form_of_check(std::string_view text, std::string_view digits, CheckForm expected) noexcept;

}  // namespace axisgate::pacontrol
