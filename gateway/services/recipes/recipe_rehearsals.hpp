// Rehearsals of stored recipes against specimens, one after the other on a player beside the gateway, with their progress. Bounds: one
// rehearsal at a time; a limited number of specimens in it; the reports of the last few recipes, which a restart forgets. Service thread
// only.
#pragma once

#include <atomic>
#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/recipes/recipe_rehearsal.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

/// An order as a client sends it.
struct RecipeRehearsalOrder {
    std::vector<std::string> specimens;
    FixedSpecimens fixed{};
    boost::json::object arguments{};  ///< of the recipe
};
/// {"specimens": "1..100", "families": {"uim342": "slow"}, "arguments": {...}}; each may be left out.
[[nodiscard]] RecipeRehearsalOrder read_rehearsal_order(const boost::json::object& body, std::vector<Fault>& faults);

class RecipeRehearsals : public std::enable_shared_from_this<RecipeRehearsals> {
public:
    static constexpr std::size_t most_specimens = 1000;  ///< of one rehearsal
    static constexpr std::size_t kept_reports = 8;       ///< of different recipes; a new one replaces the oldest

    using Needs = PortSet<ClockPort, EventPort, RehearsalPort, SitePort>;
    explicit RecipeRehearsals(const Needs& ports)
        : clock_(ports.get<ClockPort>()),
          events_(ports.get<EventPort>()),
          player_(ports.get<RehearsalPort>()),
          sites_(ports.get<SitePort>()) {}
    ~RecipeRehearsals();
    RecipeRehearsals(const RecipeRehearsals&) = delete;
    RecipeRehearsals& operator=(const RecipeRehearsals&) = delete;

    /// The recipe as stored: its name, its document, and the tag of this version.
    struct Stored {
        std::string name;
        boost::json::object document;
        std::string tag;
    };
    /// Checks and begins a rehearsal. `then` is called once, perhaps at once, with the state of the rehearsal that has begun or the
    /// refusal.
    void start(Stored recipe, RecipeRehearsalOrder order, const Origin& origin,
               std::function<void(const Refusable<boost::json::object>&)> then);
    /// The newest rehearsal of a recipe, with the rows from index `first` on. `tag` is that of the present version of the recipe.
    [[nodiscard]] boost::json::object state(const std::string& recipe, const std::string& tag, std::size_t first = 0) const;
    /// Ends it after the specimen in progress is given up; the rows so far stay.
    [[nodiscard]] Refusable<boost::json::object> cancel(const std::string& recipe, const std::string& tag, const Origin& origin);

private:
    struct Run {
        std::string recipe, tag, who, door;
        std::uint64_t site_revision = 0;
        std::int64_t began_unix_ns = 0, ended_unix_ns = 0;
        RecipeRehearsalOrder order;
        std::shared_ptr<const RecipeRehearsal> rehearsal;  ///< null before it has been checked, and after its end
        std::shared_ptr<std::atomic<bool>> ended = std::make_shared<std::atomic<bool>>(false);
        std::vector<RehearsedSpecimen> rows;
        std::size_t passed = 0;
        bool over = false, cancelled = false;
    };
    [[nodiscard]] const Run* find(const std::string& recipe) const;
    void begin(const std::shared_ptr<Run>& run);
    void next(const std::shared_ptr<Run>& run);
    void end(Run& run);
    void note(const Run& run, Severity severity, std::string who, std::string text);

    ClockPort& clock_;
    EventPort& events_;
    RehearsalPort& player_;
    SitePort& sites_;
    std::shared_ptr<Run> active_;           ///< being checked, or under way
    std::list<std::shared_ptr<Run>> runs_;  ///< that have begun, the newest first, one of each recipe
};

}  // namespace axisgate
