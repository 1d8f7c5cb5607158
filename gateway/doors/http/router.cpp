// Applies the table of routes and the rules for all of them.
#include "gateway/doors/http/router.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "gateway/doors/http/accounts.hpp"
#include "gateway/doors/http/hosts.hpp"
#include "gateway/doors/http/request_checks.hpp"
#include "gateway/doors/http/static_files.hpp"

namespace axisgate::http {
namespace {
using Takes = Route::Takes;
using Gives = Route::Gives;

constexpr std::size_t most_told_bytes = 128;  // of a text of the body in an event
constexpr std::array<Method, 5> listed_methods{Method::get, Method::post, Method::put, Method::patch, Method::remove};

/// One path of the table with all its routes, split once.
struct Shape {
    std::string_view path;
    std::vector<std::string_view> parts;
    std::size_t names = 0;  ///< number of `{...}` segments
    std::vector<const Route*> routes;
};

bool is_name(std::string_view part) { return part.starts_with('{'); }

std::vector<std::string_view> parts_of(std::string_view path) {
    std::vector<std::string_view> parts;
    for (path.remove_prefix(1);; path.remove_prefix(parts.back().size() + 1)) {
        parts.push_back(path.substr(0, path.find('/')));
        if (parts.back().size() == path.size()) return parts;
    }
}

/// Shapes by their number of segments.
std::vector<std::vector<Shape>> make_shapes() {
    std::vector<std::vector<Shape>> all;
    for (const Route& r : all_routes()) {
        auto parts = parts_of(r.path);
        if (all.size() <= parts.size()) all.resize(parts.size() + 1);
        auto& same_size = all[parts.size()];
        auto shape = std::ranges::find(same_size, r.path, &Shape::path);
        if (shape == same_size.end()) {
            const auto names = static_cast<std::size_t>(std::ranges::count_if(parts, is_name));
            same_size.push_back({r.path, std::move(parts), names, {}});
            shape = std::prev(same_size.end());
        }
        shape->routes.push_back(&r);
    }
    return all;
}

bool fits(const Shape& shape, const std::vector<std::string>& segments) {
    // From the end, where paths differ.
    for (std::size_t i = segments.size(); i-- > 0;) {
        if (is_name(shape.parts[i]) ? segments[i].empty() : shape.parts[i] != segments[i]) return false;
    }
    return true;
}

/// The path of a target: of several that fit, the one with the fewest names in it, so that /mappings/list is not a mapping.
const Shape* shape_of(const std::vector<std::string>& segments) {
    static const std::vector<std::vector<Shape>> shapes = make_shapes();
    const Shape* best = nullptr;
    if (segments.size() >= shapes.size()) return best;
    for (const Shape& s : shapes[segments.size()]) {
        if ((!best || s.names < best->names) && fits(s, segments)) best = &s;
    }
    return best;
}

/// The values of the `{...}` segments.
std::vector<std::string> names_in(const Shape& shape, const std::vector<std::string>& segments) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        if (is_name(shape.parts[i])) names.push_back(segments[i]);
    }
    return names;
}

const Route* route_for(const Shape& shape, Method method) {
    const auto it = std::ranges::find(shape.routes, method, &Route::method);
    return it == shape.routes.end() ? nullptr : *it;
}

/// "GET, HEAD, PUT"
std::string allowed_by(const Shape& shape) {
    std::string allow;
    for (const auto method : listed_methods) {
        if (!route_for(shape, method)) continue;
        allow += fmt::format("{}{}", allow.empty() ? "" : ", ", method == Method::get ? "GET, HEAD" : name_of(method));
    }
    return allow;
}

std::string_view route_word(const std::optional<Target>& target) {
    if (!target) return "none";
    if (const Shape* shape = shape_of(target->segments)) return shape->path;
    return target->segments[0] == "api" ? "none" : "static";
}

