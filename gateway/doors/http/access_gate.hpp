// Determines the identity of a request from its headers, and checks the role that a route requires. Only this file refuses because of a
// role, with 401 or 403. Bodies are not read.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/services/access/access_port.hpp"

namespace axisgate::http {

/// Without a port there are no users: requests from this machine are engineers, all others nobody.
[[nodiscard]] Identity identify(AccessPort* port, const Request& request, std::int64_t now_ns, bool touch = true);
/// Empty if the identity has at least that role; otherwise 401 (nobody) or 403 (too low).
[[nodiscard]] std::optional<Response> refuse_below(const Identity& identity, Role needed);
/// 403 for a request that changes something with a cookie but without the session's token in X-CSRF-Token.
[[nodiscard]] std::optional<Response> check_csrf(const Identity& identity, const Request& request);

inline constexpr std::string_view session_ended_text =
    "this session has ended: it was signed out, has expired, or the gateway was restarted; sign in again, or go on without a sign-in";
/// Set-Cookie of a session; `ends`: the browser deletes it.
[[nodiscard]] std::string set_cookie(AccessPort& port, std::string_view value, bool secure, bool ends);

}  // namespace axisgate::http
