// Handlers of drive descriptions: EDS and DCF files that drives of the site may name: kept, shown, removed.
// In: calls. Out: what is in a file, the file itself, what is wrong with it and in which line. Never takes half of a file, and never
// changes one that is kept: a site rests on its text.
#include <fmt/core.h>

#include <algorithm>
#include <boost/json/parse.hpp>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/descriptions/description.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// Drives that name it: in the site in force, in the one that is staged, and in the one that a trial would go back to.
std::vector<std::string> users_of(std::string_view name, const SitePort& sites, const StagePort& staging) {
    std::vector<std::string> out;
    const auto add = [&](std::string drive) {
        if (std::ranges::find(out, drive) == out.end()) out.push_back(std::move(drive));
    };
    const auto of_site = [&](const Site& site) {
        for (const auto& d : site.drives)
            if (d.description == name) add(d.name);
    };
    of_site(sites.site()->site);
    const SiteStage& stage = staging.site_stage();
    if (stage.state() != SiteStage::State::none) of_site(stage.site());
    if (const auto before = stage.busy() ? sites.site_revision(stage.base_revision()) : std::nullopt) {
        boost::system::error_code ec;
        const auto document = json::parse(before->text, ec);
        const auto* drives = !ec && document.is_object() ? document.get_object().if_contains("drives") : nullptr;
        for (const auto& v : drives && drives->is_array() ? drives->get_array() : json::array()) {
            const auto* o = v.if_object();
            const auto* named = o ? o->if_contains("description") : nullptr;
            const auto* drive = o ? o->if_contains("name") : nullptr;
            if (named && drive && named->is_string() && drive->is_string() && std::string_view(named->get_string()) == name)
                add(std::string(drive->get_string()));
        }
    }
    return out;
}

json::object description_document(const Description& d, const std::vector<std::string>& users) {
    json::object o = d.facts ? *d.facts : json::object{{"name", d.name}};
    json::array used_by;
    for (const auto& u : users)
        used_by.emplace_back(u);
    o["used_by"] = std::move(used_by);
    return o;
}

Event description_event(const std::string& who, std::string text) {
    Event e;
    e.kind = "site";
    e.who = who;
    e.door = std::string(axisgate::name_of(Door::http));
    e.text = std::move(text);
    return e;
}

Response site_is_busy() { return problem(503, "busy", "too many changes of the site wait already: try again"); }

/// Name and text from the body: the file itself with ?name=, or {"name": ..., "text": ...}.
DescriptionText sent_description(const Call& c, std::vector<Fault>& faults) {
    DescriptionText d{std::string(c.target.query.get("name").value_or("")), {}};
    if (!c.body.is_object()) {
        d.text = c.request.body;
    } else {
        for (const auto& [k, v] : c.body.get_object()) {
            if (k != "name" && k != "text")
                faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "send name and text"});
            else if (!v.is_string())
                faults.push_back({"/" + std::string(k), fmt::format("{} must be a text", std::string_view(k)), "write it in quotes"});
            else if (k == "text")
                d.text = std::string(v.get_string());
            else if (!d.name.empty() && d.name != std::string_view(v.get_string()))
                faults.push_back({"/name", fmt::format("the name is {} in the query", d.name), "write it once"});
            else
                d.name = std::string(v.get_string());
        }
    }
    if (const auto wrong = descriptions::check_name(d.name); !wrong.empty())
        faults.push_back({c.body.is_object() ? "/name" : "", wrong, "send ?name=maker-model-1.eds", c.body.is_object()});
    return d;
}
}  // namespace

Handled list_descriptions(Call&, const DescriptionPort& port, const SitePort& sites, const StagePort& staging) {
    json::array out;
    for (const auto& [name, d] : port.descriptions().all()) {
        auto o = description_document(*d, users_of(name, sites, staging));
        o.erase("pdos");
        o.erase("warnings");
        out.push_back(std::move(o));
    }
    return json_response(out);
}

