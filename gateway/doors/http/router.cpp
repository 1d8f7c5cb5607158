// Router: the table of routes and the rules that hold for all of them.
// In: requests. Out: answers.
#include "gateway/doors/http/router.hpp"

#include <fmt/format.h>
#include <boost/json/parse.hpp>

#include <algorithm>
#include <array>

#include "gateway/doors/http/static_files.hpp"

namespace axisgate::http {
namespace {
namespace json = boost::json;
using Takes = Route::Takes;
using Gives = Route::Gives;

constexpr std::array routes{
    Route{"/healthz", Method::get, get_health}.needs(Role::none),
    Route{"/readyz", Method::get, get_ready}.needs(Role::none),
    Route{"/metrics", Method::get, get_metrics, Takes::nothing, Gives::text},
    Route{"/api/v1/openapi.yaml", Method::get, get_description, Takes::nothing, Gives::yaml}.needs(Role::none),
    Route{"/api/v1/about", Method::get, get_about},
    Route{"/api/v1/families", Method::get, list_families},
    Route{"/api/v1/families/{family}", Method::get, get_family},
    Route{"/api/v1/families/{family}/parameters", Method::get, list_family_parameters},
    Route{"/api/v1/families/{family}/commands", Method::get, list_family_commands},
    Route{"/api/v1/families/{family}/errors", Method::get, list_family_errors},
    Route{"/api/v1/lines", Method::get, list_lines},
    Route{"/api/v1/lines", Method::post, add_line, Takes::json},
    Route{"/api/v1/lines/{line}", Method::get, get_line},
    Route{"/api/v1/lines/{line}", Method::put, replace_line, Takes::json},
    Route{"/api/v1/lines/{line}", Method::patch, change_line, Takes::patch},
    Route{"/api/v1/lines/{line}", Method::remove, remove_line, Takes::nothing, Gives::nothing},
    Route{"/api/v1/lines/{line}/trace", Method::get, get_trace, Takes::nothing, Gives::own},
    Route{"/api/v1/lines/{line}/scan", Method::get, get_scan},
    Route{"/api/v1/lines/{line}/scan", Method::post, start_scan, Takes::json},
    Route{"/api/v1/lines/{line}/scan", Method::remove, cancel_scan},
    Route{"/api/v1/drives", Method::get, list_drives},
    Route{"/api/v1/drives", Method::post, add_drive, Takes::json},
    Route{"/api/v1/drives/{drive}", Method::get, get_drive},
    Route{"/api/v1/drives/{drive}", Method::put, replace_drive, Takes::json},
    Route{"/api/v1/drives/{drive}", Method::patch, change_drive, Takes::patch},
    Route{"/api/v1/drives/{drive}", Method::remove, remove_drive, Takes::nothing, Gives::nothing},
    Route{"/api/v1/drives/{drive}/native", Method::post, exchange_native, Takes::json},
    Route{"/api/v1/drives/{drive}/hand", Method::get, get_hand},
    Route{"/api/v1/drives/{drive}/hand", Method::put, set_hand, Takes::json},
    Route{"/api/v1/drives/{drive}/hand", Method::patch, set_hand, Takes::patch},
    Route{"/api/v1/axes", Method::get, list_axes},
    Route{"/api/v1/axes", Method::post, add_axis, Takes::json},
    Route{"/api/v1/axes/{axis}", Method::get, get_axis},
    Route{"/api/v1/axes/{axis}", Method::put, replace_axis, Takes::json},
    Route{"/api/v1/axes/{axis}", Method::patch, change_axis, Takes::patch},
    Route{"/api/v1/axes/{axis}", Method::remove, remove_axis, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/commands", Method::post, command_axis, Takes::json}.needs(Role::viewer),  // stops; all others: operator
    Route{"/api/v1/axes/{axis}/actions", Method::post, act_on_axis, Takes::json},
    Route{"/api/v1/authority", Method::get, list_authority},
    Route{"/api/v1/axes/{axis}/authority", Method::get, get_authority},
    Route{"/api/v1/axes/{axis}/authority", Method::put, take_authority, Takes::json}.needs(Role::operating),
    Route{"/api/v1/axes/{axis}/authority", Method::remove, release_authority, Takes::nothing, Gives::nothing}.needs(Role::operating),
    Route{"/api/v1/axes/{axis}/authority/hand-over", Method::post, hand_over_authority, Takes::json}.needs(Role::operating),
    Route{"/api/v1/modbus", Method::get, get_modbus},
    Route{"/api/v1/modbus", Method::patch, change_modbus, Takes::patch},
    Route{"/api/v1/axes/{axis}/parameters", Method::get, list_parameters},
    Route{"/api/v1/axes/{axis}/parameters/{parameter}", Method::get, read_parameter},
    Route{"/api/v1/axes/{axis}/parameters/{parameter}", Method::put, write_parameter, Takes::json},
    Route{"/api/v1/moves/start", Method::post, start_moves, Takes::json}.needs(Role::operating),
    Route{"/api/v1/site", Method::get, get_site},
    Route{"/api/v1/site", Method::put, replace_site, Takes::json},
    Route{"/api/v1/mappings", Method::get, list_mappings},
    Route{"/api/v1/mappings", Method::post, add_mapping, Takes::json},
    Route{"/api/v1/mappings.csv", Method::get, get_mappings_csv, Takes::nothing, Gives::own},
    Route{"/api/v1/mappings.csv", Method::post, add_mappings_csv, Takes::csv},
    Route{"/api/v1/mappings.csv", Method::put, replace_mappings_csv, Takes::csv},
    Route{"/api/v1/mapping-points", Method::get, list_mapping_points},
    Route{"/api/v1/mappings/{mapping}", Method::get, get_mapping},
    Route{"/api/v1/mappings/{mapping}", Method::put, replace_mapping, Takes::json},
    Route{"/api/v1/mappings/{mapping}", Method::remove, remove_mapping, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/snapshots", Method::get, list_snapshots},
    Route{"/api/v1/axes/{axis}/snapshots", Method::post, take_snapshot, Takes::json},
    Route{"/api/v1/axes/{axis}/snapshot-progress", Method::get, get_snapshot_progress},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}", Method::get, get_snapshot},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}", Method::remove, remove_snapshot, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}/diff", Method::get, diff_snapshot},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}/restore", Method::post, restore_snapshot, Takes::json},
    Route{"/api/v1/axes/{axis}/parameters/{parameter}/history", Method::get, get_parameter_history},
    Route{"/api/v1/axes/{axis}/parameters.csv", Method::get, get_parameters_csv, Takes::nothing, Gives::own},
    Route{"/api/v1/axes/{axis}/parameters.csv", Method::put, put_parameters_csv, Takes::csv},
    Route{"/api/v1/site/stage", Method::get, get_stage},
    Route{"/api/v1/site/stage", Method::post, stage_site, Takes::json},
    Route{"/api/v1/site/stage", Method::remove, discard_stage, Takes::nothing, Gives::nothing},
    Route{"/api/v1/site/stage/apply", Method::post, apply_stage, Takes::json},
    Route{"/api/v1/site/stage/confirm", Method::post, confirm_stage},
    Route{"/api/v1/site/stage/roll-back", Method::post, roll_back_stage},
    Route{"/api/v1/site/history", Method::get, list_site_history},
    Route{"/api/v1/site/history/{revision}", Method::get, get_site_revision},
    Route{"/api/v1/site/history/{revision}/restore", Method::post, restore_site_revision},
    Route{"/api/v1/backup", Method::get, get_backup, Takes::nothing, Gives::own}.needs(Role::administrator),
    Route{"/api/v1/backup", Method::put, put_backup, Takes::bytes}.needs(Role::administrator),
    Route{"/api/v1/registers", Method::get, get_registers},
    Route{"/api/v1/mappings/list", Method::get, get_mapping_list, Takes::nothing, Gives::own},
    Route{"/api/v1/mappings/next-free", Method::get, get_next_free},
    Route{"/api/v1/mappings/template", Method::post, add_mapping_template, Takes::json},
    Route{"/api/v1/events", Method::get, list_events, Takes::nothing, Gives::own},
    Route{"/api/v1/alarms", Method::get, list_alarms},
    Route{"/api/v1/alarms/acknowledge", Method::post, acknowledge_alarms, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/acknowledge", Method::post, acknowledge_alarm, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/shelve", Method::post, shelve_alarm, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/unshelve", Method::post, unshelve_alarm}.needs(Role::operating),
    Route{"/api/v1/recipes", Method::get, list_recipes},
    Route{"/api/v1/recipes/{recipe}", Method::get, get_recipe},
    Route{"/api/v1/recipes/{recipe}", Method::put, put_recipe, Takes::json},
    Route{"/api/v1/recipes/{recipe}", Method::remove, remove_recipe, Takes::nothing, Gives::nothing},
    Route{"/api/v1/recipes/{recipe}/run", Method::post, run_recipe, Takes::json}.needs(Role::operating),
    Route{"/api/v1/recipes/{recipe}/runs", Method::get, list_recipe_runs},
    Route{"/api/v1/recipes/{recipe}/runs/{run}", Method::get, get_recipe_run},
    Route{"/api/v1/recipes/{recipe}/runs/{run}/cancel", Method::post, cancel_recipe_run}.needs(Role::operating),
    Route{"/api/v1/session", Method::get, get_session}.needs(Role::none),
    Route{"/api/v1/session", Method::post, sign_in, Takes::json}.needs(Role::none),
    Route{"/api/v1/session", Method::remove, sign_out, Takes::nothing, Gives::nothing}.needs(Role::none),
    Route{"/api/v1/session/first", Method::post, first_sign_in, Takes::json}.needs(Role::none),
    Route{"/api/v1/users", Method::get, list_users}.needs(Role::administrator),
    Route{"/api/v1/users", Method::post, add_user, Takes::json}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::get, get_user}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::patch, change_user, Takes::patch}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::remove, remove_user, Takes::nothing, Gives::nothing}.needs(Role::administrator),
    Route{"/api/v1/users/{user}/password", Method::put, change_password, Takes::json, Gives::nothing}.needs(Role::viewer),
    Route{"/api/v1/tokens", Method::get, list_tokens},
    Route{"/api/v1/tokens", Method::post, add_token, Takes::json}.needs(Role::viewer),
    Route{"/api/v1/tokens/{token}", Method::remove, remove_token, Takes::nothing, Gives::nothing}.needs(Role::viewer),
    Route{"/api/v1/stream", Method::get, open_stream, Takes::nothing, Gives::own, true},
};

