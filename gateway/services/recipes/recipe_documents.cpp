// Changes wait for their turn, so that the state to which a request refers is still present when it is written.
#include "gateway/services/recipes/recipe_documents.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/parse.hpp>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
#include "gateway/services/recipes/recipe_steps.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using Why = ServiceRefusal::Why;
const std::string recipe_kind = "recipe";
constexpr std::size_t most_name_bytes = 64;

bool is_recipe_name(std::string_view s) {
    return !s.empty() && s.size() <= most_name_bytes && s != "." && s != ".." && std::ranges::all_of(s, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    });
}

std::optional<KeptRecipe> parsed_recipe(const Document& d) {
    boost::system::error_code ec;
    auto v = json::parse(d.text, ec);
    if (ec || !v.is_object()) return std::nullopt;
    return KeptRecipe{d, std::move(v.get_object())};
}

ServiceRefusal too_many_recipe_changes() { return {Why::overloaded, "too many changes of recipes wait already: try again"}; }
}  // namespace

std::string KeptRecipe::tag() const { return tag_over({kept.text, kept.who, std::to_string(kept.at_unix_ns)}); }

json::object KeptRecipe::shown() const {
    json::object o = document;
    o["name"] = kept.name;
    o["changed_at"] = format_time(kept.at_unix_ns);
    o["changed_by"] = text_or_null(kept.who);
    return o;
}

json::array RecipeDocuments::list() const {
    json::array out;
    for (const auto& d : ports_.get<DocumentPort>().documents(recipe_kind)) {
        const auto kept = parsed_recipe(d);
        if (!kept) continue;
        const auto* description = kept->document.if_contains("description");
        const auto* parameters = kept->document.if_contains("parameters");
        std::vector<SiteFault> none;
        const auto recipe = read_recipe(kept->document, nullptr, none);
        const auto n = service_->running(d.name);
        out.push_back(json::object{{"name", d.name},
                                   {"etag", kept->tag()},
                                   {"description", description ? *description : json::value("")},
                                   {"parameters", parameters ? *parameters : json::value(json::object())},
                                   {"steps", recipe ? recipe->count : 0},
                                   {"changed_at", format_time(d.at_unix_ns)},
                                   {"changed_by", text_or_null(d.who)},
                                   {"running", n == 0 ? json::value(nullptr) : json::value(n)}});
    }
    return out;
}

Refusable<KeptRecipe> RecipeDocuments::find(const std::string& name) const {
    const auto d = is_recipe_name(name) ? ports_.get<DocumentPort>().document(recipe_kind, name) : std::nullopt;
    auto kept = d ? parsed_recipe(*d) : std::nullopt;
    if (!kept) return no_such("recipe", name);
    return *std::move(kept);
}

Refusable<json::object> RecipeDocuments::check(const std::string& name, json::object document, std::size_t bytes) const {
    std::vector<SiteFault> faults;
    if (!is_recipe_name(name)) faults.push_back({"", "a recipe's name has 1 to 64 letters, digits, - _ .", "choose another name", false});
    if (bytes > most_recipe_bytes)
        faults.push_back({"", fmt::format("the recipe has {} bytes; at most {} are kept", bytes, most_recipe_bytes), "divide it", false});
    if (const auto* n = document.if_contains("name"); n && *n != json::value(name))
        faults.push_back({"/name", fmt::format("the name is {} in the path", name), "leave the member out, or write the same", false});
    const auto recipe = read_recipe(document, nullptr, faults);
    if (recipe) check_recipe_form(*recipe, ports_.get<SitePort>().site()->site, faults);
    if (!faults.empty()) return faulty(faults_for(faults, "", true));
    for (const auto* key : {"name", "changed_at", "changed_by"})
        document.erase(key);
    return document;
}

/// Refuses, with the present document, if the request refers to another one.
std::optional<ServiceRefusal> RecipeDocuments::refuse_other(const std::string& name, const std::optional<Document>& now,
                                                            const MeantState& meant) const {
    const auto kept = now ? parsed_recipe(*now) : std::nullopt;
    const std::string tag = now ? KeptRecipe{*now, {}}.tag() : std::string();
    const auto refused = [&](std::string text) {
        return ServiceRefusal{.why = Why::overtaken,
                              .text = std::move(text),
                              .more = {{"current", kept ? json::value(kept->shown()) : json::value(nullptr)}},
                              .tag = tag};
    };
    if (!meant.text.empty() && !now) return refused(fmt::format("there is no recipe {} any more: leave If-Match out to make it", name));
    if (now && meant.another(tag))
        return refused(fmt::format("recipe {} was changed by {} at {}: read it again; its ETag is {}, not {}", name,
                                   now->who.empty() ? "somebody" : now->who, format_time(now->at_unix_ns), tag, meant.text));
    if (now && meant.excluded(tag))
        return refused(fmt::format("there is a recipe {} already: choose another name, or send If-Match: {} to replace it", name, tag));
    return std::nullopt;
}

