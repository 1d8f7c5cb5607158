// Checks of query and body for every route: known names, media types, no compression, unambiguous JSON. The meaning of values is checked by
// the handlers.
#pragma once

#include <boost/json/value.hpp>
#include <optional>
#include <string_view>

#include "gateway/doors/http/router.hpp"

namespace axisgate::http {

/// 415 if the media type of the body is not that of the route.
[[nodiscard]] std::optional<Response> check_media(const Request& request, Route::Takes takes);
/// 415 for a Content-Encoding other than identity.
[[nodiscard]] std::optional<Response> check_coding(const Request& request, Route::Takes takes);
/// 400 for a name that is not in `known` (separated by blanks), or occurs twice.
[[nodiscard]] std::optional<Response> check_query(const Query& query, std::string_view known);
/// Reads the body if the route takes JSON; 400 if it is not JSON, not an object, or has two members of one name.
[[nodiscard]] std::optional<Response> read_body(const Request& request, Route::Takes takes, boost::json::value& into);

}  // namespace axisgate::http
