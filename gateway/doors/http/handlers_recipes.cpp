// Handlers of recipes: the stored documents, their runs, and the reports of those.
// In: calls. Out: documents as they were put, reports as the recipe service keeps them.
// Never carries out a step: that is the service's.
#include <fmt/core.h>

#include <algorithm>
#include <boost/json/parse.hpp>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/change_queue.hpp"
#include "gateway/services/recipes/recipe_service.hpp"
#include "gateway/services/recipes/recipe_steps.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
const std::string kind = "recipe";
constexpr std::size_t most_name_bytes = 64;

bool good_name(std::string_view s) {
    return !s.empty() && s.size() <= most_name_bytes && s != "." && s != ".." && std::ranges::all_of(s, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    });
}

std::vector<Fault> in_body(const std::vector<SiteFault>& faults) {
    std::vector<Fault> out;
    for (const auto& f : faults)
        out.push_back({f.pointer, f.text, f.remedy, true});
    return out;
}

std::optional<json::object> parsed(const Document& d) {
    boost::system::error_code ec;
    auto v = json::parse(d.text, ec);
    if (ec || !v.is_object()) return std::nullopt;
    return std::move(v.get_object());
}

std::optional<std::pair<Document, json::object>> find_recipe(const Call& c, const DocumentPort& documents) {
    auto d = good_name(c.names[0]) ? documents.document(kind, c.names[0]) : std::nullopt;
    auto o = d ? parsed(*d) : std::nullopt;
    if (!o) return std::nullopt;
    return std::pair(std::move(*d), std::move(*o));
}

json::object shown(const Document& d, json::object o) {
    o["name"] = d.name;
    o["changed_at"] = format_time(d.at_unix_ns);
    o["changed_by"] = text_or_null(d.who);
    return o;
}

std::optional<std::uint64_t> number_of(const Call& c) {
    const auto n = parse_whole(c.names[1], 1, 9'999'999'999);
    return n ? std::optional(static_cast<std::uint64_t>(*n)) : std::nullopt;
}

/// Names one state of one document: another text, time or author is another tag.
std::string recipe_tag(const Document& d) { return tag_over({d.text, d.who, std::to_string(d.at_unix_ns)}); }

/// If-Match and If-None-Match of a request that changes a recipe, kept until its turn comes.
struct Wanted {
    std::string if_match, if_none_match;
    explicit Wanted(const Call& c) : if_match(c.request.headers.get("If-Match")), if_none_match(c.request.headers.get("If-None-Match")) {}

    /// 412 with what is there now, if it is not what was asked for.
    [[nodiscard]] std::optional<Response> refuse(const std::string& name, const std::optional<Document>& now) const {
        const auto refused = [&](std::string text) {
            const auto o = now ? parsed(*now) : std::nullopt;
            return overtaken(std::move(text), now ? std::optional(recipe_tag(*now)) : std::nullopt,
                             o ? json::value(shown(*now, *o)) : json::value(nullptr));
        };
        if (!if_match.empty() && !now) return refused(fmt::format("there is no recipe {} any more: leave If-Match out to make it", name));
        if (now && means_another(if_match, recipe_tag(*now)))
            return refused(fmt::format("recipe {} was changed by {} at {}: read it again; its ETag is {}, not {}", name,
                                       now->who.empty() ? "somebody" : now->who, format_time(now->at_unix_ns), recipe_tag(*now), if_match));
        if (!if_none_match.empty() && now && tag_listed(if_none_match, recipe_tag(*now), true))
            return refused(fmt::format("there is a recipe {} already: choose another name, or send If-Match: {} to replace it", name,
                                       recipe_tag(*now)));
        return std::nullopt;
    }
};

Event recipe_event(const std::string& by, std::string text) {
    Event e;
    e.kind = "recipe";
    e.who = by;
    e.door = "http";
    e.text = std::move(text);
    return e;
}

Response too_busy() { return problem(503, "busy", "too many changes of recipes wait already: try again"); }

Response no_run(const Call& c) { return problem(404, "not_found", fmt::format("recipe {} has no run {}", c.names[0], c.names[1])); }
Response store_fault(const std::string& fault) { return problem(507, "not_stored", fault); }
}  // namespace

