// Preconditions: entity tags of what is kept outside the site (recipes, users, one parameter, the Modbus door), and the 412 of all of them.
// In: what makes a state. Out: a tag; a refusal that tells what is there now. The site's is its revision.
#pragma once

#include <boost/json/value.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/services/state_tag.hpp"

namespace axisgate::http {

/// The entity tag of the site of this revision.
[[nodiscard]] std::string site_tag(std::uint64_t revision);
/// The same answer with the header ETag.
[[nodiscard]] Response with_tag(Response response, const std::string& tag);
/// 412 with `etag` and `current`: what is there now; null and no header where there is nothing any more.
[[nodiscard]] Response overtaken(std::string detail, const std::optional<std::string>& tag, boost::json::value current);
/// If-Match and If-None-Match, for a change that waits for its turn.
[[nodiscard]] MeantState meant_state(const Request& request);
/// Whether If-Match (empty: it was not sent) names another state than this one.
[[nodiscard]] bool means_another(std::string_view if_match, const std::string& tag);

}  // namespace axisgate::http
