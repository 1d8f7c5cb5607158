// Engine, presence: lines going up and down, and who serves each drive: the device, its twin, or nobody.
// In: line states, drives' links. Out: presence events, twins that take over and hand back.
// Never hands an axis over while it moves.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"

namespace axisgate {

// --- lines and links ------------------------------------------------------------------------------------------------

void Engine::line_state(Side& side, bool up, const std::string& why, Instant now) {
    const bool changed = side.up != up || !side.tried;
    side.up = up;
    side.tried = true;
    side.why = why;
    if (!changed) return;
    last_stir_ = now;
    if (!side.twin) {
        Event e;
        e.severity = up ? Severity::info : Severity::warning;
        e.kind = "line";
        e.line = side.unit.spec.name;
        e.text =
            up ? fmt::format("line {} is up: {}", side.unit.spec.name, why) : fmt::format("line {} is down: {}", side.unit.spec.name, why);
        event(std::move(e), now);
    }
    for (const auto& s : side.speakers)
        ask(*s, now, [&](Out& out) { s->adapter->on_line(up, now, out); });
    if (!up) {
        for (const DriveId id : side.unit.drives) {
            DriveLink gone;
            gone.drive = id;
            gone.text = fmt::format("line {} is down: {}", side.unit.spec.name, why);
            link(side, gone, now);
        }
    }
}

void Engine::link(Side& side, const DriveLink& l, Instant now) {
    if (is_probe(l.drive)) return scan_link(side, l);
    Drive* d = drive(l.drive);
    if (!d) return;
    bool& online = side.twin ? d->twin_online : d->device_online;
    const bool changed = online != l.online;
    if (changed) last_stir_ = now;
    const bool mine = d->serving == (side.twin ? Presence::twin : Presence::device);
    (side.twin ? d->twin_link : d->device_link) = l;
    if (changed && !l.online && mine) {
        for (const AxisId id : d->axes) {
            Axis& a = *axes_[index_of(id)];
            if (!a.profile.commanded()) continue;
            d->device_lost_while_commanded = !side.twin;
            a.lost_line = at_loss(a);  // nothing can be told to it now: what it does is judged when it has spoken again
        }
    }
    online = l.online;
    if (mine) {
        if (changed) {
            Event e;
            e.severity = l.online ? Severity::info : Severity::warning;
            e.kind = "drive";
            e.drive = d->spec.name;
            e.line = side.unit.spec.name;
            e.text = l.online ? fmt::format("drive {} answers", d->spec.name) : fmt::format("drive {} is silent: {}", d->spec.name, l.text);
            event(std::move(e), now);
        }
        d->why = l.text;
        for (const AxisId id : d->axes) {
            Axis& a = *axes_[index_of(id)];
            if (changed) end_stream(a, Reason::no_answer, l.online ? "the drive answers again" : "the drive does not answer", now);
            a.profile.on_presence(l.online ? d->serving : Presence::offline);
            publish(a, now);
            track(a, now);
        }
    }
    if (changed || !l.online) decide_presence(*d, now);
}

// --- presence -------------------------------------------------------------------------------------------------------

/// Applies the presence rule. The twin takes over only an axis that nobody commands; the device gets it back only at rest.
void Engine::decide_presence(Drive& d, Instant now) {
    const bool line_has_device = d.line->real != nullptr;
    const PresenceRule rule = line_has_device ? d.spec.presence : PresenceRule::twin;
    switch (rule) {
        case PresenceRule::device:
            if (d.serving != Presence::device) serve(d, Presence::device, "the site wants the real drive only", now);
            return;
        case PresenceRule::twin:
            if (d.serving != Presence::twin)
                serve(d, Presence::twin, line_has_device ? "the site wants the embedded model" : "the line has embedded drives alone", now);
            return;
        case PresenceRule::automatic:
            break;
    }
    if (d.serving == Presence::offline) {
        if (d.device_online) {
            serve(d, Presence::device, "the drive answers", now);
        } else if (const Side& real = *d.line->real;
                   (real.tried && !real.up) || d.device_link.silent_exchanges > 0 || now - d.waiting_since >= first_answer_limit) {
            serve(d, Presence::twin, real.up ? "no drive answered" : fmt::format("line {} is down", d.line->spec.name), now);
        }
        return;
    }
    if (d.serving == Presence::device) {
        if (d.device_online) return;
        bool commanded = d.device_lost_while_commanded;
        for (const AxisId id : d.axes)
            commanded = commanded || axes_[index_of(id)]->profile.commanded();
        if (commanded) {
            d.why =
                "it went silent while it was powered, so its twin waits: whether the real drive is off is not known; mend the line or the "
                "drive, or "
                "disable the axis to let the twin take over";
            return;
        }
        serve(d, Presence::twin, "the drive does not answer", now);
        return;
    }
    if (d.device_online && !d.handback) begin_handback(d, now);
    if (!d.device_online) d.handback.reset();
}

void Engine::serve(Drive& d, Presence by, std::string why, Instant now) {
    const Presence before = d.serving;
    LineUnit& unit = *d.line;
    d.handback.reset();
    d.device_lost_while_commanded = false;
    d.serving = by;
    d.why = why;
    for (const AxisId id : d.axes)
        new_source(*axes_[index_of(id)]);  // before it says its first word
    if (by == Presence::twin) {
        if (!unit.twins) {
            unit.twins = std::make_unique<Side>(*this, unit, true);
            const LineSetup setup = setup_for(unit);
            TwinBusOptions bus_options;
            bus_options.kind = unit.kind;
            bus_options.bit_rate = setup.bit_rate;
            bus_options.bits_per_byte = setup.bits_per_byte;
            bus_options.full_duplex = option(unit.spec.options, "full_duplex", "false") == "true";
            bus_options.converter = unit.kind == LineKind::bytes && unit.family.family->uses_can;  // a byte line names its family
            auto bus = std::make_unique<TwinBus>(bus_options);
            unit.twins->bus = bus.get();
            unit.twins->line = std::move(bus);
            sides_.push_back(unit.twins.get());
            fit_speakers(*unit.twins, now);
            unit.twins->line->open(*unit.twins, now);
        }
        plug_in_twin(d, now);
    } else if (before == Presence::twin && unit.twins) {
        d.memory = unit.twins->bus->twin(d.id)->non_volatile();
        unit.twins->bus->remove(d.id);
        d.twin_online = false;
    }
    if (unit.twins) configure_side(*unit.twins, now);
    const bool online = by == Presence::twin ? d.twin_online : d.device_online;
    for (const AxisId id : d.axes) {
        Axis& a = *axes_[index_of(id)];
        end_stream(a, Reason::interrupted, by == Presence::twin ? "the twin takes over" : "the device takes over", now);
        a.profile.on_presence(Presence::offline);
        if (online) a.profile.on_presence(by);
        a.stale = true;
        a.was_fault = false;
        publish(a, now);
        track(a, now);
    }
    Event e;
    e.severity = by == Presence::twin && before != Presence::offline ? Severity::warning : Severity::info;
    e.kind = "presence";
    e.new_value = by == Presence::twin ? "twin" : "device";
    e.drive = d.spec.name;
    e.line = unit.spec.name;
    e.text = fmt::format("drive {}: {} ({})", d.spec.name, by == Presence::twin ? "simulated by its twin" : "the real drive serves", why);
    event(std::move(e), now);
}

/// On the line's bus of twins, with the channels that the site uses.
void Engine::plug_in_twin(Drive& d, Instant now) {
    LineUnit& unit = *d.line;
    TwinSetup t;
    t.address = d.spec.address;
    for (const AxisId id : d.axes)
        t.axes = std::max(t.axes, axes_[index_of(id)]->spec.channel);
    t.kind = unit.kind;
    t.bit_rate = unit.spec.bitrate;
    t.options = d.spec.options;
    for (const auto& [k, v] : unit.spec.options)
        t.options.emplace(k, v);
    unit.twins->touched();
    unit.twins->bus->add(d.id, d.family.family->make_twin(*d.catalogue, t), d.memory, now);
    d.memory_revision = unit.twins->bus->twin(d.id)->non_volatile_revision();
    d.twin_axes = t.axes;
}

/// A channel was configured that the running twin does not have. Where it cannot be fitted as it runs, the twin is built anew, as a real
/// drive would be switched off for it.
void Engine::refit_twin(Drive& d, Instant now) {
    LineUnit& unit = *d.line;
    const bool fits = std::ranges::all_of(d.axes, [&](AxisId id) { return axes_[index_of(id)]->spec.channel <= d.twin_axes; });
    if (d.serving != Presence::twin || fits) return;
    int axes = d.twin_axes;
    for (const AxisId id : d.axes)
        axes = std::max(axes, axes_[index_of(id)]->spec.channel);
    Event e;
    e.kind = "presence";
    e.drive = d.spec.name;
    e.line = unit.spec.name;
    if (unit.twins->bus->twin(d.id)->fit_axes(axes, now)) {
        d.twin_axes = axes;
        e.text = fmt::format("drive {}: its twin has {} axes now", d.spec.name, axes);
        return event(std::move(e), now);
    }
    d.memory = unit.twins->bus->twin(d.id)->non_volatile();
    unit.twins->bus->remove(d.id);
    plug_in_twin(d, now);
    e.text = fmt::format("drive {}: its twin was started anew with {} axes", d.spec.name, d.twin_axes);
    event(std::move(e), now);
}

void Engine::begin_handback(Drive& d, Instant now) {
    d.handback = std::make_unique<Drive::Handback>();
    Speaker& by = speaker_of(*d.line->real, d);
    struct Wanted {
        AxisId axis;
        Point point;
    };
    std::vector<Wanted> wanted;
    for (const AxisId id : d.axes) {
        const Axis& a = *axes_[index_of(id)];
        for (const auto& [point, value] : a.stored) {
            const Parameter* p = d.catalogue->parameter(point);
            if (p && p->readable()) wanted.push_back({id, point});
        }
    }
    d.handback->waiting = wanted.size();
    for (const auto& w : wanted) {
        const Ticket ticket = make_ticket(engine_itself, next_++);
        OrderRecord record;
        record.axis = w.axis;
        record.body = ReadParameter{w.point};
        record.handback = d.id;
        record.given_at = now;
        orders_.emplace(ticket, std::move(record));
        Command c;
        c.ticket = ticket;
        c.axis = w.axis;
        c.body = ReadParameter{w.point};
        ask(by, now, [&](Out& out) { by.adapter->on_command(c, now, out); });
        if (!d.handback) return;
    }
}

bool Engine::handback_result(const Result& r, Instant) {
    const auto it = orders_.find(r.ticket);
    if (it == orders_.end()) return false;
    const OrderRecord record = std::move(it->second);
    orders_.erase(it);
    Drive* d = drive(record.handback);
    Axis* a = axis(record.axis);
    if (!d || !a || !d->handback) return true;
    auto& h = *d->handback;
    if (h.waiting > 0) --h.waiting;
    const Point point = std::get<ReadParameter>(record.body).point;
    const std::string id = d->catalogue->id_of(point);
    if (!good(r)) {
        ++h.unread;
        h.differences.push_back(fmt::format("{} of axis {} could not be read: {}", id, a->spec.name, r.text));
        return true;
    }
    ++h.compared;
    const Value& wanted = a->stored[point];
    const auto x = as_number(wanted), y = as_number(r.value);
    const bool same = x && y ? *x == *y : wanted == r.value;
    if (!same)
        h.differences.push_back(fmt::format("{} of axis {}: stored {}, drive {}", id, a->spec.name, to_text(wanted), to_text(r.value)));
    return true;
}

}  // namespace axisgate
