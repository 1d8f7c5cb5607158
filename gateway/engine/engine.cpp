// Engine, routing. Commands down, frames up, one result per ticket.
// In: see engine.hpp. Out: through EngineHost and the image. The other parts are in engine_*.cpp.
// Never blocks and never loops over more than what one call brought.
#include "gateway/engine/engine.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {

Engine::Engine(Families families, EngineHost& host, Image& image, std::size_t trace_frames)
    : families_(std::move(families)), host_(host), image_(image), site_(std::make_shared<SiteState>()), trace_frames_(trace_frames) {}

Engine::~Engine() = default;

Out Engine::take_out() {
    if (spare_.empty()) return {};
    Out out = std::move(spare_.back());
    spare_.pop_back();
    return out;
}

void Engine::give_back(Out&& out) {
    out.clear();
    if (spare_.size() < 16) spare_.push_back(std::move(out));
}

Engine::Axis* Engine::axis(AxisId id) const { return index_of(id) < axes_.size() ? axes_[index_of(id)].get() : nullptr; }
Engine::Drive* Engine::drive(DriveId id) const { return index_of(id) < drives_.size() ? drives_[index_of(id)].get() : nullptr; }

const Catalogue* Engine::catalogue(AxisId id) const {
    const Axis* a = axis(id);
    return a ? a->drive->catalogue.get() : nullptr;
}

Engine::Side* Engine::side_of(const Drive& d) const {
    if (d.serving == Presence::twin) return d.line->twins.get();
    return d.line->real.get();  // also while offline: a stop is tried all the same
}

Engine::Speaker& Engine::speaker_of(const Side& side, const Drive& d) { return *side.speaker_of(d.family); }

// --- up -------------------------------------------------------------------------------------------------------------

void Engine::Side::on_frame(const Frame& frame) {
    engine.now_ = std::max(engine.now_, frame.at);
    unit.log->record(frame, false, twin);
    if (engine.tap_) engine.tap_->frame(unit.id, frame, false, twin);
    bool heard = false;
    for (std::size_t i = 0; i < speakers.size(); ++i) {
        Speaker& s = *speakers[i];
        if (!s.hears(frame)) continue;
        heard = true;
        engine.ask(s, engine.now_, [&](Out& out) { s.adapter->on_frame(frame, engine.now_, out); });
    }
    if (!heard) {
        ++unclaimed;
        touched();
    }
}

void Engine::Side::on_sent(const Frame& frame) {
    unit.log->record(frame, true, twin);
    if (engine.tap_) engine.tap_->frame(unit.id, frame, true, twin);
    if (followed.handed_on && followed.frame.same(frame)) {
        engine.write_to_frame_.observe(frame.at - followed.since);
        followed.ticket = no_ticket;
        followed.handed_on = false;
    }
}

void Engine::Side::on_line_state(bool now_up, const std::string& text) {
    if (engine.tap_ && !twin) engine.tap_->line_state(unit.id, now_up, text, engine.now_);
    engine.line_state(*this, now_up, text, engine.now_);
}

/// Hands on what one call to an adapter gave back. Feedback goes before results: a client that hears "accepted" finds the image ready.
void Engine::drain(Speaker& by, Out& out, Instant now) {
    Side& side = by.side;
    side.touched();
    for (const auto& n : out.notices) {  // why a search failed is known before the feedback says that it has
        if (Axis* a = n.kind == "homing" ? axis(n.axis) : nullptr) a->homing_why = n.text;
    }
    for (auto& tx : out.frames) {
        tx.frame.sender = by.number;
        if (tap_) tap_->handed(side.unit.id, tx.frame, side.twin, now);
        const bool taken = side.line->send(tx.frame, tx.priority, now);  // a full queue is counted there
        if (tap_ && !taken && !side.twin) tap_->send_refused(side.unit.id, now);
        if (auto& f = side.followed; taken && f.ticket != no_ticket && !f.handed_on && tx.priority != Priority::poll) {
            f.handed_on = true;
            f.frame = tx.frame;
        }
    }
    for (const auto& l : out.links)
        link(side, l, now);
    for (const auto& f : out.feedback)
        feedback(side, f.axis, f.value, now);
    const Presence mine = side.twin ? Presence::twin : Presence::device;
    for (auto& s : out.samples) {
        Axis* a = axis(s.axis);
        if (!a || a->drive->serving != mine) continue;
        s.source = a->source;
        a->said[s.point] = s.value;
        tell_sample(s, now);
    }
    for (const auto& n : out.notices) {
        if (is_probe(n.drive)) continue;  // the report of the scan says what there is to say
        const Axis* a = axis(n.axis);
        const Drive* d = a ? a->drive : drive(n.drive);
        if (d && d->serving != mine) continue;
        Event e;
        e.severity = n.severity;
        e.kind = n.kind;
        e.code = n.code;
        e.text = n.text;
        e.axis = a ? a->spec.name : "";
        e.drive = d ? d->spec.name : "";
        e.line = side.unit.spec.name;
        event(std::move(e), now);
    }
    for (const auto& r : out.results)
        order_result(r, now);
    for (const auto& end : out.stream_ends)
        stream_refused(side, end, now);
}

