// Plays rehearsals on models of the site, beside the running gateway: a loss of command, and recipes against specimens of the drives. The
// results come by callbacks on the service thread; one player does one thing at a time, and gives way to all other threads. Drives and
// twins of the gateway itself are not involved.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/twin.hpp"
#include "gateway/site/rehearsal_cell.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

class RecipeRehearsal;
struct RecipeRehearsalWish;
struct RehearsedSpecimen;

class RehearsalPort {
public:
    virtual ~RehearsalPort() = default;
    /// One loss of command, which takes up to a second. The gateway's own times are put into the request.
    virtual void rehearse(std::shared_ptr<const SiteState> site, RehearsalWish wish, std::function<void(RehearsalCell)> then) = 0;
    /// [modbus] watchdog_ms, for axes without a value of their own.
    [[nodiscard]] virtual Duration watchdog() const = 0;

    /// Null comes with the faults, whose pointers are those of RecipeRehearsal.
    using Prepared = std::function<void(std::shared_ptr<const RecipeRehearsal>, std::vector<SiteFault>)>;
    /// Checks a recipe against a site with all drives simulated. The memories of the site's twins and the gateway's own lease are put into
    /// the request.
    virtual void prepare_recipe(RecipeRehearsalWish wish, Prepared then) = 0;
    /// One specimen, which takes from a millisecond to minutes; it is given up when `ended` becomes true, and `then` is called in any case.
    virtual void rehearse_recipe(std::shared_ptr<const RecipeRehearsal> rehearsal, std::string specimen,
                                 std::shared_ptr<const std::atomic<bool>> ended, std::function<void(RehearsedSpecimen)> then) = 0;
    /// Gives the stored memory of the twin of a drive to `work`, on the thread of the rehearsals; then calls `then` on the service thread.
    virtual void aside(std::shared_ptr<const SiteState> site, const std::string& drive, std::function<void(const NonVolatile&)> work,
                       std::function<void()> then) {
        (void)site, (void)drive;
        work({});
        then();
    }
};

}  // namespace axisgate
