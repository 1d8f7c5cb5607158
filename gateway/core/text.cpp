// Numbers by the character functions of the library, times by the calendar of <chrono>. Bad text never throws, and all written bytes are
// UTF-8.
#include "gateway/core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

namespace axisgate {
namespace {
namespace json = boost::json;

int hex_digit(char c) noexcept {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// Length of the valid UTF-8 sequence at the beginning of `s` (no surrogates, no overlong forms); 0 if there is none.
std::size_t sequence_length(std::string_view s) noexcept {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(s[i]); };
    const auto tail = [&](std::size_t i) { return i < s.size() && (at(i) & 0xC0u) == 0x80u; };
    const unsigned char c = at(0);
    if (c < 0x80) return 1;
    if (c >= 0xC2 && c <= 0xDF) return tail(1) ? 2 : 0;
    if (c >= 0xE0 && c <= 0xEF) {
        if (!tail(1) || !tail(2)) return 0;
        if ((c == 0xE0 && at(1) < 0xA0) || (c == 0xED && at(1) > 0x9F)) return 0;
        return 3;
    }
    if (c >= 0xF0 && c <= 0xF4) {
        if (!tail(1) || !tail(2) || !tail(3)) return 0;
        if ((c == 0xF0 && at(1) < 0x90) || (c == 0xF4 && at(1) > 0x8F)) return 0;
        return 4;
    }
    return 0;
}

void put_string(std::string_view s, std::string& out) {
    out += '"';
    while (!s.empty()) {
        const char c = s.front();
        std::size_t n = 1;
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            switch (c) {
                case '\n':
                    out += "\\n";
                    break;
                case '\r':
                    out += "\\r";
                    break;
                case '\t':
                    out += "\\t";
                    break;
                default:
                    out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
                    break;
            }
        } else if (n = sequence_length(s); n > 0) {
            out += s.substr(0, n);
        } else {
            out += "\xEF\xBF\xBD";
            n = 1;
        }
        s.remove_prefix(n);
    }
    out += '"';
}

void put_double(double d, std::string& out) {
    if (!std::isfinite(d)) {
        out += "null";
        return;
    }
    if (std::nearbyint(d) == d && std::fabs(d) < 9007199254740992.0) {
        fmt::format_to(std::back_inserter(out), "{}", static_cast<std::int64_t>(d));
        return;
    }
    fmt::format_to(std::back_inserter(out), "{}", d);
}
}  // namespace

std::optional<bool> parse_flag(std::string_view text) noexcept {
    if (text.empty() || text == "1" || text == "true") return true;
    if (text == "0" || text == "false") return false;
    return std::nullopt;
}

std::optional<std::int64_t> parse_whole(std::string_view text, std::int64_t low, std::int64_t high) noexcept {
    std::int64_t n = 0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (ec != std::errc{} || text.empty() || end != text.data() + text.size() || n < low || n > high) return std::nullopt;
    return n;
}

std::optional<double> parse_number(std::string_view text) noexcept {
    double d = 0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), d);
    if (ec != std::errc{} || text.empty() || end != text.data() + text.size() || !std::isfinite(d)) return std::nullopt;
    return d;
}

std::string format_time(std::int64_t unix_ns) {
    using namespace std::chrono;
    const sys_time<nanoseconds> t{nanoseconds{unix_ns}};
    const auto day = floor<days>(t);
    const year_month_day date{day};
    const hh_mm_ss time{floor<microseconds>(t - day)};
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                       static_cast<unsigned>(date.day()), time.hours().count(), time.minutes().count(), time.seconds().count(),
                       time.subseconds().count());
}

