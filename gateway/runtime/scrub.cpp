// One pass over the text; a secret is recognized by its name, its form or its length.
#include "gateway/runtime/scrub.hpp"

#include <algorithm>
#include <array>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
constexpr std::string_view removed = "(removed)";
constexpr std::array<std::string_view, 9> secret_words{"password", "passphrase",    "secret",     "token", "cookie",
                                                       "session",  "authorization", "credential", "psk"};
constexpr std::size_t longest_run = 40;  // of a possible key; identifiers of this program are shorter

constexpr bool in_name(char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == '.'; }
constexpr bool in_run(char c) { return is_letter(c) || is_digit(c) || c == '+' || c == '=' || c == '_' || c == '-'; }
constexpr bool in_code(char c) { return (c >= 'A' && c <= 'Z') || is_digit(c); }

/// "K7QF-2M9D-XW3E-8HTR"
bool is_code(std::string_view s) {
    constexpr std::size_t groups = 4, of = 4, length = groups * (of + 1) - 1;
    if (s.size() < length || (s.size() > length && in_run(s[length]))) return false;
    for (std::size_t i = 0; i < length; ++i) {
        if (i % (of + 1) == of ? s[i] != '-' : !in_code(s[i])) return false;
    }
    return true;
}

/// Base64 of random data has letters of both cases and few of its two signs; names of metrics and adapters differ from this.
bool is_key(std::string_view run) {
    constexpr std::ptrdiff_t most_signs = 6;
    if (std::ranges::count_if(run, [](char c) { return c == '_' || c == '-'; }) > most_signs) return false;
    const bool low = std::ranges::any_of(run, [](char c) { return c >= 'a' && c <= 'z'; });
    const bool high = std::ranges::any_of(run, [](char c) { return c >= 'A' && c <= 'Z'; });
    return (low && high) || run.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
}

bool is_secret_name(std::string_view name) {
    const std::string low = lower(name);
    // A time-out of sessions and a file's path are no secrets.
    if (low.ends_with("_min") || low.ends_with("_max_h") || low.ends_with("_s") || low.ends_with("_key") || low.ends_with("_cert"))
        return false;
    return std::ranges::any_of(secret_words, [&](std::string_view w) { return low.find(w) != std::string::npos; });
}

/// Length of the value that begins here: a quoted text with its quotes, or up to the end of the word; behind "Bearer" and the like
/// including the next word.
std::size_t value_length(std::string_view s) {
    if (s.empty() || s[0] == '\n') return 0;
    if (s[0] == '"' || s[0] == '\'') {
        std::size_t i = 1;
        while (i < s.size() && s[i] != s[0] && s[i] != '\n')
            i += s[i] == '\\' && i + 1 < s.size() && s[i + 1] != '\n' ? 2 : 1;
        return std::min(i + 1, s.size());
    }
    if (s[0] == '{' || s[0] == '[') return 0;  // its members have names of their own
    if (s.starts_with(removed)) return removed.size();
    for (const std::string_view scheme : {"bearer ", "basic "}) {
        if (lower(s.substr(0, scheme.size())) == scheme) return scheme.size() + value_length(s.substr(scheme.size()));
    }
    return std::min(s.find_first_of(" \t\r\n,;&}])"), s.size());
}
}  // namespace

std::string scrub(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    std::size_t i = 0;
    while (i < text.size()) {
        const std::string_view rest = text.substr(i);
        if (rest.starts_with("-----BEGIN ")) {
            const auto end = rest.find("-----END ");
            const auto line = end == std::string_view::npos ? end : rest.find('\n', end);
            out += removed;
            i = line == std::string_view::npos ? text.size() : i + line;
            continue;
        }
        const bool begins = i == 0 || !in_run(text[i - 1]);
        if (rest.starts_with("://")) {
            const auto host_end = std::min(rest.find_first_of("/ \t\r\n\"'<>", 3), rest.size());
            const auto at = rest.substr(0, host_end).rfind('@');
            out += "://";
            i += 3;
            if (at != std::string_view::npos) {
                out += removed;
                i += at - 3;
            }
            continue;
        }
        if (!begins || !in_run(text[i])) {
            out += text[i++];
            continue;
        }
        if (is_code(rest)) {
            out += removed;
            i += 19;
            continue;
        }
        std::size_t name = 0, run = 0;
        while (name < rest.size() && in_name(rest[name]))
            ++name;
        while (run < rest.size() && in_run(rest[run]))
            ++run;
        std::size_t behind = name;
        if (behind < rest.size() && (rest[behind] == '"' || rest[behind] == '\'')) ++behind;
        behind = std::min(rest.find_first_not_of(" \t", behind), rest.size());
        if (name > 0 && behind < rest.size() && (rest[behind] == ':' || rest[behind] == '=') && is_secret_name(rest.substr(0, name))) {
            behind = std::min(rest.find_first_not_of(" \t", behind + 1), rest.size());
            const std::size_t length = value_length(rest.substr(behind));
            out += rest.substr(0, behind);
            const bool in_json = rest[name] == '"';
            if (length > 0) out += in_json || rest[behind] == '"' ? "\"(removed)\"" : rest[behind] == '\'' ? "'(removed)'" : removed;
            i += behind + length;
            continue;
        }
        if (run >= longest_run && is_key(rest.substr(0, run))) {
            out += removed;
        } else {
            out += rest.substr(0, run);
        }
        i += run;
    }
    return out;
}

}  // namespace axisgate
