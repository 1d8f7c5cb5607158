// The rules that the stage port does not know: which client may replace, apply and confirm, and the document of the stage.
#include "gateway/services/site/site_staging.hpp"

#include <fmt/core.h>

#include <boost/json/parse.hpp>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/site/names.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using Why = ServiceRefusal::Why;
ServiceRefusal stage_conflict(std::string text) { return {Why::conflict, std::move(text)}; }

std::function<void(const SiteAnswer&)> ended_by(SiteStaging::Ended then) {
    return [then = std::move(then)](const SiteAnswer& answer) {
        if (answer.good) return then(std::nullopt);
        then(ServiceRefusal{answer.not_stored ? Why::not_stored : Why::conflict, answer.fault});
    };
}
}  // namespace

ApplyWish read_apply_wish(const json::object& body, std::vector<Fault>& faults) {
    ApplyWish wish;
    for (const auto& [k, v] : body) {
        if (k == "stage" && v.is_string()) {
            wish.stage = std::string(v.get_string());
        } else if (k == "stage") {
            faults.push_back({"/stage", "stage must be the id of a stage, a text", "write the id that POST /site/stage gave"});
        } else if (k != "confirm_within_s") {
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
        } else if (v.is_int64() &&
                   (v.get_int64() == 0 || (v.get_int64() >= SiteStage::min_trial_s && v.get_int64() <= SiteStage::max_trial_s))) {
            wish.confirm_within_s = v.get_int64();
        } else {
            faults.push_back({"/confirm_within_s",
                              fmt::format("confirm_within_s must be 0 or {} to {}", SiteStage::min_trial_s, SiteStage::max_trial_s),
                              "0: for good, without a roll back"});
        }
    }
    return wish;
}

json::object document_of(const ClientConnection& c) {
    json::array axes;
    for (const auto& axis : c.axes)
        axes.emplace_back(axis);
    return {{"id", c.id},
            {"door", c.door},
            {"kind", c.kind},
            {"peer", c.peer},
            {"since", format_time(c.since_unix_ns)},
            {"received_at", format_time(c.received_unix_ns)},
            {"axes", std::move(axes)},
            {"commands", c.commands}};
}

json::object SiteStaging::document(const ConnectionPort::List& closes) const {
    const auto site = ports_.get<SitePort>().site();
    const auto& stage = now();
    json::object o{{"state", name_of(stage.state())}, {"id", json::value()},        {"by", text_or_null(stage.by())},
                   {"client", json::value()},         {"staged_at", json::value()}, {"base_revision", json::value()},
                   {"revision", site->revision},      {"faults", json::array()},    {"diff", json::array()},
                   {"disturbs", json::array()},       {"closes", json::array()},    {"confirm_by", json::value()}};
    if (stage.state() != SiteStage::State::none) {
        o["id"] = owner_->id(stage);
        o["client"] = text_or_null(owner_->applier(stage).empty() ? owner_->stager(stage) : owner_->applier(stage));
        if (const auto at = owner_->at_unix_ns(stage); at != 0) o["staged_at"] = format_time(at);
        o["base_revision"] = stage.base_revision();
        if (stage.confirm_by_unix_ns() != 0) o["confirm_by"] = format_time(stage.confirm_by_unix_ns());
    }
    if (stage.state() == SiteStage::State::staged) {
        o["diff"] = site_diff(site->site, stage.site());
        json::array axes;
        for (const auto& a : disturbed_axes(site->site, stage.site()))
            axes.emplace_back(a);
        o["disturbs"] = std::move(axes);
        json::array connections;
        for (const auto& c : closes.value_or(std::vector<ClientConnection>{}))
            connections.push_back(document_of(c));
        o["closes"] = closes ? json::value(std::move(connections)) : json::value(nullptr);
    }
    return o;
}

void SiteStaging::ask(std::function<void(json::object)> then) const {
    if (now().state() != SiteStage::State::staged) return then(document());
    ports_.get<ConnectionPort>().closed_by(
        now().site(), [self = *this, then = std::move(then)](const ConnectionPort::List& closes) { then(self.document(closes)); });
}

/// "local 127.0.0.1 (client 127.0.0.1 tab-1) at 2026-11-21T16:30:00Z"
std::string SiteStaging::stager_text() const {
    const auto& client = owner_->stager(now());
    const auto at = owner_->at_unix_ns(now());
    return fmt::format("{}{}{}", now().by(), client.empty() ? "" : fmt::format(" (client {})", client),
                       at == 0 ? "" : " at " + format_time(at));
}

