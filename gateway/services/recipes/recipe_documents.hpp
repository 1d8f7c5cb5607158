// The stored recipes: listed, shown, changed, removed, checked before a run, with an event for each change. RecipeService runs them.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gateway/services/recipes/recipe_service.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/services/state_tag.hpp"

namespace axisgate {

struct KeptRecipe {
    Document kept;
    boost::json::object document;
    [[nodiscard]] std::string tag() const;
    /// With its name, and the client and time of its last change.
    [[nodiscard]] boost::json::object shown() const;
};
struct CheckedRun {
    Recipe recipe;
    boost::json::object arguments;  ///< complete, with defaults for those that were left out
    bool dry_run = false;
};

/// A value, made where the ports and the recipe service are available.
class RecipeDocuments {
public:
    using Needs = PortSet<AxisPort, ClockPort, DocumentPort, EventPort, SitePort>;
    RecipeDocuments(const Needs& ports, std::shared_ptr<RecipeService> service) : ports_(ports), service_(std::move(service)) {}

    [[nodiscard]] boost::json::array list() const;
    [[nodiscard]] Refusable<KeptRecipe> find(const std::string& name) const;

    /// Checks a document by itself and against the site in force; `bytes` is its size as received.
    [[nodiscard]] Refusable<boost::json::object> check(const std::string& name, boost::json::object document, std::size_t bytes) const;
    /// Number of steps of a checked document, if it could be stored now.
    [[nodiscard]] Refusable<std::size_t> try_put(const std::string& name, const boost::json::object& document,
                                                 const MeantState& meant) const;
    struct Put {
        KeptRecipe recipe;
        bool created = false;
    };
    /// Each `then` is called once, perhaps at once; `thrown` is called if the change threw.
    void put(const std::string& name, boost::json::object document, MeantState meant, const Origin& origin,
             std::function<void(Refusable<Put>)> then, ChangeQueue::Failed thrown) const;
    void remove(const std::string& name, MeantState meant, const Origin& origin, std::function<void(std::optional<ServiceRefusal>)> then,
                ChangeQueue::Failed thrown) const;
    /// Checks a recipe with the arguments of a body against the present site and drives.
    [[nodiscard]] Refusable<CheckedRun> check_run(const std::string& name, const boost::json::object& body) const;

private:
    [[nodiscard]] std::optional<ServiceRefusal> refuse_other(const std::string& name, const std::optional<Document>& now,
                                                             const MeantState& meant) const;
    [[nodiscard]] std::optional<ServiceRefusal> refuse_put(const std::string& name, const MeantState& meant, bool& created) const;
    void note(const Origin& origin, std::string text) const;

    Needs ports_;
    std::shared_ptr<RecipeService> service_;
};

}  // namespace axisgate
