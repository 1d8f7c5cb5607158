// A rehearsal gives the player one specimen after the other, so that a rehearsal of loss of command comes between them. Nothing of the
// running gateway is used but the stored site and recipe, as they were at the beginning.
#include "gateway/services/recipes/recipe_rehearsals.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using Why = ServiceRefusal::Why;

const char* const order_form = R"(write {"specimens": "1..100,slow", "families": {"uim342": "0"}, "arguments": {}})";

void read_families(const json::value& v, RecipeRehearsalOrder& order, std::vector<Fault>& faults) {
    if (!v.is_object()) return faults.push_back({"/families", "families has the wrong type", order_form});
    for (const auto& [family, specimen] : v.get_object()) {
        if (specimen.is_string()) {
            order.fixed[std::string(family)] = std::string(specimen.get_string());
        } else {
            faults.push_back({"/families/" + std::string(family), "a specimen is a text", order_form});
        }
    }
}
}  // namespace

RecipeRehearsalOrder read_rehearsal_order(const json::object& body, std::vector<Fault>& faults) {
    RecipeRehearsalOrder order;
    std::string specimens = "1..100";
    for (const auto& [key, value] : body) {
        if (key == "specimens" && value.is_string()) {
            specimens = value.get_string();
        } else if (key == "families") {
            read_families(value, order, faults);
        } else if (key == "arguments" && value.is_object()) {
            order.arguments = value.get_object();
        } else {
            const bool known = key == "specimens" || key == "arguments";
            faults.push_back({"/" + std::string(key),
                              fmt::format("{} {}", std::string_view(key), known ? "has the wrong type" : "is not known here"), order_form});
        }
    }
    std::string wrong;
    order.specimens = read_specimens(specimens, wrong);
    if (wrong.empty() && order.specimens.size() > RecipeRehearsals::most_specimens)
        wrong = fmt::format("{} has {} specimens; one rehearsal has at most {}", specimens, order.specimens.size(),
                            RecipeRehearsals::most_specimens);
    if (!wrong.empty())
        faults.push_back({"/specimens", std::move(wrong), "write seeds, ranges and names with commas, such as 1..100,slow"});
    return order;
}

RecipeRehearsals::~RecipeRehearsals() {
    if (active_) *active_->ended = true;
}

void RecipeRehearsals::note(const Run& run, Severity severity, std::string who, std::string text) {
    Event e;
    e.kind = "rehearsal";
    e.severity = severity;
    e.who = std::move(who);
    e.door = run.door;
    e.text = std::move(text);
    events_.note(std::move(e));
}

void RecipeRehearsals::start(Stored recipe, RecipeRehearsalOrder order, const Origin& origin,
                             std::function<void(const Refusable<json::object>&)> then) {
    if (active_)
        return then(ServiceRefusal{
            Why::running,
            fmt::format("a rehearsal of recipe {} is under way: wait for its end, or end it with DELETE /api/v1/recipes/{}/rehearsal",
                        active_->recipe, active_->recipe)});
    const auto site = sites_.site();
    if (site->site.axes.empty())
        return then(ServiceRefusal{Why::wrong_state, "the site has no axis, so there is nothing that could be rehearsed: add one first"});
    auto run = std::make_shared<Run>();
    run->recipe = recipe.name;
    run->tag = std::move(recipe.tag);
    run->who = origin.who ? *origin.who : "";
    run->door = std::string(name_of(origin.door));
    run->site_revision = site->revision;
    run->order = std::move(order);
    active_ = run;
    RecipeRehearsalWish wish;
    wish.name = std::move(recipe.name);
    wish.document = std::move(recipe.document);
    wish.arguments = run->order.arguments;
    wish.fixed = run->order.fixed;
    wish.site = site->site;
    wish.by = origin;
    player_.prepare_recipe(std::move(wish), [weak = weak_from_this(), run, then = std::move(then)](
                                                std::shared_ptr<const RecipeRehearsal> rehearsal, const std::vector<SiteFault>& faults) {
        const auto self = weak.lock();
        if (!self) return;
        if (!rehearsal) {
            self->active_.reset();
            std::vector<Fault> list;
            for (const auto& f : faults) {
                const bool in_body = f.pointer.starts_with("/arguments") || f.pointer.starts_with("/fixed");
                list.push_back({f.pointer == "/fixed" ? "/families" : f.pointer, f.text, f.remedy, in_body});
            }
            return then(faulty(std::move(list)));
        }
        run->rehearsal = std::move(rehearsal);
        self->begin(run);
        then(self->state(run->recipe, run->tag));
        self->next(run);
    });
}

