// A change passes from the service thread to the storage, to the hot thread, and back: put_in_force, store, start, finish. A second change
// meanwhile is refused. Events report the changes.
#include "gateway/runtime/warm_site.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/serialize.hpp>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/site_file.hpp"
#include "gateway/runtime/site_names.hpp"

namespace axisgate {

/// One change on its way through the threads.
struct WarmSite::Change {
    Site site;
    Origin origin;
    SiteChange names;  ///< for the storage
    std::string text;  ///< of the event
    std::function<void(SiteAnswer)> then;
    SiteMemory memory{};
    std::uint64_t revision = 0;
};

void WarmSite::set_site(std::shared_ptr<const SiteState> site) {
    site_ = std::move(site);
    const auto listeners = listeners_;
    for (auto* l : listeners)
        l->on_site(site_);
}

void WarmSite::put_in_force(Site site, std::uint64_t expected_revision, const Site* kept, const Origin& origin,
                            std::function<void(SiteAnswer)> then) {
    if (applying_ || (expected_revision != 0 && expected_revision != site_->revision)) {
        const std::string fault =
            applying_ ? "another change of the site is being put in force; come again in a moment"
                      : fmt::format("the site has changed meanwhile: it is revision {} now, not {}", site_->revision, expected_revision);
        return threads_.answer([this, fault, then = std::move(then)] { then({false, fault, site_}); });
    }
    applying_ = true;
    Change c{std::move(site), origin, {}, {}, std::move(then)};
    for (const auto& d : differences(site_->site, c.site))
        c.text += (c.text.empty() ? "" : "; ") + d;
    if (c.text.empty()) c.text = "saved without a change";
    c.names = names_between(to_json(site_->site), to_json(c.site));
    if (kept) {
        for (const auto& a : kept->axes)
            c.names.kept_axes.push_back(a.name);
        for (const auto& d : kept->drives)
            c.names.kept_drives.push_back(d.name);
    }
    threads_.on_cold([this, c = std::move(c)](Store& s) mutable { store(std::move(c), s); });
}

/// On the storage thread.
void WarmSite::store(Change c, Store& store) {
    for (const auto& known : store.axes().value_or(std::vector<AxisRecord>())) {
        if (known.removed_unix_ns && std::ranges::find(*c.names.axes, known.name, &SiteAxis::name) != c.names.axes->end())
            c.text += fmt::format("; axis {} was there before: what was stored for it is shown again", known.name);
    }
    const auto saved = store.save_site(boost::json::serialize(to_json(c.site)), c.origin.text(), unix_now_ns(), c.names);
    if (!saved)
        return threads_.answer([this, fault = saved.error().text, then = std::move(c.then)] {
            finish({false, fault, nullptr, true}, then);
        });
    c.memory = read_site_memory(store, c.site);
    c.revision = *saved;
    threads_.answer([this, c = std::move(c)]() mutable { start(std::move(c)); });
}

void WarmSite::start(Change c) {
    events_.note("site", std::move(c.text), c.origin);  // reported before the events that the change causes
    auto job = [this, site = std::move(c.site), memory = std::move(c.memory), revision = c.revision, then = c.then](Engine& engine,
                                                                                                                    Instant now) mutable {
        engine.change_site(std::move(site), std::move(memory), revision, now,
                           [this, then = std::move(then)](std::shared_ptr<const SiteState> state) mutable {
                               threads_.hot.publish_site(*state);
                               threads_.answer([this, state = std::move(state), then = std::move(then)]() mutable {
                                   finish({true, {}, std::move(state)}, then);
                               });
                           });
    };
    if (!threads_.on_hot(std::move(job)))
        finish({false, "the site is stored, but could not be put in force now: restart, or save it again", nullptr}, c.then);
}

void WarmSite::finish(const SiteAnswer& answer, const std::function<void(SiteAnswer)>& then) {
    applying_ = false;
    if (answer.good) set_site(answer.now);
    then({answer.good, answer.fault, site_, answer.not_stored});
}

std::vector<SiteRevision> WarmSite::site_history(std::size_t limit, std::uint64_t before) const {
    return threads_.reader.site_history(limit, before).value_or(std::vector<SiteRevision>());
}

std::optional<SiteRevision> WarmSite::site_revision(std::uint64_t revision) const {
    return threads_.reader.site(revision).value_or(std::nullopt);
}

}  // namespace axisgate
