// The site in force: what goes, what comes or changes, and how it is put to work.
// In: the wanted site and what is remembered of its drives. Out: the machine as the site wants it; what is told of removed axes and
// options. Never gives an id to another name.
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
#include "gateway/site/site_stage.hpp"

namespace axisgate::engine {

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

std::shared_ptr<const SiteState> SiteInForce::put(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    machine_.now = machine_.last_stir = std::max(machine_.now, now);
    for (const auto& unit : machine_.lines) {
        if (unit) scans_.end(*unit, ScanReport::State::cancelled, "the site has changed: scan again", now);
    }
    const Site& old = machine_.site->site;
    const KeptParts kept{old, site};

    // 1. what goes: axes, then drives, then lines. Their ids stay theirs if the name comes back.
    std::map<std::string, LineId> line_ids;
    std::map<std::string, DriveId> drive_ids;
    std::map<std::string, AxisId> axis_ids;
    for (std::size_t i = 0; i < old.lines.size(); ++i)
        line_ids[old.lines[i].name] = machine_.site->line_ids[i];
    for (std::size_t i = 0; i < old.drives.size(); ++i)
        drive_ids[old.drives[i].name] = machine_.site->drive_ids[i];
    for (std::size_t i = 0; i < old.axes.size(); ++i)
        axis_ids[old.axes[i].name] = machine_.site->axis_ids[i];

    std::vector<std::unique_ptr<Axis>> gone_axes;
    for (const auto& a : old.axes) {
        if (kept.axis(a)) continue;
        auto& slot = machine_.axes[index_of(axis_ids[a.name])];
        drop_axis(*slot, "it was removed or changed in the site");
        std::erase(slot->drive->axes, slot->id);
        gone_axes.push_back(std::move(slot));
    }
    for (const auto& d : old.drives) {
        if (kept.drive(d)) continue;
        auto& slot = machine_.drives[index_of(drive_ids[d.name])];
        LineUnit& unit = *slot->line;
        if (slot->serving == Presence::twin && unit.twins) unit.twins->bus->remove(slot->id);
        std::erase(unit.drives, slot->id);
        slot.reset();
    }
    for (const auto& l : old.lines) {
        if (kept.line(l)) continue;
        auto& slot = machine_.lines[index_of(line_ids[l.name])];
        for (Side* s : {slot->real.get(), slot->twins.get()}) {
            if (!s) continue;
            s->line->close();
            machine_.sides.remove(*s);
        }
        slot.reset();
    }

    // 2. what comes or changes.
    auto state = std::make_shared<SiteState>();
    state->revision = revision;
    std::vector<LineUnit*> fresh_lines;
    for (const auto& l : site.lines) {
        const auto known = line_ids.find(l.name);
        const LineId id = known != line_ids.end() ? known->second : LineId{static_cast<std::uint16_t>(machine_.lines.size())};
        if (known == line_ids.end()) machine_.lines.emplace_back();
        auto& slot = machine_.lines[index_of(id)];
        if (!slot) {
            slot = std::make_unique<LineUnit>();
            slot->id = id;
            slot->spec = l;
            slot->family = machine_.families.find(l.family);
            fresh_lines.push_back(slot.get());
        }
        slot->families.clear();
        for (const auto& name : site.families_on(l))
            slot->families.push_back(machine_.families.find(name));
        state->line_ids.push_back(id);
    }
    std::vector<Drive*> fresh_drives;
    for (const auto& d : site.drives) {
        const auto known = drive_ids.find(d.name);
        const DriveId id = known != drive_ids.end() ? known->second : DriveId{static_cast<std::uint16_t>(machine_.drives.size())};
        if (known == drive_ids.end()) machine_.drives.emplace_back();
        auto& slot = machine_.drives[index_of(id)];
        if (!slot) {
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
            fresh_drives.push_back(slot.get());
        }
        state->drive_ids.push_back(id);
    }
    std::vector<AxisId> by_number;
    std::vector<LineUnit*> changed_lines;
    for (const auto& a : site.axes) {
        const auto known = axis_ids.find(a.name);
        const AxisId id = known != axis_ids.end() ? known->second : AxisId{static_cast<std::uint16_t>(machine_.axes.size())};
        if (known == axis_ids.end()) machine_.axes.emplace_back();
        (void)machine_.image.grow(machine_.axes.size());
        auto& slot = machine_.axes[index_of(id)];
        if (!slot) {
            slot = std::make_unique<Axis>();
            slot->id = id;
            for (const auto& d : machine_.drives) {
                if (d && d->spec.name == a.drive) slot->drive = d.get();
            }
            slot->drive->axes.push_back(id);
            publisher_.new_source(*slot);
            changed_lines.push_back(slot->drive->line);
            if (slot->drive->serving != Presence::offline) slot->profile.on_presence(slot->drive->serving);
            if (const auto m = memory.stored.find(a.name); m != memory.stored.end()) {
                for (const auto& [parameter, value] : m->second) {
                    if (const auto point = slot->drive->catalogue->find(parameter)) slot->stored[*point] = value;
                }
            }
        }
        slot->leaving_until = {};
        slot->spec = a;  // number, unit, scale and limits change without disturbing anything
        slot->limits = AxisLimits::of(a);
        state->axis_ids.push_back(id);
        if (static_cast<std::size_t>(a.number) >= by_number.size()) by_number.resize(static_cast<std::size_t>(a.number) + 1, no_axis);
        by_number[static_cast<std::size_t>(a.number)] = id;
    }
    machine_.image.set_numbers(std::move(by_number));
    machine_.image.mapping_revision = mapping_revision(site);
    state->site = std::move(site);
    machine_.site = state;

    // 3. put it to work. Adapters of lines that stay are told the new set of drives; fresh lines are opened.
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
    return machine_.site;
}

/// Options that nobody reads as they stand: said once, of what is new. What an adapter reads it complains of itself.
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
