// Router: the table of routes and the rules that hold for all of them.
// In: requests. Out: answers.
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

constexpr std::array routes{
    Route{"/healthz", Method::get, take<get_health>}.needs(Role::none),
    Route{"/readyz", Method::get, take<get_ready>}.needs(Role::none),
    Route{"/metrics", Method::get, take<get_metrics>, Takes::nothing, Gives::text},
    Route{"/api/v1/openapi.yaml", Method::get, take<get_description>, Takes::nothing, Gives::yaml}.needs(Role::none),
    Route{"/api/v1/about", Method::get, take<get_about>},
    Route{"/api/v1/families", Method::get, take<list_families>},
    Route{"/api/v1/families/{family}", Method::get, take<get_family>},
    Route{"/api/v1/families/{family}/parameters", Method::get, take<list_family_parameters>},
    Route{"/api/v1/families/{family}/commands", Method::get, take<list_family_commands>},
    Route{"/api/v1/families/{family}/errors", Method::get, take<list_family_errors>},
    Route{"/api/v1/lines", Method::get, take<list_lines>},
    Route{"/api/v1/lines", Method::post, take<add_line>, Takes::json},
    Route{"/api/v1/lines/{line}", Method::get, take<get_line>},
    Route{"/api/v1/lines/{line}", Method::put, take<replace_line>, Takes::json},
    Route{"/api/v1/lines/{line}", Method::patch, take<change_line>, Takes::patch},
    Route{"/api/v1/lines/{line}", Method::remove, take<remove_line>, Takes::nothing, Gives::nothing}.asks("cascade"),
    Route{"/api/v1/lines/{line}/trace", Method::get, take<get_trace>, Takes::nothing, Gives::own}.asks("format since limit"),
    Route{"/api/v1/lines/{line}/scan", Method::get, take<get_scan>},
    Route{"/api/v1/lines/{line}/scan", Method::post, take<start_scan>, Takes::json},
    Route{"/api/v1/lines/{line}/scan", Method::remove, take<cancel_scan>},
    Route{"/api/v1/host/ports", Method::get, take<list_host_ports>}.needs(Role::engineer),
    Route{"/api/v1/drives", Method::get, take<list_drives>},
    Route{"/api/v1/drives", Method::post, take<add_drive>, Takes::json},
    Route{"/api/v1/drives/{drive}", Method::get, take<get_drive>},
    Route{"/api/v1/drives/{drive}", Method::put, take<replace_drive>, Takes::json},
    Route{"/api/v1/drives/{drive}", Method::patch, take<change_drive>, Takes::patch},
    Route{"/api/v1/drives/{drive}", Method::remove, take<remove_drive>, Takes::nothing, Gives::nothing}.asks("cascade"),
    Route{"/api/v1/drives/{drive}/native", Method::post, take<exchange_native>, Takes::json},
    Route{"/api/v1/drives/{drive}/hand", Method::get, take<get_hand>}.asks("describe"),
    Route{"/api/v1/drives/{drive}/hand", Method::put, take<set_hand>, Takes::json},
    Route{"/api/v1/drives/{drive}/hand", Method::patch, take<set_hand>, Takes::patch},
    Route{"/api/v1/axes", Method::get, take<list_axes>},
    Route{"/api/v1/axes", Method::post, take<add_axis>, Takes::json},
    Route{"/api/v1/axes/{axis}", Method::get, take<get_axis>},
    Route{"/api/v1/axes/{axis}", Method::put, take<replace_axis>, Takes::json},
    Route{"/api/v1/axes/{axis}", Method::patch, take<change_axis>, Takes::patch},
    Route{"/api/v1/axes/{axis}", Method::remove, take<remove_axis>, Takes::nothing, Gives::nothing}.asks("cascade"),
    Route{"/api/v1/axes/{axis}/commands", Method::post, take<command_axis>, Takes::json}
        .asks("wait")
        .needs(Role::viewer)
        .moves(),  // stops; all others: operator
    Route{"/api/v1/axes/{axis}/actions", Method::post, take<act_on_axis>, Takes::json}.asks("wait").moves(),
    Route{"/api/v1/authority", Method::get, take<list_authority>},
    Route{"/api/v1/axes/{axis}/authority", Method::get, take<get_authority>},
    Route{"/api/v1/axes/{axis}/authority", Method::put, take<take_authority>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/axes/{axis}/authority", Method::remove, take<release_authority>, Takes::nothing, Gives::nothing}.needs(Role::operating),
    Route{"/api/v1/axes/{axis}/authority/hand-over", Method::post, take<hand_over_authority>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/modbus", Method::get, take<get_modbus_door>},
    Route{"/api/v1/modbus", Method::patch, take<change_modbus_door>, Takes::patch},
    Route{"/api/v1/connections", Method::get, take<list_connections>},
    Route{"/api/v1/connections/{connection}", Method::remove, take<close_connection>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/parameters", Method::get, take<list_parameters>}.asks("group array first"),
    Route{"/api/v1/axes/{axis}/parameters/{parameter}", Method::get, take<read_parameter>}.asks("cached history"),
    Route{"/api/v1/axes/{axis}/parameters/{parameter}", Method::put, take<write_parameter>, Takes::json},
    Route{"/api/v1/moves/start", Method::post, take<start_moves>, Takes::json}.asks("wait").needs(Role::operating).moves(),
    Route{"/api/v1/site", Method::get, take<get_site>},
    Route{"/api/v1/site", Method::put, take<replace_site>, Takes::json}.asks("dry_run"),
    Route{"/api/v1/mappings", Method::get, take<list_mappings>}.asks("unit axis"),
    Route{"/api/v1/mappings", Method::post, take<add_mapping>, Takes::json},
    Route{"/api/v1/mappings", Method::remove, take<remove_mappings>}.asks("unit axis ids all dry_run"),
    Route{"/api/v1/mappings.csv", Method::get, take<get_mappings_csv>, Takes::nothing, Gives::own},
    Route{"/api/v1/mappings.csv", Method::post, take<add_mappings_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/mappings.csv", Method::put, take<replace_mappings_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/mapping-points", Method::get, take<list_mapping_points>},
    Route{"/api/v1/mappings/{mapping}", Method::get, take<get_mapping>},
    Route{"/api/v1/mappings/{mapping}", Method::put, take<replace_mapping>, Takes::json},
    Route{"/api/v1/mappings/{mapping}", Method::remove, take<remove_mapping>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/snapshots", Method::get, take<list_snapshots>},
    Route{"/api/v1/axes/{axis}/snapshots", Method::post, take<take_snapshot>, Takes::json},
    Route{"/api/v1/axes/{axis}/snapshot-progress", Method::get, take<get_snapshot_progress>},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}", Method::get, take<get_snapshot>, Takes::nothing, Gives::own}.asks("format"),
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}", Method::remove, take<remove_snapshot>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}/diff", Method::get, take<diff_snapshot>}.asks("with"),
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}/restore", Method::post, take<restore_snapshot>, Takes::json},
    Route{"/api/v1/axes/{axis}/parameters/{parameter}/history", Method::get, take<get_parameter_history>}.asks("limit"),
    Route{"/api/v1/axes/{axis}/parameters.csv", Method::get, take<get_parameters_csv>, Takes::nothing, Gives::own},
    Route{"/api/v1/axes/{axis}/parameters.csv", Method::put, take<put_parameters_csv>, Takes::csv}.asks(
        "dry_run include_addressing include_live"),
    Route{"/api/v1/site/stage", Method::get, take<get_stage>},
    Route{"/api/v1/site/stage", Method::post, take<stage_site>, Takes::json}.asks("replace"),
    Route{"/api/v1/site/stage", Method::remove, take<discard_stage>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/site/stage/apply", Method::post, take<apply_stage>, Takes::json},
    Route{"/api/v1/site/stage/confirm", Method::post, take<confirm_stage>},
    Route{"/api/v1/site/stage/roll-back", Method::post, take<roll_back_stage>},
    Route{"/api/v1/site/history", Method::get, take<list_site_history>}.asks("limit before"),
    Route{"/api/v1/site/history/{revision}", Method::get, take<get_site_revision>},
    Route{"/api/v1/site/history/{revision}/restore", Method::post, take<restore_site_revision>}.asks("replace"),
    Route{"/api/v1/backup", Method::get, take<get_backup>, Takes::nothing, Gives::own}.needs(Role::administrator),
    Route{"/api/v1/backup", Method::put, take<put_backup>, Takes::bytes}.needs(Role::administrator),
    Route{"/api/v1/backup/pending", Method::get, take<get_waiting_backup>}.needs(Role::administrator),
    Route{"/api/v1/backup/pending", Method::remove, take<cancel_waiting_backup>, Takes::nothing, Gives::nothing}.needs(Role::administrator),
    Route{"/api/v1/recorder/trends", Method::get, take<get_trends>, Takes::nothing, Gives::own}.asks("axes points from to columns"),
    Route{"/api/v1/recorder/steps", Method::get, take<get_recorded_steps>}.asks("axes from to"),
    Route{"/api/v1/recorder/captures", Method::get, take<list_captures>},
    Route{"/api/v1/recorder/captures", Method::post, take<arm_capture>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/recorder/captures/{capture}", Method::get, take<get_capture>, Takes::nothing, Gives::own},
    Route{"/api/v1/recorder/captures/{capture}", Method::patch, take<rename_capture>, Takes::patch}.needs(Role::operating),
    Route{"/api/v1/recorder/captures/{capture}", Method::remove, take<remove_capture>, Takes::nothing, Gives::nothing}.needs(
        Role::operating),
    Route{"/api/v1/recorder/recordings", Method::get, take<list_recordings>},
    Route{"/api/v1/recorder/recordings", Method::post, take<make_recording>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/recorder/recordings/{recording}", Method::get, take<get_recording>, Takes::nothing, Gives::own},
    Route{"/api/v1/recorder/recordings/{recording}/playback", Method::get, take<play_back_recording>}.asks("at frames columns"),
    Route{"/api/v1/recorder/recordings/{recording}", Method::patch, take<rename_recording>, Takes::patch}.needs(Role::operating),
    Route{"/api/v1/recorder/recordings/{recording}", Method::remove, take<remove_recording>, Takes::nothing, Gives::nothing}.needs(
        Role::operating),
    Route{"/api/v1/eds", Method::get, take<get_eds>, Takes::nothing, Gives::own},
    Route{"/api/v1/descriptions", Method::get, take<list_descriptions>},
    Route{"/api/v1/descriptions", Method::post, take<add_description>, Takes::eds}.asks("name"),
    Route{"/api/v1/descriptions/{description}", Method::get, take<get_drive_description>, Takes::nothing, Gives::own}.asks("format"),
    Route{"/api/v1/descriptions/{description}", Method::remove, take<remove_description>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/fail_safe", Method::get, take<get_fail_safe>},
    Route{"/api/v1/fail_safe/rehearsal", Method::get, take<get_rehearsal>},
    Route{"/api/v1/fail_safe/rehearsal", Method::post, take<start_rehearsal>, Takes::json},
    Route{"/api/v1/fail_safe/{axis}", Method::get, take<get_axis_fail_safe>},
    Route{"/api/v1/fail_safe/{axis}", Method::put, take<put_axis_fail_safe>, Takes::json},
    Route{"/api/v1/registers", Method::get, take<get_registers>}.asks("unit table address count"),
    Route{"/api/v1/mappings/list", Method::get, take<get_mapping_list>, Takes::nothing, Gives::own}.asks("format"),
    Route{"/api/v1/mappings/next-free", Method::get, take<get_next_free>}.asks("unit table words align"),
    Route{"/api/v1/mappings/units", Method::get, take<list_mapping_units>},
    Route{"/api/v1/mappings/units/{unit}", Method::put, take<change_mapping_unit>, Takes::json},
    Route{"/api/v1/fleet", Method::get, take<get_fleet>},
    Route{"/api/v1/fleet/{gateway}/axes/{axis}/commands", Method::post, take<command_fleet_axis>, Takes::json}
        .asks("wait")
        .needs(Role::viewer)
        .moves(),  // as above
    Route{"/api/v1/assemblies", Method::get, take<list_assemblies>},
    Route{"/api/v1/assemblies.csv", Method::get, take<get_assemblies_csv>, Takes::nothing, Gives::own},
    Route{"/api/v1/assemblies.csv", Method::post, take<add_assemblies_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/assemblies.csv", Method::put, take<replace_assemblies_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/assemblies/{instance}", Method::get, take<get_assembly>},
    Route{"/api/v1/assemblies/{instance}", Method::put, take<put_assembly>, Takes::json},
    Route{"/api/v1/assemblies/{instance}", Method::remove, take<remove_assembly>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/profiles", Method::get, take<list_profiles>},
    Route{"/api/v1/profiles/{unit}", Method::get, take<get_profile>},
    Route{"/api/v1/profiles/{unit}", Method::put, take<put_profile>, Takes::json},
    Route{"/api/v1/profiles/{unit}", Method::remove, take<remove_profile>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/mappings/template", Method::post, take<add_mapping_template>, Takes::json},
    Route{"/api/v1/events", Method::get, take<list_events>, Takes::nothing, Gives::own}.asks(
        "since axis severity kind state before limit order format"),
    Route{"/api/v1/alarms", Method::get, take<list_alarms>}.asks("state"),
    Route{"/api/v1/alarms/acknowledge", Method::post, take<acknowledge_alarms>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/acknowledge", Method::post, take<acknowledge_alarm>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/shelve", Method::post, take<shelve_alarm>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/unshelve", Method::post, take<unshelve_alarm>}.needs(Role::operating),
    Route{"/api/v1/recipes", Method::get, take<list_recipes>},
    Route{"/api/v1/recipes/{recipe}", Method::get, take<get_recipe>},
    Route{"/api/v1/recipes/{recipe}", Method::put, take<put_recipe>, Takes::json}.asks("dry_run"),
    Route{"/api/v1/recipes/{recipe}", Method::remove, take<remove_recipe>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/recipes/{recipe}/run", Method::post, take<run_recipe>, Takes::json}.needs(Role::operating).moves(),
    Route{"/api/v1/recipes/{recipe}/runs", Method::get, take<list_recipe_runs>},
    Route{"/api/v1/recipes/{recipe}/runs/{run}", Method::get, take<get_recipe_run>},
    Route{"/api/v1/recipes/{recipe}/runs/{run}/cancel", Method::post, take<cancel_recipe_run>}.needs(Role::operating),
    Route{"/api/v1/session", Method::get, take<get_session>}.needs(Role::none),
    Route{"/api/v1/session", Method::post, take<sign_in>, Takes::json}.needs(Role::none),
    Route{"/api/v1/session", Method::remove, take<sign_out>, Takes::nothing, Gives::nothing}.needs(Role::none),
    Route{"/api/v1/session/first", Method::post, take<first_sign_in>, Takes::json}.needs(Role::none),
    Route{"/api/v1/users", Method::get, take<list_users>}.needs(Role::administrator),
    Route{"/api/v1/users", Method::post, take<add_user>, Takes::json}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::get, take<get_user>}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::patch, take<change_user>, Takes::patch}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::remove, take<remove_user>, Takes::nothing, Gives::nothing}.needs(Role::administrator),
    Route{"/api/v1/users/{user}/password", Method::put, take<change_password>, Takes::json, Gives::nothing}.needs(Role::viewer),
    Route{"/api/v1/tokens", Method::get, take<list_tokens>},
    Route{"/api/v1/tokens", Method::post, take<add_token>, Takes::json}.needs(Role::viewer),
    Route{"/api/v1/tokens/{token}", Method::remove, take<remove_token>, Takes::nothing, Gives::nothing}.needs(Role::viewer),
    Route{"/api/v1/stream", Method::get, take<open_stream>, Takes::nothing, Gives::own, true},
};

constexpr std::array<Method, 5> listed_methods{Method::get, Method::post, Method::put, Method::patch, Method::remove};

/// One path of the table with all its routes, taken apart once.
struct Shape {
    std::string_view path;
    std::vector<std::string_view> parts;
    std::size_t names = 0;  ///< how many of them are `{...}`
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
    for (const Route& r : routes) {
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
    // From the end: there paths differ.
    for (std::size_t i = segments.size(); i-- > 0;) {
        if (is_name(shape.parts[i]) ? segments[i].empty() : shape.parts[i] != segments[i]) return false;
    }
    return true;
}

/// The path that a target means: of those that fit, the one with the fewest names in it, so that /mappings/list is no mapping.
const Shape* shape_of(const std::vector<std::string>& segments) {
    static const std::vector<std::vector<Shape>> shapes = make_shapes();
    const Shape* best = nullptr;
    if (segments.size() >= shapes.size()) return best;
    for (const Shape& s : shapes[segments.size()]) {
        if ((!best || s.names < best->names) && fits(s, segments)) best = &s;
    }
    return best;
}

/// What the `{...}` segments hold.
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

}  // namespace

std::span<const Route> all_routes() noexcept { return routes; }

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

/// What the head of a request leads to: an answer, or a route with everything that its handler needs beside the body.
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
    // Who it is, and whether he may: before anything of the request is looked at further.
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
        if (e.answer && e.answer->status >= 400) a.refusal = std::move(e.answer);
    } catch (const std::exception& x) {
        a.refusal = problem(500, "internal", fmt::format("a fault of the gateway itself: {}", x.what()));
    }
    if (a.refusal) finish(*a.refusal, head.method == Method::head);
    return a;
}

Handled Router::dispatch(const Request& request, std::optional<Target> target, const Respond& respond) const {
    Entry e = enter(request, std::move(target), true);
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
    // Named clients that may command: to one of them an axis can be handed over.
    if (call.identity.role >= Role::operating && (!call.identity.user.empty() || request.headers.count("X-Client") != 0)) {
        context_.clients->note(*call.origin().client, context_.ports.get<ClockPort>().now_unix_ns());
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
    // A command may be answered from inside a call: then the promise is an answer at once.
    struct Once {
        bool inside = true, answered = false;
        std::optional<Response> early;
        Respond respond;
    };
    auto once = std::make_shared<Once>();
    once->respond = std::move(respond);
    const bool is_head = request.method == Method::head;
    Handled handled;
    std::string_view route = "none";
    try {
        auto target = parse_target(request.target);
        route = route_word(target);
        handled = dispatch(request, std::move(target), [once, is_head](Response r) {
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
