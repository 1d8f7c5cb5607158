// Access gate: from a request's headers to an identity, and from a route to the role that it needs. The one place that refuses for a role.
// In: requests, the accounts. Out: an Identity; 401 or 403 with what is needed. Never looks at a body.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/services/access/access_port.hpp"

namespace axisgate::http {

/// Without a port there are no users: requests from this machine are engineers, all others nobody.
[[nodiscard]] Identity identify(AccessPort* port, const Request& request, std::int64_t now_ns, bool touch = true);
/// Nothing if the identity has at least that role; else 401 (nobody) or 403 (too low).
[[nodiscard]] std::optional<Response> refuse_below(const Identity& identity, Role needed);
/// 403 for a request that changes something over a cookie without the session's token in X-CSRF-Token.
[[nodiscard]] std::optional<Response> check_csrf(const Identity& identity, const Request& request);

inline constexpr std::string_view session_ended_text =
    "this session has ended: it was signed out, has expired, or the gateway was restarted; sign in again, or go on without a sign-in";
/// Set-Cookie of a session; `ends`: the browser forgets it.
[[nodiscard]] std::string set_cookie(AccessPort& port, std::string_view value, bool secure, bool ends);

}  // namespace axisgate::http
