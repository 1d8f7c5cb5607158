// Number: reading and writing.
// In: numbers, texts. Out: decimal texts without exponent; numbers, or nothing where the text is not one to its end.
// Never uses the locale.
#include "adapters/pacontrol/wire_number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace axisgate::pacontrol {

std::optional<std::int64_t> integer_of(std::string_view text) noexcept {
    if (text.starts_with('+')) text.remove_prefix(1);
    std::int32_t v = 0;
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (text.empty() || ec != std::errc{} || p != text.data() + text.size()) return std::nullopt;
    return v;
}

std::optional<double> real_of(std::string_view text) noexcept {
    if (text.starts_with('+')) text.remove_prefix(1);
    double v = 0;
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), v, std::chars_format::fixed);
    if (text.empty() || ec != std::errc{} || p != text.data() + text.size() || !std::isfinite(v)) return std::nullopt;
    return v;
}

std::optional<std::uint32_t> whole_of(std::string_view s) noexcept {
    int base = 10;
    if (s.starts_with("0x") || s.starts_with("0X")) {
        base = 16;
        s.remove_prefix(2);
    }
    std::uint32_t v = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), v, base);
    if (s.empty() || ec != std::errc{} || p != s.data() + s.size()) return std::nullopt;
    return v;
}

std::vector<std::string_view> words_of(std::string_view s) {
    std::vector<std::string_view> w;
    while (true) {
        const auto at = s.find_first_not_of(" ,\t");
        if (at == std::string_view::npos) return w;
        s.remove_prefix(at);
        const auto end = std::min(s.size(), s.find_first_of(" ,\t"));
        w.push_back(s.substr(0, end));
        s.remove_prefix(end);
    }
}

std::string real_text(double value) {
    constexpr double most = std::numeric_limits<float>::max();
    if (!std::isfinite(value)) value = 0;  // the callers have refused it
    const auto f = static_cast<float>(value > most ? most : value < -most ? -most : value);
    std::array<char, 64> b{};
    const auto [p, ec] = std::to_chars(b.data(), b.data() + b.size(), f, std::chars_format::fixed);
    std::string s(b.data(), ec == std::errc{} ? p : b.data());
    if (s.find('.') == std::string::npos) s += ".0";
    return s;
}

std::string axis_text(std::int64_t increments) {
    const std::uint64_t n = increments < 0 ? ~static_cast<std::uint64_t>(increments) + 1 : static_cast<std::uint64_t>(increments);
    std::string decimals = std::to_string(1000 + n % 1000).substr(1);
    while (decimals.size() > 1 && decimals.back() == '0')
        decimals.pop_back();
    return (increments < 0 ? "-" : "") + std::to_string(n / 1000) + "." + decimals;
}

std::int64_t increments_of(double axis_units) noexcept {
    constexpr double low = std::numeric_limits<std::int32_t>::min(), high = std::numeric_limits<std::int32_t>::max();
    const double v = std::round(axis_units * 1000.0);
    if (!(v > low)) return static_cast<std::int64_t>(low);
    return static_cast<std::int64_t>(v < high ? v : high);
}

}  // namespace axisgate::pacontrol
