// Site change: one change of the site on its way: planned on the site in force, put in force; one after the other. In: who wants it, which
// revision is meant, a plan. Out: the site in force after it, or why not. A change that lost a race against another is planned anew on the
// newer site. Never puts a site in force that parse_site has not checked as a whole, nor one while another is on trial.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/change_queue.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/ports/stage.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

/// What a change comes to on the site in force.
struct SitePlan {
    Site site;
    std::function<void(const std::shared_ptr<const SiteState>& now)> then;  ///< when it is in force
};

struct SiteChange {
    Origin origin;
    std::optional<std::uint64_t> only_for{};  ///< refused on any other revision; nothing: it is planned on whatever is in force
    std::vector<std::uint64_t> meant{};       ///< revisions that were named, for what has changed since
    bool whole_document = false;              ///< what was sent is the site
    std::function<Refusable<SitePlan>(const SiteState& before)> plan{};
    std::function<void(ServiceRefusal)> refused{};
};

/// While a staged site is on trial nothing else is changed.
[[nodiscard]] std::optional<ServiceRefusal> refuse_on_trial(const StagePort& staging);
/// The site in force is another than the one that was meant: what has changed since the first of `meant` that the history still has.
[[nodiscard]] ServiceRefusal site_overtaken(const SitePort& sites, const std::vector<std::uint64_t>& meant, const SiteState& now,
                                            std::string text);

/// Queues the change: `plan.then` or `refused` is called once, perhaps at once. `thrown`: the change threw.
void change_site(ChangeQueue& queue, SitePort& sites, const StagePort& staging, SiteChange change, ChangeQueue::Failed thrown);

/// A changed document as a site; faults are told below `entry` ("/axes/2") where they point into it.
[[nodiscard]] Refusable<Site> checked_site(const boost::json::value& document, const Families& families, std::string_view entry);

}  // namespace axisgate