constexpr std::array<Method, 5> told_methods{Method::get, Method::post, Method::put, Method::patch, Method::remove};

/// The names in the `{...}` segments, if the path is the route's.
std::optional<std::vector<std::string>> match(std::string_view path, const std::vector<std::string>& segments) {
    std::vector<std::string> names;
    path.remove_prefix(1);
    for (std::size_t i = 0;; ++i) {
        const auto slash = path.find('/');
        const auto want = path.substr(0, slash);
        if (i >= segments.size()) return std::nullopt;
        if (want.starts_with('{')) {
            if (segments[i].empty()) return std::nullopt;
            names.push_back(segments[i]);
        } else if (want != segments[i]) {
            return std::nullopt;
        }
        if (slash == std::string_view::npos) return i + 1 == segments.size() ? std::optional(std::move(names)) : std::nullopt;
        path.remove_prefix(slash + 1);
    }
}

/// The route path that a target means: of those that match, the one with the fewest names in it, so that /mappings/list is no mapping.
std::string_view path_of(const std::vector<std::string>& segments) {
    std::string_view best;
    for (const auto& r : routes) {
        if (r.path == best || !match(r.path, segments)) continue;
        if (best.empty() || std::ranges::count(r.path, '{') < std::ranges::count(best, '{')) best = r.path;
    }
    return best;
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

/// Reads the body where the route takes one; what is wrong with it otherwise.
std::optional<Response> read_body(const Request& request, Takes takes, json::value& into) {
    const auto media = media_of(request.headers.get("Content-Type"));
    if (takes == Takes::bytes) {
        if (media == "application/octet-stream") return std::nullopt;
        return problem(415, "unsupported_media_type", "send the file with Content-Type: application/octet-stream");
    }
    if (takes == Takes::csv) {
        if (media == "text/csv") return std::nullopt;
        Response r = problem(415, "unsupported_media_type",
                             fmt::format("send a table with Content-Type: text/csv in UTF-8, not \"{}\"", request.headers.get("Content-Type")));
        r.headers.set("Accept-Post", "text/csv");
        return r;
    }
    const bool good = media == "application/json" || (takes == Takes::patch && media == "application/merge-patch+json");
    if (!good) {
        Response r = problem(415, "unsupported_media_type",
                             fmt::format("send {} with Content-Type: application/json in UTF-8, not \"{}\"",
                                         request.body.empty() ? "a JSON object" : "the body", request.headers.get("Content-Type")));
        r.headers.set(takes == Takes::patch ? "Accept-Patch" : "Accept-Post",
                      takes == Takes::patch ? "application/merge-patch+json, application/json" : "application/json");
        return r;
    }
    boost::system::error_code ec;
    into = json::parse(request.body, ec);
    if (ec) return problem(400, "bad_request", fmt::format("the body is not JSON: {}", ec.message()));
    if (!into.is_object()) return problem(400, "bad_request", "the body must be a JSON object");
    return std::nullopt;
}

/// HOST without its port: "[::1]" keeps its brackets.
std::string_view host_name(std::string_view host) {
    if (host.starts_with('[')) return host.substr(0, std::min(host.find(']') + 1, host.size()));
    return host.substr(0, host.find(':'));
}

bool is_ip_address(std::string_view name) {
    if (name.starts_with('[')) {
        return name.size() > 3 && name.ends_with(']') && std::ranges::all_of(name.substr(1, name.size() - 2), [](char c) {
                   return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == ':' || c == '.';
               });
    }
    int parts = 0;
    while (!name.empty()) {
        const auto dot = name.find('.');
        if (!parse_whole(name.substr(0, dot), 0, 255)) return false;
        ++parts;
        if (dot == std::string_view::npos) break;
        name.remove_prefix(dot + 1);
    }
    return parts == 4;
}

bool is_loopback(std::string_view name) {
    return name == "localhost" || name.ends_with(".localhost") || name == "[::1]" || (name.starts_with("127.") && is_ip_address(name));
}
}  // namespace