void Engine::feedback(Side& side, AxisId id, const AxisFeedback& value, Instant now) {
    Axis* a = axis(id);
    if (!a || a->drive->serving != (side.twin ? Presence::twin : Presence::device)) return;
    const bool first = !image_.picture(id).current;
    auto next = a->profile.on_feedback(value, now);
    a->stale = false;
    if (first) a->run.found = value.moving && a->run.velocity == 0, a->last_deceleration = 0;  // its power may have been off
    if (bool& lost = a->drive->device_lost_while_commanded; lost && !side.twin) {
        // It is back and has said that nothing is under way any more: its next silence is judged by what it does then.
        lost = std::ranges::any_of(a->drive->axes, [&](AxisId x) {
            const auto& p = axes_[index_of(x)]->profile;
            return p.commanded() || p.state() == PowerState::not_ready_to_switch_on;
        });
    }
    if (a->lost_line) fail_safe(*a, LossCause::line_lost, now);
    if (value.fault != a->was_fault || (value.fault && value.error_code != a->last_error)) {
        Event e;
        e.axis = a->spec.name;
        e.drive = a->drive->spec.name;
        e.code = value.error_code;
        if (value.fault) {
            const ErrorCode* known = a->drive->catalogue->error(value.error_code);
            e.severity = Severity::alarm;
            e.kind = "fault";
            e.text = known                   ? fmt::format("fault {}: {}", value.error_code, known->text)
                     : value.error_code != 0 ? fmt::format("fault, drive's code {}", value.error_code)
                                             : "fault; the drive gives no number for it";
        } else {
            e.kind = "fault_cleared";
            e.text = "the fault is cleared";
            e.code = a->last_error;
        }
        a->was_fault = value.fault;
        a->last_error = value.error_code;
        event(std::move(e), now);
    }
    if (a->stream.on && a->profile.state() != PowerState::operation_enabled)
        end_stream(*a, Reason::wrong_state, fmt::format("the axis is {} now", name_of(a->profile.state())), now);
    check_run(*a, now);
    publish(*a, now);
    if (next) {
        if (std::holds_alternative<QuickStop>(*next)) {
            Event e;
            e.severity = Severity::warning;
            e.kind = "fault_reaction";
            e.axis = a->spec.name;
            e.code = value.error_code;
            e.text = "the drive reports a fault and still moves: it is stopped";
            event(std::move(e), now);
        }
        give_order(*a, nullptr, std::move(*next), {}, now);
    }
    track(*a, now);
}

