// Engine, part three: the site in force, lines going up and down, and who serves each drive: the device, its twin, or nobody.
// In: the wanted site, line states, drives' links. Out: adapters configured, twins made and removed, presence events.
// Never disturbs what did not change, and never hands an axis over while it moves.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/core/engine.hpp"
#include "gateway/core/engine_parts.hpp"
#include "gateway/core/line_uri.hpp"

namespace axisgate {
namespace {
Duration stale_limit(const LineSpec& spec, LineKind kind) {
    if (spec.manners.stale_after > Duration::zero()) return spec.manners.stale_after;
    return kind == LineKind::can ? std::chrono::seconds(1) : std::chrono::seconds(3);
}
}  // namespace

// --- the site -------------------------------------------------------------------------------------------------------

LineSetup Engine::setup_for(const LineUnit& unit, const Side& side) const {
    LineSetup s;
    s.id = unit.id;
    s.name = unit.spec.name;
    s.kind = unit.kind;
    s.manners = unit.spec.manners;
    s.options = unit.spec.options;
    s.bit_rate = unit.spec.bitrate;
    const Family& family = *unit.family.family;
    if (const auto uri = parse_line_uri(unit.spec.uri, family.default_bit_rate, family.default_format); uri.good()) {
        if (uri.uri.kind == LineUri::Kind::serial || (uri.uri.kind == LineUri::Kind::pty && uri.uri.serial.baud != 0)) {
            s.bit_rate = uri.uri.serial.baud;
            s.bits_per_byte = static_cast<std::uint8_t>(uri.uri.serial.format.bits_per_byte());
        } else if (uri.uri.kind == LineUri::Kind::twin) {
            if (const auto format = parse_serial_format(family.default_format)) s.bits_per_byte = format->bits_per_byte();
            if (s.bit_rate == 0) s.bit_rate = unit.kind == LineKind::can ? family.default_can_bit_rate : family.default_bit_rate;
        }
    }
    for (const DriveId id : unit.drives) {
        const Drive& d = *drives_[index_of(id)];
        const bool here = side.twin ? d.serving == Presence::twin : d.spec.presence != PresenceRule::twin;
        if (!here) continue;
        DriveSetup ds;
        ds.id = id;
        ds.name = d.spec.name;
        ds.address = d.spec.address;
        ds.options = d.spec.options;
        for (const AxisId a : d.axes) ds.axes.push_back({a, axes_[index_of(a)]->spec.channel});
        s.drives.push_back(std::move(ds));
    }
    s.drives.insert(s.drives.end(), side.probes.begin(), side.probes.end());
    return s;
}

void Engine::configure_side(Side& side, Instant now) {
    Out out = take_out();
    side.adapter->configure(setup_for(side.unit, side), now, out);
    drain(side, out, now);
    give_back(std::move(out));
}

/// Makes the sides that a new line needs and opens the real one. The twins' side is made when the first drive is simulated.
void Engine::build_line(LineUnit& unit, Instant now) {
    const Family& family = *unit.family.family;
    const auto uri = parse_line_uri(unit.spec.uri, family.default_bit_rate, family.default_format);
    const bool only_twins = uri.good() && uri.uri.kind == LineUri::Kind::twin;
    unit.kind = only_twins ? (family.uses_can ? LineKind::can : LineKind::bytes)
                           : (uri.uri.kind == LineUri::Kind::can ? LineKind::can : LineKind::bytes);
    if (only_twins && option(unit.spec.options, "kind", "") == "bytes" && family.uses_bytes) unit.kind = LineKind::bytes;
    unit.stale_after = stale_limit(unit.spec, unit.kind);
    unit.log = std::make_shared<FrameLog>(trace_frames_);
    if (only_twins) return;
    unit.real = std::make_unique<Side>(*this, unit, false);
    unit.real->adapter = family.make_adapter(*unit.family.catalogue, unit.kind);
    unit.real->line = host_.make_line(unit.spec, setup_for(unit, *unit.real));
    sides_.push_back(unit.real.get());
    configure_side(*unit.real, now);
    unit.real->line->open(*unit.real, now);
    unit.real->touched();
}

void Engine::drop_axis(Axis& a, std::string_view why, Instant now) {
    const auto waiting = a.clients;
    for (const auto number : waiting) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::line_down;
        r.text = fmt::format("axis {}: {}", a.spec.name, why);
        finish(number, std::move(r), now);
    }
    std::erase_if(orders_, [&](const auto& entry) { return entry.second.axis == a.id; });
    image_.picture(a.id) = AxisPicture{};
    image_.publish(a.id);
}

