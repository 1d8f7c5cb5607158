// One cell or one specimen is one job with copies of the site, of its descriptions and of the twins' memories; nothing is shared with the
// gateway's own engine.
#include "gateway/runtime/warm_rehearsal.hpp"

#include <sched.h>

#include <boost/asio/post.hpp>
#include <optional>

#include "gateway/engine/rehearsal.hpp"
#include "gateway/runtime/site_file.hpp"
#include "gateway/services/recipes/recipe_rehearsal.hpp"
#include "gateway/site/descriptions.hpp"

namespace axisgate {
namespace {
/// Lowers the priority below that of all other threads. If this is refused, the rehearsal is played all the same.
void stand_back() {
    const sched_param none{};
    (void)sched_setscheduler(0, SCHED_IDLE, &none);
}

/// A rehearsal refers to its families, whose shelf belongs to the service thread; this one has a copy.
struct OwnRehearsal {
    Families families;
    std::optional<RecipeRehearsal> rehearsal{};
};
}  // namespace

WarmRehearsal::~WarmRehearsal() {
    thread_.stop();
    thread_.join();
}

void WarmRehearsal::rehearse(std::shared_ptr<const SiteState> site, RehearsalWish wish, std::function<void(RehearsalCell)> then) {
    wish.watchdog = watchdog_;
    wish.lease = lease_;
    auto memory = read_site_memory(threads_.reader, site->site);
    boost::asio::post(thread_,
                      [this, site = std::move(site), memory = std::move(memory), wish = std::move(wish), then = std::move(then)]() mutable {
                          stand_back();
                          auto cell = axisgate::rehearse(families_, site->site, memory, wish);
                          threads_.answer([then = std::move(then), cell = std::move(cell)]() mutable { then(std::move(cell)); });
                      });
}

void WarmRehearsal::prepare_recipe(RecipeRehearsalWish wish, Prepared then) {
    wish.lease = lease_;
    wish.memory = read_site_memory(threads_.reader, wish.site);
    auto own = std::make_shared<OwnRehearsal>(OwnRehearsal{families_});
    if (families_.descriptions) own->families.descriptions = std::make_shared<DescriptionShelf>(*families_.descriptions);
    boost::asio::post(thread_, [this, own = std::move(own), wish = std::move(wish), then = std::move(then)]() mutable {
        stand_back();
        std::vector<SiteFault> faults;
        own->rehearsal.emplace(own->families, std::move(wish), faults);
        std::shared_ptr<const RecipeRehearsal> made;
        if (faults.empty()) made = {own, &*own->rehearsal};
        threads_.answer([then = std::move(then), made = std::move(made), faults = std::move(faults)]() mutable {
            then(std::move(made), std::move(faults));
        });
    });
}

void WarmRehearsal::rehearse_recipe(std::shared_ptr<const RecipeRehearsal> rehearsal, std::string specimen,
                                    std::shared_ptr<const std::atomic<bool>> ended, std::function<void(RehearsedSpecimen)> then) {
    boost::asio::post(thread_, [this, rehearsal = std::move(rehearsal), specimen = std::move(specimen), ended = std::move(ended),
                                then = std::move(then)]() mutable {
        stand_back();
        auto row = rehearsal->play(specimen, *ended);
        threads_.answer([then = std::move(then), row = std::move(row)]() mutable { then(std::move(row)); });
    });
}

void WarmRehearsal::aside(std::shared_ptr<const SiteState> site, const std::string& drive, std::function<void(const NonVolatile&)> work,
                          std::function<void()> then) {
    auto memory = read_site_memory(threads_.reader, site->site);
    NonVolatile own;
    if (const auto it = memory.twins.find(drive); it != memory.twins.end()) own = std::move(it->second);
    boost::asio::post(thread_, [this, own = std::move(own), work = std::move(work), then = std::move(then)]() mutable {
        stand_back();
        work(own);
        threads_.answer(std::move(then));
    });
}

}  // namespace axisgate
