// Preconditions: entity tags of what is kept outside the site (recipes, users, one parameter, the Modbus door), and the 412 of all of them.
// In: what makes a state. Out: a tag; a refusal that tells what is there now. The site has its revision.
#pragma once

#include <boost/json/value.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/doors/http/message.hpp"

namespace axisgate::http {

/// A strong entity tag, with its quotes: other parts, or parts divided otherwise, are another tag. Gives no part away.
[[nodiscard]] std::string tag_over(std::initializer_list<std::string_view> parts);
/// The same answer with the header ETag.
[[nodiscard]] Response with_tag(Response response, const std::string& tag);
/// 412 with `etag` and `current`: what is there now; null and no header where there is nothing any more.
[[nodiscard]] Response overtaken(std::string detail, const std::optional<std::string>& tag, boost::json::value current);
/// Whether If-Match (empty: it was not sent) names another state than this one.
[[nodiscard]] bool means_another(std::string_view if_match, const std::string& tag);

}  // namespace axisgate::http
