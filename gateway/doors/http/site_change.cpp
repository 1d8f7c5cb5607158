// If-Match names a list of revisions. The service makes the change.
#include "gateway/doors/http/site_change.hpp"

#include <fmt/core.h>

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// The revisions in If-Match.
std::vector<std::uint64_t> revisions_in(std::string_view if_match) {
    std::vector<std::uint64_t> out;
    while (!if_match.empty()) {
        const auto item = next_item(if_match);
        if (item.size() < 3 || item.front() != '"' || item.back() != '"') continue;
        if (const auto revision = parse_whole(item.substr(1, item.size() - 2), 1, INT64_MAX))
            out.push_back(static_cast<std::uint64_t>(*revision));
    }
    return out;
}
}  // namespace

Planned planned(Refusable<Site> site, std::function<Response(const std::shared_ptr<const SiteState>& now)> show) {
    if (auto* refusal = std::get_if<ServiceRefusal>(&site)) return std::move(*refusal);
    return Plan{std::get<Site>(std::move(site)), std::move(show)};
}

void put_revision(Response& r, const SiteState& site) { r.headers.set("Site-Revision", std::to_string(site.revision)); }

Response site_answer(const SiteState& now, const json::value& body, unsigned status) {
    Response r = json_response(body, status);
    put_revision(r, now);
    return r;
}
Response site_without(const std::shared_ptr<const SiteState>& now) {
    Response r = nothing_left();
    put_revision(r, *now);
    return r;
}

std::optional<Response> precondition(const Call& c, const SitePort& sites, const SiteState& site, bool demanded) {
    const auto header = c.request.headers.get("If-Match");
    if (header.empty()) {
        if (!demanded) return std::nullopt;
        return problem(428, "precondition_required", "say with If-Match which revision of the site you change: its ETag");
    }
    if (tag_listed(header, site_tag(site.revision), false)) return std::nullopt;
    return problem_of(
        site_overtaken(sites, revisions_in(header), site,
                       fmt::format("the site has the revision {} by now, not {}: read it again", site_tag(site.revision), header)));
}

Handled change_site(Call& c, SitePort& sites, const StagePort& staging, bool if_match_demanded,
                    std::function<Planned(const SiteState& before)> plan) {
    if (const auto refusal = refuse_on_trial(staging)) return problem_of(*refusal);
    const auto site = sites.site();
    if (auto refusal = precondition(c, sites, *site, if_match_demanded)) return *refusal;
    SiteChange change{.origin = c.origin()};
    const auto if_match = c.request.headers.get("If-Match");
    if (!if_match.empty()) change.only_for = site->revision;
    change.meant = revisions_in(if_match);
    change.whole_document = c.target.path == "/api/v1/site";
    change.plan = [plan = std::move(plan), respond = c.respond](const SiteState& before) mutable -> Refusable<SitePlan> {
        auto made = plan(before);
        if (auto* refusal = std::get_if<ServiceRefusal>(&made)) return std::move(*refusal);
        return SitePlan{std::move(std::get<Plan>(made).site), [respond, show = std::move(std::get<Plan>(made).show)](
                                                                  const std::shared_ptr<const SiteState>& now) { respond(show(now)); }};
    };
    change.refused = [respond = c.respond](const ServiceRefusal& refusal) { respond(problem_of(refusal)); };
    axisgate::change_site(*c.context.changes, sites, staging, std::move(change), thrown(c.respond));
    return {gateway_limit, problem(504, "time_out", "the change was not applied in time: look at the site before trying again")};
}

Handled import_table(Call& c, SitePort& sites, const StagePort& staging, const SiteTable& table, bool whole) {
    std::optional<Response> fault;
    const bool dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    auto read = read_rows(table, c.request.body);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&read)) return problem_of(*refusal);
    auto& rows = std::get<SiteRows>(read);
    const auto now = sites.site();
    if (!dry_run) {
        return change_site(c, sites, staging, false, [&sites, &table, rows = std::move(rows), whole](const SiteState& before) -> Planned {
            auto site = site_with_rows(table, rows, before.site, sites.families(), whole);
            json::object report;
            if (const auto* good = std::get_if<Site>(&site)) report = import_report(table, false, rows.rows.size(), before.site, *good);
            return planned(std::move(site),
                           [report](const std::shared_ptr<const SiteState>& after) { return site_answer(*after, report); });
        });
    }
    if (auto refusal = precondition(c, sites, *now, false)) return *std::move(refusal);
    return given(site_with_rows(table, rows, now->site, sites.families(), whole),
                 [&](const Site& site) { return site_answer(*now, import_report(table, true, rows.rows.size(), now->site, site)); });
}

Response table_answer(const SiteState& now, const SiteTable& table, std::string csv) {
    Response r = file_answer("text/csv; charset=utf-8", fmt::format("{}.csv", table.member), std::move(csv));
    put_revision(r, now);
    return r;
}

}  // namespace axisgate::http
