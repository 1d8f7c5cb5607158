// Preconditions: tags are FNV-1a of what makes a state; nothing depends on their being hard to forge.
// In: states, headers. Out: tags, 412. Keeps nothing; never decides for the site, which has its revision.
#include "gateway/doors/http/preconditions.hpp"

#include <fmt/core.h>

#include "gateway/doors/http/problem.hpp"
#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace json = boost::json;

std::string tag_over(std::initializer_list<std::string_view> parts) {
    std::uint64_t h = 14695981039346656037ull;  // FNV-1a, 64 bits: nothing depends on it being hard to forge
    for (const auto part : parts) {
        for (const char x : part)
            h = (h ^ static_cast<unsigned char>(x)) * 1099511628211ull;
        h = (h ^ 0xFF) * 1099511628211ull;
    }
    return fmt::format("\"{:016x}\"", h);
}

Response with_tag(Response r, const std::string& tag) {
    r.headers.set("ETag", tag);
    return r;
}

Response overtaken(std::string detail, const std::optional<std::string>& tag, json::value current) {
    Problem p{.status = 412, .reason = "precondition_failed", .detail = std::move(detail)};
    p.more["etag"] = tag ? json::value(*tag) : json::value(nullptr);
    p.more["current"] = std::move(current);
    Response r = to_response(p);
    return tag ? with_tag(std::move(r), *tag) : r;
}

bool means_another(std::string_view if_match, const std::string& tag) { return !if_match.empty() && !tag_listed(if_match, tag, false); }

}  // namespace axisgate::http
