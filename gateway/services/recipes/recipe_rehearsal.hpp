// Runs a recipe against specimens of the drives of its site, each in virtual time and in a gateway of its own: which specimen does the
// recipe pass with, and at which step does it fail with another one. The same specimen gives the same result. The functions take from a
// millisecond to seconds of processor time, so they must not run on the hot or the service thread; several may run at once.
#pragma once

#include <atomic>
#include <boost/json/object.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/services/recipes/recipe.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Limit of specimens of one order.
inline constexpr std::size_t most_rehearsed_specimens = 10'000;

/// Specimens of families that stay the same in all runs: {"uim342": "slow"}.
using FixedSpecimens = std::map<std::string, std::string, std::less<>>;
/// Families and specimens that do not exist are faults at "/fixed".
void check_fixed(const FixedSpecimens& fixed, const Families& families, std::vector<SiteFault>& faults);
/// The site with every drive as this specimen, or as that of its family.
[[nodiscard]] Site site_of_specimen(Site site, std::string_view specimen, const FixedSpecimens& fixed);

struct RecipeRehearsalWish {
    std::string name;  ///< of the recipe
    boost::json::object document{}, arguments{};
    Site site{};
    SiteMemory memory{};  ///< of the site's twins; empty: drives as delivered
    FixedSpecimens fixed{};
    Duration lease = std::chrono::seconds(30);
    Origin by{};  ///< the client as which the recipe commands
};

struct RehearsedSpecimen {
    std::string specimen;
    bool passed = false;
    std::string pointer;  ///< of the step at which the run ended early: "/steps/3"; empty: it passed, or did not begin
    std::string step;     ///< label of that step
    std::string text;     ///< why it failed
    std::string event;    ///< the newest warning of a drive, axis or line in the run; empty: none
    double seconds = 0;   ///< virtual time of the run
};
/// The members of RehearsedSpecimen; texts that are empty are null.
[[nodiscard]] boost::json::object to_json(const RehearsedSpecimen& rehearsed);

/// "1..100", "17", "slow", and lists of these with commas; each specimen once, in the order of the text. An empty list comes with a fault.
[[nodiscard]] std::vector<std::string> read_specimens(std::string_view text, std::string& fault);

class RecipeRehearsal {
public:
    /// How long the drives of the recipe may take until they are identified and report a position.
    static constexpr Duration start_limit = std::chrono::seconds(60);

    /// Checks the recipe against the site with all drives simulated. Faults have pointers into the recipe's document, or "/arguments",
    /// "/fixed". play() may be called if there are none.
    RecipeRehearsal(const Families& families, RecipeRehearsalWish wish, std::vector<SiteFault>& faults);
    /// `specimen` is one of core/specimen.hpp. When another thread sets `ended`, the run is given up soon and counts as failed.
    [[nodiscard]] RehearsedSpecimen play(std::string_view specimen, const std::atomic<bool>& ended = never_ended) const;
    [[nodiscard]] const RecipeRehearsalWish& wish() const noexcept { return wish_; }

private:
    static const std::atomic<bool> never_ended;

    const Families& families_;
    RecipeRehearsalWish wish_;
    Recipe recipe_;
    std::vector<std::string> axes_;  ///< that the recipe commands or reads
};

}  // namespace axisgate
