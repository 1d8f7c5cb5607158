// Numbers of the serial port as text.
// In: numbers, text. Out: text, numbers. Never throws, never writes an exponent.
#include "adapters/pacontrol/twin/value.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace axisgate::pacontrol::twin {

std::int32_t whole(const Datum& d) noexcept {
    return static_cast<std::int32_t>(std::clamp(std::round(d.value), -2147483648.0, integer_limit));
}

std::optional<float> single(const Datum& d) noexcept {
    if (!std::isfinite(d.value) || std::abs(d.value) > 3.4028234e38) return std::nullopt;
    return static_cast<float>(d.value);
}

namespace {

/// With at most three decimals: all of them, or as few as the value needs, but one.
std::string with_decimals(double v, bool all_three) {
    char text[400];  // the largest double has 309 digits
    std::snprintf(text, sizeof text, "%.3f", v);
    std::string s = text;
    while (!all_three && s.ends_with('0') && s[s.size() - 2] != '.')
        s.pop_back();
    return s.find_first_not_of("-0.") == std::string::npos && s.starts_with('-') ? s.substr(1) : s;
}

}  // namespace

std::string to_wire(const Datum& d, RealForm form) {
    char text[64];
    if (!d.real) {
        std::snprintf(text, sizeof text, "%.0f", std::clamp(std::round(d.value), -2147483648.0, integer_limit) + 0.0);
        return text;
    }
    if (form != RealForm::seven_digits) return with_decimals(d.value, form == RealForm::three_decimals);
    const double v = d.value == 0 ? 0.0 : d.value;  // no -0
    int decimals = 6;
    for (double edge = 10; decimals > 0 && std::abs(v) >= edge; edge *= 10)
        --decimals;
    int length = std::snprintf(text, sizeof text, "%.*f", decimals, v);
    const int digits = length - (v < 0 ? 1 : 0);
    if (decimals > 0 && digits > 8) length = std::snprintf(text, sizeof text, "%.*f", decimals - 1, v);  // 9.9999999 became 10.000000
    if (std::string_view(text) == "-0.000000") return "0.000000";
    return {text, static_cast<std::size_t>(length)};
}

std::optional<Datum> from_wire(std::string_view text, bool real) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    if (text.empty() || text.size() > 48) return std::nullopt;
    bool digit = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        digit = digit || (c >= '0' && c <= '9');
        if (!((c >= '0' && c <= '9') || c == '.' || (c == '-' && i == 0))) return std::nullopt;
    }
    double v = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), v, std::chars_format::fixed);
    if (!digit || fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(v)) return std::nullopt;
    return real ? Datum::number(v) : Datum::integer(std::round(v));
}

}  // namespace axisgate::pacontrol::twin
