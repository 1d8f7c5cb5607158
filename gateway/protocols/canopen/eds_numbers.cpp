// EDS numbers: the standard's form first, then the others.
#include "gateway/protocols/canopen/eds_numbers.hpp"

#include <algorithm>
#include <charconv>

#include "gateway/core/text.hpp"

namespace axisgate::canopen {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || c == '/' || static_cast<unsigned char>(c) >= 0x80;
}

std::optional<std::uint64_t> digits(std::string_view text, int base) {
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n, base);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return n;
}

/// The same without a suffix of C, a unit or a fraction of zeros.
std::string_view without_suffix(std::string_view text, bool hex) {
    if (hex) {
        while (text.size() > 1 && (text.back() == 'u' || text.back() == 'U' || text.back() == 'l' || text.back() == 'L'))
            text.remove_suffix(1);
        if (text.ends_with('h') || text.ends_with('H')) text.remove_suffix(1);
        return text;
    }
    const auto end = std::min(text.find_first_not_of("0123456789"), text.size());
    std::string_view rest = text.substr(end);
    if (rest.starts_with('.')) rest.remove_prefix(std::min(rest.find_first_not_of('0', 1), rest.size()));
    rest = trimmed(rest);
    return end > 0 && std::ranges::all_of(rest, is_word) ? text.substr(0, end) : std::string_view();
}

}  // namespace

std::string_view without_comment(std::string_view text) { return trimmed(text.substr(0, text.find(';'))); }

std::optional<EdsNumber> eds_number(std::string_view text) {
    text = without_comment(text);
    EdsNumber n;
    if (text.starts_with('-') || text.starts_with('+')) {
        n.negative = text[0] == '-';
        text.remove_prefix(1);
    }
    n.hex = text.starts_with("0x") || text.starts_with("0X");
    if (n.hex) text.remove_prefix(2);
    const bool octal = !n.hex && text.size() > 1 && text[0] == '0';
    const auto given = [&n](std::optional<std::uint64_t> size, bool unusual) {
        n.size = *size;
        n.unusual = unusual;
        return n;
    };
    if (const auto plain = digits(text, n.hex ? 16 : octal ? 8 : 10)) return given(plain, false);
    if (octal && std::ranges::all_of(text, is_digit)) {
        const auto decimal = digits(text, 10);
        return decimal ? std::optional(given(decimal, true)) : std::nullopt;
    }
    if (!n.hex && text.size() > 1 && (text.ends_with('h') || text.ends_with('H'))) {
        if (const auto size = digits(text.substr(0, text.size() - 1), 16)) {
            n.hex = true;
            return given(size, true);
        }
    }
    const auto size = digits(without_suffix(text, n.hex), n.hex ? 16 : 10);
    return size ? std::optional(given(size, true)) : std::nullopt;
}

std::optional<std::uint64_t> eds_whole(std::string_view text, std::uint64_t most) {
    const auto n = eds_number(text);
    if (!n || n->negative || n->size > most) return std::nullopt;
    return n->size;
}

std::optional<std::int64_t> eds_whole_of(DataType type, const EdsNumber& n) {
    const auto range = range_of(type);
    if (!range) return std::nullopt;
    const auto bits = *bits_of(type);
    if (n.hex && !n.negative && is_signed(type) && n.size > static_cast<std::uint64_t>(range->max)) {
        if (bits < 64 && n.size >> bits != 0) return std::nullopt;
        const auto shift = 64 - bits;
        return static_cast<std::int64_t>(n.size << shift) >> shift;
    }
    const std::uint64_t most = n.negative ? ~static_cast<std::uint64_t>(range->min) + 1 : static_cast<std::uint64_t>(range->max);
    if (n.size > most) return std::nullopt;
    return n.negative ? static_cast<std::int64_t>(~n.size + 1) : static_cast<std::int64_t>(n.size);
}

std::optional<std::string> without_node(std::string_view text) {
    std::string t = lower(without_comment(text));
    for (const std::string_view node : {std::string_view("$nodeid"), std::string_view("nodeid")}) {
        const auto at = t.find(node);
        if (at == std::string::npos) continue;
        t.erase(at, node.size());
        const auto plus = t.find('+');
        if (plus != std::string::npos) t.erase(plus, 1);
        return std::string(trimmed(t).empty() ? "0" : trimmed(t));
    }
    return std::nullopt;
}

}  // namespace axisgate::canopen
