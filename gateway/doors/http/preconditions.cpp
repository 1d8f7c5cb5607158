// Compares the state that a request names with the present one, and makes the 412. For the site the revision is compared elsewhere.
#include "gateway/doors/http/preconditions.hpp"

#include <fmt/core.h>

#include "gateway/doors/http/problem.hpp"
#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace json = boost::json;

std::string site_tag(std::uint64_t revision) { return fmt::format("\"{}\"", revision); }

Response with_tag(Response r, const std::string& tag) {
    r.headers.set("ETag", tag);
    return r;
}

Response overtaken(std::string detail, const std::optional<std::string>& tag, json::value current) {
    return problem_of(ServiceRefusal{.why = ServiceRefusal::Why::overtaken,
                                     .text = std::move(detail),
                                     .more = {{"current", std::move(current)}},
                                     .tag = tag.value_or("")});
}

MeantState meant_state(const Request& request) {
    return {std::string(request.headers.get("If-Match")), std::string(request.headers.get("If-None-Match")), tag_listed};
}

bool means_another(std::string_view if_match, const std::string& tag) { return !if_match.empty() && !tag_listed(if_match, tag, false); }

}  // namespace axisgate::http