void Engine::publish(Axis& a, Instant now) {
    AxisPicture& p = image_.picture(a.id);
    a.profile.fill(p);
    p.number = static_cast<std::uint16_t>(a.spec.number);
    p.family_number = a.drive->catalogue->number();
    p.source = a.source;
    p.authority = a.authority.door();
    p.authority_since = a.authority.since();
    p.authority_until = a.authority.until();
    const auto write = [](std::array<char, 64>& into, std::string_view text) {
        into.fill(0);
        std::copy_n(text.begin(), std::min(text.size(), into.size() - 1), into.begin());
    };
    write(p.authority_holder, a.authority.holder().name);
    write(p.authority_commander, a.authority.commander().door == Door::none ? std::string() : a.authority.commander().text());
    // An axis is online when it can be commanded: its drive answers, and has said where it is.
    const bool answers =
        (a.drive->serving == Presence::device && a.drive->device_online) || (a.drive->serving == Presence::twin && a.drive->twin_online);
    const bool online = answers && p.current;
    p.presence = answers ? a.drive->serving : Presence::offline;  // as the drive's own status says it
    const auto put = [](std::uint16_t& word, std::uint16_t bit, bool on) {
        word = on ? static_cast<std::uint16_t>(word | bit) : static_cast<std::uint16_t>(word & ~bit);
    };
    const bool simulated = a.drive->serving == Presence::twin || a.profile.feedback().simulated, stale = a.stale || !online;
    put(p.flags, flag_online, online);
    if (a.at_limit) p.statusword |= cia402::sw_internal_limit;
    p.fail_safe_cause = static_cast<std::uint16_t>(a.loss);
    p.streaming = a.stream.on;
    p.stream_mode = a.stream.mode;
    p.set_points = a.stream.taken;
    p.set_points_refused = a.stream.refused;
    p.set_point_refusal = a.stream.refusal;
    put(p.flags, flag_fail_safe, a.loss != LossCause::none);
    put(p.flags, flag_simulated, simulated);
    put(p.flags, flag_stale, stale);
    put(p.statusword, cia402::sw_simulated, simulated);
    put(p.statusword, cia402::sw_stale, stale);
    if (p.flags & flag_moving) last_stir_ = now;
    image_.publish(a.id);
    if (tap_) tap_->picture(a.id, p, now);
}

// --- down -----------------------------------------------------------------------------------------------------------

/// Sends one order to the adapter of the axis' line. `client`: whose command it is; null for the engine's own.
void Engine::give_order(Axis& a, Client* client, CommandBody body, Origin origin, Instant now) {
    if (!client) {  // a client's order was looked at before it changed anything; what waited since may not fit any more
        if (const auto no = beyond_limits(a, body)) {
            a.profile.on_order_result(body, false, now);
            Event e;
            e.severity = Severity::warning;
            e.kind = "limit";
            e.axis = a.spec.name;
            e.text = fmt::format("{} that waited is not begun: {}", name_of(body), no->text);
            return event(std::move(e), now);
        }
    }
    if (std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) || is_urgent(body)) {
        end_stream(a, Reason::interrupted, fmt::format("ended by {}", name_of(body)), now);
        supersede(a, client ? client->number : 0, name_of(body), now);
        a.held = {};  // another motion, or a stop: nobody's finger holds this one
        a.run = {};
        a.at_limit = false;
        if (const auto* m = std::get_if<Move>(&body); m && m->kind == Move::Kind::velocity)
            a.run = {m->target, m->acceleration.value_or(0), m->deceleration.value_or(a.last_deceleration), a.profile.feedback().position,
                     now};
        a.homing_why.clear();
        const auto* move = client ? std::get_if<Move>(&client->body) : nullptr;
        if (move && move->hold_ms) begin_hold(a, *move, client->origin);
    }
    if (const auto* together = std::get_if<StartTogether>(&body)) {
        for (const AxisId id : together->axes) {
            if (Axis* x = axis(id)) end_stream(*x, Reason::interrupted, fmt::format("ended by {}", name_of(body)), now);
        }
    }
    const Ticket ticket = make_ticket(engine_itself, next_++);
    OrderRecord record;
    record.client = client ? client->number : 0;
    record.axis = a.id;
    record.body = body;
    record.given_at = now;
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        // Looked at now: the acknowledgement may come with the new value said already.
        const auto said = a.said.find(write->point), stored = a.stored.find(write->point);
        if (said != a.said.end() && known(said->second))
            record.before = said->second;
        else if (stored != a.stored.end())
            record.before = stored->second;
    }
    orders_.emplace(ticket, std::move(record));
    Side* side = side_of(*a.drive);
    if (!side || !side->up) {
        Result r;
        r.ticket = ticket;
        r.axis = a.id;
        r.outcome = Outcome::refused;
        r.reason = side ? Reason::line_down : Reason::no_answer;
        r.text = side ? fmt::format("line {} is down: {}", side->unit.spec.name, side->why)
                      : fmt::format("drive {} does not answer", a.drive->spec.name);
        return order_result(r, now);
    }
    Command order;
    order.ticket = ticket;
    order.axis = a.id;
    // What ends in the drive's own way is the adapter's to tell; every other end is watched here, by what the axis shows.
    order.until_done = client && client->until_done && std::holds_alternative<Action>(body);
    order.body = std::move(body);
    order.origin = std::move(origin);
    if (!side->twin && side->followed.ticket == no_ticket) {
        side->followed.ticket = ticket;
        side->followed.since = now;
    }
    Speaker& by = speaker_of(*side, *a.drive);
    const FlightCause cause(tap_, client ? client->ticket : no_ticket);
    ask(by, now, [&](Out& out) { by.adapter->on_command(order, now, out); });
}

