// Puts a new site in force at once, or when the axes that it removes or replaces stand. An alarm reports each axis whose standstill is
// unknown. There is one change at a time: an older one comes into force before the next begins.
#include <algorithm>

#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/site_change.hpp"
#include "gateway/engine/site_in_force.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate::engine {
namespace {
constexpr Duration rest_limit = std::chrono::seconds(5);
}  // namespace

std::shared_ptr<const SiteState> SiteChange::apply_at_once(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    if (publisher_.tap()) record(site, memory, revision, true, now);
    const FlightWithin within(publisher_.tap());
    return site_in_force_.put(std::move(site), std::move(memory), revision, now);
}

void SiteChange::begin(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Engine::Applied then) {
    if (publisher_.tap()) record(site, memory, revision, false, now);
    const FlightWithin within(publisher_.tap());
    machine_.now = std::max(machine_.now, now);
    if (change_) put_in_force(now);  // one at a time; the older one has had its time
    change_ = std::make_unique<Change>();
    change_->until = now + rest_limit;
    const KeptParts kept{machine_.site->site, site};
    for (std::size_t i = 0; i < machine_.site->axis_ids.size(); ++i) {
        Axis& a = *machine_.axes[index_of(machine_.site->axis_ids[i])];
        if (kept.axis(machine_.site->site.axes[i])) continue;
        a.leaving_until = change_->until;
        if (!under_way(a)) continue;
        change_->stopped.push_back({a.id, now});
        Event e;
        e.severity = Severity::warning;
        e.kind = "site";
        e.axis = a.spec.name;
        e.text = "the axis is stopped: the changed site takes it away or makes it anew";
        publisher_.event(std::move(e), now);
    }
    change_->site = std::move(site);
    change_->memory = std::move(memory);
    change_->revision = revision;
    change_->then = std::move(then);
    for (const auto& [id, asked] : change_->stopped) {
        Axis& a = *machine_.axis(id);
        orders_.give_own(a, QuickStop{}, now);
        publisher_.publish(a, now);
    }
    check(now);
}

void SiteChange::check(Instant now) {
    if (!change_) return;
    const auto stands = [&](const Change::Stopped& s) {
        const Axis& a = *machine_.axis(s.axis);
        const Side* side = machine_.side_of(*a.drive);
        if (!side || !side->up) return true;  // the line is down, so no order can be sent
        if (awaits_answer(a)) return false;
        return !a.drive->answers() || (a.profile.at_rest() && a.profile.feedback().at > s.asked);
    };
    if (now < change_->until && !std::ranges::all_of(change_->stopped, stands)) return;
    put_in_force(now);
}

void SiteChange::put_in_force(Instant now) {
    const auto change = std::move(change_);
    for (const auto& [id, asked] : change->stopped) {
        const Axis& a = *machine_.axis(id);
        if (a.drive->answers() && a.profile.at_rest() && a.profile.feedback().at > asked) continue;
        Event e;
        e.severity = Severity::alarm;
        e.kind = "site";
        e.axis = a.spec.name;
        e.text =
            "the changed site takes the axis away or makes it anew, and whether it stands is not known: look at the machine, and switch "
            "its drive off if it moves";
        publisher_.event(std::move(e), now);
    }
    auto state = site_in_force_.put(std::move(change->site), std::move(change->memory), change->revision, now);
    if (change->then) change->then(std::move(state));
}

bool SiteChange::under_way(const Axis& a) const {
    if (!a.drive->answers()) return a.drive->device_lost_while_commanded;  // an unreachable drive that was commanded may still be moving
    const AxisFeedback& f = a.profile.feedback();
    return f.moving || f.homing || a.stream.on || (a.motion.runs() && !a.motion.over) || awaits_answer(a);
}

/// An order that may start or end a motion has not been answered yet.
bool SiteChange::awaits_answer(const Axis& a) const {
    return std::ranges::any_of(pending_.orders, [&](const auto& entry) {
        const CommandBody& body = entry.second.body;
        if (const auto* together = std::get_if<StartTogether>(&body))
            return std::ranges::find(together->axes, a.id) != together->axes.end();
        return entry.second.axis == a.id && (is_urgent(body) || std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) ||
                                             std::holds_alternative<Action>(body) || std::holds_alternative<Native>(body));
    });
}

/// The inputs that a replay needs to begin.
void SiteChange::record(const Site& site, const SiteMemory& memory, std::uint64_t revision, bool at_once, Instant now) {
    auto input = std::make_shared<SiteInput>();
    input->site = site;
    input->memory = memory;
    input->revision = revision;
    input->at_once = at_once;
    input->lease = machine_.lease;
    input->watchdog = machine_.watchdog;
    for (const auto& d : site.drives) {
        const auto text =
            d.description.empty() || !machine_.families.descriptions ? nullptr : machine_.families.descriptions->find(d.description);
        if (text && std::ranges::find(input->descriptions, text->name, &DescriptionText::name) == input->descriptions.end())
            input->descriptions.push_back(*text);
    }
    publisher_.tap()->site(std::move(input), now);
}

}  // namespace axisgate::engine