std::span<const Route> all_routes() noexcept { return routes; }

bool same_host(std::string_view origin, std::string_view host) {
    const auto scheme = origin.find("://");
    if (scheme == std::string_view::npos) return false;
    const std::string name = lower(origin.substr(0, scheme));
    if (name != "http" && name != "https") return false;
    const auto with_port = [&name](std::string_view h) {
        std::string s = lower(trimmed(h));
        const std::size_t colon = s.rfind(':');
        if (colon == std::string::npos || s.ends_with(']')) s += name == "https" ? ":443" : ":80";
        return s;
    };
    return !trimmed(host).empty() && with_port(origin.substr(scheme + 3)) == with_port(host);
}

bool host_allowed(std::string_view host, const Settings& settings) {
    std::string name = lower(host_name(trimmed(host)));
    if (name.size() > 1 && name.back() == '.') name.pop_back();
    const std::string bound = lower(host_name(settings.bind));
    const auto listed = [&](const std::string& allowed) { return lower(allowed) == name; };
    if (is_ip_address(name) || is_loopback(name) || (!bound.empty() && name == bound)) return true;
    if (std::ranges::any_of(settings.allowed_hosts, listed)) return true;
    return settings.allowed_hosts.empty() && !is_loopback(bound) && !name.empty();
}

