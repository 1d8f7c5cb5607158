// Connects twins to their bus, with as many axes as the site uses, stores their memory, and applies the tester's conditions. Unknown names
// are refused before the first condition is set.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/publisher.hpp"
#include "gateway/engine/twins.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::engine {

/// Connects a twin to the line's twin bus, with the channels that the site uses.
void Twins::plug_in(Drive& d, Instant now) {
    LineUnit& unit = *d.line;
    TwinSetup t;
    t.address = d.spec.address;
    for (const AxisId id : d.axes)
        t.axes = std::max(t.axes, machine_.axes[index_of(id)]->spec.channel);
    t.kind = unit.kind;
    t.bit_rate = unit.spec.bitrate;
    t.options = d.spec.options;
    for (const auto& [k, v] : unit.spec.options)
        t.options.emplace(k, v);
    unit.twins->touched();
    unit.twins->bus->add(d.id, make_specimen(*d.family.family, *d.catalogue, t), d.memory, now);
    d.memory_revision = unit.twins->bus->twin(d.id)->non_volatile_revision();
    d.twin_axes = t.axes;
}

/// A channel was configured that the running twin does not have. If it cannot be added while the twin runs, the twin is built anew, as a
/// real drive would be switched off for it.
void Twins::refit(Drive& d, Instant now) {
    LineUnit& unit = *d.line;
    const bool fits = std::ranges::all_of(d.axes, [&](AxisId id) { return machine_.axes[index_of(id)]->spec.channel <= d.twin_axes; });
    if (d.serving != Presence::twin || fits) return;
    int axes = d.twin_axes;
    for (const AxisId id : d.axes)
        axes = std::max(axes, machine_.axes[index_of(id)]->spec.channel);
    Event e;
    e.kind = "presence";
    e.drive = d.spec.name;
    e.line = unit.spec.name;
    if (unit.twins->bus->twin(d.id)->fit_axes(axes, now)) {
        d.twin_axes = axes;
        e.text = fmt::format("drive {}: its twin has {} axes now", d.spec.name, axes);
        return publisher_.event(std::move(e), now);
    }
    d.memory = unit.twins->bus->twin(d.id)->non_volatile();
    unit.twins->bus->remove(d.id);
    plug_in(d, now);
    e.text = fmt::format("drive {}: its twin was started anew with {} axes", d.spec.name, d.twin_axes);
    publisher_.event(std::move(e), now);
}

/// Passes a twin's non-volatile memory to the store if it has changed.
void Twins::save_memory(Drive& d) {
    if (d.serving != Presence::twin || !d.line->twins) return;
    const Twin* t = d.line->twins->bus->twin(d.id);
    if (!t || t->non_volatile_revision() == d.memory_revision) return;
    d.memory_revision = t->non_volatile_revision();
    d.memory = t->non_volatile();
    host_.on_twin_memory(d.spec.name, d.memory);
}

std::string Twins::use_hand(DriveId id, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin, Instant now) {
    Twin* t = of(id);
    if (!t) return "the drive is not simulated: a hand reaches only a twin";
    const Drive& d = *machine_.drive(id);
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
        publisher_.event(std::move(e), now);
    }
    return {};
}

std::string Twins::adopt(DriveId id, NonVolatile memory, const Origin& origin, Instant now) {
    Drive* d = machine_.drive(id);
    if (!d) return "there is no such drive any more";
    if (d->serving == Presence::twin)
        return "the drive is simulated now: its twin adopts values while the real drive serves its axes, and shows them when it is away";
    Event e;
    e.kind = "twin";
    e.drive = d->spec.name;
    e.text = fmt::format("drive {}: its twin has adopted what the drive holds", d->spec.name);
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    d->memory = std::move(memory);
    host_.on_twin_memory(d->spec.name, d->memory);
    publisher_.event(std::move(e), now);
    return {};
}

Twin* Twins::of(DriveId id) const {
    Drive* d = machine_.drive(id);
    return d && d->serving == Presence::twin && d->line->twins ? d->line->twins->bus->twin(id) : nullptr;
}

}  // namespace axisgate::engine