void Engine::order_result(const Result& given, Instant now) {
    for (Side* s : sides_) {  // it has ended: with a frame that was seen to leave, or without one
        if (s->followed.ticket != given.ticket) continue;
        s->followed.ticket = no_ticket;
        s->followed.handed_on = false;
    }
    const auto it = orders_.find(given.ticket);
    if (it == orders_.end()) return;  // answered already: the adapter broke its law, the client is not told twice
    if (it->second.handback != no_drive) {
        (void)handback_result(given, now);
        return;
    }
    Result r = given;
    OrderRecord& record = it->second;
    Axis* a = axis(record.axis);
    const bool is_good = good(r);
    if (a && is_good) remember_ramp(*a, record.body);
    if (const auto* write = std::get_if<WriteParameter>(&record.body); write && is_good && a) {
        // Acknowledged by the drive; the client hears of it when it is on disk.
        StoreOrder order;
        order.ticket = given.ticket;
        order.axis = record.axis;
        order.axis_name = a->spec.name;
        const Catalogue& cat = *a->drive->catalogue;
        order.parameter = cat.id_of(write->point);
        order.storage = cat.parameter(write->point)->storage;
        order.value = known(r.value) ? r.value : write->value;
        order.previous = record.before;
        if (const auto c = clients_.find(record.client); c != clients_.end()) order.origin = c->second->origin;
        r.value = order.value;
        record.kept = r;
        for (auto& [ticket, other] : orders_) {  // those given behind it find what it left
            const auto* later = std::get_if<WriteParameter>(&other.body);
            if (later && ticket != given.ticket && other.axis == record.axis && later->point == write->point && !known(other.kept.value))
                other.before = order.value;
        }
        // The drive has it, whether the disk takes it or not.
        Sample s;
        s.axis = record.axis;
        s.point = write->point;
        s.value = order.value;
        s.at = now;
        s.source = a->source;
        a->said[s.point] = s.value;
        tell_sample(s, now);
        save_twin_memory(*a->drive);  // a twin's EEPROM goes to disk along with the value that it took
        host_.on_store(std::move(order));
        return;
    }
    const CommandBody body = std::move(record.body);
    const std::uint64_t number = record.client;
    orders_.erase(it);
    if (!a) return;
    const auto owner = clients_.find(number);
    // A set-point that had to wait begins by an order of the engine's own: it is still the motion of whoever gave it.
    const Ticket mover = owner != clients_.end() ? owner->second->ticket : a->setpoint_ticket;
    if (std::holds_alternative<StartTogether>(body)) {
        for (const AxisId id : std::get<StartTogether>(body).axes) {
            if (Axis* other = axis(id)) {
                if (is_good) image_.picture(id).motion_ticket = mover;
                publish(*other, now);
            }
        }
    }
    if (const auto* move = std::get_if<Move>(&body); is_good && ((move && !move->prepare_only) || std::holds_alternative<Home>(body)))
        image_.picture(a->id).motion_ticket = mover;
    if (is_good && is_urgent(body)) image_.picture(a->id).motion_ticket = no_ticket;
    if (is_good) remember_prepared(*a, body);
    a->profile.on_order_result(body, is_good, now);
    if (std::holds_alternative<Move>(body)) {
        if (!is_good)
            a->held = {};
        else if (a->held.time > Duration::zero())
            a->held.until = now + a->held.time;
    }
    publish(*a, now);
    const auto c = clients_.find(number);
    if (c == clients_.end()) {
        if (!is_good && number == 0 && !std::holds_alternative<ReadParameter>(body)) {
            Event e;
            e.severity = Severity::warning;
            e.kind = "command";
            e.axis = a->spec.name;
            e.code = r.code;
            e.text = fmt::format("{} was not carried out: {}", name_of(body), r.text);
            event(std::move(e), now);
        }
        return;
    }
    Client& client = *c->second;
    if (client.waiting > 0) --client.waiting;
    if (!is_good) {
        if (good(client.result)) client.result = r;
    } else if (good(client.result)) {
        client.result.value = r.value;
        client.result.bytes = r.bytes;
        client.result.code = r.code;
        if (!r.text.empty()) client.result.text = r.text;
        if (r.outcome == Outcome::done) client.result.outcome = Outcome::done;
    }
    if (client.waiting > 0) return;
    if (client.lets_go && (client.result.reason == Reason::line_down || client.result.reason == Reason::no_answer)) {
        client.result = {};
        client.result.outcome = Outcome::accepted;
        client.result.text = fmt::format(
            "axis {}: nobody answers; it is taken as disabled and its twin takes over, but whether the real drive is off is not known",
            a->spec.name);
        return finish(number, client.result, now);
    }
    if (!good(client.result)) return finish(number, client.result, now);
    client.accepted = true;
    client.accepted_at = now;
    track(*a, now);
}