std::shared_ptr<const SiteState> Engine::apply_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    now_ = std::max(now_, now);
    for (const auto& unit : lines_) {
        if (unit) end_scan(*unit, ScanReport::State::cancelled, "the site has changed: scan again", now);
    }
    const Site& old = site_->site;
    const auto line_stays = [&](const LineSpec& l) {
        const LineSpec* n = site.line(l.name);
        return n && *n == l;
    };
    const auto drive_stays = [&](const DriveSpec& d) {
        const DriveSpec* n = site.drive(d.name);
        const LineSpec* l = old.line(d.line);
        return n && *n == d && l && line_stays(*l);
    };
    const auto axis_stays = [&](const AxisSpec& a) {
        const AxisSpec* n = site.axis(a.name);
        const DriveSpec* d = old.drive(a.drive);
        return n && n->drive == a.drive && n->channel == a.channel && d && drive_stays(*d);
    };

    // 1. what goes: axes, then drives, then lines. Their ids stay theirs if the name comes back.
    std::map<std::string, LineId> line_ids;
    std::map<std::string, DriveId> drive_ids;
    std::map<std::string, AxisId> axis_ids;
    for (std::size_t i = 0; i < old.lines.size(); ++i) line_ids[old.lines[i].name] = site_->line_ids[i];
    for (std::size_t i = 0; i < old.drives.size(); ++i) drive_ids[old.drives[i].name] = site_->drive_ids[i];
    for (std::size_t i = 0; i < old.axes.size(); ++i) axis_ids[old.axes[i].name] = site_->axis_ids[i];

    std::vector<std::unique_ptr<Axis>> gone_axes;
    for (const auto& a : old.axes) {
        if (axis_stays(a)) continue;
        auto& slot = axes_[index_of(axis_ids[a.name])];
        drop_axis(*slot, "it was removed or changed in the site", now);
        std::erase(slot->drive->axes, slot->id);
        gone_axes.push_back(std::move(slot));
    }
    for (const auto& d : old.drives) {
        if (drive_stays(d)) continue;
        auto& slot = drives_[index_of(drive_ids[d.name])];
        LineUnit& unit = *slot->line;
        if (slot->serving == Presence::twin && unit.twins) unit.twins->bus->remove(slot->id);
        std::erase(unit.drives, slot->id);
        slot.reset();
    }
    for (const auto& l : old.lines) {
        if (line_stays(l)) continue;
        auto& slot = lines_[index_of(line_ids[l.name])];
        for (Side* s : {slot->real.get(), slot->twins.get()}) {
            if (!s) continue;
            s->line->close();
            std::erase(sides_, s);
        }
        slot.reset();
    }

    // 2. what comes or changes.
    auto state = std::make_shared<SiteState>();
    state->revision = revision;
    std::vector<LineUnit*> fresh_lines;
    for (const auto& l : site.lines) {
        const auto known = line_ids.find(l.name);
        const LineId id = known != line_ids.end() ? known->second : LineId{static_cast<std::uint16_t>(lines_.size())};
        if (known == line_ids.end()) lines_.emplace_back();
        auto& slot = lines_[index_of(id)];
        if (!slot) {
            slot = std::make_unique<LineUnit>();
            slot->id = id;
            slot->spec = l;
            slot->family = families_.find(l.family);
            fresh_lines.push_back(slot.get());
        }
        state->line_ids.push_back(id);
    }
    std::vector<Drive*> fresh_drives;
    for (const auto& d : site.drives) {
        const auto known = drive_ids.find(d.name);
        const DriveId id = known != drive_ids.end() ? known->second : DriveId{static_cast<std::uint16_t>(drives_.size())};
        if (known == drive_ids.end()) drives_.emplace_back();
        auto& slot = drives_[index_of(id)];
        if (!slot) {
            slot = std::make_unique<Drive>();
            slot->id = id;
            slot->spec = d;
            slot->waiting_since = now;
            slot->device_link.drive = id;
            for (const auto& unit : lines_) {
                if (unit && unit->spec.name == d.line) slot->line = unit.get();
            }
            slot->line->drives.push_back(id);
            if (const auto m = memory.twins.find(d.name); m != memory.twins.end()) slot->memory = m->second;
            fresh_drives.push_back(slot.get());
        }
        state->drive_ids.push_back(id);
    }
    std::vector<AxisId> by_number;
    std::vector<LineUnit*> changed_lines;
    for (const auto& a : site.axes) {
        const auto known = axis_ids.find(a.name);
        const AxisId id = known != axis_ids.end() ? known->second : AxisId{static_cast<std::uint16_t>(axes_.size())};
        if (known == axis_ids.end()) axes_.emplace_back();
        (void)image_.grow(axes_.size());
        auto& slot = axes_[index_of(id)];
        if (!slot) {
            slot = std::make_unique<Axis>();
            slot->id = id;
            for (const auto& d : drives_) {
                if (d && d->spec.name == a.drive) slot->drive = d.get();
            }
            slot->drive->axes.push_back(id);
            changed_lines.push_back(slot->drive->line);
            if (slot->drive->serving != Presence::offline) slot->profile.on_presence(slot->drive->serving);
            if (const auto m = memory.stored.find(a.name); m != memory.stored.end()) {
                for (const auto& [parameter, value] : m->second) {
                    if (const auto point = slot->drive->line->family.catalogue->find(parameter)) slot->stored[*point] = value;
                }
            }
        }
        slot->spec = a;  // number, unit, scale and limits change without disturbing anything
        slot->limits = AxisLimits::of(a);
        state->axis_ids.push_back(id);
        if (static_cast<std::size_t>(a.number) >= by_number.size()) by_number.resize(static_cast<std::size_t>(a.number) + 1, no_axis);
        by_number[static_cast<std::size_t>(a.number)] = id;
    }
    image_.set_numbers(std::move(by_number));
    image_.mapping_revision = mapping_revision(site);
    state->site = std::move(site);
    site_ = state;

    // 3. put it to work. Adapters of lines that stay are told the new set of drives; fresh lines are opened.
    for (const auto& unit : lines_) {
        if (!unit || std::ranges::find(fresh_lines, unit.get()) != fresh_lines.end()) continue;
        if (unit->real) configure_side(*unit->real, now);
        if (unit->twins) configure_side(*unit->twins, now);
    }
    for (LineUnit* unit : fresh_lines) build_line(*unit, now);
    for (Drive* d : fresh_drives) decide_presence(*d, now);
    for (const auto& a : axes_) {
        if (a) publish(*a, now);
    }
    return site_;
}

