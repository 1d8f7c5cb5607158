// Handlers of recipes: the stored documents, their runs, and the reports. The services read the documents.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
std::optional<std::uint64_t> number_of(const Call& c) {
    const auto n = parse_whole(c.names[1], 1, 9'999'999'999);
    return n ? std::optional(static_cast<std::uint64_t>(*n)) : std::nullopt;
}
Response no_run(const Call& c) { return problem(404, "not_found", fmt::format("recipe {} has no run {}", c.names[0], c.names[1])); }
Handled store_limit() { return {gateway_limit, problem(504, "no_answer", "the store has not answered")}; }
}  // namespace

Handled list_recipes(Call&, const RecipeDocuments& recipes) { return json_response(recipes.list()); }

Handled get_recipe(Call& c, const RecipeDocuments& recipes) {
    return given(recipes.find(c.names[0]), [](const KeptRecipe& kept) { return with_tag(json_response(kept.shown()), kept.tag()); });
}

Handled put_recipe(Call& c, const RecipeDocuments& recipes) {
    auto checked = recipes.check(c.names[0], c.body.get_object(), c.request.body.size());
    if (const auto* refusal = std::get_if<ServiceRefusal>(&checked)) return problem_of(*refusal);
    auto& document = std::get<json::object>(checked);
    std::optional<Response> fault;
    const bool dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    if (dry_run) {
        return given(recipes.try_put(c.names[0], document, meant_state(c.request)), [](std::size_t steps) {
            return json_response(json::object{{"dry_run", true}, {"steps", steps}});
        });
    }
    recipes.put(
        c.names[0], std::move(document), meant_state(c.request), c.origin(),
        [respond = c.respond](const Refusable<RecipeDocuments::Put>& answer) {
            respond(given(answer, [](const RecipeDocuments::Put& put) {
                Response r = with_tag(json_response(put.recipe.shown(), put.created ? 201 : 200), put.recipe.tag());
                if (put.created) r.headers.set("Location", "/api/v1/recipes/" + percent_encode(put.recipe.kept.name));
                return r;
            }));
        },
        thrown(c.respond));
    return store_limit();
}

Handled remove_recipe(Call& c, const RecipeDocuments& recipes) {
    const auto found = recipes.find(c.names[0]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    recipes.remove(
        c.names[0], meant_state(c.request), c.origin(),
        [respond = c.respond](const std::optional<ServiceRefusal>& refusal) { respond(refusal ? problem_of(*refusal) : nothing_left()); },
        thrown(c.respond));
    return store_limit();
}

Handled run_recipe(Call& c, const RecipeDocuments& recipes) {
    auto checked = recipes.check_run(c.names[0], c.body.get_object());
    if (const auto* refusal = std::get_if<ServiceRefusal>(&checked)) return problem_of(*refusal);
    auto& run = std::get<CheckedRun>(checked);
    if (run.dry_run) {
        json::array commanded;
        for (const auto& a : commanded_axes(run.recipe))
            commanded.emplace_back(a);
        return json_response(
            json::object{{"dry_run", true}, {"arguments", run.arguments}, {"axes", std::move(commanded)}, {"steps", run.recipe.count}});
    }
    return given(c.context.recipes->start(c.names[0], std::move(run.recipe), run.arguments, c.origin()), [&](const json::object& report) {
        Response r = json_response(report, 202);
        r.headers.set("Location",
                      fmt::format("/api/v1/recipes/{}/runs/{}", percent_encode(c.names[0]), report.at("n").to_number<std::uint64_t>()));
        return r;
    });
}

Handled list_recipe_runs(Call& c, const RecipeDocuments& recipes) {
    return given(recipes.find(c.names[0]), [&](const KeptRecipe&) {
        json::array out;
        for (auto& r : c.context.recipes->reports(c.names[0]))
            out.push_back(std::move(r));
        return json_response(out);
    });
}

Handled get_recipe_run(Call& c) {
    const auto n = number_of(c);
    const auto report = n ? c.context.recipes->report(c.names[0], *n) : std::nullopt;
    return report ? Handled(json_response(*report)) : Handled(no_run(c));
}

Handled cancel_recipe_run(Call& c) {
    const auto n = number_of(c);
    if (!n) return no_run(c);
    return given(c.context.recipes->cancel(c.names[0], *n, c.origin()),
                 [](const json::object& report) { return json_response(report, 202); });
}

Handled get_recipe_rehearsal(Call& c, const RecipeDocuments& recipes) {
    std::optional<Response> fault;
    const auto first = query_whole(c, "first", 0, RecipeRehearsals::most_specimens, 0, fault);
    if (fault) return *fault;
    return given(recipes.find(c.names[0]), [&](const KeptRecipe& kept) {
        return json_response(c.context.recipe_rehearsals->state(c.names[0], kept.tag(), static_cast<std::size_t>(first)));
    });
}

Handled rehearse_recipe(Call& c, const RecipeDocuments& recipes) {
    auto found = recipes.find(c.names[0]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    std::vector<Fault> faults;
    auto order = read_rehearsal_order(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    auto& kept = std::get<KeptRecipe>(found);
    c.context.recipe_rehearsals->start({c.names[0], kept.document, kept.tag()}, std::move(order), c.origin(),
                                       [respond = c.respond, name = c.names[0]](const Refusable<json::object>& begun) {
                                           respond(given(begun, [&](const json::object& state) {
                                               Response r = json_response(state, 202);
                                               r.headers.set("Location", fmt::format("/api/v1/recipes/{}/rehearsal", percent_encode(name)));
                                               return r;
                                           }));
                                       });
    return {gateway_limit, problem(504, "no_answer", "the rehearsal has not been checked yet: GET shows when it has begun")};
}

Handled cancel_recipe_rehearsal(Call& c, const RecipeDocuments& recipes) {
    return given(recipes.find(c.names[0]), [&](const KeptRecipe& kept) {
        return given(c.context.recipe_rehearsals->cancel(c.names[0], kept.tag(), c.origin()),
                     [](const json::object& state) { return json_response(state, 202); });
    });
}

}  // namespace axisgate::http