std::optional<ServiceRefusal> SiteStaging::refuse_taken(const Origin& origin) const {
    if (now().state() != SiteStage::State::staged || owner_->stager(now()) == *origin.client) return std::nullopt;
    return ServiceRefusal{
        .why = Why::stage_taken,
        .text = fmt::format("{} has staged a site that is not applied yet: wait for it, or replace it with ?replace=true", stager_text()),
        .more = {{"stage", owner_->id(now())}}};
}

std::optional<ServiceRefusal> SiteStaging::stage(const json::value& document, const Origin& origin) const {
    const auto& sites = ports_.get<SitePort>();
    const auto before = sites.site();
    std::vector<SiteFault> faults;
    auto site = parse_site(document, sites.families(), faults);
    if (site) faults = names_to_change(*site, &before->site);
    if (!site || !faults.empty()) return faulty(faults_for(faults, "", true));
    if (auto fault = ports_.get<StagePort>().stage_site(std::move(*site), before->revision, origin); !fault.empty())
        return stage_conflict(std::move(fault));
    owner_->staged(now(), origin, ports_.get<ClockPort>().now_unix_ns());
    return std::nullopt;
}

std::optional<ServiceRefusal> SiteStaging::discard() const {
    if (auto fault = ports_.get<StagePort>().discard_stage(); !fault.empty()) return stage_conflict(std::move(fault));
    return std::nullopt;
}

void SiteStaging::apply(const ApplyWish& wish, const Origin& origin, std::string session, Ended then) const {
    const auto& stage = now();
    if (const bool some = stage.state() != SiteStage::State::none; wish.stage && (!some || *wish.stage != owner_->id(stage))) {
        auto text = some ? fmt::format("the staged site is another than {}: {} staged it; nothing was applied, look at it first",
                                       *wish.stage, stager_text())
                         : fmt::format("{} is not staged any more: it was applied or discarded; nothing was applied", *wish.stage);
        return then(ServiceRefusal{.why = Why::stage_replaced,
                                   .text = std::move(text),
                                   .more = {{"stage", some ? json::value(owner_->id(stage)) : json::value(nullptr)}}});
    }
    if (stage.state() == SiteStage::State::staged) owner_->applied(stage, origin, std::move(session));
    ports_.get<StagePort>().apply_stage(static_cast<std::uint32_t>(wish.confirm_within_s), origin, ended_by(std::move(then)));
}

void SiteStaging::confirm(const Origin& origin, const std::string& session, Ended then) const {
    const auto& stage = now();
    const auto& applier = owner_->applier(stage);
    // The same user in another session counts as another one, because a confirmation shows that the gateway can still be reached from the
    // place where the site was applied.
    const bool own = identity_of(*origin.who) == stage.by() &&
                     (applier.empty() || (applier == *origin.client && owner_->applier_session(stage) == session));
    if (stage.state() == SiteStage::State::applied && !own) {
        return then(stage_conflict(
            fmt::format("only {}{}, who applied the site, can confirm it, in the same session; it rolls back by itself at {}, or now with "
                        "POST /api/v1/site/stage/roll-back, and can then be applied from here",
                        stage.by(), applier.empty() ? "" : fmt::format(" (client {})", applier), format_time(stage.confirm_by_unix_ns()))));
    }
    if (auto fault = stage.check_confirm(*origin.who, ports_.get<ClockPort>().now_unix_ns()); !fault.empty())
        return then(stage_conflict(std::move(fault)));
    // The disk is being asked; until it has answered, the stage counts as applied, and it is confirmed only once.
    if (owner_->confirming) return then(stage_conflict("it is being confirmed already"));
    owner_->confirming = true;
    ports_.get<StagePort>().confirm_stage(origin, [owner = owner_, then = std::move(then)](const std::string& fault) {
        owner->confirming = false;
        then(fault.empty() ? std::nullopt : std::optional(ServiceRefusal{Why::not_stored, fault}));
    });
}

void SiteStaging::roll_back(const Origin& origin, Ended then) const {
    ports_.get<StagePort>().roll_back_stage(origin, ended_by(std::move(then)));
}

json::array site_history(const SitePort& sites, std::size_t limit, std::uint64_t before) {
    json::array out;
    for (const auto& r : sites.site_history(limit, before))
        out.push_back(
            json::object{{"revision", r.revision}, {"at", format_time(r.at_unix_ns)}, {"who", text_or_null(r.who)}, {"bytes", r.bytes}});
    return out;
}

Refusable<json::value> site_revision(const SitePort& sites, std::string_view number) {
    const auto n = parse_whole(number, 1, INT64_MAX);
    const auto r = n ? sites.site_revision(static_cast<std::uint64_t>(*n)) : std::nullopt;
    boost::system::error_code ec;
    auto document = r ? json::parse(r->text, ec) : json::value();
    if (!r || ec) return no_such("revision", number);
    return document;
}

}  // namespace axisgate
