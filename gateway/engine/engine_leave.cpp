// Engine, a site change in motion: what the new site takes away or makes anew is stopped first, while its line still stands.
// In: the wanted site. Out: a quick stop and an event per axis under way, then the site in force.
// Never waits for ever: a drive that cannot be brought to rest, or is not heard, does not keep its site from being changed.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {
namespace {
constexpr Duration rest_limit = std::chrono::seconds(5);
}  // namespace

bool Engine::online(const Axis& a) const {
    return a.drive->serving == Presence::twin ? a.drive->twin_online : a.drive->serving == Presence::device && a.drive->device_online;
}

/// An order that may set it in motion, or end that, has not been answered yet.
bool Engine::awaits_answer(const Axis& a) const {
    return std::ranges::any_of(orders_, [&](const auto& entry) {
        const CommandBody& body = entry.second.body;
        if (const auto* together = std::get_if<StartTogether>(&body))
            return std::ranges::find(together->axes, a.id) != together->axes.end();
        return entry.second.axis == a.id && (is_urgent(body) || std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) ||
                                             std::holds_alternative<Action>(body) || std::holds_alternative<Native>(body));
    });
}

bool Engine::under_way(const Axis& a) const {
    if (!online(a)) return a.drive->device_lost_while_commanded;  // it may be moving: nobody knows
    const AxisFeedback& f = a.profile.feedback();
    return f.moving || f.homing || a.stream.on || a.profile.active_target() || a.run.velocity != 0 || awaits_answer(a);
}

void Engine::change_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Applied then) {
    if (tap_) tap_site(site, memory, revision, false, now);
    const FlightWithin within(tap_);
    now_ = std::max(now_, now);
    if (change_) put_change_in_force(now);  // one at a time: the older one has had its time
    change_ = std::make_unique<Change>();
    change_->until = now + rest_limit;
    const KeptParts kept{site_->site, site};
    for (std::size_t i = 0; i < site_->axis_ids.size(); ++i) {
        Axis& a = *axes_[index_of(site_->axis_ids[i])];
        if (kept.axis(site_->site.axes[i])) continue;
        a.leaving_until = change_->until;
        if (!under_way(a)) continue;
        change_->stopped.push_back({a.id, now});
        Event e;
        e.severity = Severity::warning;
        e.kind = "site";
        e.axis = a.spec.name;
        e.text = "the axis is stopped: the changed site takes it away or makes it anew";
        event(std::move(e), now);
    }
    change_->site = std::move(site);
    change_->memory = std::move(memory);
    change_->revision = revision;
    change_->then = std::move(then);
    for (const auto& [id, asked] : change_->stopped) {
        Axis& a = *axis(id);
        auto decision = a.profile.on_command(QuickStop{});
        for (auto& o : decision.orders)
            give_order(a, nullptr, std::move(o), {}, now);
        publish(a, now);
    }
    check_change(now);
}

void Engine::check_change(Instant now) {
    if (!change_) return;
    const auto stands = [&](const Change::Stopped& s) {
        const Axis& a = *axis(s.axis);
        const Side* side = side_of(*a.drive);
        if (!side || !side->up) return true;  // nothing can be sent any more
        if (awaits_answer(a)) return false;
        return !online(a) || (a.profile.at_rest() && a.profile.feedback().at > s.asked);
    };
    if (now < change_->until && !std::ranges::all_of(change_->stopped, stands)) return;
    put_change_in_force(now);
}

void Engine::put_change_in_force(Instant now) {
    const auto change = std::move(change_);
    for (const auto& [id, asked] : change->stopped) {
        const Axis& a = *axis(id);
        if (online(a) && a.profile.at_rest() && a.profile.feedback().at > asked) continue;
        Event e;
        e.severity = Severity::alarm;
        e.kind = "site";
        e.axis = a.spec.name;
        e.text =
            "the changed site takes the axis away or makes it anew, and whether it stands is not known: look at the machine, and switch "
            "its drive off if it moves";
        event(std::move(e), now);
    }
    auto state = put_in_force(std::move(change->site), std::move(change->memory), change->revision, now);
    if (change->then) change->then(std::move(state));
}

}  // namespace axisgate