// --- lines and links ------------------------------------------------------------------------------------------------

void Engine::line_state(Side& side, bool up, const std::string& why, Instant now) {
    const bool changed = side.up != up || !side.tried;
    side.up = up;
    side.tried = true;
    side.why = why;
    if (!changed) return;
    if (!side.twin) {
        Event e;
        e.severity = up ? Severity::info : Severity::warning;
        e.kind = "line";
        e.line = side.unit.spec.name;
        e.text = up ? fmt::format("line {} is up: {}", side.unit.spec.name, why) : fmt::format("line {} is down: {}", side.unit.spec.name, why);
        event(std::move(e), now);
    }
    Out out = take_out();
    side.adapter->on_line(up, now, out);
    drain(side, out, now);
    give_back(std::move(out));
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
    const bool mine = d->serving == (side.twin ? Presence::twin : Presence::device);
    if (!side.twin) d->device_link = l;
    if (changed && !l.online && mine) {
        for (const AxisId id : d->axes) {
            if (axes_[index_of(id)]->profile.commanded()) d->device_lost_while_commanded = !side.twin;
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
            if (d.serving != Presence::twin) serve(d, Presence::twin, line_has_device ? "the site wants the embedded model" : "the line has embedded drives alone", now);
            return;
        case PresenceRule::automatic: break;
    }
    if (d.serving == Presence::offline) {
        if (d.device_online) {
            serve(d, Presence::device, "the drive answers", now);
        } else if (const Side& real = *d.line->real; (real.tried && !real.up) || d.device_link.silent_exchanges > 0 || now - d.waiting_since >= first_answer_limit) {
            serve(d, Presence::twin, real.up ? "no drive answered" : fmt::format("line {} is down", d.line->spec.name), now);
        }
        return;
    }
    if (d.serving == Presence::device) {
        if (d.device_online) return;
        bool commanded = d.device_lost_while_commanded;
        for (const AxisId id : d.axes) commanded = commanded || axes_[index_of(id)]->profile.commanded();
        if (commanded) {
            d.why = "the drive went silent while it was commanded; the twin takes over after a disable";
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
    if (by == Presence::twin) {
        if (!unit.twins) {
            unit.twins = std::make_unique<Side>(*this, unit, true);
            unit.twins->adapter = unit.family.family->make_adapter(*unit.family.catalogue, unit.kind);
            const LineSetup setup = setup_for(unit, *unit.twins);
            TwinBusOptions bus_options;
            bus_options.kind = unit.kind;
            bus_options.bit_rate = setup.bit_rate;
            bus_options.bits_per_byte = setup.bits_per_byte;
            bus_options.full_duplex = option(unit.spec.options, "full_duplex", "false") == "true";
            auto bus = std::make_unique<TwinBus>(bus_options);
            unit.twins->bus = bus.get();
            unit.twins->line = std::move(bus);
            sides_.push_back(unit.twins.get());
            configure_side(*unit.twins, now);
            unit.twins->line->open(*unit.twins, now);
        }
        TwinSetup t;
        t.address = d.spec.address;
        for (const AxisId id : d.axes) t.axes = std::max(t.axes, axes_[index_of(id)]->spec.channel);
        t.kind = unit.kind;
        t.bit_rate = unit.spec.bitrate;
        t.options = d.spec.options;
        for (const auto& [k, v] : unit.spec.options) t.options.emplace(k, v);
        unit.twins->touched();
        unit.twins->bus->add(d.id, unit.family.family->make_twin(*unit.family.catalogue, t), d.memory, now);
        d.memory_revision = unit.twins->bus->twin(d.id)->non_volatile_revision();
    } else if (before == Presence::twin && unit.twins) {
        d.memory = unit.twins->bus->twin(d.id)->non_volatile();
        unit.twins->bus->remove(d.id);
        d.twin_online = false;
    }
    if (unit.twins) configure_side(*unit.twins, now);
    const bool online = by == Presence::twin ? d.twin_online : d.device_online;
    for (const AxisId id : d.axes) {
        Axis& a = *axes_[index_of(id)];
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

void Engine::begin_handback(Drive& d, Instant now) {
    d.handback = std::make_unique<Drive::Handback>();
    Side& real = *d.line->real;
    struct Wanted {
        AxisId axis;
        Point point;
    };
    std::vector<Wanted> wanted;
    for (const AxisId id : d.axes) {
        const Axis& a = *axes_[index_of(id)];
        for (const auto& [point, value] : a.stored) {
            const Parameter* p = d.line->family.catalogue->parameter(point);
            if (p && p->readable()) wanted.push_back({id, point});
        }
    }
    d.handback->waiting = wanted.size();
    for (const auto& w : wanted) {
        const Ticket ticket = make_ticket(Door::internal, next_++);
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
        Out out = take_out();
        real.adapter->on_command(c, now, out);
        drain(real, out, now);
        give_back(std::move(out));
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
    const std::string id = d->line->family.catalogue->id_of(point);
    if (!good(r)) {
        ++h.unread;
        h.differences.push_back(fmt::format("{} of axis {} could not be read: {}", id, a->spec.name, r.text));
        return true;
    }
    ++h.compared;
    const Value& wanted = a->stored[point];
    const auto x = as_number(wanted), y = as_number(r.value);
    const bool same = x && y ? *x == *y : wanted == r.value;
    if (!same) h.differences.push_back(fmt::format("{} of axis {}: stored {}, drive {}", id, a->spec.name, to_text(wanted), to_text(r.value)));
    return true;
}

// --- time -----------------------------------------------------------------------------------------------------------

Instant Engine::deadline() const {
    Instant t = lines_.empty() ? never : next_housekeeping_;
    for (Side* s : sides_)
        t = std::min(t, s->deadline());
    return t;
}

void Engine::on_deadline(Instant now) {
    now_ = std::max(now_, now);
    // Bounded: a side that is due again at once gets its next turn with the next call.
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        Side& s = *sides_[i];
        if (s.deadline() > now) continue;
        s.touched();
        if (s.line->deadline() <= now) s.line->on_deadline(now);
        if (s.adapter->deadline() <= now) {
            Out out = take_out();
            s.adapter->on_deadline(now, out);
            drain(s, out, now);
            give_back(std::move(out));
        }
    }
    if (now >= next_housekeeping_) {
        next_housekeeping_ = now + housekeeping_period;
        housekeeping(now);
        for (Side* s : sides_)
            s->touched();
    }
}

void Engine::housekeeping(Instant now) {
    for (const auto& unit : lines_) {
        if (unit) scan_turn(*unit, now);
    }
    for (const auto& slot : axes_) {
        if (!slot) continue;
        Axis& a = *slot;
        const bool stale = now - a.profile.feedback().at > a.drive->line->stale_after || !image_.picture(a.id).ever_seen;
        if (stale != a.stale) {
            a.stale = stale;
            publish(a, now);
        }
        if (!a.clients.empty()) track(a, now);
        check_hold(a, now);
        if (const auto v = a.authority.expire(now); v.change != AxisAuthority::Change::none) authority_changed(a, v, nullptr, now);
    }
    for (const auto& slot : drives_) {
        if (!slot) continue;
        Drive& d = *slot;
        decide_presence(d, now);
        if (d.handback && d.handback->waiting == 0 && d.device_online) {
            bool rest = true;
            for (const AxisId id : d.axes) rest = rest && axes_[index_of(id)]->profile.at_rest();
            if (rest) {
                auto h = std::move(d.handback);
                serve(d, Presence::device, fmt::format("the drive is back; {} parameters compared, {} differ", h->compared, h->differences.size()), now);
                for (const auto& text : h->differences) {
                    Event e;
                    e.severity = Severity::warning;
                    e.kind = "parameters_differ";
                    e.drive = d.spec.name;
                    e.text = text;
                    event(std::move(e), now);
                }
            }
        }
        save_twin_memory(d);
    }
}

/// Hands a twin's non-volatile memory to the store if it has changed since.
void Engine::save_twin_memory(Drive& d) {
    if (d.serving != Presence::twin || !d.line->twins) return;
    const Twin* t = d.line->twins->bus->twin(d.id);
    if (!t || t->non_volatile_revision() == d.memory_revision) return;
    d.memory_revision = t->non_volatile_revision();
    d.memory = t->non_volatile();
    host_.on_twin_memory(d.spec.name, d.memory);
}

// --- what others ask ------------------------------------------------------------------------------------------------

LineReport Engine::line_report(LineId id, Instant now) const {
    LineReport r;
    const LineUnit* u = index_of(id) < lines_.size() ? lines_[index_of(id)].get() : nullptr;
    if (!u) return r;
    const Side* main = u->real ? u->real.get() : u->twins.get();
    if (main) {
        r.status = main->line->status(now);
        r.counters = main->adapter->counters();
    }
    if (u->twins) {
        r.has_twin_bus = true;
        r.twin_status = u->twins->line->status(now);
        if (u->real) {
            const AdapterCounters t = u->twins->adapter->counters();
            r.counters.exchanges += t.exchanges;
            r.counters.timeouts += t.timeouts;
            r.counters.retries += t.retries;
            r.counters.refused += t.refused;
            r.counters.garbled += t.garbled;
            r.counters.unexpected += t.unexpected;
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
    if ((d->serving == Presence::device && !d->device_online) || (d->serving == Presence::twin && !d->twin_online)) s.presence = Presence::offline;
    s.text = d->why;
    s.silent_exchanges = d->device_link.silent_exchanges;
    s.retry_pause_ms = milliseconds_of(d->device_link.retry_pause);
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
        const bool served = d->serving == Presence::twin ? d->twin_online : (d->serving == Presence::device && (d->device_online || (real && real->tried)));
        if (!served) return false;
        // Whoever is told `ready` commands at once: an axis whose drive answers has also said where it is.
        const bool answers = d->serving == Presence::twin ? d->twin_online : d->device_online;
        if (answers && !std::ranges::all_of(d->axes, [&](AxisId a) { return image_.picture(a).ever_seen; })) return false;
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
            const bool needed = std::ranges::any_of(l->drives, [&](DriveId id) { return drives_[index_of(id)]->spec.presence == PresenceRule::device; });
            if (needed) out.push_back(fmt::format("line {} is down: {}", l->spec.name, l->real->why));
        }
    }
    for (const auto& d : drives_) {
        if (d && ((d->serving == Presence::device && !d->device_online) || (d->serving == Presence::twin && !d->twin_online) || d->serving == Presence::offline)) {
            out.push_back(fmt::format("drive {} does not answer: {}", d->spec.name, d->why));
        }
    }
    return out;
}

}  // namespace axisgate
