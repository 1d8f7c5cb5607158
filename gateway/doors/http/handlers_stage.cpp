// Handlers of staged site changes and of the site's history.
// In: calls. Out: the stage with its differences; revisions.
// Never changes a site at once: what is staged is applied as one, and taken back unless it is confirmed.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/site/names.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// `closes`: connections that a staged site would close; nothing: nobody could say.
Response stage_answer(const SitePort& sites, const StagePort& staging, const StageOwner& owner,
                      const ConnectionPort::List& closes = std::vector<ClientConnection>{}) {
    const auto now = sites.site();
    const auto& stage = staging.site_stage();
    json::object o{{"state", name_of(stage.state())}, {"id", json::value()},        {"by", text_or_null(stage.by())},
                   {"client", json::value()},         {"staged_at", json::value()}, {"base_revision", json::value()},
                   {"revision", now->revision},       {"faults", json::array()},    {"diff", json::array()},
                   {"disturbs", json::array()},       {"closes", json::array()},    {"confirm_by", json::value()}};
    if (stage.state() != SiteStage::State::none) {
        o["id"] = owner.id(stage);
        o["client"] = text_or_null(owner.applier(stage).empty() ? owner.stager(stage) : owner.applier(stage));
        if (const auto at = owner.at_unix_ns(stage); at != 0) o["staged_at"] = format_time(at);
        o["base_revision"] = stage.base_revision();
        if (stage.confirm_by_unix_ns() != 0) o["confirm_by"] = format_time(stage.confirm_by_unix_ns());
    }
    if (stage.state() == SiteStage::State::staged) {
        o["diff"] = site_diff(now->site, stage.site());
        json::array axes;
        for (const auto& a : disturbed_axes(now->site, stage.site()))
            axes.emplace_back(a);
        o["disturbs"] = std::move(axes);
        json::array connections;
        for (const auto& c : closes.value_or(std::vector<ClientConnection>{}))
            connections.push_back(document_of(c));
        o["closes"] = closes ? json::value(std::move(connections)) : json::value(nullptr);
    }
    Response r = json_response(o);
    r.headers.set("ETag", site_tag(now->revision));
    put_revision(r, *now);
    return r;
}

/// The same of a site that may be staged: the doors are asked which connections it would close.
Handled staged_answer(const Call& c, ConnectionPort& connections, const SitePort& sites, const StagePort& staging) {
    const auto& stage = staging.site_stage();
    if (stage.state() != SiteStage::State::staged) return stage_answer(sites, staging, *c.context.stages);
    connections.closed_by(stage.site(), [&sites, &staging, owner = c.context.stages, respond = c.respond](
                                            const ConnectionPort::List& closes) { respond(stage_answer(sites, staging, *owner, closes)); });
    return {gateway_limit, stage_answer(sites, staging, *c.context.stages, std::nullopt)};
}

Response conflict(std::string text) { return problem(409, "conflict", std::move(text)); }

/// "local 127.0.0.1 (client 127.0.0.1 tab-1) at 2026-11-21T16:30:00Z"
std::string stager_text(const StageOwner& owner, const SiteStage& stage) {
    const auto& client = owner.stager(stage);
    const auto at = owner.at_unix_ns(stage);
    return fmt::format("{}{}{}", stage.by(), client.empty() ? "" : fmt::format(" (client {})", client),
                       at == 0 ? "" : " at " + format_time(at));
}

/// 409 if another client's stage waits: it is not replaced in silence.
std::optional<Response> refuse_taken(const Call& c, const StagePort& staging) {
    const auto& stage = staging.site_stage();
    const auto& owner = *c.context.stages;
    std::optional<Response> fault;
    const bool replace = query_flag(c, "replace", fault);
    if (fault || replace || stage.state() != SiteStage::State::staged || owner.stager(stage) == *c.origin().client) return fault;
    Problem p{.status = 409,
              .reason = "stage_taken",
              .detail = fmt::format("{} has staged a site that is not applied yet: wait for it, or replace it with ?replace=true",
                                    stager_text(owner, stage))};
    p.more["stage"] = owner.id(stage);
    return to_response(p);
}

