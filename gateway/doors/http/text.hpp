// Text: the small languages of HTTP: targets, queries, times, media types, entity tags, hex, and JSON out.
// In: bytes that a client sent, or values to show. Out: values, or text that is always valid UTF-8. Bad input gives nothing, never a guess.
// Never knows the gateway.
#pragma once

#include <boost/json/value.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace axisgate::http {

/// Decodes %XX. Nothing if a % is not followed by two hex digits, or if the result has a NUL or is not UTF-8.
[[nodiscard]] std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space = false);
/// Encodes all but unreserved characters (RFC 3986 2.3).
[[nodiscard]] std::string percent_encode(std::string_view text);

/// A query string as pairs, in order.
struct Query {
    std::vector<std::pair<std::string, std::string>> pairs;
    /// First value of that name.
    [[nodiscard]] std::optional<std::string_view> get(std::string_view name) const noexcept;
};

/// A request target, taken apart.
struct Target {
    std::vector<std::string> segments;  ///< decoded; "/a/b" has two, "/" has one empty
    std::string path;                   ///< decoded and joined, for static files; only if no segment has a slash, else empty
    Query query;
};
/// Origin form ("/a/b?c=d") or absolute form ("http://host/a"). Nothing if it is neither.
[[nodiscard]] std::optional<Target> parse_target(std::string_view target);
/// The host and port of an absolute form; nothing for any other.
[[nodiscard]] std::optional<std::string_view> authority_of(std::string_view target) noexcept;

/// "1", "true", "": true; "0", "false": false; nothing for other text.
[[nodiscard]] std::optional<bool> parse_flag(std::string_view text) noexcept;
/// Decimal, within the bounds; nothing else.
[[nodiscard]] std::optional<std::int64_t> parse_whole(std::string_view text, std::int64_t low, std::int64_t high) noexcept;
/// Finite decimal number, the whole text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;

/// RFC 3339 in UTC with microseconds: "2026-01-02T03:04:05.678901Z".
[[nodiscard]] std::string format_time(std::int64_t unix_ns);
/// RFC 3339 with any fraction and any offset, years 1970..2261; nanoseconds since 1970.
[[nodiscard]] std::optional<std::int64_t> parse_time(std::string_view text) noexcept;

/// Whether an Accept header (empty: anything) takes the media type.
[[nodiscard]] bool accepts(std::string_view accept, std::string_view media) noexcept;
/// Index of the best liked of the types, the first one among equals; nothing if none is accepted.
[[nodiscard]] std::optional<std::size_t> best_accepted(std::string_view accept, std::span<const std::string_view> media) noexcept;
/// The type of a Content-Type header, lower case, without its parameters; empty if a charset other than UTF-8 is named.
[[nodiscard]] std::string media_of(std::string_view content_type);

/// One item of a comma separated list, taken off its front; commas in quoted strings do not separate.
[[nodiscard]] std::string_view next_item(std::string_view& list) noexcept;
/// Whether a list of entity tags (If-Match, If-None-Match; `*`) names this one. `weak`: W/ prefixes do not matter.
[[nodiscard]] bool tag_listed(std::string_view header, std::string_view tag, bool weak) noexcept;

/// Upper case pairs without spaces.
[[nodiscard]] std::string to_hex(std::span<const std::uint8_t> bytes);
/// Pairs, with blanks between pairs allowed; nothing if it is not that.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> from_hex(std::string_view text);

[[nodiscard]] bool is_utf8(std::string_view text) noexcept;
[[nodiscard]] std::string lower(std::string_view text);
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// JSON text, compact. Doubles in their shortest form (whole ones without an exponent), not-a-number and infinities as null, bytes that
/// are not UTF-8 as U+FFFD: what leaves the door is always JSON.
[[nodiscard]] std::string json_text(const boost::json::value& value);
void json_text(const boost::json::value& value, std::string& into);
/// A double as the JSON number people expect: whole ones below 2^53 as integers; null if it is not finite.
[[nodiscard]] boost::json::value number(double value);
/// null for an empty text.
[[nodiscard]] boost::json::value text_or_null(std::string_view text);

}  // namespace axisgate::http