Handled list_recipes(Call& c, const DocumentPort& documents) {
    json::array out;
    for (const auto& d : documents.documents(kind)) {
        const auto o = parsed(d);
        if (!o) continue;
        const auto* description = o->if_contains("description");
        const auto* parameters = o->if_contains("parameters");
        std::vector<SiteFault> none;
        const auto recipe = read_recipe(*o, nullptr, none);
        const auto n = c.context.recipes->running(d.name);
        out.push_back(json::object{{"name", d.name},
                                   {"etag", recipe_tag(d)},
                                   {"description", description ? *description : json::value("")},
                                   {"parameters", parameters ? *parameters : json::value(json::object())},
                                   {"steps", recipe ? recipe->count : 0},
                                   {"changed_at", format_time(d.at_unix_ns)},
                                   {"changed_by", text_or_null(d.who)},
                                   {"running", n == 0 ? json::value(nullptr) : json::value(n)}});
    }
    return json_response(out);
}

Handled get_recipe(Call& c, const DocumentPort& documents) {
    auto found = find_recipe(c, documents);
    if (!found) return nothing_named("recipe", c.names[0]);
    return with_tag(json_response(shown(found->first, std::move(found->second))), recipe_tag(found->first));
}

Handled put_recipe(Call& c, const ClockPort& clock, DocumentPort& documents, EventPort& events) {
    std::vector<SiteFault> faults;
    const std::string name = c.names[0];
    if (!good_name(name)) faults.push_back({"", "a recipe's name has 1 to 64 letters, digits, - _ .", "choose another name", false});
    json::object document = c.body.get_object();
    if (c.request.body.size() > most_recipe_bytes)
        faults.push_back({"", fmt::format("the recipe has {} bytes; at most {} are kept", c.request.body.size(), most_recipe_bytes),
                          "divide it", false});
    if (const auto* n = document.if_contains("name"); n && *n != json::value(name))
        faults.push_back({"/name", fmt::format("the name is {} in the path", name), "leave the member out, or write the same", false});
    const auto recipe = read_recipe(document, nullptr, faults);
    if (recipe) check_recipe_form(*recipe, faults);
    if (!faults.empty()) return invalid(in_body(faults));
    for (const auto* key : {"name", "changed_at", "changed_by"})
        document.erase(key);
    std::optional<Response> fault;
    const bool dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    const auto refused = [name, wanted = Wanted(c), &documents](bool& created) -> std::optional<Response> {
        const auto now = documents.document(kind, name);
        created = !now;
        if (auto refusal = wanted.refuse(name, now)) return refusal;
        if (created && documents.documents(kind).size() >= RecipeService::most_recipes)
            return problem(409, "too_many",
                           fmt::format("there are {} recipes: delete those that are no longer needed", RecipeService::most_recipes));
        return std::nullopt;
    };
    if (dry_run) {
        bool created = false;
        if (auto refusal = refused(created)) return *refusal;
        return json_response(json::object{{"dry_run", true}, {"steps", recipe->count}});
    }
    const bool taken = c.context.recipes->changes->run(
        [refused, name, document, respond = c.respond, who = c.who(), &clock, &documents, &events](std::function<void()> done) {
            bool created = false;
            if (auto refusal = refused(created)) {
                respond(*std::move(refusal));
                return done();
            }
            const Document d{name, json_text(document), who, clock.now_unix_ns()};
            documents.save_document(kind, d, [respond, &events, d, document, created, done](const std::string& why) {
                if (why.empty()) {
                    events.note(recipe_event(d.who, fmt::format("recipe {} {}", d.name, created ? "made" : "changed")));
                    Response r = with_tag(json_response(shown(d, document), created ? 201 : 200), recipe_tag(d));
                    if (created) r.headers.set("Location", "/api/v1/recipes/" + percent_encode(d.name));
                    respond(std::move(r));
                } else {
                    respond(store_fault(why));
                }
                done();
            });
        },
        thrown(c.respond));
    if (!taken) return too_busy();
    return {gateway_limit, problem(504, "no_answer", "the store has not answered")};
}

