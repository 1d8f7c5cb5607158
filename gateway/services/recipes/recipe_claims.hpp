// Recipe claims: which motions of axes are a run's own, so that its end stops those and no others.
// In: the run's commands with their tickets and results, pictures of axes. Out: what a result means for the motion; whose a motion is now.
// Bounds: the axes of one run; 16 tickets per axis. Never asks a drive; what nobody can tell counts as the run's own.
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

    /// A command that may move the axis is about to be given, is on its way, has its result.
    void ask(const std::string& axis, const AxisPicture& before);
    void sent(const std::string& axis, Ticket ticket);
    [[nodiscard]] RecipeAnswer::Motion answered(const RecipeStep& step, const CommandBody& body, const Result& result,
                                                const AxisPicture& now);

    [[nodiscard]] RecipeWorld::Claim claim(const std::string& axis, const AxisPicture& now, const Origin& run,
                                           const ClockPort& clock) const;

private:
    struct Claim {
        std::vector<Ticket> own;
        bool sure = false;          ///< the drive has taken a motion of the run: only `own` are its own
        Ticket before = no_ticket;  ///< not sure: the motion that was there before may hide the run's
        bool waiting = false;       ///< for a result
        bool moved_before = false;  ///< it was moving when that command was given
        Ticket waiting_before = no_ticket;
    };
    std::map<std::string, Claim, std::less<>> claims_;
};

}  // namespace axisgate