/// What a drive was told to brake with it keeps; whatever else is said to it may have changed that.
void Engine::remember_ramp(Axis& a, const CommandBody& body) {
    const auto* m = std::get_if<Move>(&body);
    if (m && m->deceleration) a.last_deceleration = *m->deceleration;
    if (std::holds_alternative<WriteParameter>(body) || std::holds_alternative<Native>(body) || std::holds_alternative<Action>(body))
        a.last_deceleration = 0;
}

/// A move that was prepared counts until the axis is moved or stopped.
void Engine::remember_prepared(Axis& a, const CommandBody& body) {
    if (const auto* m = std::get_if<Move>(&body)) {
        a.prepared = m->prepare_only ? std::optional<Move>(*m) : std::nullopt;
    } else if (const auto* together = std::get_if<StartTogether>(&body)) {
        for (const AxisId id : together->axes) {
            if (Axis* x = axis(id)) x->prepared.reset();
        }
    } else if (is_urgent(body) || std::holds_alternative<Home>(body)) {
        a.prepared.reset();
    }
}

void Engine::on_stored(Ticket order, const std::string& fault, Instant now) {
    if (tap_) tap_->stored(order, fault, now);
    now_ = std::max(now_, now);
    const auto it = orders_.find(order);
    if (it == orders_.end()) return;
    OrderRecord record = std::move(it->second);
    orders_.erase(it);
    Axis* a = axis(record.axis);
    Result r = record.kept;
    if (a) {
        const auto& write = std::get<WriteParameter>(record.body);
        Event e;
        e.kind = "write";
        e.axis = a->spec.name;
        e.parameter = a->drive->catalogue->id_of(write.point);
        if (known(record.before)) e.old_value = to_text(record.before);
        e.new_value = to_text(r.value);
        if (fault.empty()) {
            a->stored[write.point] = r.value;
            e.text = fmt::format("{} = {}", e.parameter, e.new_value);
        } else {
            e.severity = Severity::alarm;
            e.kind = "not_stored";
            e.text = fmt::format("the drive took {} = {}, but it could not be stored: {}", e.parameter, e.new_value, fault);
        }
        if (const auto c = clients_.find(record.client); c != clients_.end()) {
            e.who = c->second->origin.who ? *c->second->origin.who : "";
            e.door = std::string(name_of(c->second->origin.door));
        }
        event(e, now);
        if (!fault.empty()) {
            r.outcome = Outcome::failed;
            r.reason = Reason::not_stored;
            r.text = e.text;
        }
    }
    if (fault.empty() && r.outcome == Outcome::accepted) r.outcome = Outcome::done;
    finish(record.client, std::move(r), now);
}

void Engine::finish(std::uint64_t number, Result r, Instant) {
    const auto it = clients_.find(number);
    if (it == clients_.end()) return;
    r.ticket = it->second->ticket;
    r.axis = it->second->axis;
    if (Axis* a = axis(r.axis)) std::erase(a->clients, number);
    clients_.erase(it);
    if (r.ticket != no_ticket) answer(r);
}

}  // namespace axisgate
