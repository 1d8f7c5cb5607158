// Engine, what others ask: reports of lines and drives, frame logs, the tester's hand, whether all is settled.
// In: questions from the hot thread. Out: copies.
// Never changes an axis; the hand changes a twin alone.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {

// --- what others ask ------------------------------------------------------------------------------------------------

LineReport Engine::line_report(LineId id, Instant now) const {
    LineReport r;
    const LineUnit* u = index_of(id) < lines_.size() ? lines_[index_of(id)].get() : nullptr;
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
            const auto of = std::ranges::find(r.families, s->family.family->name, &LineReport::OfFamily::family);
            if (of != r.families.end()) of->counters += counted;
        }
    }
    return r;
}

DriveStatus Engine::drive_status(DriveId id) const {
    DriveStatus s;
    const Drive* d = drive(id);
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
    return s;
}

std::shared_ptr<const FrameLog> Engine::frame_log(LineId id) const {
    return index_of(id) < lines_.size() && lines_[index_of(id)] ? lines_[index_of(id)]->log : nullptr;
}

Twin* Engine::twin(DriveId id) {
    Drive* d = drive(id);
    return d && d->serving == Presence::twin && d->line->twins ? d->line->twins->bus->twin(id) : nullptr;
}

std::string Engine::set_hand(DriveId id, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin, Instant now) {
    if (tap_) tap_->hand(id, items, origin, now);
    return use_hand(id, items, origin, now);
}

std::string Engine::use_hand(DriveId id, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin, Instant now) {
    Twin* t = twin(id);
    if (!t) return "the drive is not simulated: a hand reaches only a twin";
    const Drive& d = *drive(id);
    const auto offered = t->hand();
    for (const auto& [name, value] : items) {  // names first, so that all or none are set
        const auto it = std::ranges::find(offered, name, &HandItem::name);
        if (it == offered.end() || !it->writable) {
            std::string names;
            for (const auto& h : offered) {
                if (h.writable) names += (names.empty() ? "" : ", ") + h.name;
            }
            return fmt::format("{} cannot be set on this drive; it offers {}", name, names);
        }
    }
    for (const auto& [name, value] : items) {
        const std::string wrong = d.line->twins->bus->set_hand(id, name, value, now);
        d.line->twins->touched();
        if (!wrong.empty()) return wrong;
        Event e;
        e.kind = "hand";
        e.drive = d.spec.name;
        e.text = fmt::format("hand: {} = {}", name, to_text(value));
        e.who = origin.who ? *origin.who : "";
        e.door = std::string(name_of(origin.door));
        event(std::move(e), now);
    }
    return {};
}

bool Engine::settled() const {
    for (const auto& d : drives_) {
        if (!d) continue;
        const Side* real = d->line->real.get();
        const bool served =
            d->serving == Presence::twin ? d->twin_online : (d->serving == Presence::device && (d->device_online || (real && real->tried)));
        if (!served) return false;
        // Whoever is told `ready` commands at once: an axis whose drive answers has also said where it is.
        const bool answers = d->serving == Presence::twin ? d->twin_online : d->device_online;
        if (answers && !std::ranges::all_of(d->axes, [&](AxisId a) { return image_.picture(a).current; })) return false;
    }
    for (const auto& l : lines_) {
        if (l && l->real && !l->real->tried) return false;
    }
    return true;
}

std::vector<std::string> Engine::complaints() const {
    std::vector<std::string> out;
    for (const auto& l : lines_) {
        if (l && l->real && !l->real->up) {
            const bool needed =
                std::ranges::any_of(l->drives, [&](DriveId id) { return drives_[index_of(id)]->spec.presence == PresenceRule::device; });
            if (needed) out.push_back(fmt::format("line {} is down: {}", l->spec.name, l->real->why));
        }
    }
    for (const auto& d : drives_) {
        if (d && ((d->serving == Presence::device && !d->device_online) || (d->serving == Presence::twin && !d->twin_online) ||
                  d->serving == Presence::offline)) {
            out.push_back(fmt::format("drive {} does not answer: {}", d->spec.name, d->why));
        }
    }
    return out;
}

}  // namespace axisgate