std::optional<std::int64_t> parse_time(std::string_view s) noexcept {
    using namespace std::chrono;
    const auto digits = [&s](std::size_t n, std::int64_t low, std::int64_t high) -> std::optional<std::int64_t> {
        if (s.size() < n || !std::ranges::all_of(s.substr(0, n), [](char c) { return c >= '0' && c <= '9'; })) return std::nullopt;
        const auto v = parse_whole(s.substr(0, n), low, high);
        if (v) s.remove_prefix(n);
        return v;
    };
    const auto skip = [&s](std::string_view any) {
        if (s.empty() || any.find(s.front()) == std::string_view::npos) return false;
        s.remove_prefix(1);
        return true;
    };
    const auto y = digits(4, 1970, 2261);
    if (!y || !skip("-")) return std::nullopt;
    const auto mo = digits(2, 1, 12);
    if (!mo || !skip("-")) return std::nullopt;
    const auto d = digits(2, 1, 31);
    if (!d || !skip("Tt ")) return std::nullopt;
    const auto h = digits(2, 0, 23);
    if (!h || !skip(":")) return std::nullopt;
    const auto mi = digits(2, 0, 59);
    if (!mi || !skip(":")) return std::nullopt;
    const auto sec = digits(2, 0, 60);
    if (!sec) return std::nullopt;
    std::int64_t fraction_ns = 0;
    if (skip(".")) {
        std::int64_t weight = 100'000'000;
        std::size_t n = 0;
        while (!s.empty() && s.front() >= '0' && s.front() <= '9') {
            fraction_ns += weight * (s.front() - '0');
            weight /= 10;
            ++n;
            s.remove_prefix(1);
        }
        if (n == 0) return std::nullopt;
    }
    std::int64_t offset_min = 0;
    if (!s.empty() && (s.front() == 'Z' || s.front() == 'z')) {
        s.remove_prefix(1);
    } else {
        // A plus that a query string has turned into a blank is still a plus.
        const bool minus = !s.empty() && s.front() == '-';
        if (!skip("+- ")) return std::nullopt;
        const auto oh = digits(2, 0, 23);
        if (!oh || !skip(":")) return std::nullopt;
        const auto om = digits(2, 0, 59);
        if (!om) return std::nullopt;
        offset_min = (*oh * 60 + *om) * (minus ? -1 : 1);
    }
    const year_month_day date{year{static_cast<int>(*y)}, month{static_cast<unsigned>(*mo)}, day{static_cast<unsigned>(*d)}};
    if (!s.empty() || !date.ok()) return std::nullopt;
    const std::int64_t total_s = sys_days{date}.time_since_epoch().count() * 86'400LL + *h * 3600 + *mi * 60 + *sec - offset_min * 60;
    return total_s * 1'000'000'000LL + fraction_ns;
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
    static constexpr char digits[] = "0123456789ABCDEF";
    std::string out;
    out.reserve(bytes.size() * 2);
    for (const auto b : bytes) {
        out += digits[b >> 4];
        out += digits[b & 15];
    }
    return out;
}

std::optional<std::vector<std::uint8_t>> from_hex(std::string_view text) {
    std::vector<std::uint8_t> out;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == ' ' || text[i] == '\t') {
            ++i;
            continue;
        }
        const int high = hex_digit(text[i]);
        const int low = i + 1 < text.size() ? hex_digit(text[i + 1]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        out.push_back(static_cast<std::uint8_t>(high * 16 + low));
        i += 2;
    }
    return out;
}

bool is_utf8(std::string_view text) noexcept {
    while (!text.empty()) {
        const auto n = sequence_length(text);
        if (n == 0) return false;
        text.remove_prefix(n);
    }
    return true;
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(), [](char c) { return lower(c); });
    return out;
}

std::string_view trimmed(std::string_view text) noexcept {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
        text.remove_suffix(1);
    return text;
}

void json_text(const json::value& value, std::string& out) {
    switch (value.kind()) {
        case json::kind::null:
            out += "null";
            break;
        case json::kind::bool_:
            out += value.get_bool() ? "true" : "false";
            break;
        case json::kind::int64:
            fmt::format_to(std::back_inserter(out), "{}", value.get_int64());
            break;
        case json::kind::uint64:
            fmt::format_to(std::back_inserter(out), "{}", value.get_uint64());
            break;
        case json::kind::double_:
            put_double(value.get_double(), out);
            break;
        case json::kind::string:
            put_string(std::string_view(value.get_string()), out);
            break;
        case json::kind::array: {
            out += '[';
            bool first = true;
            for (const auto& item : value.get_array()) {
                if (!first) out += ',';
                first = false;
                json_text(item, out);
            }
            out += ']';
            break;
        }
        case json::kind::object: {
            out += '{';
            bool first = true;
            for (const auto& [k, v] : value.get_object()) {
                if (!first) out += ',';
                first = false;
                put_string(std::string_view(k), out);
                out += ':';
                json_text(v, out);
            }
            out += '}';
            break;
        }
    }
}

std::string json_text(const json::value& value) {
    std::string out;
    json_text(value, out);
    return out;
}

json::value number(double value) {
    if (!std::isfinite(value)) return nullptr;
    if (std::nearbyint(value) == value && std::fabs(value) < 9007199254740992.0) return static_cast<std::int64_t>(value);
    return value;
}

json::value text_or_null(std::string_view text) {
    if (text.empty()) return nullptr;
    return json::value(json::string_view(text.data(), text.size()));
}

std::string csv_cell(std::string_view text) {
    std::string s(text);
    // The mark is also put behind marks that the text has itself, so that the reader, which removes one, restores the text.
    const auto first = s.find_first_not_of('\'');
    const bool formula =
        first != std::string::npos && std::string_view("=+-@").find(s[first]) != std::string_view::npos && !parse_number(s);
    if (formula) s.insert(s.begin(), '\'');
    if (s.find_first_of(",;\"\t\r\n") == std::string::npos) return s;
    std::string out = "\"";
    for (const char c : s) {
        if (c == '"') out += '"';
        out += c;
    }
    return out + "\"";
}

}  // namespace axisgate
