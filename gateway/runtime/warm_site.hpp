// The site port: stores a site, has the hot thread put it in force, and informs the listeners. One change at a time; a site that could not
// be stored is not put in force.
#pragma once

#include <memory>
#include <vector>

#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

class WarmSite final : public SitePort {
public:
    WarmSite(const WarmThreads& threads, WarmEvents& events, Families families)
        : threads_(threads), events_(events), families_(std::move(families)) {}
    /// Before the start, and when the hot thread has put one in force.
    void set_site(std::shared_ptr<const SiteState> site);
    /// A change is being put in force.
    [[nodiscard]] bool applying() const noexcept { return applying_; }
    /// As apply_site. `kept`: data that are stored under this site's names stay, too, although the new site lacks the names, because it may
    /// be rolled back.
    void put_in_force(Site site, std::uint64_t expected_revision, const Site* kept, const Origin& origin,
                      std::function<void(SiteAnswer)> then);

    [[nodiscard]] std::shared_ptr<const SiteState> site() const override { return site_; }
    [[nodiscard]] const Families& families() const override { return families_; }
    void apply_site(Site site, std::uint64_t expected_revision, Origin origin, std::function<void(SiteAnswer)> then) override {
        put_in_force(std::move(site), expected_revision, nullptr, origin, std::move(then));
    }
    [[nodiscard]] std::vector<SiteRevision> site_history(std::size_t limit, std::uint64_t before) const override;
    [[nodiscard]] std::optional<SiteRevision> site_revision(std::uint64_t revision) const override;
    void listen(SiteListener* listener) override { listeners_.push_back(listener); }
    void unlisten(SiteListener* listener) override { std::erase(listeners_, listener); }

private:
    struct Change;
    void store(Change change, Store& store);
    void start(Change change);
    void finish(const SiteAnswer& answer, const std::function<void(SiteAnswer)>& then);

    const WarmThreads& threads_;
    WarmEvents& events_;
    Families families_;
    std::shared_ptr<const SiteState> site_ = std::make_shared<const SiteState>();
    std::vector<SiteListener*> listeners_;
    bool applying_ = false;
};

}  // namespace axisgate
