// The queries of Engine: reports of lines and drives, frame logs, readiness. They return copies and change nothing.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"

namespace axisgate {
using engine::Axis, engine::Drive, engine::LineUnit, engine::Side, engine::Speaker;

// --- queries --------------------------------------------------------------------------------------------------------

const Catalogue* Engine::catalogue(AxisId id) const {
    const Axis* a = parts_->machine.axis(id);
    return a ? a->drive->catalogue.get() : nullptr;
}

LineReport Engine::line_report(LineId id, Instant now) const {
    LineReport r;
    const LineUnit* u = parts_->machine.line(id);
    if (!u) return r;
    const Side* main = u->real ? u->real.get() : u->twins.get();
    if (main) r.status = main->line->status(now);
    if (u->twins) {
        r.has_twin_bus = true;
        r.twin_status = u->twins->line->status(now);
    }
    for (const FamilyEntry& f : u->families)
        r.families.push_back({std::string(f.family->name), {}});
    r.scanned = u->scanned_gone;
    for (const Side* side : {u->real.get(), u->twins.get()}) {
        if (!side) continue;
        r.unclaimed += side->unclaimed;
        for (const auto& s : side->speakers) {
            const AdapterCounters all = s->adapter->counters();
            const AdapterCounters scanned = s->scanned_now(all);
            const AdapterCounters counted = Speaker::difference(all, scanned);
            r.scanned += scanned;
            r.counters += counted;
            // Values that several families share are taken from the first one.
            const auto of =
                std::ranges::find_if(u->families, [&](const FamilyEntry& f) { return &serving_family(*f.family) == s->family.family; });
            if (of != u->families.end()) r.families[static_cast<std::size_t>(of - u->families.begin())].counters += counted;
        }
    }
    return r;
}

DriveStatus Engine::drive_status(DriveId id) const {
    DriveStatus s;
    const Drive* d = parts_->machine.drive(id);
    if (!d) return s;
    s.presence = d->serving;
    s.device_online = d->device_online;
    if ((d->serving == Presence::device && !d->device_online) || (d->serving == Presence::twin && !d->twin_online))
        s.presence = Presence::offline;
    s.text = d->why;
    s.simulated = d->serving == Presence::twin;
    const DriveLink& serving = s.simulated ? d->twin_link : d->device_link;
    s.silent_exchanges = serving.silent_exchanges;
    s.retry_pause_ms = milliseconds_of(serving.retry_pause);
    s.watchdog = serving.watchdog;
    s.limits = serving.limits;
    s.beats = serving.beats;
    return s;
}

std::shared_ptr<const FrameLog> Engine::frame_log(LineId id) const {
    const LineUnit* u = parts_->machine.line(id);
    return u ? u->log : nullptr;
}

bool Engine::settled() const {
    for (const auto& d : parts_->machine.drives) {
        if (!d) continue;
        const Side* real = d->line->real.get();
        const bool served =
            d->serving == Presence::twin ? d->twin_online : (d->serving == Presence::device && (d->device_online || (real && real->tried)));
        if (!served) return false;
        // A client may command as soon as it sees `ready`, so an axis counts only when its drive has also reported its position.
        const bool answers = d->serving == Presence::twin ? d->twin_online : d->device_online;
        if (answers && !std::ranges::all_of(d->axes, [&](AxisId a) { return parts_->machine.image.picture(a).current; })) return false;
    }
    for (const auto& l : parts_->machine.lines) {
        if (l && l->real && !l->real->tried) return false;
    }
    return true;
}

std::vector<std::string> Engine::complaints() const {
    std::vector<std::string> out;
    for (const auto& l : parts_->machine.lines) {
        if (l && l->real && !l->real->up) {
            const bool needed = std::ranges::any_of(
                l->drives, [&](DriveId id) { return parts_->machine.drives[index_of(id)]->spec.presence == PresenceRule::device; });
            if (needed) out.push_back(fmt::format("line {} is down: {}", l->spec.name, l->real->why));
        }
    }
    for (const auto& d : parts_->machine.drives) {
        if (d && ((d->serving == Presence::device && !d->device_online) || (d->serving == Presence::twin && !d->twin_online) ||
                  d->serving == Presence::offline)) {
            out.push_back(fmt::format("drive {} does not answer: {}", d->spec.name, d->why));
        }
    }
    return out;
}

}  // namespace axisgate
