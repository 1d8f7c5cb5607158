// Site change: one change of the site on its way: planned on the site in force, put in force, and shown; one after the other.
// In: a call, a plan. Out: Handled. A change that lost a race against another is planned anew on the newer site.
// Never puts a site in force that parse_site has not checked as a whole.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/doors/http/handlers.hpp"

namespace axisgate::http {

/// What a change comes to on the site in force, and how its success is shown; or why it cannot be.
struct Plan {
    Site site;
    std::function<Response(const std::shared_ptr<const SiteState>& now)> show;
};
using Planned = std::variant<Plan, Response>;

/// The entity tag of the site of this revision.
[[nodiscard]] std::string site_tag(std::uint64_t revision);

/// Queues the change. `if_match_demanded`: 428 without If-Match.
[[nodiscard]] Handled change_site(Call& call, SitePort& sites, const StagePort& staging, bool if_match_demanded,
                                  std::function<Planned(const SiteState& before)> plan);

/// 412 or 428 where If-Match says so.
[[nodiscard]] std::optional<Response> precondition(const Call& call, const SitePort& sites, const SiteState& site, bool demanded);
/// Pointers into the site become pointers into the request's body where they point into the entry `entry` ("/axes/2").
[[nodiscard]] std::vector<Fault> faults_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document);
/// 409 if all there is to say is that a place is taken; else 422.
[[nodiscard]] Response refusal_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document);
/// The header Site-Revision.
void put_revision(Response& response, const SiteState& site);

}  // namespace axisgate::http
