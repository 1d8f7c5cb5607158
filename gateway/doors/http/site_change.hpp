// Site changes as requests: If-Match, Site-Revision and the answers of a change of the site.
// In: a call, a plan. Out: Handled. The change itself is the service's.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/site/site_change.hpp"
#include "gateway/services/site/site_table.hpp"

namespace axisgate::http {

/// What a change comes to on the site in force, and how its success is shown; or why it cannot be.
struct Plan {
    Site site;
    std::function<Response(const std::shared_ptr<const SiteState>& now)> show;
};
using Planned = Refusable<Plan>;
/// A site that was checked, or why it is none, as a plan.
[[nodiscard]] Planned planned(Refusable<Site> site, std::function<Response(const std::shared_ptr<const SiteState>& now)> show);

/// Queues the change. `if_match_demanded`: 428 without If-Match.
[[nodiscard]] Handled change_site(Call& call, SitePort& sites, const StagePort& staging, bool if_match_demanded,
                                  std::function<Planned(const SiteState& before)> plan);
/// 412 or 428 where If-Match says so.
[[nodiscard]] std::optional<Response> precondition(const Call& call, const SitePort& sites, const SiteState& site, bool demanded);

/// The header Site-Revision.
void put_revision(Response& response, const SiteState& site);
/// A document with it; 204 with it.
[[nodiscard]] Response site_answer(const SiteState& now, const boost::json::value& body, unsigned status = 200);
[[nodiscard]] Response site_without(const std::shared_ptr<const SiteState>& now);

/// A list of the site as CSV, in: tried first by `dry_run`. `whole`: in place of all entries. `table` outlives the call's job.
[[nodiscard]] Handled import_table(Call& call, SitePort& sites, const StagePort& staging, const SiteTable& table, bool whole);
/// The list as a file.
[[nodiscard]] Response table_answer(const SiteState& now, const SiteTable& table, std::string csv);

}  // namespace axisgate::http