Handled stage_document(Call& c, const ClockPort& clock, ConnectionPort& connections, const SitePort& sites, StagePort& staging,
                       const json::value& document) {
    const auto now = sites.site();
    if (auto refusal = refuse_taken(c, staging)) return *refusal;
    if (auto refusal = precondition(c, sites, *now, c.context.settings.require_if_match)) return *refusal;
    std::vector<SiteFault> faults;
    auto site = parse_site(document, sites.families(), faults);
    if (site) faults = names_to_change(*site, &now->site);
    if (!site || !faults.empty()) return invalid(faults_for(faults, "", true));
    if (auto fault = staging.stage_site(std::move(*site), now->revision, c.origin()); !fault.empty()) return conflict(std::move(fault));
    c.context.stages->staged(staging.site_stage(), c.origin(), clock.now_unix_ns());
    return staged_answer(c, connections, sites, staging);
}

auto show_after(const SitePort& sites, const StagePort& staging, std::shared_ptr<StageOwner> owner, Respond respond) {
    return [&sites, &staging, owner = std::move(owner), respond = std::move(respond)](const SiteAnswer& answer) {
        if (!answer.good) return respond(answer.not_stored ? problem(507, "not_stored", answer.fault) : conflict(answer.fault));
        respond(stage_answer(sites, staging, *owner));
    };
}
const char* const in_time = "it was not done in time: look at /site/stage before trying again";
}  // namespace

Handled stage_site(Call& c, const ClockPort& clock, ConnectionPort& connections, const SitePort& sites, StagePort& staging) {
    return stage_document(c, clock, connections, sites, staging, c.body);
}
Handled get_stage(Call& c, ConnectionPort& connections, const SitePort& sites, const StagePort& staging) {
    return staged_answer(c, connections, sites, staging);
}

Handled discard_stage(Call&, StagePort& staging) {
    const bool nothing = staging.site_stage().state() == SiteStage::State::none;
    if (auto fault = staging.discard_stage(); !fault.empty()) return conflict(std::move(fault));
    Response r;
    r.status = 204;
    r.changed_nothing = nothing;
    return r;
}

Handled apply_stage(Call& c, const SitePort& sites, StagePort& staging) {
    std::vector<Fault> faults;
    std::int64_t within = 60;
    std::optional<std::string> meant;
    for (const auto& [k, v] : c.body.get_object()) {
        if (k == "stage" && v.is_string()) {
            meant = std::string(v.get_string());
        } else if (k == "stage") {
            faults.push_back({"/stage", "stage must be the id of a stage, a text", "write the id that POST /site/stage gave"});
        } else if (k != "confirm_within_s") {
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
        } else if (v.is_int64() &&
                   (v.get_int64() == 0 || (v.get_int64() >= SiteStage::min_trial_s && v.get_int64() <= SiteStage::max_trial_s))) {
            within = v.get_int64();
        } else {
            faults.push_back({"/confirm_within_s",
                              fmt::format("confirm_within_s must be 0 or {} to {}", SiteStage::min_trial_s, SiteStage::max_trial_s),
                              "0: for good, without a roll back"});
        }
    }
    if (!faults.empty()) return invalid(std::move(faults));
    if (auto refusal = precondition(c, sites, *sites.site(), false)) return *refusal;
    const auto& stage = staging.site_stage();
    const auto& owner = c.context.stages;
    if (const bool some = stage.state() != SiteStage::State::none; meant && (!some || *meant != owner->id(stage))) {
        Problem p{.status = 409, .reason = "stage_replaced", .detail = {}};
        p.detail = some ? fmt::format("the staged site is another than {}: {} staged it; nothing was applied, look at it first", *meant,
                                      stager_text(*owner, stage))
                        : fmt::format("{} is not staged any more: it was applied or discarded; nothing was applied", *meant);
        p.more["stage"] = some ? json::value(owner->id(stage)) : json::value(nullptr);
        return to_response(p);
    }
    if (stage.state() == SiteStage::State::staged) owner->applied(stage, c.origin(), session_of(c.identity));
    staging.apply_stage(static_cast<std::uint32_t>(within), c.origin(), show_after(sites, staging, owner, c.respond));
    return {gateway_limit, problem(504, "time_out", in_time)};
}