std::optional<Response> Router::check_host(const Request& request) const {
    const auto count = request.headers.count("Host");
    if (count == 0 && request.http_1_0) return std::nullopt;
    if (count != 1) return problem(400, "bad_request", count == 0 ? "the Host header is missing" : "there are several Host headers");
    const auto host = request.headers.get("Host");
    if (host_allowed(host, context_.settings)) return std::nullopt;
    return problem(
        421, "misdirected",
        fmt::format("this gateway is not called {}: use its IP address or localhost, or add the name to the allowed hosts", host));
}

std::optional<Response> Router::check_origin(const Request& request) {
    const auto origin = request.headers.get("Origin");
    const bool cross_site = request.headers.get("Sec-Fetch-Site") == "cross-site";
    if (!cross_site && (request.headers.count("Origin") == 0 || same_host(origin, request.headers.get("Host")))) return std::nullopt;
    return problem(403, "forbidden",
                   fmt::format("the request comes from a page of another host ({})", origin.empty() ? "cross-site" : origin));
}

Handled Router::dispatch(const Request& request, const Respond& respond) const {
    if (auto refusal = check_host(request)) return *refusal;
    if (request.method == Method::options && request.target == "*") {
        Response r;
        r.status = 204;
        return r;
    }
    const auto target = parse_target(request.target);
    if (!target) return problem(400, "bad_request", "the request target cannot be read: a path that begins with /, percent-encoded UTF-8");

    const Method wanted = request.method == Method::head ? Method::get : request.method;
    const Route* route = nullptr;
    const std::string_view path = path_of(target->segments);
    std::vector<std::string> names;
    std::string allow;
    for (const auto told : told_methods) {
        for (const auto& r : routes) {
            if (r.method != told || r.path != path) continue;
            auto found = match(r.path, target->segments);
            if (!found) continue;
            allow += fmt::format("{}{}", allow.empty() ? "" : ", ", name_of(told) == "GET" ? "GET, HEAD" : name_of(told));
            if (told == wanted) {
                route = &r;
                names = std::move(*found);
            }
        }
    }
    const bool is_api = !target->segments.empty() && target->segments[0] == "api";
    const bool is_file = allow.empty() && !is_api;
    if (allow.empty() && is_api)
        return problem(404, "not_found", fmt::format("there is nothing at {}: see /api/v1/openapi.yaml", request.target));
    if (is_file) allow = "GET, HEAD";
    if (request.method == Method::options) {
        Response r;
        r.status = 204;
        r.headers.set("Allow", allow + ", OPTIONS");
        return r;
    }
    if (is_file && wanted == Method::get) return static_file(context_.asset, *target, request.headers);
    if (!route) {
        Response r = problem(405, "method_not_allowed", fmt::format("this takes {}, OPTIONS", allow));
        r.headers.set("Allow", allow + ", OPTIONS");
        return r;
    }
    // Who it is, and whether he may: before anything of the request is looked at further.
    AccessPort* port = context_.access.get();
    Identity identity = http::identify(port, request, context_.gateway.now_unix_ns());
    if (const Role needed = route->needed(); needed != Role::none) {
        if (auto refusal = refuse_below(identity, needed)) return *refusal;
    }
    if (route->handler != sign_in && route->handler != first_sign_in) {
        if (auto refusal = check_csrf(identity, request)) return *refusal;
    }
    if (!identity.token_to_keep.empty()) {
        if (const auto it = port->desk().tokens().find(identity.token_to_keep); it != port->desk().tokens().end()) {
            port->keep({record_of(it->second)}, who(identity, request.peer), [](const std::string&) {});
        }
    }
    if (wanted != Method::get || route->same_origin_only) {
        if (auto refusal = check_origin(request)) return *refusal;
    }
    if (const auto media = media_given(route->gives); !media.empty() && !accepts(request.headers.get("Accept"), media)) {
        return problem(406, "not_acceptable", fmt::format("this can be given as {}", media));
    }
    Call call{context_, request, *target, std::move(names), nullptr, respond, std::move(identity)};
    if (route->takes != Takes::nothing) {
        if (auto refusal = read_body(request, route->takes, call.body)) return *refusal;
    }
    return route->handler(call);
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
    // A Gateway may answer from inside a call: then the promise is an answer at once.
    struct Once {
        bool inside = true, answered = false;
        std::optional<Response> early;
        Respond respond;
    };
    auto once = std::make_shared<Once>();
    once->respond = std::move(respond);
    const bool is_head = request.method == Method::head;
    Handled handled;
    try {
        handled = dispatch(request, [once, is_head](Response r) {
            if (once->answered) return;
            once->answered = true;
            if (once->inside) {
                once->early = std::move(r);
                return;
            }
            finish(r, is_head);
            once->respond(std::move(r));
        });
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
        finish(*handled.now, is_head);
    } else {
        finish(handled.at_limit, is_head);
    }
    return handled;
}

bool Router::may_still_watch(const Request& request) const {
    return http::identify(context_.access.get(), request, context_.gateway.now_unix_ns(), false).role >= Role::viewer;
}

std::string_view Router::route_of(const Request& request) const {
    const auto target = parse_target(request.target);
    if (!target) return "none";
    if (const auto path = path_of(target->segments); !path.empty()) return path;
    return target->segments[0] == "api" ? "none" : "static";
}

}  // namespace axisgate::http
