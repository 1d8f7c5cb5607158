// Gateways by their instance; commands by their id until the gateway answers, is lost, or five minutes have passed.
#include "gateway/doors/dds/fleet.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

#include "gateway/axis/authority.hpp"
#include "gateway/core/plain_text.hpp"

namespace axisgate::dds {
namespace {
Result no_result(Outcome outcome, Reason reason, std::string text) {
    Result r;
    r.outcome = outcome;
    r.reason = reason;
    r.text = std::move(text);
    return r;
}
/// The word of the other gateway; an unknown word of a newer program counts as a fault of the gateway.
Outcome outcome_named(std::string_view word) {
    for (const Outcome o : {Outcome::accepted, Outcome::done, Outcome::refused, Outcome::failed}) {
        if (name_of(o) == word) return o;
    }
    return Outcome::failed;
}
Reason reason_named(std::string_view word) {
    for (int i = 0; i <= static_cast<int>(Reason::internal); ++i) {
        if (name_of(static_cast<Reason>(i)) == word) return static_cast<Reason>(i);
    }
    return Reason::internal;
}
}  // namespace

Event Fleet::lose(Known& k, Instant now) {
    k.gateway.alive = false;
    ++comings_;
    k.lost_at = now;
    std::vector<std::string> unanswered;
    for (const auto& [id, w] : waiting_) {
        if (w->awaited.erase(k.gateway.instance) > 0 && w->awaited.empty()) unanswered.push_back(id);
    }
    for (const auto& id : unanswered) {
        const auto it = waiting_.find(id);
        if (it == waiting_.end()) continue;  // it was completed by the end of another one
        const Waiting& w = *it->second;
        std::vector<Result> answers;
        for (const auto& [instance, answer] : w.answers)
            answers.push_back(answer);
        Result r = answers.empty()
                       ? no_result(Outcome::failed, Reason::no_answer,
                                   fmt::format("the gateway {} is gone; nobody knows whether the command was carried out", k.gateway.name))
                       : together(answers, w.gateway);
        if (good(r)) r.text += fmt::format("{}another gateway called {} is gone without an answer", r.text.empty() ? "" : "; ", w.gateway);
        end(id, r);
    }
    Event e;
    e.kind = "fleet";
    e.door = "dds";
    e.severity = Severity::warning;
    e.text = fmt::format("the gateway {} is gone: it has ended, or is not to be reached", k.gateway.name);
    return e;
}

std::optional<Event> Fleet::on_gateway(const axisgate_GatewayState& s, bool alive, std::int64_t now_unix_ns, Instant now) {
    const auto it = known_.find(s.instance);
    const bool other = s.instance != instance_;
    Event e;
    e.kind = "fleet";
    e.door = "dds";
    if (!alive) {
        if (it == known_.end() || !it->second.gateway.alive) return std::nullopt;
        return lose(it->second, now);
    }
    const bool found = it == known_.end() || !it->second.gateway.alive;
    if (found) ++comings_;
    if (it == known_.end() && (!is_plain(s.gateway) || !is_plain(s.http) || !make_room(now))) {
        ++left_out_;
        return std::nullopt;
    }
    Known& k = known_[s.instance];
    k.lost_at = never;
    k.received_at = now;
    FleetGateway& g = k.gateway;
    g.name = s.gateway;
    g.instance = s.instance;
    g.here = !other;
    g.alive = true;
    g.version = s.version;
    g.http = s.http;
    g.at_unix_ns = s.at_unix_ns;
    g.clock_ahead_ns = s.at_unix_ns - now_unix_ns;
    g.uptime_ms = s.uptime_ms;
    k.axes_told = std::min<std::size_t>(s.axes, axes_most);
    if (!found || !other) return std::nullopt;
    e.text = fmt::format("the gateway {} is in the domain", g.name);
    return e;
}

/// Lost gateways are removed first, the one that was lost earliest. Of the others, one with axes is a working gateway; names without axes
/// are easy to invent, and the one with the oldest message is removed for a newcomer.
bool Fleet::make_room(Instant now) {
    if (known_.size() < gateways_most) return true;
    const auto rank = [this](const auto& k) {
        return std::make_tuple(k.first == instance_, k.second.gateway.alive, !k.second.axes.empty(), k.second.received_at);
    };
    const auto victim = std::ranges::min_element(known_, [&rank](const auto& a, const auto& b) { return rank(a) < rank(b); });
    if (victim->first == instance_ || (victim->second.gateway.alive && !victim->second.axes.empty())) return false;
    if (victim->second.gateway.alive) {
        ++left_out_;
        (void)lose(victim->second, now);  // its answer is not awaited any more
    }
    known_.erase(victim->first);
    ++comings_;
    return true;
}

void Fleet::on_axis(const axisgate_AxisState& s, bool valid, bool alive) {
    if (!valid || !alive) {
        // Only the key is known: of every gateway of the name, alive or not; one that still has the axis reports it again.
        for (auto& [instance, k] : known_) {
            if (k.gateway.name == s.gateway && k.gateway.alive) k.axes.erase(s.axis);
        }
        return;
    }
    const auto it = known_.find(s.instance);
    if (it == known_.end()) return;  // its gateway's own state arrives within half a second, and this one again
    auto& axes = it->second.axes;
    if (axes.size() >= axes_most && !axes.contains(s.axis)) {
        ++left_out_;
        return;
    }
    FleetAxis& a = axes[s.axis];
    a.name = s.axis;
    a.family = s.family;
    a.unit = s.unit;
    a.authority = s.authority;
    a.holder = s.authority_holder;
    a.number = s.number;
    a.increments_per_unit = s.increments_per_unit > 0 ? s.increments_per_unit : 1;
    a.online = s.online;
    a.simulated = s.simulated;
    a.stale = s.stale;
    a.referenced = s.referenced;
    a.moving = s.moving;
    a.target_reached = s.target_reached;
    a.fault = s.fault;
    a.warning = s.warning;
    a.statusword = s.statusword;
    a.error_code = s.error_code;
    a.fail_safe_cause = s.fail_safe_cause;
    a.mode = s.mode;
    a.position = s.position;
    a.velocity = s.velocity;
    a.at_unix_ns = s.at_unix_ns;
    a.position_demand = s.position_demand;
    a.demand_source = s.demand_source;
    a.sequence = s.count;
}

void Fleet::on_result(const axisgate_CommandResult& s) {
    if (!std::string_view(s.source).starts_with(name_)) return;
    const auto it = waiting_.find(s.id);
    // The id belongs to this process; an answer for another start, or for a namesake, does not belong to this command unless it is a stop.
    if (it == waiting_.end() || std::string_view(it->second->sample.source) != s.source) return;
    Waiting& w = *it->second;
    if (!w.stops && !w.awaited.contains(s.instance)) return;
    Result r = no_result(outcome_named(s.outcome), reason_named(s.reason), s.text);
    r.code = s.code;
    if (const auto known = known_.find(s.instance); known != known_.end()) {
        const auto axis = known->second.axes.find(s.axis);
        if (axis != known->second.axes.end()) axis->second.answered = std::max(axis->second.answered, s.count);
    }
    if (!w.stops) return end(s.id, r);
    w.awaited.erase(s.instance);
    if (w.answers.size() < gateways_most) w.answers.emplace(s.instance, std::move(r));
    if (!w.awaited.empty()) return;
    std::vector<Result> answers;
    for (const auto& [instance, answer] : w.answers)
        answers.push_back(answer);
    end(s.id, together(answers, w.gateway));
}

std::vector<Event> Fleet::on_turn(Instant now) {
    std::vector<Event> published;
    if (!opened_) opened_ = now;
    for (auto& [instance, k] : known_) {
        if (instance != instance_ && k.gateway.alive && now - k.received_at > std::chrono::milliseconds(lease_ms))
            published.push_back(lose(k, now));
    }
    std::vector<std::string> over;
    for (auto& [id, w] : waiting_) {
        if (now >= w->until) {
            over.push_back(id);
        } else if (now - w->sent >= sent_again) {
            w->sent = now;
            send_(w->sample);
        }
    }
    for (const auto& id : over) {
        const auto it = waiting_.find(id);
        if (it == waiting_.end()) continue;
        const Waiting& w = *it->second;
        FleetOrder to;
        to.gateway = w.gateway;
        Result r;
        if (w.unheard && !target(to, r)) {
            r.text += "; the stop was sent all the same, and nobody has answered it";
        } else {
            r = no_result(
                Outcome::failed, Reason::no_answer,
                fmt::format("no result from the gateway {} in time; nobody knows whether the command was carried out", w.gateway));
        }
        end(id, r);
    }
    try_unheard(now);
    std::erase_if(known_, [now](const auto& k) { return !k.second.gateway.alive && now - k.second.lost_at >= lost_kept; });
    return published;
}

std::vector<FleetGateway> Fleet::list(std::int64_t now_unix_ns, Instant now) const {
    std::vector<FleetGateway> out;
    for (const auto& [instance, k] : known_) {
        FleetGateway g = k.gateway;
        g.namesake = std::ranges::any_of(known_, [&g](const auto& other) {
            return other.second.gateway.alive && other.second.gateway.name == g.name && other.first != g.instance;
        });
        g.silent_ms = std::max<std::int64_t>(0, (now - k.received_at) / std::chrono::milliseconds(1));
        for (const auto& [name, a] : k.axes) {
            g.axes.push_back(a);
            g.axes.back().age_ms = age_ms(g, a, now_unix_ns);
        }
        out.push_back(std::move(g));
    }
    std::ranges::stable_sort(out, {}, &FleetGateway::name);
    return out;
}

std::int64_t Fleet::age_ms(const FleetGateway& g, const FleetAxis& a, std::int64_t now_unix_ns) {
    if (a.at_unix_ns == 0) return -1;
    return std::max<std::int64_t>(0, (now_unix_ns + g.clock_ahead_ns - a.at_unix_ns) / 1'000'000);
}

Fleet::Seen Fleet::mirrored(std::string_view gateway, std::string_view axis) const {
    FleetOrder to;
    to.gateway = gateway;
    const auto no = [&](std::string_view what, bool circle) {
        return Seen{nullptr, nullptr, fmt::format("{}/{} {}", gateway, axis, what), false, circle};
    };
    if (gateway == name_) return no("is an axis of this gateway: it needs no mirror", true);
    for (const auto& [instance, k] : known_) {
        const auto of_it = k.gateway.name == gateway ? k.axes.find(std::string(axis)) : k.axes.end();
        if (of_it != k.axes.end() && of_it->second.family == "remote" && k.gateway.alive)
            return no("is a mirror itself: name the gateway that has the drive", true);
    }
    Result fault;
    const FleetGateway* g = target(to, fault);
    if (!g) return {nullptr, nullptr, fault.text};
    const auto& axes = known_.at(g->instance).axes;
    const auto it = axes.find(std::string(axis));
    if (it == axes.end()) return no("is not there: its gateway has no such axis", false);
    if (!it->second.online) return {g, nullptr, fmt::format("{}/{} does not answer its own gateway", gateway, axis), true};
    return {g, &it->second, {}};
}

const FleetGateway* Fleet::target(const FleetOrder& o, Result& fault) const {
    const FleetGateway* found = nullptr;
    bool lost = false;
    for (const auto& [instance, k] : known_) {
        if (k.gateway.name != o.gateway || (o.instance != 0 && o.instance != instance)) continue;
        if (!k.gateway.alive) {
            lost = true;
        } else if (found) {
            fault =
                no_result(Outcome::refused, Reason::wrong_state,
                          fmt::format("two gateways of the domain are called {}; give one of them another name ([dds] name)", o.gateway));
            return nullptr;
        } else {
            found = &k.gateway;
        }
    }
    if (!found) {
        fault = lost ? no_result(Outcome::refused, Reason::line_down, fmt::format("the gateway {} is gone", o.gateway))
                     : no_result(Outcome::refused, Reason::unknown_point, fmt::format("there is no gateway {} in the domain", o.gateway));
    }
    return found;
}

void Fleet::end(const std::string& id, const Result& result) {
    auto node = waiting_.extract(id);
    if (!node.empty()) node.mapped()->then(result);
}

}  // namespace axisgate::dds