Handled confirm_stage(Call& c, const ClockPort& clock, const SitePort& sites, StagePort& staging) {
    const auto& stage = staging.site_stage();
    const auto& applier = c.context.stages->applier(stage);
    const Origin origin = c.origin();
    // The same user in another session is another one: who confirms has seen that he can still reach the gateway from where he applied it.
    const bool own = identity_of(*origin.who) == stage.by() &&
                     (applier.empty() || (applier == *origin.client && c.context.stages->applier_session(stage) == session_of(c.identity)));
    if (stage.state() == SiteStage::State::applied && !own) {
        return conflict(
            fmt::format("only {}{}, who applied the site, can confirm it, in the same session; it rolls back by itself at {}, or now with "
                        "POST /api/v1/site/stage/roll-back, and can then be applied from here",
                        stage.by(), applier.empty() ? "" : fmt::format(" (client {})", applier), format_time(stage.confirm_by_unix_ns())));
    }
    if (auto fault = stage.check_confirm(*origin.who, clock.now_unix_ns()); !fault.empty()) return conflict(std::move(fault));
    // The disk is asked; until it has answered the stage still stands as applied, and it is confirmed once.
    if (c.context.stages->confirming) return conflict("it is being confirmed already");
    c.context.stages->confirming = true;
    staging.confirm_stage(origin, [&sites, &staging, owner = c.context.stages, respond = c.respond](const std::string& fault) {
        owner->confirming = false;
        respond(fault.empty() ? stage_answer(sites, staging, *owner) : problem(507, "not_stored", fault));
    });
    return {gateway_limit, problem(504, "time_out", in_time)};
}

Handled roll_back_stage(Call& c, const SitePort& sites, StagePort& staging) {
    staging.roll_back_stage(c.origin(), show_after(sites, staging, c.context.stages, c.respond));
    return {gateway_limit, problem(504, "time_out", in_time)};
}

Handled list_site_history(Call& c, const SitePort& sites) {
    std::optional<Response> fault;
    const auto limit = query_whole(c, "limit", 1, 1000, 100, fault);
    const auto before = query_whole(c, "before", 0, INT64_MAX, 0, fault);
    if (fault) return *fault;
    json::array out;
    for (const auto& r : sites.site_history(static_cast<std::size_t>(limit), static_cast<std::uint64_t>(before)))
        out.push_back(
            json::object{{"revision", r.revision}, {"at", format_time(r.at_unix_ns)}, {"who", text_or_null(r.who)}, {"bytes", r.bytes}});
    return json_response(out);
}

namespace {
std::optional<json::value> document_of_revision(const Call& c, const SitePort& sites) {
    const auto n = parse_whole(c.names[0], 1, INT64_MAX);
    const auto r = n ? sites.site_revision(static_cast<std::uint64_t>(*n)) : std::nullopt;
    if (!r) return std::nullopt;
    boost::system::error_code ec;
    auto v = json::parse(r->text, ec);
    return ec ? std::nullopt : std::optional(std::move(v));
}
}  // namespace

Handled get_site_revision(Call& c, const SitePort& sites) {
    const auto document = document_of_revision(c, sites);
    return document ? json_response(*document) : nothing_named("revision", c.names[0]);
}

Handled restore_site_revision(Call& c, const ClockPort& clock, ConnectionPort& connections, const SitePort& sites, StagePort& staging) {
    const auto document = document_of_revision(c, sites);
    if (!document) return nothing_named("revision", c.names[0]);
    return stage_document(c, clock, connections, sites, staging, *document);
}

}  // namespace axisgate::http