void RecipeRehearsals::begin(const std::shared_ptr<Run>& run) {
    run->began_unix_ns = clock_.now_unix_ns();
    std::erase_if(runs_, [&](const auto& r) { return r->recipe == run->recipe; });
    runs_.push_front(run);
    if (runs_.size() > kept_reports) runs_.pop_back();
    note(*run, Severity::info, run->who,
         fmt::format("recipe {} is rehearsed against {} specimens", run->recipe, run->order.specimens.size()));
}

void RecipeRehearsals::next(const std::shared_ptr<Run>& run) {
    if (run->cancelled || run->rows.size() == run->order.specimens.size()) return end(*run);
    player_.rehearse_recipe(run->rehearsal, run->order.specimens[run->rows.size()], run->ended,
                            [weak = weak_from_this(), run](RehearsedSpecimen row) {
                                const auto self = weak.lock();
                                if (!self) return;
                                if (!run->cancelled) {  // otherwise this one was given up, and says nothing about the specimen
                                    run->passed += row.passed ? 1 : 0;
                                    run->rows.push_back(std::move(row));
                                }
                                self->next(run);
                            });
}

void RecipeRehearsals::end(Run& run) {
    active_.reset();
    run.over = true;
    run.rehearsal.reset();
    run.ended_unix_ns = clock_.now_unix_ns();
    if (run.cancelled) return;  // was told when it was asked for
    const std::size_t failed = run.rows.size() - run.passed;
    note(run, failed == 0 ? Severity::info : Severity::warning, run.who,
         fmt::format("recipe {} was rehearsed: {} of {} specimens passed", run.recipe, run.passed, run.rows.size()));
}

const RecipeRehearsals::Run* RecipeRehearsals::find(const std::string& recipe) const {
    const auto it = std::ranges::find_if(runs_, [&](const auto& r) { return r->recipe == recipe; });
    return it == runs_.end() ? nullptr : it->get();
}

json::object RecipeRehearsals::state(const std::string& recipe, const std::string& tag, std::size_t first) const {
    const Run* run = find(recipe);
    json::object out{{"recipe", recipe}, {"state", "none"},     {"total", 0},          {"done", 0},      {"passed", 0},
                     {"failed", 0},      {"began_at", nullptr}, {"ended_at", nullptr}, {"who", nullptr}, {"site_revision", nullptr},
                     {"outdated", false}};
    json::array rows;
    if (run) {
        out["state"] = !run->over ? (run->cancelled ? "cancelling" : "running") : run->cancelled ? "cancelled" : "done";
        out["total"] = run->order.specimens.size();
        out["done"] = run->rows.size();
        out["passed"] = run->passed;
        out["failed"] = run->rows.size() - run->passed;
        out["began_at"] = format_time(run->began_unix_ns);
        if (run->over) out["ended_at"] = format_time(run->ended_unix_ns);
        out["who"] = text_or_null(run->who);
        out["site_revision"] = run->site_revision;
        out["outdated"] = run->tag != tag || run->site_revision != sites_.site()->revision;
        json::object families;
        for (const auto& [family, specimen] : run->order.fixed)
            families[family] = specimen;
        out["families"] = std::move(families);
        out["arguments"] = run->order.arguments;
        for (std::size_t i = first; i < run->rows.size(); ++i)
            rows.push_back(to_json(run->rows[i]));
    } else {
        out["families"] = json::object();
        out["arguments"] = json::object();
    }
    out["specimens"] = std::move(rows);
    return out;
}

Refusable<json::object> RecipeRehearsals::cancel(const std::string& recipe, const std::string& tag, const Origin& origin) {
    if (!active_ || active_->recipe != recipe || !active_->rehearsal)
        return ServiceRefusal{Why::wrong_state, fmt::format("recipe {} is not being rehearsed", recipe)};
    if (!std::exchange(active_->cancelled, true)) {
        *active_->ended = true;
        note(*active_, Severity::info, origin.who ? *origin.who : "",
             fmt::format("the rehearsal of recipe {} was ended after {} of {} specimens", recipe, active_->rows.size(),
                         active_->order.specimens.size()));
    }
    return state(recipe, tag);
}

}  // namespace axisgate