std::string_view media_given(Gives gives) {
    switch (gives) {
        case Gives::json:
            return "application/json";
        case Gives::text:
            return "text/plain";
        case Gives::yaml:
            return "application/yaml";
        case Gives::nothing:
        case Gives::own:
            return {};
    }
    return {};
}

std::string event_text(std::string_view pattern, const Call& call) {
    std::string text;
    std::size_t name = 0;
    for (auto rest = pattern; !rest.empty();) {
        const auto open = rest.find('{'), close = rest.find('}');
        text += rest.substr(0, open);
        if (open == std::string_view::npos || close == std::string_view::npos) break;
        const auto word = rest.substr(open + 1, close - open - 1);
        rest.remove_prefix(close + 1);
        const auto* const body = call.body.if_object();
        const auto* const member = body && !word.empty() ? body->if_contains(word) : nullptr;
        if (word.empty() && name < call.names.size()) text += call.names[name++];
        if (member && member->is_string()) text += std::string_view(member->get_string()).substr(0, most_told_bytes);
    }
    return text;
}

}  // namespace

std::optional<Response> Router::check_host(const Request& request) const {
    const auto count = request.headers.count("Host");
    if (count > 1) return problem(400, "bad_request", "there are several Host headers");
    if (count == 0 && !request.http_1_0) return problem(400, "bad_request", "the Host header is missing");
    const auto named = authority_of(request.target);
    if (named && named->empty()) return problem(400, "bad_request", "the request target names no host");
    if (count == 0 && !named) return std::nullopt;
    const auto host = host_meant(request);
    if (!host_is_written_right(host))
        return problem(400, "bad_request", "the Host header is not a name or an address with or without a port");
    if (host_allowed(host, context_.settings)) return std::nullopt;
    return problem(
        421, "misdirected",
        fmt::format("this gateway is not called {}: use its IP address or localhost, or add the name to [http] allowed_hosts", host));
}

std::optional<Response> Router::check_origin(const Request& request) {
    const auto origin = request.headers.get("Origin");
    const bool cross_site = request.headers.get("Sec-Fetch-Site") == "cross-site";
    if (!cross_site && (request.headers.count("Origin") == 0 || same_host(origin, host_meant(request)))) return std::nullopt;
    return problem(403, "forbidden",
                   fmt::format("the request comes from a page of another host ({})", origin.empty() ? "cross-site" : origin));
}

/// The result of a request's head: an answer, or a route with everything that its handler needs except the body.
struct Router::Entry {
    std::optional<Response> answer;
    const Route* route = nullptr;
    std::optional<Target> target;
    std::vector<std::string> names;
    Identity identity{};
};

std::size_t Router::most_bytes(const Route& route, const Identity& identity) const noexcept {
    if (identity.role == Role::none) return context_.settings.max_stranger_bytes;
    return route.takes == Takes::bytes ? context_.settings.max_backup_bytes : context_.settings.max_body_bytes;
}