Handled remove_recipe(Call& c, DocumentPort& documents, EventPort& events) {
    if (!find_recipe(c, documents)) return nothing_named("recipe", c.names[0]);
    const bool taken = c.context.recipes->changes->run(
        [name = c.names[0], wanted = Wanted(c), service = c.context.recipes, respond = c.respond, who = c.who(), &documents,
         &events](std::function<void()> done) {
            const auto refusal = [&]() -> std::optional<Response> {
                const auto now = documents.document(kind, name);
                if (!now) return nothing_named("recipe", name);
                if (auto r = wanted.refuse(name, now)) return r;
                if (const auto n = service->running(name); n != 0)
                    return problem(409, "running", fmt::format("recipe {} is running (run {}): cancel it first", name, n));
                return std::nullopt;
            }();
            if (refusal) {
                respond(*refusal);
                return done();
            }
            documents.delete_document(kind, name, [respond, &events, service, name, who, done](const std::string& why) {
                if (why.empty()) {
                    events.note(recipe_event(who, fmt::format("recipe {} deleted", name)));
                    service->forget(name);
                    Response r;
                    r.status = 204;
                    respond(std::move(r));
                } else {
                    respond(store_fault(why));
                }
                done();
            });
        },
        thrown(c.respond));
    if (!taken) return too_busy();
    return {gateway_limit, problem(504, "no_answer", "the store has not answered")};
}

Handled run_recipe(Call& c, const AxisPort& axes, const DocumentPort& documents, const SitePort& sites) {
    auto found = find_recipe(c, documents);
    if (!found) return nothing_named("recipe", c.names[0]);
    std::vector<SiteFault> faults;
    json::object arguments;
    bool dry_run = false;
    for (const auto& [k, v] : c.body.get_object()) {
        if (k == "arguments" && v.is_object()) {
            arguments = v.get_object();
        } else if (k == "dry_run" && v.is_bool()) {
            dry_run = v.get_bool();
        } else {
            const bool known = k == "arguments" || k == "dry_run";
            faults.push_back({"/" + std::string(k),
                              fmt::format("{} {}", std::string_view(k), known ? "has the wrong type" : "is not known here"),
                              "write {\"arguments\": {...}, \"dry_run\": false}", false});
        }
    }
    auto recipe = read_recipe(found->second, &arguments, faults);
    if (recipe) check_recipe(*recipe, sites, faults);
    if (recipe) check_simulated(*recipe, sites, axes, faults);
    if (!faults.empty()) {
        std::vector<Fault> list;
        for (const auto& f : faults)
            list.push_back({f.pointer, f.text, f.remedy, !f.pointer.starts_with("/steps") && !f.pointer.starts_with("/parameters")});
        return invalid(std::move(list));
    }
    const auto whole = whole_arguments(found->second, arguments);
    if (dry_run) {
        json::array commanded;
        for (const auto& a : commanded_axes(*recipe))
            commanded.emplace_back(a);
        return json_response(
            json::object{{"dry_run", true}, {"arguments", whole}, {"axes", std::move(commanded)}, {"steps", recipe->count}});
    }
    auto started = c.context.recipes->start(c.names[0], std::move(*recipe), whole, c.origin());
    if (const auto* p = std::get_if<RunRefusal>(&started)) return problem_of(*p);
    const auto& report = std::get<json::object>(started);
    Response r = json_response(report, 202);
    r.headers.set("Location",
                  fmt::format("/api/v1/recipes/{}/runs/{}", percent_encode(c.names[0]), report.at("n").to_number<std::uint64_t>()));
    return r;
}

Handled list_recipe_runs(Call& c, const DocumentPort& documents) {
    if (!find_recipe(c, documents)) return nothing_named("recipe", c.names[0]);
    json::array out;
    for (auto& r : c.context.recipes->reports(c.names[0]))
        out.push_back(std::move(r));
    return json_response(out);
}

Handled get_recipe_run(Call& c) {
    const auto n = number_of(c);
    const auto report = n ? c.context.recipes->report(c.names[0], *n) : std::nullopt;
    return report ? Handled(json_response(*report)) : Handled(no_run(c));
}

Handled cancel_recipe_run(Call& c) {
    const auto n = number_of(c);
    if (!n) return no_run(c);
    auto answer = c.context.recipes->cancel(c.names[0], *n, c.origin());
    if (const auto* p = std::get_if<RunRefusal>(&answer)) return problem_of(*p);
    return json_response(std::get<json::object>(answer), 202);
}

}  // namespace axisgate::http
