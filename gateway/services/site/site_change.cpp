// A change that another change has overtaken is planned again on the newer site, three times at most. The queue runs one change at a time.
#include "gateway/services/site/site_change.hpp"

#include <fmt/core.h>

#include <boost/json/parse.hpp>
#include <utility>

#include "gateway/site/names.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// Number of attempts for a change that other changes overtake.
constexpr int most_change_attempts = 3;

/// The changes since the first of these revisions that the history still has; null if it has none of them.
json::value changes_since(const SitePort& sites, const std::vector<std::uint64_t>& revisions, const SiteState& now) {
    for (const auto revision : revisions) {
        const auto stored = sites.site_revision(revision);
        if (!stored) continue;
        boost::system::error_code ec;
        const auto document = json::parse(stored->text, ec);
        if (ec) continue;
        std::vector<SiteFault> faults;
        if (const auto then = parse_site(document, sites.families(), faults)) return site_diff(*then, now.site);
    }
    return nullptr;
}

/// One change on its way: planned on the site in force, applied; and planned again if another change came between.
struct QueuedChange : std::enable_shared_from_this<QueuedChange> {
    SitePort& sites;
    SiteChange change;
    std::function<void()> done{};
    int attempts = 0;

    QueuedChange(SitePort& s, SiteChange c) : sites(s), change(std::move(c)) {}

    void refuse(ServiceRefusal refusal) {
        change.refused(std::move(refusal));
        done();
    }
    void refuse_overtaken(const SiteState& now) {
        refuse(site_overtaken(sites, change.meant, now, "the site was changed by another client meanwhile: read it again"));
    }
    void attempt() {
        ++attempts;
        const auto before = sites.site();
        if (change.only_for && *change.only_for != before->revision) return refuse_overtaken(*before);
        auto planned = change.plan(*before);
        if (auto* refusal = std::get_if<ServiceRefusal>(&planned)) return refuse(std::move(*refusal));
        auto& [site, show] = std::get<SitePlan>(planned);
        if (const auto names = names_to_change(site, &before->site); !names.empty())
            return refuse(faulty(faults_for(names, "", change.whole_document)));
        if (to_json(site) == to_json(before->site)) {  // nothing changes, so nothing is disturbed
            show(before);
            return done();
        }
        auto then = [self = shared_from_this(), before, then = std::move(show)](const SiteAnswer& answer) {
            if (answer.good) {
                then(answer.now);
                return self->done();
            }
            if (!answer.now || answer.now->revision == before->revision)
                return self->refuse(
                    {ServiceRefusal::Why::not_stored, answer.fault.empty() ? "the site could not be stored" : answer.fault});
            if (self->change.only_for) return self->refuse_overtaken(*answer.now);
            if (self->attempts < most_change_attempts) return self->attempt();
            self->refuse({ServiceRefusal::Why::overloaded, "other clients keep changing the site: try again"});
        };
        sites.apply_site(std::move(site), before->revision, change.origin, std::move(then));
    }
};
}  // namespace

std::optional<ServiceRefusal> refuse_on_trial(const StagePort& staging) {
    if (!staging.site_stage().busy()) return std::nullopt;
    return ServiceRefusal{ServiceRefusal::Why::conflict,
                          "a staged site is on trial: confirm it or roll it back before the site is changed otherwise"};
}

ServiceRefusal site_overtaken(const SitePort& sites, const std::vector<std::uint64_t>& meant, const SiteState& now, std::string text) {
    return {.why = ServiceRefusal::Why::overtaken,
            .text = std::move(text),
            .more = {{"changes", changes_since(sites, meant, now)}, {"current", to_json(now.site)}},
            .revision = now.revision};
}

void change_site(ChangeQueue& queue, SitePort& sites, const StagePort& staging, SiteChange change, ChangeQueue::Failed thrown) {
    if (auto refusal = refuse_on_trial(staging)) return change.refused(*std::move(refusal));
    auto order = std::make_shared<QueuedChange>(sites, std::move(change));
    const bool taken = queue.run(
        [order](std::function<void()> done) {
            order->done = std::move(done);
            order->attempt();
        },
        std::move(thrown));
    if (!taken) order->change.refused({ServiceRefusal::Why::overloaded, "too many changes of the site wait already: try again"});
}

Refusable<Site> checked_site(const json::value& document, const Families& families, std::string_view entry) {
    std::vector<SiteFault> faults;
    auto site = parse_site(document, families, faults);
    if (!site) return refusal_for(faults, entry, false);
    return *std::move(site);
}

}  // namespace axisgate
