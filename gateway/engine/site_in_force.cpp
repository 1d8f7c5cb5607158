// Applies a site to the machine: removes, adds and changes lines, drives and axes, and reports removed axes and faulty options. An id is
// never given to another name.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/presences.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/scans.hpp"
#include "gateway/engine/site_in_force.hpp"
#include "gateway/engine/speakers.hpp"
#include "gateway/engine/twins.hpp"
#include "gateway/site/options.hpp"

namespace axisgate::engine {
namespace {
/// The index of a name: its former one if the name is known, otherwise a new one at the end.
template <class Id, class Slot>
Id place_of(const std::map<std::string, Id>& known, const std::string& name, std::vector<Slot>& slots) {
    if (const auto it = known.find(name); it != known.end()) return it->second;
    slots.emplace_back();
    return Id{static_cast<std::uint16_t>(slots.size() - 1)};
}
}  // namespace

void SiteInForce::drop_axis(Axis& a, std::string_view why) {
    const auto waiting = a.clients;
    for (const auto number : waiting) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::line_down;
        r.text = fmt::format("axis {}: {}", a.spec.name, why);
        clients_.finish(number, std::move(r));
    }
    std::erase_if(pending_.orders, [&](const auto& entry) { return entry.second.axis == a.id; });
    machine_.image.picture(a.id) = AxisPicture{};
    machine_.image.publish(a.id);
}

SiteInForce::Ids SiteInForce::ids_in_force() const {
    const SiteState& now = *machine_.site;
    Ids ids;
    for (std::size_t i = 0; i < now.site.lines.size(); ++i)
        ids.lines[now.site.lines[i].name] = now.line_ids[i];
    for (std::size_t i = 0; i < now.site.drives.size(); ++i)
        ids.drives[now.site.drives[i].name] = now.drive_ids[i];
    for (std::size_t i = 0; i < now.site.axes.size(); ++i)
        ids.axes[now.site.axes[i].name] = now.axis_ids[i];
    return ids;
}

/// Removes axes, then drives, then lines. Their ids stay reserved for the case that the name returns. The axes remain in memory until the
/// new site works.
std::vector<std::unique_ptr<Axis>> SiteInForce::take_away(const Site& old, const KeptParts& kept, const Ids& ids) {
    std::vector<std::unique_ptr<Axis>> gone_axes;
    for (const auto& a : old.axes) {
        if (kept.axis(a)) continue;
        auto& slot = machine_.axes[index_of(ids.axes.at(a.name))];
        drop_axis(*slot, "it was removed or changed in the site");
        std::erase(slot->drive->axes, slot->id);
        gone_axes.push_back(std::move(slot));
    }
    for (const auto& d : old.drives) {
        if (kept.drive(d)) continue;
        auto& slot = machine_.drives[index_of(ids.drives.at(d.name))];
        LineUnit& unit = *slot->line;
        if (slot->serving == Presence::twin && unit.twins) unit.twins->bus->remove(slot->id);
        std::erase(unit.drives, slot->id);
        slot.reset();
    }
    for (const auto& l : old.lines) {
        if (kept.line(l)) continue;
        auto& slot = machine_.lines[index_of(ids.lines.at(l.name))];
        for (Side* s : {slot->real.get(), slot->twins.get()}) {
            if (!s) continue;
            s->line->close();
            machine_.sides.remove(*s);
        }
        slot.reset();
    }
    return gone_axes;
}

std::vector<LineUnit*> SiteInForce::add_lines(const Site& site, const Ids& ids, SiteState& state) {
    std::vector<LineUnit*> fresh;
    for (const auto& l : site.lines) {
        const LineId id = place_of(ids.lines, l.name, machine_.lines);
        auto& slot = machine_.lines[index_of(id)];
        if (!slot) {
            slot = std::make_unique<LineUnit>();
            slot->id = id;
            slot->spec = l;
            slot->family = machine_.families.find(l.family);
            fresh.push_back(slot.get());
        }
        slot->families.clear();
        for (const auto& name : site.families_on(l))
            slot->families.push_back(machine_.families.find(name));
        state.line_ids.push_back(id);
    }
    return fresh;
}

std::vector<Drive*> SiteInForce::add_drives(const Site& site, const Ids& ids, const SiteMemory& memory, SiteState& state, Instant now) {
    std::vector<Drive*> fresh;
    for (const auto& d : site.drives) {
        const DriveId id = place_of(ids.drives, d.name, machine_.drives);
        auto& slot = machine_.drives[index_of(id)];
        state.drive_ids.push_back(id);
        if (slot) continue;
        slot = std::make_unique<Drive>();
        slot->id = id;
        slot->spec = d;
        slot->waiting_since = now;
        slot->device_link.drive = id;
        for (const auto& unit : machine_.lines) {
            if (unit && unit->spec.name == d.line) slot->line = unit.get();
        }
        slot->line->drives.push_back(id);
        slot->family = machine_.families.find(site.family_of(d));
        slot->catalogue = catalogue_of(site, d, machine_.families);
        if (const auto m = memory.twins.find(d.name); m != memory.twins.end()) slot->memory = m->second;
        fresh.push_back(slot.get());
    }
    return fresh;
}

