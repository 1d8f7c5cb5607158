// Runs recipes: submits their requests to the axes, gives them time and answers, stores their reports. Bounds: 4 runs at once, one per
// recipe, no axis in two; a run is stored at its start, its end, and once a second in between. Service thread only; the owner calls
// on_deadline.
#pragma once

#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/services/change_queue.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/recipes/recipe_claims.hpp"
#include "gateway/services/recipes/recipe_reports.hpp"
#include "gateway/services/recipes/recipe_run.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

class RecipeService : public std::enable_shared_from_this<RecipeService> {
public:
    static constexpr std::size_t most_runs = 4;
    static constexpr std::size_t kept_reports = RecipeReports::kept;
    static constexpr std::size_t most_recipes = 200;
    static constexpr Duration publish_period = std::chrono::milliseconds(100);  ///< of the progress of one run

    static constexpr Duration keep_period = std::chrono::seconds(1);  ///< between two writes of a run in progress

    using Needs = PortSet<AxisPort, ClockPort, DocumentPort, EventPort, SitePort>;
    RecipeService(const Needs& ports, std::function<Instant()> clock)
        : axes_(ports.get<AxisPort>()),
          wall_(ports.get<ClockPort>()),
          events_(ports.get<EventPort>()),
          sites_(ports.get<SitePort>()),
          clock_(std::move(clock)),
          reports_(std::make_shared<RecipeReports>(ports)) {}

    /// Once at the start: reports runs that the end of the gateway has interrupted.
    void begin() { reports_->begin(); }

    /// Changes of the documents, one after the other, so that the condition of If-Match still holds when the document is written.
    const std::shared_ptr<ChangeQueue> changes = std::make_shared<ChangeQueue>();

    /// Called when deadline() may have changed for another reason than on_deadline.
    std::function<void()> rearm;
    /// Called with the report of a run when it has changed, at most every publish_period, and at its end.
    std::function<void(const std::string& recipe, const boost::json::object& report)> publish;

    /// Starts a checked recipe; returns its first report, or the reason why it cannot start.
    [[nodiscard]] Refusable<boost::json::object> start(const std::string& name, Recipe recipe, boost::json::object arguments,
                                                       const Origin& origin);
    [[nodiscard]] Refusable<boost::json::object> cancel(const std::string& name, std::uint64_t n, const Origin& origin);
    [[nodiscard]] std::optional<boost::json::object> report(const std::string& name, std::uint64_t n) const;
    /// Newest first, without their steps.
    [[nodiscard]] std::vector<boost::json::object> reports(const std::string& name) const;
    /// Number of the run in progress; 0: none.
    [[nodiscard]] std::uint64_t running(const std::string& name) const;
    /// Complete reports of the runs in progress.
    [[nodiscard]] std::vector<boost::json::object> in_progress() const;
    /// Deletes the reports of a removed recipe.
    void forget(const std::string& name);

    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);

private:
    struct Active {
        std::string name;
        std::uint64_t n = 0;
        std::unique_ptr<RecipeRun> run;
        std::vector<std::string> axes;
        boost::json::object arguments;
        Origin origin;    ///< of its commands
        std::string who;  ///< the client that started it
        Instant published{}, kept{};
        std::uint64_t published_revision = 0, kept_revision = 0;
        RecipeClaims claims;
    };
    struct World;
    void pump(const std::shared_ptr<Active>& active, Instant now);
    void carry_out(const std::shared_ptr<Active>& active, const RecipeRequest& request);
    void answer(const std::weak_ptr<Active>& active, std::uint32_t number, RecipeAnswer answer);
    void submit(const std::shared_ptr<Active>& active, std::uint32_t number, const RecipeStep* mover, Command command);
    void keep(Active& active, Instant now);
    void ended(const std::shared_ptr<Active>& active);
    void note(const Active& active, Severity severity, std::string text, std::string axis = {});
    [[nodiscard]] boost::json::object document(const Active& active) const;

    AxisPort& axes_;
    ClockPort& wall_;
    EventPort& events_;
    SitePort& sites_;
    std::function<Instant()> clock_;
    std::vector<std::shared_ptr<Active>> active_;
    std::shared_ptr<RecipeReports> reports_;
    bool due_now_ = false;
};

}  // namespace axisgate
