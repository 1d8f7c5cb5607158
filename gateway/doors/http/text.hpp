// The small grammars of HTTP: targets, queries, media types, entity tags. Bad input gives an empty result.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/text.hpp"

namespace axisgate::http {

/// Decodes %XX. Empty if a % is not followed by two hex digits, or if the result has a NUL or is not UTF-8.
[[nodiscard]] std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space = false);
/// Encodes all characters except unreserved ones (RFC 3986 2.3).
[[nodiscard]] std::string percent_encode(std::string_view text);

/// A query string as pairs, in order.
struct Query {
    std::vector<std::pair<std::string, std::string>> pairs;
    /// First value of that name.
    [[nodiscard]] std::optional<std::string_view> get(std::string_view name) const noexcept;
};

/// A request target, split into its parts.
struct Target {
    std::vector<std::string> segments;  ///< decoded; "/a/b" has two, "/" has one empty
    std::string path;                   ///< decoded and joined, for static files; empty if a segment contains a slash
    Query query;
};
/// Origin form ("/a/b?c=d") or absolute form ("http://host/a"). Empty if it is neither.
[[nodiscard]] std::optional<Target> parse_target(std::string_view target);
/// The host and port of an absolute form; empty for any other.
[[nodiscard]] std::optional<std::string_view> authority_of(std::string_view target) noexcept;

/// True if an Accept header (empty: anything) accepts the media type.
[[nodiscard]] bool accepts(std::string_view accept, std::string_view media) noexcept;
/// Index of the type with the highest quality, the first one among equals; empty if none is accepted.
[[nodiscard]] std::optional<std::size_t> best_accepted(std::string_view accept, std::span<const std::string_view> media) noexcept;
/// The type of a Content-Type header, lower case, without its parameters; empty if a charset other than UTF-8 is named.
[[nodiscard]] std::string media_of(std::string_view content_type);

/// One item of a comma separated list, removed from its front; commas in quoted strings do not separate.
[[nodiscard]] std::string_view next_item(std::string_view& list) noexcept;
/// True if a list of entity tags (If-Match, If-None-Match; `*`) contains this one. `weak`: W/ prefixes are ignored.
[[nodiscard]] bool tag_listed(std::string_view header, std::string_view tag, bool weak) noexcept;

}  // namespace axisgate::http
