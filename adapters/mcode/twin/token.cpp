// Tokens: one pass over a line, character by character.
// In: a line. Out: its tokens.
// Never reads past the line or the limit: what is longer is cut, and the line's length is checked before.
#include "adapters/mcode/twin/token.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "gateway/core/text.hpp"

namespace axisgate::mcode::twin {
namespace {

/// End of the number that begins at `at`.
std::size_t number_end(std::string_view s, std::size_t at) noexcept {
    while (at < s.size() && is_digit(s[at]))
        ++at;
    if (at < s.size() && s[at] == '.') {
        ++at;
        while (at < s.size() && is_digit(s[at]))
            ++at;
    }
    if (at < s.size() && (s[at] == 'e' || s[at] == 'E')) {
        std::size_t e = at + 1;
        if (e < s.size() && (s[e] == '+' || s[e] == '-')) ++e;
        if (e < s.size() && is_digit(s[e])) {
            while (e < s.size() && is_digit(s[e]))
                ++e;
            at = e;
        }
    }
    return at;
}

/// Whether digits that no double holds are too small, and not too large. At most `line_limit` characters.
bool below_one(std::string_view s) noexcept {
    const std::size_t e = std::min(s.find_first_of("eE"), s.size());
    const std::string_view digits = s.substr(0, e);
    const std::size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_of("123456789");
    if (first == std::string_view::npos) return true;  // 0 with any exponent
    long exponent = 0;
    if (e < s.size()) {
        std::string_view figure = s.substr(e + 1);
        if (figure.starts_with('+')) figure.remove_prefix(1);
        const auto [end, fault] = std::from_chars(figure.data(), figure.data() + figure.size(), exponent);
        if (fault != std::errc{}) return figure.starts_with('-');
    }
    return exponent + static_cast<long>(point) - static_cast<long>(first) < 0;
}

Number number_of(std::string_view s) noexcept {
    std::int64_t i = 0;
    const char* const last = s.data() + s.size();
    if (const auto [end, fault] = std::from_chars(s.data(), last, i); fault == std::errc{} && end == last) return Number::of(i);
    double d = 0;
    if (const auto [end, fault] = std::from_chars(s.data(), last, d); fault == std::errc{} && end == last) return Number::of_real(d);
    // Nearer to 0 than any double is 0; beyond the largest is infinity, which every range refuses.
    return Number::of_real(below_one(s) ? 0.0 : std::numeric_limits<double>::infinity());
}

}  // namespace

Tokens::Tokens(std::string_view line) noexcept {
    if (line.size() > line_limit) line = line.substr(0, line_limit);
    std::size_t at = 0;
    while (at < line.size() && size_ < line_limit) {
        const char c = line[at];
        if (c == ' ' || c == '\t') {
            ++at;
            continue;
        }
        if (c == '\'') break;
        Token& t = tokens_[size_++];
        const std::size_t begin = at;
        if (is_letter(c)) {
            while (at < line.size() && (is_letter(line[at]) || is_digit(line[at]) || line[at] == '_'))
                ++at;
            t.kind = Token::Kind::name;
        } else if (is_digit(c) || (c == '.' && at + 1 < line.size() && is_digit(line[at + 1]))) {
            at = number_end(line, at);
            t.kind = Token::Kind::number;
            t.number = number_of(line.substr(begin, at - begin));
        } else if (c == '"') {
            const std::size_t close = line.find('"', at + 1);
            t.kind = close == std::string_view::npos ? Token::Kind::other : Token::Kind::text;
            t.text = line.substr(at + 1, close == std::string_view::npos ? close : close - at - 1);
            at = close == std::string_view::npos ? line.size() : close + 1;
            continue;
        } else {
            const char d = at + 1 < line.size() ? line[at + 1] : '\0';
            t.kind = Token::Kind::sign;
            t.sign = c;
            ++at;
            if ((c == '<' && d == '>') || (c == '<' && d == '=') || (c == '>' && d == '=') || (c == '=' && d == '<')) {
                t.sign = d == '>' ? 'n' : c == '>' ? 'g' : 'l';
                ++at;
            } else if (std::string_view("=+-*/&|^!,;<>").find(c) == std::string_view::npos) {
                t.kind = Token::Kind::other;
            }
        }
        t.text = line.substr(begin, at - begin);
    }
    tokens_[size_] = Token{};
}

}  // namespace axisgate::mcode::twin