std::optional<ServiceRefusal> RecipeDocuments::refuse_put(const std::string& name, const MeantState& meant, bool& created) const {
    const auto& documents = ports_.get<DocumentPort>();
    const auto now = documents.document(recipe_kind, name);
    created = !now;
    if (auto refusal = refuse_other(name, now, meant)) return refusal;
    if (created && documents.documents(recipe_kind).size() >= RecipeService::most_recipes)
        return ServiceRefusal{Why::too_many,
                              fmt::format("there are {} recipes: delete those that are no longer needed", RecipeService::most_recipes)};
    return std::nullopt;
}

Refusable<std::size_t> RecipeDocuments::try_put(const std::string& name, const json::object& document, const MeantState& meant) const {
    bool created = false;
    if (auto refusal = refuse_put(name, meant, created)) return *std::move(refusal);
    std::vector<SiteFault> none;
    const auto recipe = read_recipe(document, nullptr, none);
    return recipe ? recipe->count : 0;
}

void RecipeDocuments::note(const Origin& origin, std::string text) const {
    Event e;
    e.kind = "recipe";
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    e.text = std::move(text);
    ports_.get<EventPort>().note(std::move(e));
}

void RecipeDocuments::put(const std::string& name, json::object document, MeantState meant, const Origin& origin,
                          std::function<void(Refusable<Put>)> then, ChangeQueue::Failed thrown) const {
    const bool taken = service_->changes->run(
        [self = *this, name, document = std::move(document), meant = std::move(meant), origin, then](std::function<void()> done) {
            bool created = false;
            if (auto refusal = self.refuse_put(name, meant, created)) {
                then(*std::move(refusal));
                return done();
            }
            KeptRecipe kept{{name, json_text(document), origin.who ? *origin.who : "", self.ports_.get<ClockPort>().now_unix_ns()},
                            document};
            const Document d = kept.kept;
            self.ports_.get<DocumentPort>().save_document(
                recipe_kind, d, [self, origin, then, kept = std::move(kept), created, done](const std::string& why) {
                    if (why.empty()) {
                        self.note(origin, fmt::format("recipe {} {}", kept.kept.name, created ? "made" : "changed"));
                        then(Put{kept, created});
                    } else {
                        then(ServiceRefusal{Why::not_stored, why});
                    }
                    done();
                });
        },
        std::move(thrown));
    if (!taken) then(too_many_recipe_changes());
}

void RecipeDocuments::remove(const std::string& name, MeantState meant, const Origin& origin,
                             std::function<void(std::optional<ServiceRefusal>)> then, ChangeQueue::Failed thrown) const {
    const bool taken = service_->changes->run(
        [self = *this, name, meant = std::move(meant), origin, then](std::function<void()> done) {
            const auto now = self.ports_.get<DocumentPort>().document(recipe_kind, name);
            auto refusal = now ? self.refuse_other(name, now, meant) : std::optional(no_such("recipe", name));
            if (const auto n = self.service_->running(name); !refusal && n != 0)
                refusal = ServiceRefusal{Why::running, fmt::format("recipe {} is running (run {}): cancel it first", name, n)};
            if (refusal) {
                then(std::move(refusal));
                return done();
            }
            self.ports_.get<DocumentPort>().delete_document(recipe_kind, name, [self, name, origin, then, done](const std::string& why) {
                if (why.empty()) {
                    self.note(origin, fmt::format("recipe {} deleted", name));
                    self.service_->forget(name);
                }
                then(why.empty() ? std::nullopt : std::optional(ServiceRefusal{Why::not_stored, why}));
                done();
            });
        },
        std::move(thrown));
    if (!taken) then(too_many_recipe_changes());
}

Refusable<CheckedRun> RecipeDocuments::check_run(const std::string& name, const json::object& body) const {
    auto found = find(name);
    if (auto* refusal = std::get_if<ServiceRefusal>(&found)) return std::move(*refusal);
    const auto& document = std::get<KeptRecipe>(found).document;
    std::vector<SiteFault> faults;
    json::object arguments;
    bool dry_run = false;
    for (const auto& [k, v] : body) {
        if (k == "arguments" && v.is_object()) {
            arguments = v.get_object();
        } else if (k == "dry_run" && v.is_bool()) {
            dry_run = v.get_bool();
        } else {
            const bool is_known = k == "arguments" || k == "dry_run";
            faults.push_back({"/" + std::string(k),
                              fmt::format("{} {}", std::string_view(k), is_known ? "has the wrong type" : "is not known here"),
                              "write {\"arguments\": {...}, \"dry_run\": false}", false});
        }
    }
    auto recipe = read_recipe(document, &arguments, faults);
    if (recipe) check_recipe(*recipe, ports_.get<SitePort>(), faults);
    if (recipe) check_simulated(*recipe, ports_.get<SitePort>(), ports_.get<AxisPort>(), faults);
    if (!faults.empty()) {
        std::vector<Fault> list;
        for (const auto& f : faults)
            list.push_back({f.pointer, f.text, f.remedy, !f.pointer.starts_with("/steps") && !f.pointer.starts_with("/parameters")});
        return faulty(std::move(list));
    }
    auto whole = whole_arguments(document, arguments);
    return CheckedRun{std::move(*recipe), std::move(whole), dry_run};
}

}  // namespace axisgate
