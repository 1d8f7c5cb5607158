// Checks and cleans names and texts of unknown origin for display to people or on a terminal: no line end, no escape sequence, no change of
// the writing direction.
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate {

/// One character at the beginning of `text`, which is not empty: its length in bytes, and whether it is plain. A byte that is not UTF-8 is
/// one character, not plain.
struct PlainStep {
    std::size_t bytes = 1;
    std::uint32_t code = 0;
    bool plain = false;
};
[[nodiscard]] inline PlainStep plain_step(std::string_view text) noexcept {
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return {1, first, first >= 0x20 && first != 0x7F};
    const std::size_t n = first >= 0xF0 && first < 0xF5 ? 4 : first >= 0xE0 && first < 0xF0 ? 3 : first >= 0xC2 && first < 0xE0 ? 2 : 1;
    if (n == 1 || text.size() < n) return {1, first, false};
    std::uint32_t code = first & (0x7Fu >> n);
    for (std::size_t i = 1; i < n; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u) return {1, first, false};
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    const bool long_form = (n == 3 && code < 0x800) || (n == 4 && code < 0x10000) || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000);
    if (long_form) return {1, first, false};
    const bool controls =
        code < 0xA0 || code == 0x2028 || code == 0x2029 || (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return {n, code, !controls};
}

/// True if there is no control character (including C1), no separator of lines or paragraphs, no override of the direction, and only
/// complete UTF-8.
[[nodiscard]] inline bool is_plain(std::string_view text) noexcept {
    while (!text.empty()) {
        const PlainStep step = plain_step(text);
        if (!step.plain) return false;
        text.remove_prefix(step.bytes);
    }
    return true;
}

/// The text with all other characters escaped: \\n, \\x1b, \\u202e. A tabulator becomes a blank.
[[nodiscard]] inline std::string one_line(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const PlainStep step = plain_step(text);
        if (step.plain) {
            out += text.substr(0, step.bytes);
        } else if (step.code == '\t') {
            out += ' ';
        } else if (step.code == '\n' || step.code == '\r') {
            out += step.code == '\n' ? "\\n" : "\\r";
        } else {
            out += step.code < 0x100 ? fmt::format("\\x{:02x}", step.code) : fmt::format("\\u{:04x}", step.code);
        }
        text.remove_prefix(step.bytes);
    }
    return out;
}

}  // namespace axisgate
