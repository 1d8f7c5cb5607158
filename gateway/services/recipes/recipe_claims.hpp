// Determines which motions of axes belong to a run, so that its end stops these and no others. Bounds: the axes of one run; 16 tickets per
// axis. If the owner of a motion is unknown, it counts as the run's own.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gateway/axis/image.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/recipes/recipe_run.hpp"

namespace axisgate {

class RecipeClaims {
public:
    static constexpr std::size_t most_tickets = 16;  ///< of one axis; the newest are kept

    /// A command that may move the axis is about to be sent, is on its way, has its result.
    void ask(const std::string& axis, const AxisPicture& before);
    void sent(const std::string& axis, Ticket ticket);
    [[nodiscard]] RecipeAnswer::Motion answered(const RecipeStep& step, const CommandBody& body, const Result& result,
                                                const AxisPicture& now);

    [[nodiscard]] RecipeWorld::Claim claim(const std::string& axis, const AxisPicture& now, const Origin& run,
                                           const ClockPort& clock) const;

private:
    struct Claim {
        std::vector<Ticket> own;
        bool sure = false;          ///< the drive has accepted a motion of the run: only `own` belongs to the run
        Ticket before = no_ticket;  ///< not sure: the earlier motion, which may hide that of the run
        bool waiting = false;       ///< for a result
        bool moved_before = false;  ///< it was moving when that command was given
        Ticket waiting_before = no_ticket;
    };
    std::map<std::string, Claim, std::less<>> claims_;
};

}  // namespace axisgate
