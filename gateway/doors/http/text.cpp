// Small readers and writers of HTTP's grammars, each by the section of its RFC. The result depends only on the arguments.
#include "gateway/doors/http/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "gateway/core/text.hpp"

namespace axisgate::http {
namespace {
namespace json = boost::json;

int hex_digit(char c) noexcept {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool same_word(std::string_view a, std::string_view b) noexcept {
    return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

/// The quality of the type in the Accept header, 0..1000; -1: not accepted. The most specific range decides (RFC 9110 12.5.1).
int liking(std::string_view accept, std::string_view media) noexcept {
    if (trimmed(accept).empty()) return 1000;
    const auto kind = media.substr(0, media.find('/'));
    int best_specific = -1, quality = -1;
    while (!accept.empty()) {
        const auto item = next_item(accept);
        const auto range = trimmed(item.substr(0, item.find(';')));
        int specific = -1;
        if (same_word(range, media)) {
            specific = 2;
        } else if (range.size() > 2 && range.ends_with("/*") && same_word(range.substr(0, range.size() - 2), kind)) {
            specific = 1;
        } else if (range == "*/*") {
            specific = 0;
        }
        if (specific <= best_specific) continue;
        best_specific = specific;
        quality = 1000;
        for (auto rest = item.substr(std::min(item.find(';'), item.size())); !rest.empty();) {
            rest.remove_prefix(1);
            const auto parameter = trimmed(rest.substr(0, rest.find(';')));
            rest = rest.substr(std::min(rest.find(';'), rest.size()));
            if (parameter.size() > 2 && (parameter.starts_with("q=") || parameter.starts_with("Q="))) {
                if (const auto q = parse_number(parameter.substr(2))) quality = static_cast<int>(std::clamp(*q, 0.0, 1.0) * 1000);
            }
        }
    }
    return quality > 0 ? quality : -1;
}
}  // namespace

std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
            const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
            if (high < 0 || low < 0) return std::nullopt;
            c = static_cast<char>(high * 16 + low);
            i += 2;
        } else if (c == '+' && plus_is_space) {
            c = ' ';
        }
        if (c == '\0') return std::nullopt;
        out += c;
    }
    if (!is_utf8(out)) return std::nullopt;
    return out;
}

std::string percent_encode(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const bool plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' || c == '~';
        if (plain) {
            out += c;
        } else {
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return out;
}

std::optional<std::string_view> Query::get(std::string_view name) const noexcept {
    for (const auto& [k, v] : pairs) {
        if (k == name) return v;
    }
    return std::nullopt;
}

std::optional<std::string_view> authority_of(std::string_view target) noexcept {
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (target.size() <= scheme.size() || !same_word(target.substr(0, scheme.size()), scheme)) continue;
        target.remove_prefix(scheme.size());
        return target.substr(0, target.find_first_of("/?"));
    }
    return std::nullopt;
}

std::optional<Target> parse_target(std::string_view target) {
    bool bare_query = false;
    if (const auto authority = authority_of(target)) {
        target.remove_prefix(static_cast<std::size_t>(authority->data() - target.data()) + authority->size());
        if (target.empty()) target = "/";
        bare_query = target.front() == '?';  // "http://host?a=b": the path is "/"
    }
    if (!bare_query && (target.empty() || target.front() != '/')) return std::nullopt;
    if (!std::ranges::all_of(target, [](char c) { return static_cast<unsigned char>(c) > 0x20 && c != 0x7F && c != '#'; }))
        return std::nullopt;
    Target t;
    const auto mark = target.find('?');
    std::string_view path = bare_query ? std::string_view() : target.substr(1, mark == std::string_view::npos ? mark : mark - 1);
    bool slashes = false;
    for (;;) {
        const auto slash = path.find('/');
        auto segment = percent_decode(path.substr(0, slash));
        if (!segment) return std::nullopt;
        slashes = slashes || segment->find('/') != std::string::npos;
        t.segments.push_back(std::move(*segment));
        if (slash == std::string_view::npos) break;
        path.remove_prefix(slash + 1);
    }
    if (!slashes) {
        for (const auto& s : t.segments)
            t.path += "/" + s;
    }
    std::string_view query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
    while (!query.empty()) {
        const auto end = query.find('&');
        const auto item = query.substr(0, end);
        query.remove_prefix(end == std::string_view::npos ? query.size() : end + 1);
        if (item.empty()) continue;
        const auto equals = item.find('=');
        auto key = percent_decode(item.substr(0, equals), true);
        auto value = percent_decode(equals == std::string_view::npos ? std::string_view() : item.substr(equals + 1), true);
        if (!key || !value) return std::nullopt;
        t.query.pairs.emplace_back(std::move(*key), std::move(*value));
    }
    return t;
}

bool accepts(std::string_view accept, std::string_view media) noexcept { return liking(accept, media) >= 0; }

std::optional<std::size_t> best_accepted(std::string_view accept, std::span<const std::string_view> media) noexcept {
    std::optional<std::size_t> best;
    int best_liking = -1;
    for (std::size_t i = 0; i < media.size(); ++i) {
        if (const int l = liking(accept, media[i]); l > best_liking) {
            best_liking = l;
            best = i;
        }
    }
    return best;
}

std::string media_of(std::string_view content_type) {
    const auto end = content_type.find(';');
    std::string_view rest = end == std::string_view::npos ? std::string_view() : content_type.substr(end + 1);
    while (!rest.empty()) {
        const auto stop = rest.find(';');
        const std::string parameter = lower(trimmed(rest.substr(0, stop)));
        rest.remove_prefix(stop == std::string_view::npos ? rest.size() : stop + 1);
        if (parameter.starts_with("charset=") && parameter != "charset=utf-8" && parameter != "charset=\"utf-8\"") return {};
    }
    return lower(trimmed(content_type.substr(0, end)));
}

std::string_view next_item(std::string_view& list) noexcept {
    bool quoted = false;
    std::size_t i = 0;
    for (; i < list.size(); ++i) {
        if (list[i] == '"') quoted = !quoted;
        if (list[i] == ',' && !quoted) break;
    }
    const auto item = list.substr(0, i);
    list.remove_prefix(std::min(i + 1, list.size()));
    return trimmed(item);
}

bool tag_listed(std::string_view header, std::string_view tag, bool weak) noexcept {
    while (!header.empty()) {
        auto item = next_item(header);
        if (item == "*") return true;
        if (weak && item.starts_with("W/")) item.remove_prefix(2);
        if (item == tag) return true;
    }
    return false;
}

}  // namespace axisgate::http
