// Site change: a change that lost a race against another one is planned anew on the newer site, three times at most.
// In: plans. Out: answers, through the site port. Never runs two changes at a time: the queue of the door gives each its turn.
#include "gateway/doors/http/site_change.hpp"
#include "gateway/site/names.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// A change that lost a race against another one is made again on the newer site, so often.
constexpr int most_attempts = 3;

/// What became of the site since the first revision that `if_match` names and the history still has; null if it has none of them.
json::value changes_since(const SitePort& sites, std::string_view if_match, const SiteState& now) {
    for (auto rest = if_match; !rest.empty();) {
        auto item = next_item(rest);
        if (item.size() < 3 || item.front() != '"' || item.back() != '"') continue;
        const auto revision = parse_whole(item.substr(1, item.size() - 2), 1, INT64_MAX);
        const auto stored = revision ? sites.site_revision(static_cast<std::uint64_t>(*revision)) : std::nullopt;
        if (!stored) continue;
        boost::system::error_code ec;
        const auto document = json::parse(stored->text, ec);
        if (ec) continue;
        std::vector<SiteFault> faults;
        if (const auto then = parse_site(document, sites.families(), faults)) return site_diff(*then, now.site);
    }
    return nullptr;
}

/// 412: the site in force, and what has changed since the one that was meant.
Response site_overtaken(const SitePort& sites, std::string_view if_match, const SiteState& now, std::string detail) {
    Response r = to_response(Problem{
        .status = 412,
        .reason = "precondition_failed",
        .detail = std::move(detail),
        .more = {{"etag", site_tag(now.revision)}, {"changes", changes_since(sites, if_match, now)}, {"current", to_json(now.site)}}});
    r.headers.set("ETag", site_tag(now.revision));
    put_revision(r, now);
    return r;
}

/// One change on its way: planned on the site in force, applied; and planned again if another change came between.
struct QueuedChange : std::enable_shared_from_this<QueuedChange> {
    SitePort& sites;
    Origin origin;
    std::optional<std::uint64_t> only_for;  ///< If-Match was given: the change is for this revision alone
    std::string if_match;
    bool whole_document = false;  ///< the request's body is the site
    std::function<Planned(const SiteState& before)> plan;
    Respond respond;
    std::function<void()> done;
    int attempts = 0;

    QueuedChange(SitePort& s, Origin o) : sites(s), origin(std::move(o)) {}

    void end(Response r) {
        respond(std::move(r));
        done();
    }
    void attempt() {
        ++attempts;
        const auto before = sites.site();
        if (only_for && *only_for != before->revision) return end(overtaken(*before));
        auto planned = plan(*before);
        if (auto* refusal = std::get_if<Response>(&planned)) return end(std::move(*refusal));
        auto& [site, show] = std::get<Plan>(planned);
        if (const auto names = names_to_change(site, &before->site); !names.empty())
            return end(invalid(faults_for(names, "", whole_document)));
        if (to_json(site) == to_json(before->site)) return end(show(before));  // nothing changes: nothing is disturbed
        auto then = [self = shared_from_this(), before, show = std::move(show)](SiteAnswer answer) {
            if (answer.good) return self->end(show(answer.now));
            if (!answer.now || answer.now->revision == before->revision) {
                return self->end(problem(507, "not_stored", answer.fault.empty() ? "the site could not be stored" : answer.fault));
            }
            if (!self->only_for && self->attempts < most_attempts) return self->attempt();
            self->end(self->only_for ? self->overtaken(*answer.now)
                                     : problem(503, "busy", "other clients keep changing the site: try again"));
        };
        sites.apply_site(std::move(site), before->revision, origin, std::move(then));
    }
    Response overtaken(const SiteState& now) {
        return site_overtaken(sites, if_match, now, "the site was changed by another client meanwhile: read it again");
    }
};

}  // namespace

std::string site_tag(std::uint64_t revision) { return fmt::format("\"{}\"", revision); }

void put_revision(Response& r, const SiteState& site) { r.headers.set("Site-Revision", std::to_string(site.revision)); }

std::optional<Response> precondition(const Call& c, const SitePort& sites, const SiteState& site, bool demanded) {
    const auto header = c.request.headers.get("If-Match");
    if (header.empty()) {
        if (!demanded) return std::nullopt;
        return problem(428, "precondition_required", "say with If-Match which revision of the site you change: its ETag");
    }
    if (tag_listed(header, site_tag(site.revision), false)) return std::nullopt;
    return site_overtaken(sites, header, site,
                          fmt::format("the site has the revision {} by now, not {}: read it again", site_tag(site.revision), header));
}

std::vector<Fault> faults_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document) {
    std::vector<Fault> out;
    for (const auto& f : faults) {
        const bool inside =
            !entry.empty() && f.pointer.starts_with(entry) && (f.pointer.size() == entry.size() || f.pointer[entry.size()] == '/');
        out.push_back({inside ? f.pointer.substr(entry.size()) : f.pointer, f.text, f.remedy, whole_document || inside});
    }
    return out;
}

Response refusal_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document) {
    auto list = faults_for(faults, entry, whole_document);
    if (faults.empty() || !std::ranges::all_of(faults, &SiteFault::conflict)) return invalid(std::move(list));
    Problem p;
    p.status = 409;
    p.reason = "conflict";
    p.detail = fmt::format("{}; {}", list.front().text, list.front().remedy);
    p.faults = std::move(list);
    return to_response(p);
}

Handled change_site(Call& c, SitePort& sites, const StagePort& staging, bool if_match_demanded,
                    std::function<Planned(const SiteState& before)> plan) {
    const auto site = sites.site();
    if (staging.site_stage().busy())
        return problem(409, "conflict", "a staged site is on trial: confirm it or roll it back before the site is changed otherwise");
    if (auto refusal = precondition(c, sites, *site, if_match_demanded)) return *refusal;
    auto order = std::make_shared<QueuedChange>(sites, c.origin());
    order->whole_document = c.target.path == "/api/v1/site";
    order->if_match = c.request.headers.get("If-Match");
    if (!order->if_match.empty()) order->only_for = site->revision;
    order->plan = std::move(plan);
    order->respond = c.respond;
    const bool taken = c.context.changes->run(
        [order](std::function<void()> done) {
            order->done = std::move(done);
            order->attempt();
        },
        thrown(order->respond));
    if (!taken) return problem(503, "busy", "too many changes of the site wait already: try again");
    return {gateway_limit, problem(504, "time_out", "the change was not applied in time: look at the site before trying again")};
}

}  // namespace axisgate::http
