// Handlers of the program itself: health, metrics, description, about, and the handshake of the live feed; and the common functions of all
// handlers.
#include <fmt/core.h>

#include <cmath>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/websocket_codec.hpp"

namespace axisgate::http {
namespace json = boost::json;

Handled get_health(Call&, const StatusPort& status) {
    return json_response(json::object{{"status", "ok"}, {"uptime_s", number(status.uptime_s())}});
}

Handled get_ready(Call& c, const StatusPort& status) {
    auto missing = status.not_ready();
    // Names of lines, drives and interfaces are only for known clients; whether everything is ready is for all.
    if (!missing.empty() && c.context.access && c.identity.role == Role::none)
        missing = {fmt::format("{} {} missing or not as it should be; sign in to read which", missing.size(),
                               missing.size() == 1 ? "thing is" : "things are")};
    json::array list;
    std::string all;
    for (const auto& m : missing) {
        list.emplace_back(m);
        all += (all.empty() ? "" : "; ") + m;
    }
    if (missing.empty()) return json_response(json::object{{"ready", true}, {"missing", std::move(list)}});
    Problem p{.status = 503, .reason = "not_ready", .detail = all};
    p.more["ready"] = false;
    p.more["missing"] = std::move(list);
    return to_response(p);
}

Handled get_metrics(Call& c, const StatusPort& status) {
    Response r;
    r.headers.set("Content-Type", "text/plain; version=0.0.4; charset=utf-8");
    r.body = status.metrics();
    if (!r.body.empty() && r.body.back() != '\n') r.body += '\n';
    if (c.context.own_metrics) r.body += c.context.own_metrics();
    return r;
}

Handled get_description(Call& c) {
    const auto text = c.context.asset ? c.context.asset("schema/openapi.yaml") : std::string_view();
    if (text.data() == nullptr) return problem(404, "not_found", "this build holds no description");
    Response r;
    r.headers.set("Content-Type", "application/yaml");
    r.body = std::string(text);
    return r;
}

Handled get_eds(Call&, const SitePort& sites, const StatusPort& status) {
    Response r;
    r.body = status.eds();
    if (r.body.empty()) return problem(404, "not_found", "the EtherNet/IP door is shut: see [enip] bind, and the log for why");
    r.headers.set("Content-Type", "text/plain; charset=us-ascii");
    r.headers.set("Content-Disposition", "attachment; filename=\"axisgate.eds\"");
    r.headers.set("Mapping-Revision", fmt::format("{:08x}", mapping_revision(sites.site()->site)));
    return r;
}

Handled get_about(Call& c, const ClockPort& clock, const SitePort& sites, const StatusPort& status) {
    const auto site = sites.site();
    json::array families, doors;
    for (const auto& e : sites.families().entries)
        families.emplace_back(e.family->name);
    for (const auto& d : status.doors())
        doors.push_back(json::object{{"name", d.name}, {"address", d.address}});
    return json_response(json::object{{"name", "axisgate"},
                                      {"version", c.context.settings.version},
                                      {"api", "/api/v1"},
                                      {"uptime_s", number(status.uptime_s())},
                                      {"now", format_time(clock.now_unix_ns())},
                                      {"site_revision", site->revision},
                                      {"families", std::move(families)},
                                      {"doors", std::move(doors)},
                                      {"lines", site->site.lines.size()},
                                      {"drives", site->site.drives.size()},
                                      {"axes", site->site.axes.size()}});
}

Handled open_stream(Call& c) {
    const Headers& h = c.request.headers;
    const auto names = [](std::string_view list, std::string_view word) {
        const std::string all = "," + lower(list) + ",";
        std::string packed;
        for (const char x : all) {
            if (x != ' ' && x != '\t') packed += x;
        }
        return packed.find("," + std::string(word) + ",") != std::string::npos;
    };
    const auto upgrade_needed = [](std::string detail) {
        Response r = problem(426, "upgrade_required", std::move(detail));
        r.headers.set("Upgrade", "websocket");
        r.headers.set("Connection", "Upgrade");
        r.headers.set("Sec-WebSocket-Version", "13");
        return r;
    };
    if (c.request.method != Method::get || c.request.http_1_0 || !names(h.get("Upgrade"), "websocket") ||
        !names(h.get("Connection"), "upgrade")) {
        return upgrade_needed("this is a WebSocket: open it with a WebSocket client");
    }
    if (trimmed(h.get("Sec-WebSocket-Version")) != "13") return upgrade_needed("this gateway speaks version 13 of the WebSocket protocol");
    const auto key = trimmed(h.get("Sec-WebSocket-Key"));
    if (!is_handshake_key(key) || h.count("Sec-WebSocket-Key") != 1) {
        return problem(400, "bad_request", "Sec-WebSocket-Key must be 16 bytes in base64");
    }
    Response r;
    r.status = 101;
    r.headers.set("Upgrade", "websocket");
    r.headers.set("Connection", "Upgrade");
    r.headers.set("Sec-WebSocket-Accept", handshake_accept(key));
    return r;
}

// --- shared -----------------------------------------------------------------------------------------------------------

Response nothing_named(std::string_view what, std::string_view name) {
    return problem(404, "not_found", fmt::format("there is no {} {}", what, name));
}

Response nothing_left() {
    Response r;
    r.status = 204;
    return r;
}

Response file_answer(std::string_view media, std::string_view name, std::string text) {
    Response r;
    r.headers.set("Content-Type", std::string(media));
    r.headers.set("Content-Disposition", fmt::format("attachment; filename=\"{}\"", name));
    r.body = std::move(text);
    return r;
}

bool wants_json(const Call& c, std::string_view other, std::optional<Response>& fault) {
    const auto format = c.target.query.get("format");
    if (format && *format != other && *format != "json")
        fault = problem(400, "bad_request", fmt::format("format must be {} or json", other));
    static constexpr std::string_view media[] = {"application/json", "text/plain"};
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!fault && !format && !liked) fault = problem(406, "not_acceptable", "this is application/json or text/plain");
    return format ? *format == "json" : liked == std::size_t{0};
}

