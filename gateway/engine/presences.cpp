// The presence rule: which side serves a drive, and the comparison of parameters before a device gets its axes back. A twin never takes
// over an axis whose device fell silent while the axis was commanded.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/motions.hpp"
#include "gateway/engine/presences.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/routing.hpp"
#include "gateway/engine/scans.hpp"
#include "gateway/engine/speakers.hpp"
#include "gateway/engine/streams.hpp"
#include "gateway/engine/twins.hpp"

namespace axisgate::engine {

void Presences::end_handback(Drive& d, Instant now) {
    if (!d.handback || d.handback->waiting != 0 || !d.device_online) return;
    if (!std::ranges::all_of(d.axes, [&](AxisId id) { return machine_.axes[index_of(id)]->profile.at_rest(); })) return;
    auto h = std::move(d.handback);
    serve(d, Presence::device, fmt::format("the drive is back; {} parameters compared, {} differ", h->compared, h->differences.size()),
          now);
    for (const auto& text : h->differences) {
        Event e;
        e.severity = Severity::warning;
        e.kind = "parameters_differ";
        e.drive = d.spec.name;
        e.text = text;
        publisher_.event(std::move(e), now);
    }
}

void Presences::line_state(Side& side, bool up, const std::string& why, Instant now) {
    const bool changed = side.up != up || !side.tried;
    side.up = up;
    side.tried = true;
    side.why = why;
    if (!changed) return;
    machine_.last_stir = now;
    if (!side.twin) {
        Event e;
        e.severity = up ? Severity::info : Severity::warning;
        e.kind = "line";
        e.line = side.unit.spec.name;
        e.text =
            up ? fmt::format("line {} is up: {}", side.unit.spec.name, why) : fmt::format("line {} is down: {}", side.unit.spec.name, why);
        publisher_.event(std::move(e), now);
    }
    for (const auto& s : side.speakers)
        routing_.ask(*s, now, [&](Out& out) { s->adapter->on_line(up, now, out); });
    if (!up) {
        for (const DriveId id : side.unit.drives) {
            DriveLink gone;
            gone.drive = id;
            gone.text = fmt::format("line {} is down: {}", side.unit.spec.name, why);
            link(side, gone, now);
        }
    }
}

void Presences::link(Side& side, const DriveLink& l, Instant now) {
    if (Scans::is_probe(l.drive)) return Scans::answered(side, l);
    Drive* d = machine_.drive(l.drive);
    if (!d) return;
    bool& online = side.twin ? d->twin_online : d->device_online;
    const bool changed = online != l.online;
    if (changed) machine_.last_stir = now;
    const bool mine = d->serving == (side.twin ? Presence::twin : Presence::device);
    (side.twin ? d->twin_link : d->device_link) = l;
    if (changed && !l.online && mine) {
        for (const AxisId id : d->axes) {
            Axis& a = *machine_.axes[index_of(id)];
            if (!a.profile.commanded() && !a.motion.runs()) continue;
            d->device_lost_while_commanded = !side.twin;
            a.lost_line = LossOfCommand::at_loss(a);  // no order can reach it now; its motion is judged when it reports again
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
            publisher_.event(std::move(e), now);
        }
        d->why = l.text;
        for (const AxisId id : d->axes) {
            Axis& a = *machine_.axes[index_of(id)];
            if (changed) streams_.end(a, Reason::no_answer, l.online ? "the drive answers again" : "the drive does not answer", now);
            a.profile.on_presence(l.online ? d->serving : Presence::offline);
            publisher_.publish(a, now);
            clients_.track(a, now);
        }
    }
    if (changed || !l.online) decide(*d, now);
}

/// Applies the presence rule: the twin takes over only an axis that no client commands, and the device gets it back only at rest.
void Presences::decide(Drive& d, Instant now) {
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
            commanded = commanded || machine_.axes[index_of(id)]->profile.commanded();
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

void Presences::serve(Drive& d, Presence by, std::string why, Instant now) {
    const Presence before = d.serving;
    LineUnit& unit = *d.line;
    d.handback.reset();
    d.device_lost_while_commanded = false;
    d.serving = by;
    d.why = why;
    for (const AxisId id : d.axes)
        publisher_.new_source(*machine_.axes[index_of(id)]);  // before its first feedback
    if (by == Presence::twin) {
        if (!unit.twins) {
            unit.twins = std::make_unique<Side>(routing_, unit, true);
            const LineSetup setup = speakers_.setup_for(unit);
            TwinBusOptions bus_options;
            bus_options.kind = unit.kind;
            bus_options.bit_rate = setup.bit_rate;
            bus_options.bits_per_byte = setup.bits_per_byte;
            bus_options.full_duplex = option(unit.spec.options, "full_duplex", "false") == "true";
            bus_options.converter = unit.kind == LineKind::bytes && unit.family.family->uses_can;  // a byte line names its family
            auto bus = std::make_unique<TwinBus>(bus_options);
            unit.twins->bus = bus.get();
            unit.twins->line = std::move(bus);
            machine_.sides.add(*unit.twins);
            speakers_.fit(*unit.twins, now);
            unit.twins->line->open(*unit.twins, now);
        }
        twins_.plug_in(d, now);
    } else if (before == Presence::twin && unit.twins) {
        d.memory = unit.twins->bus->twin(d.id)->non_volatile();
        unit.twins->bus->remove(d.id);
        d.twin_online = false;
    }
    if (unit.twins) speakers_.configure_side(*unit.twins, now);
    const bool online = by == Presence::twin ? d.twin_online : d.device_online;
    for (const AxisId id : d.axes) {
        Axis& a = *machine_.axes[index_of(id)];
        streams_.end(a, Reason::interrupted, by == Presence::twin ? "the twin takes over" : "the device takes over", now);
        a.profile.on_presence(Presence::offline);
        if (online) a.profile.on_presence(by);
        motions_.forget(a);
        a.stale = true;
        a.was_fault = a.was_safe_stop = false;
        publisher_.publish(a, now);
        clients_.track(a, now);
    }
    Event e;
    e.severity = by == Presence::twin && before != Presence::offline ? Severity::warning : Severity::info;
    e.kind = "presence";
    e.new_value = by == Presence::twin ? "twin" : "device";
    e.drive = d.spec.name;
    e.line = unit.spec.name;
    e.text = fmt::format("drive {}: {} ({})", d.spec.name, by == Presence::twin ? "simulated by its twin" : "the real drive serves", why);
    publisher_.event(std::move(e), now);
}

void Presences::begin_handback(Drive& d, Instant now) {
    d.handback = std::make_unique<Drive::Handback>();
    Speaker& by = Machine::speaker_of(*d.line->real, d);
    struct Wanted {
        AxisId axis;
        Point point;
    };
    std::vector<Wanted> wanted;
    for (const AxisId id : d.axes) {
        const Axis& a = *machine_.axes[index_of(id)];
        for (const auto& [point, value] : a.stored) {
            const Parameter* p = d.catalogue->parameter(point);
            if (p && p->readable()) wanted.push_back({id, point});
        }
    }
    d.handback->waiting = wanted.size();
    for (const auto& w : wanted) {
        const Ticket ticket = make_ticket(engine_itself, pending_.next++);
        OrderRecord record;
        record.axis = w.axis;
        record.body = ReadParameter{w.point};
        record.handback = d.id;
        pending_.orders.emplace(ticket, std::move(record));
        Command c;
        c.ticket = ticket;
        c.axis = w.axis;
        c.body = ReadParameter{w.point};
        routing_.ask(by, now, [&](Out& out) { by.adapter->on_command(c, now, out); });
        if (!d.handback) return;
    }
}

void Presences::handback_result(const Result& r) {
    const auto it = pending_.orders.find(r.ticket);
    if (it == pending_.orders.end()) return;
    const OrderRecord record = std::move(it->second);
    pending_.orders.erase(it);
    Drive* d = machine_.drive(record.handback);
    Axis* a = machine_.axis(record.axis);
    if (!d || !a || !d->handback) return;
    auto& h = *d->handback;
    if (h.waiting > 0) --h.waiting;
    const Point point = std::get<ReadParameter>(record.body).point;
    const std::string id = d->catalogue->id_of(point);
    if (!good(r)) {
        ++h.unread;
        h.differences.push_back(fmt::format("{} of axis {} could not be read: {}", id, a->spec.name, r.text));
        return;
    }
    ++h.compared;
    const Value& wanted = a->stored[point];
    const auto x = as_number(wanted), y = as_number(r.value);
    const bool same = x && y ? *x == *y : wanted == r.value;
    if (!same)
        h.differences.push_back(fmt::format("{} of axis {}: stored {}, drive {}", id, a->spec.name, to_text(wanted), to_text(r.value)));
}

}  // namespace axisgate::engine
