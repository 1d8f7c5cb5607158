// Numbers, times, hex and JSON as text, and back. The text may have any origin: bad input gives an empty result, and written text is always
// valid UTF-8.
#pragma once

#include <boost/json/value.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

/// "1", "true", "": true; "0", "false": false; empty for other text.
[[nodiscard]] std::optional<bool> parse_flag(std::string_view text) noexcept;
/// Decimal, within the bounds; otherwise empty.
[[nodiscard]] std::optional<std::int64_t> parse_whole(std::string_view text, std::int64_t low, std::int64_t high) noexcept;
/// Finite decimal number, the whole text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;

/// RFC 3339 in UTC with microseconds: "2026-01-02T03:04:05.678901Z".
[[nodiscard]] std::string format_time(std::int64_t unix_ns);
/// RFC 3339 with any fraction and any offset, years 1970..2261; nanoseconds since 1970.
[[nodiscard]] std::optional<std::int64_t> parse_time(std::string_view text) noexcept;

/// Upper case pairs without spaces.
[[nodiscard]] std::string to_hex(std::span<const std::uint8_t> bytes);
/// Pairs, with blanks between pairs allowed; empty for anything else.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> from_hex(std::string_view text);

/// ASCII, in every locale.
[[nodiscard]] constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
[[nodiscard]] constexpr bool is_letter(char c) noexcept { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
[[nodiscard]] constexpr char upper(char c) noexcept { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
[[nodiscard]] constexpr char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

[[nodiscard]] bool is_utf8(std::string_view text) noexcept;
[[nodiscard]] std::string lower(std::string_view text);
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// JSON text, compact. Doubles in their shortest form (whole ones without an exponent), NaN and infinities as null, bytes that are not
/// UTF-8 as U+FFFD, so that the output is always JSON.
[[nodiscard]] std::string json_text(const boost::json::value& value);
void json_text(const boost::json::value& value, std::string& into);
/// A double as the JSON number that people expect: whole ones below 2^53 as integers; null if it is not finite.
[[nodiscard]] boost::json::value number(double value);
/// null for an empty text.
[[nodiscard]] boost::json::value text_or_null(std::string_view text);

/// A cell that a spreadsheet takes as text, and not as a formula or as several cells.
[[nodiscard]] std::string csv_cell(std::string_view text);

}  // namespace axisgate