Response bad_query(std::string_view name, std::string_view must) {
    return problem(400, "bad_request", fmt::format("{} must be {}", name, must));
}

bool query_flag(const Call& call, std::string_view name, std::optional<Response>& fault) {
    const auto text = call.target.query.get(name);
    if (!text) return false;
    const auto flag = parse_flag(*text);
    if (!flag) fault = bad_query(name, "0, 1, true or false");
    return flag.value_or(false);
}

std::int64_t query_whole(const Call& call, std::string_view name, std::int64_t low, std::int64_t high, std::int64_t otherwise,
                         std::optional<Response>& fault) {
    const auto text = call.target.query.get(name);
    if (!text) return otherwise;
    const auto n = parse_whole(*text, low, high);
    if (!n) fault = bad_query(name, fmt::format("a whole number from {} to {}", low, high));
    return n.value_or(otherwise);
}

double query_wait(const Call& call, std::optional<Response>& fault) {
    const auto text = call.target.query.get("wait");
    if (!text) return 0;
    const auto s = parse_number(*text);
    if (s && *s >= 0 && *s <= 300) return *s;
    fault = bad_query("wait", "a number of seconds from 0 to 300");
    return 0;
}

json::object command_answer(Ticket ticket, std::string_view result, std::string_view reason, std::string_view axis,
                            std::string_view command) {
    return {{"ticket", shown(ticket)}, {"result", result}, {"reason", reason}, {"axis", axis},
            {"command", command},      {"code", nullptr},  {"text", ""},       {"value", nullptr}};
}

Handled submit_command(Call& call, AxisPort& axes, Command command, std::string axis, std::string name, double wait_s,
                       std::function<Response(const Result&)> show) {
    command.origin = call.origin();
    command.until_done = wait_s > 0;
    const Ticket ticket = axes.submit(std::move(command), [respond = call.respond, axis, name, show = std::move(show)](const Result& r) {
        respond(good(r) ? show(r) : problem_of(r, axis, name));
    });
    if (wait_s > 0) {
        const auto limit = std::chrono::nanoseconds(std::llround(wait_s * 1e9));
        return {limit, json_response(command_answer(ticket, "accepted", fmt::format("not done after {} s", wait_s), axis, name))};
    }
    Result none;
    none.ticket = ticket;
    none.outcome = Outcome::failed;
    none.reason = Reason::no_answer;
    none.text = fmt::format("{}: no result within {} s; nobody knows whether it was done", name, gateway_limit.count());
    return {gateway_limit, problem_of(none, axis, name)};
}

}  // namespace axisgate::http
