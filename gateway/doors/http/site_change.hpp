// Changes of the site as requests: If-Match, Site-Revision and the answers. The service makes the change.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/site/site_change.hpp"
#include "gateway/services/site/site_table.hpp"

namespace axisgate::http {

/// The plan of a change for the site in force, and its answer; or the refusal.
struct Plan {
    Site site;
    std::function<Response(const std::shared_ptr<const SiteState>& now)> show;
};
using Planned = Refusable<Plan>;
/// A checked site, or its faults, as a plan.
[[nodiscard]] Planned planned(Refusable<Site> site, std::function<Response(const std::shared_ptr<const SiteState>& now)> show);

/// Queues the change. `if_match_demanded`: 428 without If-Match.
[[nodiscard]] Handled change_site(Call& call, SitePort& sites, const StagePort& staging, bool if_match_demanded,
                                  std::function<Planned(const SiteState& before)> plan);
/// 412 or 428 if If-Match requires it.
[[nodiscard]] std::optional<Response> precondition(const Call& call, const SitePort& sites, const SiteState& site, bool demanded);

/// The header Site-Revision.
void put_revision(Response& response, const SiteState& site);
/// A document with the header; 204 with it.
[[nodiscard]] Response site_answer(const SiteState& now, const boost::json::value& body, unsigned status = 200);
[[nodiscard]] Response site_without(const std::shared_ptr<const SiteState>& now);

/// Imports a list of the site from CSV; `dry_run` only checks it. `whole`: instead of all entries. `table` must outlive the call's job.
[[nodiscard]] Handled import_table(Call& call, SitePort& sites, const StagePort& staging, const SiteTable& table, bool whole);
/// The list as a file.
[[nodiscard]] Response table_answer(const SiteState& now, const SiteTable& table, std::string csv);

}  // namespace axisgate::http
