// Handlers of staged site changes and of the site's history. SiteStaging carries them out.
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/site/site_staging.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Response stage_answer(const SitePort& sites, const json::object& document) {
    const auto now = sites.site();
    Response r = json_response(document);
    r.headers.set("ETag", site_tag(now->revision));
    put_revision(r, *now);
    return r;
}

/// The stage, with the connections that the doors would close.
Handled staged_answer(const Call& c, const SitePort& sites, const SiteStaging& staging) {
    staging.ask([&sites, respond = c.respond](const json::object& document) { respond(stage_answer(sites, document)); });
    return {gateway_limit, stage_answer(sites, staging.document(std::nullopt))};
}

Handled stage_document(Call& c, const SitePort& sites, const SiteStaging& staging, const json::value& document) {
    std::optional<Response> fault;
    const bool replace = query_flag(c, "replace", fault);
    if (fault) return *fault;
    if (const auto refusal = replace ? std::nullopt : staging.refuse_taken(c.origin())) return problem_of(*refusal);
    if (auto refusal = precondition(c, sites, *sites.site(), c.context.settings.require_if_match)) return *refusal;
    if (const auto refusal = staging.stage(document, c.origin())) return problem_of(*refusal);
    return staged_answer(c, sites, staging);
}

SiteStaging::Ended show_after(const Call& c, const SitePort& sites, const SiteStaging& staging) {
    return [&sites, staging, respond = c.respond](const std::optional<ServiceRefusal>& refusal) {
        respond(refusal ? problem_of(*refusal) : stage_answer(sites, staging.document()));
    };
}
Handled in_time() { return {gateway_limit, problem(504, "time_out", "it was not done in time: look at /site/stage before trying again")}; }
}  // namespace

Handled stage_site(Call& c, const SitePort& sites, const SiteStaging& staging) { return stage_document(c, sites, staging, c.body); }
Handled get_stage(Call& c, const SitePort& sites, const SiteStaging& staging) { return staged_answer(c, sites, staging); }

Handled discard_stage(Call&, const SiteStaging& staging) {
    const bool nothing = staging.state() == SiteStage::State::none;
    if (const auto refusal = staging.discard()) return problem_of(*refusal);
    Response r = nothing_left();
    r.changed_nothing = nothing;
    return r;
}

Handled apply_stage(Call& c, const SitePort& sites, const SiteStaging& staging) {
    std::vector<Fault> faults;
    const auto wish = read_apply_wish(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    if (auto refusal = precondition(c, sites, *sites.site(), false)) return *refusal;
    staging.apply(wish, c.origin(), session_of(c.identity), show_after(c, sites, staging));
    return in_time();
}

Handled confirm_stage(Call& c, const SitePort& sites, const SiteStaging& staging) {
    staging.confirm(c.origin(), session_of(c.identity), show_after(c, sites, staging));
    return in_time();
}

Handled roll_back_stage(Call& c, const SitePort& sites, const SiteStaging& staging) {
    staging.roll_back(c.origin(), show_after(c, sites, staging));
    return in_time();
}

Handled list_site_history(Call& c, const SitePort& sites) {
    std::optional<Response> fault;
    const auto limit = query_whole(c, "limit", 1, 1000, 100, fault);
    const auto before = query_whole(c, "before", 0, INT64_MAX, 0, fault);
    if (fault) return *fault;
    return json_response(site_history(sites, static_cast<std::size_t>(limit), static_cast<std::uint64_t>(before)));
}

Handled get_site_revision(Call& c, const SitePort& sites) { return given(site_revision(sites, c.names[0]), json_answer); }

Handled restore_site_revision(Call& c, const SitePort& sites, const SiteStaging& staging) {
    const auto document = site_revision(sites, c.names[0]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&document)) return problem_of(*refusal);
    return stage_document(c, sites, staging, std::get<json::value>(document));
}

}  // namespace axisgate::http