std::unique_ptr<Axis> SiteInForce::new_axis(AxisId id, const AxisSpec& a, const SiteMemory& memory) {
    auto axis = std::make_unique<Axis>();
    axis->id = id;
    for (const auto& d : machine_.drives) {
        if (d && d->spec.name == a.drive) axis->drive = d.get();
    }
    axis->drive->axes.push_back(id);
    publisher_.new_source(*axis);
    if (axis->drive->serving != Presence::offline) axis->profile.on_presence(axis->drive->serving);
    if (const auto m = memory.stored.find(a.name); m != memory.stored.end()) {
        for (const auto& [parameter, value] : m->second) {
            if (const auto point = axis->drive->catalogue->find(parameter)) axis->stored[*point] = value;
        }
    }
    return axis;
}

void SiteInForce::add_axes(const Site& site, const Ids& ids, const SiteMemory& memory, SiteState& state) {
    std::vector<AxisId> by_number;
    for (const auto& a : site.axes) {
        const AxisId id = place_of(ids.axes, a.name, machine_.axes);
        (void)machine_.image.grow(machine_.axes.size());
        auto& slot = machine_.axes[index_of(id)];
        if (!slot) slot = new_axis(id, a, memory);
        slot->leaving_until = {};
        slot->spec = a;  // number, unit, scale and limits change without disturbing the axis
        slot->limits = AxisLimits::of(a);
        state.axis_ids.push_back(id);
        if (static_cast<std::size_t>(a.number) >= by_number.size()) by_number.resize(static_cast<std::size_t>(a.number) + 1, no_axis);
        by_number[static_cast<std::size_t>(a.number)] = id;
    }
    machine_.image.set_numbers(std::move(by_number));
}

/// Gives the adapters of remaining lines the new set of drives, and opens new lines.
void SiteInForce::put_to_work(std::span<LineUnit* const> fresh_lines, std::span<Drive* const> fresh_drives, Instant now) {
    for (const auto& d : machine_.drives) {
        if (d) twins_.refit(*d, now);
    }
    for (const auto& unit : machine_.lines) {
        if (!unit || std::ranges::find(fresh_lines, unit.get()) != fresh_lines.end()) continue;
        if (unit->real) speakers_.fit(*unit->real, now);
        if (unit->twins) speakers_.fit(*unit->twins, now);
    }
    for (LineUnit* unit : fresh_lines)
        speakers_.build_line(*unit, now);
    for (Drive* d : fresh_drives)
        presences_.decide(*d, now);
    tell_options(fresh_lines, fresh_drives, now);
    for (const auto& a : machine_.axes) {
        if (a) publisher_.publish(*a, now);
    }
}

std::shared_ptr<const SiteState> SiteInForce::put(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    machine_.now = machine_.last_stir = std::max(machine_.now, now);
    for (const auto& unit : machine_.lines) {
        if (unit) scans_.end(*unit, ScanReport::State::cancelled, "the site has changed: scan again", now);
    }
    const Site& old = machine_.site->site;
    const Ids ids = ids_in_force();
    const auto gone_axes = take_away(old, KeptParts{old, site}, ids);
    auto state = std::make_shared<SiteState>();
    state->revision = revision;
    const auto fresh_lines = add_lines(site, ids, *state);
    const auto fresh_drives = add_drives(site, ids, memory, *state, now);
    add_axes(site, ids, memory, *state);
    machine_.image.mapping_revision = mapping_revision(site);
    state->site = std::move(site);
    machine_.site = state;
    put_to_work(fresh_lines, fresh_drives, now);
    return machine_.site;
}

/// Reports options that have no effect, once, for new lines and drives. An adapter reports the options that it reads itself.
void SiteInForce::tell_options(std::span<LineUnit* const> lines, std::span<Drive* const> drives, Instant now) {
    for (const OptionFault& f : check_options(machine_.site->site, machine_.families)) {
        const bool fresh = f.drive.empty() ? std::ranges::any_of(lines, [&](const LineUnit* l) { return l->spec.name == f.line; })
                                           : std::ranges::any_of(drives, [&](const Drive* d) { return d->spec.name == f.drive; });
        if (!fresh || f.adapter_says) continue;
        Event e;
        e.severity = Severity::warning;
        e.kind = "setup";
        e.line = f.line;
        e.drive = f.drive;
        e.text = f.text + "; it counts as not given";
        publisher_.event(std::move(e), now);
    }
}

}  // namespace axisgate::engine
