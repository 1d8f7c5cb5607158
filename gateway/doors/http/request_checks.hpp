// Request checks: what holds for the query and the body of every route: known names, media types, no packing, JSON without doubt.
// In: a request and what its route takes. Out: a refusal, or nothing. Never looks at what a value means: that is the handler's.
#pragma once

#include <boost/json/value.hpp>
#include <optional>
#include <string_view>

#include "gateway/doors/http/router.hpp"

namespace axisgate::http {

/// 415 if the media type that is announced for the body is not the route's.
[[nodiscard]] std::optional<Response> check_media(const Request& request, Route::Takes takes);
/// 415 for a Content-Encoding other than identity.
[[nodiscard]] std::optional<Response> check_coding(const Request& request, Route::Takes takes);
/// 400 for a name that is not among `known` (with blanks between them), or stands twice.
[[nodiscard]] std::optional<Response> check_query(const Query& query, std::string_view known);
/// Reads the body where the route takes JSON; 400 if it is none, no object, or has two members of one name.
[[nodiscard]] std::optional<Response> read_body(const Request& request, Route::Takes takes, boost::json::value& into);

}  // namespace axisgate::http
