// Check: the sums.
// In: the text, the digits that came. Out: decimal digits; by which of the forms (text, text with ETX, 0) a received check is right.
// Never looks at control symbols: the caller cuts the text out.
#include "adapters/pacontrol/wire_check.hpp"

#include <charconv>

namespace axisgate::pacontrol {

std::string_view name_of(CheckForm form) noexcept {
    switch (form) {
        case CheckForm::text:
            return "text";
        case CheckForm::with_etx:
            return "text and ETX";
        case CheckForm::zero:
            return "0, not used";
    }
    return "?";
}

std::optional<CheckMode> check_mode_named(std::string_view name) noexcept {
    if (name == "compute") return CheckMode::compute;
    if (name == "zero") return CheckMode::zero;
    if (name == "learn") return CheckMode::learn;
    return std::nullopt;
}

std::uint8_t check_of(std::string_view text, CheckForm form) noexcept {
    if (form == CheckForm::zero) return 0;
    std::uint8_t sum = form == CheckForm::with_etx ? 3 : 0;
    for (const char c : text)
        sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
    return sum;
}

std::optional<CheckForm> form_of_check(std::string_view text, std::string_view digits, CheckForm expected) noexcept {
    unsigned v = 0;
    const auto [p, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), v);
    if (digits.empty() || digits.size() > 3 || ec != std::errc{} || p != digits.data() + digits.size() || v > 255) return std::nullopt;
    if (v == check_of(text, expected)) return expected;
    for (const CheckForm f : {CheckForm::text, CheckForm::with_etx, CheckForm::zero}) {
        if (v == check_of(text, f)) return f;
    }
    return std::nullopt;
}

}  // namespace axisgate::pacontrol
