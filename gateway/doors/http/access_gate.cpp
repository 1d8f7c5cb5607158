// Reads cookies, Authorization and the headers by which proxies forward requests. An unknown scheme does not count as a request without
// credentials.
#include "gateway/doors/http/access_gate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/doors/http/hosts.hpp"
#include "gateway/doors/http/problem.hpp"
#include "gateway/doors/http/text.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http {
namespace {
constexpr std::size_t most_cookies = 8;  // with our name; further ones are ignored

std::vector<std::string_view> cookies_of(const Request& request, std::string_view name) {
    std::vector<std::string_view> out;
    for (const auto& [key, value] : request.headers.fields) {
        if (key.size() != 6 || lower(key) != "cookie") continue;
        std::string_view rest = value;
        while (!rest.empty() && out.size() < most_cookies) {
            const auto end = std::min(rest.find(';'), rest.size());
            const auto pair = trimmed(rest.substr(0, end));
            rest.remove_prefix(std::min(end + 1, rest.size()));
            const auto equals = pair.find('=');
            if (equals != std::string_view::npos && pair.substr(0, equals) == name) out.push_back(pair.substr(equals + 1));
        }
    }
    return out;
}

/// The headers that proxies, load balancers and content networks add to forwarded requests.
constexpr std::array<std::string_view, 14> forwarding{"forwarded",           "via",
                                                      "x-real-ip",           "x-client-ip",
                                                      "x-cluster-client-ip", "x-originating-ip",
                                                      "x-remote-ip",         "x-remote-addr",
                                                      "x-proxyuser-ip",      "true-client-ip",
                                                      "client-ip",           "cf-connecting-ip",
                                                      "fastly-client-ip",    "proxy-connection"};
constexpr std::array<std::string_view, 4> forwarding_begins{"x-forwarded", "x-original-", "x-envoy-", "cdn-"};

bool was_forwarded(const Request& request) {
    if (host_is_outer_address(host_meant(request))) return true;
    for (const auto& [key, value] : request.headers.fields) {
        const char first = key.empty() ? ' ' : static_cast<char>(key.front() | 0x20);
        if (std::string_view("cfptvx").find(first) == std::string_view::npos)
            continue;  // rejects the most frequent fields of most
                       // requests
        const std::string name = lower(key);
        if (std::ranges::find(forwarding, name) != forwarding.end()) return true;
        if (std::ranges::any_of(forwarding_begins, [&name](auto begin) { return name.starts_with(begin); })) return true;
    }
    return false;
}
}  // namespace

Identity identify(AccessPort* port, const Request& request, std::int64_t now_ns, bool touch) {
    Credentials c;
    c.peer = request.peer;
    c.forwarded = was_forwarded(request);
    if (port) c.cookies = cookies_of(request, port->accounts().settings().cookie);
    if (request.headers.count("Authorization") > 0) {
        // Any other scheme is an unknown credential, and does not count as none.
        const auto value = trimmed(request.headers.get("Authorization"));
        c.bearer = lower(value.substr(0, 7)) == "bearer " ? trimmed(value.substr(7)) : std::string_view();
    }
    if (!port) {
        if (!c.bearer) return local_identity(c, Role::engineer);
        Identity nobody;
        nobody.wrong_token = true;
        return nobody;
    }
    return port->accounts().identify(c, now_ns, touch);
}

std::string set_cookie(AccessPort& port, std::string_view value, bool secure, bool ends) {
    return fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/{}{}", port.accounts().settings().cookie, value, secure ? "; Secure" : "",
                       ends ? "; Max-Age=0" : "");
}

std::optional<Response> refuse_below(const Identity& identity, Role needed) {
    if (identity.role >= needed) return std::nullopt;
    if (identity.session_ended) {
        Response r = problem(401, "session_ended", std::string(session_ended_text));
        r.headers.set("WWW-Authenticate", R"(Bearer realm="axisgate")");
        return r;
    }
    if (identity.role == Role::none) {
        Response r =
            problem(401, identity.wrong_token ? "wrong_token" : "sign_in",
                    identity.wrong_token ? "this token is not known, has expired, or its user is disabled: make a new one on the page Users"
                                         : fmt::format("sign in first: this needs the role {}", name_of(needed)));
        r.headers.set("WWW-Authenticate",
                      identity.wrong_token ? R"(Bearer realm="axisgate", error="invalid_token")" : R"(Bearer realm="axisgate")");
        return r;
    }
    return problem(403, "role",
                   fmt::format("this needs the role {}; {} has the role {}", name_of(needed),
                               identity.user.empty() ? "this machine without a sign-in" : identity.user, name_of(identity.role)));
}

std::optional<Response> check_csrf(const Identity& identity, const Request& request) {
    if (identity.via != Identity::Via::cookie) return std::nullopt;
    if (request.method == Method::get || request.method == Method::head || request.method == Method::options) return std::nullopt;
    if (same_secret(request.headers.get("X-CSRF-Token"), identity.csrf)) return std::nullopt;
    return problem(403, "csrf", "the header X-CSRF-Token is missing or not this session's: it is in the answer of GET /api/v1/session");
}

}  // namespace axisgate::http