Router::Entry Router::enter(const Request& request, std::optional<Target> target, bool touch) const {
    Entry e;
    const auto answer = [&e](Response r) {
        e.answer = std::move(r);
        return std::move(e);
    };
    if (auto refusal = check_host(request)) return answer(*std::move(refusal));
    if (request.method == Method::options && request.target == "*") {
        Response r;
        r.status = 204;
        return answer(std::move(r));
    }
    e.target = std::move(target);
    if (!e.target)
        return answer(problem(400, "bad_request", "the request target cannot be read: a path that begins with /, percent-encoded UTF-8"));

    const Method wanted = request.method == Method::head ? Method::get : request.method;
    const Shape* shape = shape_of(e.target->segments);
    e.route = shape ? route_for(*shape, wanted) : nullptr;
    const bool is_api = !e.target->segments.empty() && e.target->segments[0] == "api";
    if (!shape && is_api)
        return answer(problem(404, "not_found", fmt::format("there is nothing at {}: see /api/v1/openapi.yaml", request.target)));
    if (!shape && wanted == Method::get) return answer(static_file(context_.asset, *e.target, request.headers));
    if (!e.route) {
        const std::string allow = (shape ? allowed_by(*shape) : "GET, HEAD") + ", OPTIONS";
        Response r;
        if (request.method == Method::options) {
            r.status = 204;
        } else {
            r = problem(405, "method_not_allowed", fmt::format("this takes {}", allow));
        }
        r.headers.set("Allow", allow);
        return answer(std::move(r));
    }
    e.names = names_in(*shape, e.target->segments);
    // Identity and role are checked before anything else of the request.
    e.identity = http::identify(context_.access.get(), request, context_.ports.get<ClockPort>().now_unix_ns(), touch);
    if (const Role needed = e.route->needed(); needed != Role::none) {
        if (auto refusal = refuse_below(e.identity, needed)) {
            if (e.identity.session_ended) refusal->headers.set("Set-Cookie", set_cookie(*context_.access, "", request.secure, true));
            return answer(*std::move(refusal));
        }
    }
    if (e.route->handler != take<sign_in> && e.route->handler != take<first_sign_in>) {
        if (auto refusal = check_csrf(e.identity, request)) return answer(*std::move(refusal));
    }
    if (wanted != Method::get || e.route->same_origin_only) {
        if (auto refusal = check_origin(request)) return answer(*std::move(refusal));
    }
    if (const auto most = most_bytes(*e.route, e.identity); request.announced_bytes.value_or(0) > most)
        return answer(problem(413, "too_large", fmt::format("a body may have {} bytes here", most)));
    if (const auto media = media_given(e.route->gives); !media.empty() && !accepts(request.headers.get("Accept"), media))
        return answer(problem(406, "not_acceptable", fmt::format("this can be given as {}", media)));
    if (auto refusal = check_query(e.target->query, e.route->query)) return answer(*std::move(refusal));
    if (auto refusal = check_media(request, e.route->takes)) return answer(*std::move(refusal));
    if (auto refusal = check_coding(request, e.route->takes)) return answer(*std::move(refusal));
    return e;
}

Admission Router::admit(const Request& head) const {
    Admission a;
    a.max_body_bytes = context_.settings.max_stranger_bytes;
    try {
        Entry e = enter(head, parse_target(head.target), false);
        if (e.route) a.max_body_bytes = most_bytes(*e.route, e.identity);
        if (e.answer && e.answer->status >= 400) {
            Audit::Asked asked;
            fill(asked, head, e);
            audit_->answered(asked, *e.answer, context_.now());
            a.refusal = std::move(e.answer);
        }
    } catch (const std::exception& x) {
        a.refusal = problem(500, "internal", fmt::format("a fault of the gateway itself: {}", x.what()));
    }
    if (a.refusal) finish(*a.refusal, head.method == Method::head);
    return a;
}

/// The data for a possible event; for requests that only read, only refusals.
void Router::fill(Audit::Asked& asked, const Request& request, const Entry& e) const {
    asked.changes = request.method != Method::get && request.method != Method::head && request.method != Method::options;
    if (!asked.changes && !(e.answer && Audit::is_refusal(e.answer->status, false))) return;
    asked.what = what_is_asked(request);
    asked.peer = request.peer;
    asked.who = context_.access ? who(e.identity, request.peer) : request.peer;
}

