// Files are compressed when the page is built; the compressed form is a representation with a tag of its own.
#include "gateway/doors/http/static_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/doors/http/problem.hpp"
#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace {
/// FNV-1a, 64 bits: identifies the content; it need not be hard to forge.
std::uint64_t hash_of(std::string_view bytes) noexcept {
    std::uint64_t h = 14695981039346656037ull;
    for (const unsigned char c : bytes)
        h = (h ^ c) * 1099511628211ull;
    return h;
}

bool is_hidden_or_upward(const Target& target) {
    if (target.path.empty()) return true;
    return std::ranges::any_of(target.segments, [](const std::string& s) {
        return s.starts_with('.') || s.find('\\') != std::string::npos ||
               std::ranges::any_of(s, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    });
}

/// True if an Accept-Encoding field accepts gzip (RFC 9110 12.5.3): by its name, otherwise by "*", and not with a quality of 0.
bool takes_gzip(std::string_view field) {
    bool by_star = false;
    while (!field.empty()) {
        const auto end = std::min(field.find(','), field.size());
        const auto item = field.substr(0, end);
        field.remove_prefix(std::min(end + 1, field.size()));
        const auto mark = std::min(item.find(';'), item.size());
        const std::string name = lower(trimmed(item.substr(0, mark)));
        if (name != "gzip" && name != "x-gzip" && name != "*") continue;
        const std::string quality = mark < item.size() ? lower(trimmed(item.substr(mark + 1))) : std::string();
        const bool taken = !quality.starts_with("q=") || parse_number(std::string_view(quality).substr(2)).value_or(1) > 0;
        if (name != "*") return taken;
        by_star = taken;
    }
    return by_star;
}

/// True if an Accept field names text/html itself, as browsers do when a page is opened; requests that accept anything want no page.
bool asks_for_html(std::string_view field) {
    while (!field.empty()) {
        const auto end = std::min(field.find(','), field.size());
        const auto item = field.substr(0, end);
        field.remove_prefix(std::min(end + 1, field.size()));
        const auto mark = std::min(item.find(';'), item.size());
        if (lower(trimmed(item.substr(0, mark))) != "text/html") continue;
        const std::string quality = mark < item.size() ? lower(trimmed(item.substr(mark + 1))) : std::string();
        return !quality.starts_with("q=") || parse_number(std::string_view(quality).substr(2)).value_or(1) > 0;
    }
    return false;
}
bool is_address_of_page(const Target& target) {
    constexpr std::array<std::string_view, 6> others{"api", "assets", "healthz", "help", "metrics", "readyz"};
    return std::ranges::find(others, std::string_view(target.segments.front())) == others.end();
}
}  // namespace

std::string_view media_for(std::string_view path) noexcept {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 15> types{{{".html", "text/html; charset=utf-8"},
                                                                                          {".js", "text/javascript; charset=utf-8"},
                                                                                          {".mjs", "text/javascript; charset=utf-8"},
                                                                                          {".css", "text/css; charset=utf-8"},
                                                                                          {".json", "application/json"},
                                                                                          {".map", "application/json"},
                                                                                          {".webmanifest", "application/manifest+json"},
                                                                                          {".svg", "image/svg+xml"},
                                                                                          {".png", "image/png"},
                                                                                          {".webp", "image/webp"},
                                                                                          {".ico", "image/x-icon"},
                                                                                          {".woff2", "font/woff2"},
                                                                                          {".woff", "font/woff"},
                                                                                          {".txt", "text/plain; charset=utf-8"},
                                                                                          {".yaml", "application/yaml"}}};
    for (const auto& [ending, type] : types) {
        if (path.ends_with(ending)) return type;
    }
    return "application/octet-stream";
}

Response static_file(const AssetLookup& asset, const Target& target, const Headers& headers) {
    if (is_hidden_or_upward(target)) return problem(404, "not_found", "there is no such file");
    std::string path = target.path;
    if (path == "/help") path += '/';  // the contents of the handbook; its links are whole paths
    if (path.ends_with('/')) path += "index.html";
    std::string_view bytes = asset ? asset("web/dist" + path) : std::string_view();
    // The page has addresses of its own, with names in them ("/axes/portal.x"): a browser that opens one gets the page.
    const bool opened = bytes.data() == nullptr && is_address_of_page(target) && asks_for_html(headers.get("Accept"));
    if (opened) {
        path = "/index.html";
        bytes = asset ? asset("web/dist/index.html") : std::string_view();
    }
    if (bytes.data() == nullptr) {
        return problem(
            404, "not_found",
            target.path == "/" || opened
                ? "this build holds no page; the interface is described at /api/v1/openapi.yaml"
                : fmt::format("there is no {} here: the interface is at /api/v1, described by /api/v1/openapi.yaml", target.path));
    }
    // Compressed when the page was built, not for each request. The compressed form has its own tag.
    Response r;
    if (opened) r.headers.set("Vary", "Accept");
    const auto packed = asset("web/dist" + path + ".gz");
    if (packed.data() != nullptr) {
        r.headers.set("Vary", opened ? "Accept, Accept-Encoding" : "Accept-Encoding");
        if (takes_gzip(headers.get("Accept-Encoding"))) {
            r.headers.set("Content-Encoding", "gzip");
            bytes = packed;
        }
    }
    const std::string tag = fmt::format("\"{:016x}\"", hash_of(bytes));
    r.headers.set("ETag", tag);
    // The build of the page gives each content of assets/ a name of its own, so such a file never changes. All others are cached as well,
    // but validated each time; the tag makes this cheap.
    r.headers.set("Cache-Control", path.starts_with("/assets/") ? "max-age=31536000, immutable" : "no-cache");
    if (tag_listed(headers.get("If-None-Match"), tag, true)) {
        r.status = 304;
        r.headers.remove("Content-Encoding");  // there is no content
        return r;
    }
    r.headers.set("Content-Type", std::string(media_for(path)));
    r.body = std::string(bytes);
    return r;
}

}  // namespace axisgate::http
