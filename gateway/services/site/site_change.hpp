// One change of the site: planned on the site in force, put in force; one after the other. A change that another one has overtaken is
// planned again on the newer site. Only sites that parse_site has checked as a whole come into force, and none while another is on trial.
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

/// The plan of a change for the site in force.
struct SitePlan {
    Site site;
    std::function<void(const std::shared_ptr<const SiteState>& now)> then;  ///< called when it is in force
};

struct SiteChange {
    Origin origin;
    std::optional<std::uint64_t> only_for{};  ///< refused on any other revision; empty: it is planned on the present one
    std::vector<std::uint64_t> meant{};       ///< revisions that the request named, for the list of changes since
    bool whole_document = false;              ///< the input is the whole site
    std::function<Refusable<SitePlan>(const SiteState& before)> plan{};
    std::function<void(ServiceRefusal)> refused{};
};

/// Refuses other changes while a staged site is on trial.
[[nodiscard]] std::optional<ServiceRefusal> refuse_on_trial(const StagePort& staging);
/// The site in force is not the one to which the request refers; includes the changes since the first of `meant` that the history still
/// has.
[[nodiscard]] ServiceRefusal site_overtaken(const SitePort& sites, const std::vector<std::uint64_t>& meant, const SiteState& now,
                                            std::string text);

/// Queues the change: `plan.then` or `refused` is called once, perhaps at once. `thrown` is called if the change threw.
void change_site(ChangeQueue& queue, SitePort& sites, const StagePort& staging, SiteChange change, ChangeQueue::Failed thrown);

/// A changed document as a site; faults are reported below `entry` ("/axes/2") if they point into it.
[[nodiscard]] Refusable<Site> checked_site(const boost::json::value& document, const Families& families, std::string_view entry);

}  // namespace axisgate