Handled get_drive_description(Call& c, const DescriptionPort& port, const SitePort& sites, const StagePort& staging) {
    const auto format = c.target.query.get("format");
    if (format && *format != "eds" && *format != "json") return problem(400, "bad_request", "format must be eds or json");
    const auto found = port.descriptions().find(c.names[0]);
    if (!found) return nothing_named("description", c.names[0]);
    static constexpr std::string_view media[] = {"application/json", "text/plain"};
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!format && !liked) return problem(406, "not_acceptable", "this is application/json or text/plain");
    if (format ? *format == "json" : *liked == 0) return json_response(description_document(*found, users_of(found->name, sites, staging)));
    Response r;
    r.headers.set("Content-Type", fmt::format("text/plain; charset={}", is_utf8(found->text) ? "utf-8" : "iso-8859-1"));
    r.headers.set("Content-Disposition", fmt::format("attachment; filename=\"{}\"", found->name));
    r.headers.set("Vary", "Accept");
    r.body = found->text;
    return r;
}

Handled add_description(Call& c, const ClockPort& clock, DescriptionPort& port, EventPort& events, const SitePort& sites,
                        const StagePort& staging) {
    std::vector<Fault> faults;
    Description d;
    static_cast<DescriptionText&>(d) = sent_description(c, faults);
    if (!faults.empty()) return invalid(std::move(faults));
    d.who = c.who();
    d.at_unix_ns = clock.now_unix_ns();
    const auto read = descriptions::read(d.text);
    if (!read.eds) return invalid(descriptions::faults_of(read));
    d.facts = descriptions::facts(d, read);
    const bool taken = c.context.changes->run(
        [d = std::move(d), respond = c.respond, &port, &events, &sites, &staging](std::function<void()> done) {
            const auto answer = [&](Response r) {
                respond(std::move(r));
                done();
            };
            if (const auto there = port.descriptions().find(d.name)) {
                if (there->text == d.text) return answer(json_response(description_document(*there, users_of(d.name, sites, staging))));
                return answer(
                    problem(409, "conflict",
                            fmt::format("there is another description {}: choose another name, or delete that one first", d.name)));
            }
            if (port.descriptions().all().size() >= descriptions::most_descriptions)
                return answer(
                    problem(409, "too_many",
                            fmt::format("there are {} descriptions: delete those that no drive names", descriptions::most_descriptions)));
            port.add_description(d, [d, respond, &events, done](const std::string& fault) {
                if (fault.empty()) {
                    events.note(description_event(d.who, fmt::format("description {} added", d.name)));
                    Response r = json_response(description_document(d, {}), 201);
                    r.headers.set("Location", "/api/v1/descriptions/" + percent_encode(d.name));
                    respond(std::move(r));
                } else {
                    respond(problem(507, "not_stored", fault));
                }
                done();
            });
        },
        thrown(c.respond));
    if (!taken) return site_is_busy();
    return {gateway_limit, problem(504, "no_answer", "the store has not answered")};
}

Handled remove_description(Call& c, DescriptionPort& port, EventPort& events, const SitePort& sites, const StagePort& staging) {
    const bool taken = c.context.changes->run(
        [name = c.names[0], who = c.who(), respond = c.respond, &port, &events, &sites, &staging](std::function<void()> done) {
            const auto answer = [&](Response r) {
                respond(std::move(r));
                done();
            };
            if (!port.descriptions().find(name)) return answer(nothing_named("description", name));
            const auto users = users_of(name, sites, staging);
            if (!users.empty()) {
                std::string list;
                json::array used_by;
                for (const auto& u : users) {
                    list += (list.empty() ? "" : ", ") + u;
                    used_by.emplace_back(u);
                }
                return answer(to_response(
                    Problem{.status = 409,
                            .reason = "conflict",
                            .detail = fmt::format("description {} is named by {} (in force, staged, or where a trial goes back to): change "
                                                  "the site first",
                                                  name, list),
                            .more = {{"used_by", std::move(used_by)}}}));
            }
            port.remove_description(name, [name, who, respond, &events, done](const std::string& fault) {
                if (fault.empty()) {
                    events.note(description_event(who, fmt::format("description {} deleted", name)));
                    Response r;
                    r.status = 204;
                    respond(std::move(r));
                } else {
                    respond(problem(507, "not_stored", fault));
                }
                done();
            });
        },
        thrown(c.respond));
    if (!taken) return site_is_busy();
    return {gateway_limit, problem(504, "no_answer", "the store has not answered")};
}

}  // namespace axisgate::http