Handled Router::dispatch(const Request& request, std::optional<Target> target, const Respond& respond, Audit::Asked& asked) const {
    Entry e = enter(request, std::move(target), true);
    fill(asked, request, e);
    Handled handled;
    if (e.route) handled.known = e.identity.role != Role::none;
    if (e.answer) {
        handled.now = std::move(e.answer);
        return handled;
    }
    if (context_.access) keep_uses(context_.access);
    const bool known = *handled.known;
    Call call{context_, request, *e.target, std::move(e.names), nullptr, respond, std::move(e.identity)};
    if (auto refusal = read_body(request, e.route->takes, call.body)) return *std::move(refusal);
    // Named clients that may command are candidates for a hand-over.
    if (call.identity.role >= Role::operating && (!call.identity.user.empty() || request.headers.count("X-Client") != 0)) {
        context_.clients->note(*call.origin().client, context_.ports.get<ClockPort>().now_unix_ns());
    }
    if (!e.route->event_kind.empty()) {
        asked.kind = e.route->event_kind;
        asked.told = event_text(e.route->event_text, call);
    }
    handled = e.route->handler(call);
    handled.known = known;
    handled.commands = e.route->commands;
    return handled;
}

void Router::finish(Response& r, bool is_head) {
    if (r.status == 204 || r.status == 304 || r.status == 101 || is_head) r.without_body = true;
    if (r.status == 101) return;
    r.headers.set("X-Content-Type-Options", "nosniff");
    r.headers.set("Referrer-Policy", "no-referrer");
    r.headers.set("X-Frame-Options", "DENY");
    r.headers.set("Cross-Origin-Resource-Policy", "same-origin");
    r.headers.set("Content-Security-Policy",
                  "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'");
    if (r.headers.get("Cache-Control").empty()) r.headers.set("Cache-Control", "no-store");
}

Handled Router::handle(const Request& request, Respond respond) const {
    // A command may be answered from inside a call: then the promise is an immediate answer.
    struct Once {
        bool inside = true, answered = false;
        std::optional<Response> early;
        Respond respond;
        Audit::Asked asked;
        std::shared_ptr<Audit> audit;
        std::function<Instant()> now;
    };
    auto once = std::make_shared<Once>();
    once->respond = std::move(respond);
    once->audit = audit_;
    once->now = context_.now;
    const bool is_head = request.method == Method::head;
    Handled handled;
    std::string_view route = "none";
    try {
        auto target = parse_target(request.target);
        route = route_word(target);
        handled = dispatch(
            request, std::move(target),
            [once, is_head](Response r) {
                if (once->answered) return;
                once->answered = true;
                if (once->inside) {
                    once->early = std::move(r);
                    return;
                }
                once->audit->answered(once->asked, r, once->now());
                finish(r, is_head);
                once->respond(std::move(r));
            },
            once->asked);
    } catch (const std::exception& e) {
        handled = problem(500, "internal", fmt::format("a fault of the gateway itself: {}", e.what()));
    }
    once->inside = false;
    if (handled.now) {
        once->answered = true;
    } else if (once->early) {
        handled.now = std::move(once->early);
    }
    if (handled.now) {
        audit_->answered(once->asked, *handled.now, context_.now());
        finish(*handled.now, is_head);
    } else {
        finish(handled.at_limit, is_head);
    }
    handled.route = route;
    return handled;
}

bool Router::moves(const Request& request) const {
    if (request.method == Method::get || request.method == Method::head) return false;
    const auto target = parse_target(request.target);
    const Shape* shape = target ? shape_of(target->segments) : nullptr;
    const Route* route = shape ? route_for(*shape, request.method) : nullptr;
    return route && route->commands;
}

std::string_view Router::why_not_watched_on(const Request& request) const {
    const Identity now = http::identify(context_.access.get(), request, context_.ports.get<ClockPort>().now_unix_ns(), false);
    if (now.role >= Role::viewer) return {};
    return now.wrong_token ? "the token has expired or was removed" : "signed out";
}

std::optional<Origin> Router::commander_of(const Request& request) const {
    const Identity now = http::identify(context_.access.get(), request, context_.ports.get<ClockPort>().now_unix_ns(), false);
    if (now.role < Role::operating) return std::nullopt;
    return origin_of(request, now, context_.access ? who(now, request.peer) : request.peer);
}

std::string_view Router::route_of(const Request& request) const { return route_word(parse_target(request.target)); }

}  // namespace axisgate::http
