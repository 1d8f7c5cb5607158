// Entity tags of objects outside the site (recipes, users, single parameters, the Modbus door), and the 412 for all of them, with the
// present state. The site's tag is its revision.
#pragma once

#include <boost/json/value.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/services/state_tag.hpp"

namespace axisgate::http {

/// The entity tag of the site with this revision.
[[nodiscard]] std::string site_tag(std::uint64_t revision);
/// The same answer with the header ETag.
[[nodiscard]] Response with_tag(Response response, const std::string& tag);
/// 412 with `etag` and `current`, the present state; null and no header if it does not exist any more.
[[nodiscard]] Response overtaken(std::string detail, const std::optional<std::string>& tag, boost::json::value current);
/// If-Match and If-None-Match, for a change that waits for its turn.
[[nodiscard]] MeantState meant_state(const Request& request);
/// True if If-Match (empty: it was not sent) names another state than this one.
[[nodiscard]] bool means_another(std::string_view if_match, const std::string& tag);

}  // namespace axisgate::http
