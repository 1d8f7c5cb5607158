// Sends one order to the adapter and handles its one result; the site's limits are checked on the way. A client is answered when all orders
// of its command have their results, and for a parameter write after the store has recorded it.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/motions.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/presences.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/routing.hpp"
#include "gateway/engine/streams.hpp"
#include "gateway/engine/twins.hpp"

namespace axisgate::engine {

void Orders::give_own(Axis& a, const CommandBody& body, Instant now) {
    auto decision = a.profile.on_command(body);
    for (auto& o : decision.orders)
        give(a, nullptr, std::move(o), {}, now);
}

Stated Orders::stated(const Axis& a, const CommandBody& body) {
    Stated nothing;
    nothing.kind = Stated::Kind::nothing;
    const bool in_its_language = std::holds_alternative<Native>(body) || std::holds_alternative<Action>(body);
    if (!in_its_language && !std::holds_alternative<WriteParameter>(body)) return nothing;
    if (const auto read = a.drive->family.family->stated) {
        Stated said = read(*a.drive->catalogue, a.spec.channel, body);
        // An action that is complete when the axis has arrived or stands moves the axis, whatever its name is.
        const auto* action = std::get_if<Action>(&body);
        const CatalogueCommand* listed = action ? a.drive->catalogue->command(action->name) : nullptr;
        const bool moves = listed && (listed->completes == Completion::target_reached || listed->completes == Completion::standstill);
        if (moves && said.kind == Stated::Kind::nothing) said.kind = Stated::Kind::unread;
        return said;
    }
    return in_its_language ? Stated{} : nothing;
}

/// The same stop is on its way already: this one shares its entry and its answer, so that many equal stops cannot keep another stop out.
bool Orders::join_stop(Axis& a, Client* client, const CommandBody& body) {
    constexpr std::size_t most = 1024;  // limit of commands that wait for one answer; further ones are answered that the stop is on its way
    const auto kind = Stops::of(body);
    if (!kind) return false;
    a.stops.asked = make_ticket(engine_itself, pending_.next);
    a.stops.asked_kind = std::max(*kind, a.stops.wanted.value_or(*kind));
    if (a.stops.of(*kind).order == no_ticket) return false;
    if (!client) return true;
    auto& joined = a.stops.of(*kind).joined;
    if (joined.size() < most) {
        joined.push_back(client->number);
        return true;
    }
    Result r = client->result;
    r.outcome = Outcome::accepted;
    r.text = fmt::format("axis {}: the same stop is on its way already", a.spec.name);
    clients_.finish(client->number, std::move(r));
    return true;
}

void Orders::begin_stop(Axis& a, const OrderRecord& record, Ticket ticket, Instant now) {
    const auto kind = Stops::of(record.body);
    if (!kind) return;
    a.stops.of(*kind).order = ticket;
    if (a.stops.wanted && *a.stops.wanted > *kind) return;
    if (a.stops.wanted != kind || a.stops.acknowledged) {
        a.stops.first_at = now;
        a.stops.speed_then = std::llabs(a.profile.feedback().velocity);
    }
    a.stops.wanted = kind;
    a.stops.acknowledged = false;
    a.stops.given_at = now;
}

/// An order was given before a stop, and the drive accepted it, or may have accepted it, behind the stop. The motion that it begins is
/// ended as the stop demands.
void Orders::stop_behind(Axis& a, std::string_view what, const Origin& by, Instant now) {
    Event e;
    e.severity = Severity::warning;
    e.kind = "motion";
    e.axis = a.spec.name;
    e.text = fmt::format("{} of {} was taken by the drive behind a stop that had come after it: it is stopped again", what,
                         AuthorityClient::of(by).text());
    publisher_.event(std::move(e), now);
    a.stops.wanted = a.stops.asked_kind;
    a.stops.first_at = now;
    a.stops.speed_then = std::llabs(a.profile.feedback().velocity);
    if (a.stops.of(a.stops.asked_kind).order == no_ticket) stop_again(a, now);
}

void Orders::stop_again(Axis& a, Instant now) {
    OrderRecord record;
    record.axis = a.id;
    record.body = Stops::body(*a.stops.wanted);
    record.repeated = true;
    const Ticket ticket = make_ticket(engine_itself, pending_.next++);
    CommandBody body = record.body;
    a.stops.acknowledged = false;
    a.stops.of(*a.stops.wanted).order = ticket;
    a.stops.given_at = now;
    pending_.orders.emplace(ticket, std::move(record));
    send(a, nullptr, ticket, std::move(body), {}, now);
}

/// Sends one order to the adapter of the axis' line. `client` is the command that it belongs to; null for the engine's own orders.
void Orders::give(Axis& a, Client* client, CommandBody body, Origin origin, Instant now) {
    if (!client) {  // a client's order was checked before it changed anything; a set-point that has waited may not fit any more
        if (const auto no = beyond_limits(a, body)) {
            a.profile.on_order_result(body, false, now);
            Event e;
            e.severity = Severity::warning;
            e.kind = "limit";
            e.axis = a.spec.name;
            e.text = fmt::format("{} that waited is not begun: {}", name_of(body), no->text);
            return publisher_.event(std::move(e), now);
        }
    }
    if (is_urgent(body)) {
        streams_.end(a, Reason::interrupted, fmt::format("ended by {}", name_of(body)), now);
        clients_.supersede(a, client ? client->number : 0, name_of(body));
        if (join_stop(a, client, body)) return;
    }
    const Ticket ticket = make_ticket(engine_itself, pending_.next++);
    OrderRecord record;
    record.client = client ? client->number : 0;
    record.axis = a.id;
    record.body = body;
    record.by = origin;
    Axis& moves = concerned(a, stated(a, body));
    record.motion = Motions::asked(moves, body, origin);
    record.mover = moves.id;
    if (record.motion) {
        ++moves.motions_asked;
        moves.asked = *record.motion;
    }
    begin_stop(a, record, ticket, now);
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        // The previous value is read now, because the acknowledgement may arrive after the new value was reported.
        const auto reported = a.reported.find(write->point), stored = a.stored.find(write->point);
        if (reported != a.reported.end() && known(reported->second))
            record.before = reported->second;
        else if (stored != a.stored.end())
            record.before = stored->second;
    }
    pending_.orders.emplace(ticket, std::move(record));
    send(a, client, ticket, std::move(body), std::move(origin), now);
}

void Orders::send(Axis& a, Client* client, Ticket ticket, CommandBody body, Origin origin, Instant now) {
    Side* side = machine_.side_of(*a.drive);
    if (!side || !side->up) {
        Result r;
        r.ticket = ticket;
        r.axis = a.id;
        r.outcome = Outcome::refused;
        r.reason = side ? Reason::line_down : Reason::no_answer;
        r.text = side ? fmt::format("line {} is down: {}", side->unit.spec.name, side->why)
                      : fmt::format("drive {} does not answer", a.drive->spec.name);
        return result(r, now);
    }
    Command order;
    order.ticket = ticket;
    order.axis = a.id;
    // The adapter reports the end of commands that end in the drive's own way; every other end is observed here at the axis.
    order.until_done = client && client->until_done && std::holds_alternative<Action>(body);
    order.body = std::move(body);
    order.origin = std::move(origin);
    if (!side->twin && side->followed.ticket == no_ticket) {
        side->followed.ticket = ticket;
        side->followed.since = now;
    }
    Speaker& by = Machine::speaker_of(*side, *a.drive);
    const FlightCause cause(publisher_.tap(), client ? client->ticket : no_ticket);
    routing_.ask(by, now, [&](Out& out) { by.adapter->on_command(order, now, out); });
}

Ticket Orders::client_of(Ticket order) const noexcept {
    const auto it = order == no_ticket ? pending_.orders.end() : pending_.orders.find(order);
    if (it == pending_.orders.end()) return no_ticket;
    const auto client = pending_.clients.find(it->second.client);
    return client == pending_.clients.end() ? no_ticket : client->second->ticket;
}

void Orders::result(const Result& given, Instant now) {
    for (Side* s : machine_.sides) {  // the measurement has ended, with or without a frame that was sent
        if (s->followed.ticket != given.ticket) continue;
        s->followed.ticket = no_ticket;
        s->followed.handed_on = false;
    }
    const auto it = pending_.orders.find(given.ticket);
    if (it == pending_.orders.end())
        return;  // the order was answered already; the adapter broke its law, and the client gets no second
                 // answer
    if (it->second.handback != no_drive) {
        presences_.handback_result(given);
        return;
    }
    Result r = given;
    Axis* a = machine_.axis(it->second.axis);
    const bool is_good = good(r);
    if (a && is_good) remember_ramp(*a, it->second.body);
    if (a && is_good && std::holds_alternative<WriteParameter>(it->second.body)) {
        if (auto motion = std::exchange(it->second.motion, std::nullopt)) {
            OrderRecord moved;
            moved.motion = std::move(motion);
            moved.mover = it->second.mover;
            moved.client = it->second.client;
            moved.body = it->second.body;
            moved.by = it->second.by;
            moved.owner_lost = it->second.owner_lost;
            record_motion(*a, moved, no_ticket, r, now);
        }
        return store_write(*a, it->second, r, given.ticket, now);
    }
    OrderRecord record = std::move(it->second);
    pending_.orders.erase(it);
    if (!a) return;
    const auto owner = pending_.clients.find(record.client);
    // A waiting set-point begins by an order of the engine, but it is still the motion of its client.
    const Ticket mover = owner != pending_.clients.end() ? owner->second->ticket : a->setpoint_ticket;
    record_motion(*a, record, mover, r, now);
    if (is_good) remember_prepared(*a, record.body);
    a->profile.on_order_result(record.body, is_good, now);
    if (is_good && std::holds_alternative<Enable>(record.body)) a->latch.bits = 0;
    publisher_.publish(*a, now);
    std::vector<std::uint64_t> joined;
    if (const auto kind = Stops::of(record.body); kind && a->stops.of(*kind).order == given.ticket) {
        a->stops.of(*kind).order = no_ticket;
        joined = std::exchange(a->stops.of(*kind).joined, {});
    }
    if (!pending_.clients.contains(record.client) && !is_good && record.client == 0 && !record.repeated)
        not_carried_out(*a, record.body, r, now);
    answer(record.client, *a, r, now);
    for (const auto number : joined)
        answer(number, *a, r, now);
}

/// The drive has acknowledged the write; the client gets its answer when the value is on the disk.
void Orders::store_write(Axis& a, OrderRecord& record, Result& r, Ticket ticket, Instant now) {
    const auto& write = std::get<WriteParameter>(record.body);
    StoreOrder order;
    order.ticket = ticket;
    order.axis = record.axis;
    order.axis_name = a.spec.name;
    const Catalogue& cat = *a.drive->catalogue;
    order.parameter = cat.id_of(write.point);
    order.storage = cat.parameter(write.point)->storage;
    order.value = known(r.value) ? r.value : write.value;
    order.previous = record.before;
    if (const auto c = pending_.clients.find(record.client); c != pending_.clients.end()) order.origin = c->second->origin;
    r.value = order.value;
    record.kept = r;
    for (auto& [other_ticket, other] : pending_.orders) {  // later writes find the value that this one has left
        const auto* later = std::get_if<WriteParameter>(&other.body);
        if (later && other_ticket != ticket && other.axis == record.axis && later->point == write.point && !known(other.kept.value))
            other.before = order.value;
    }
    // The drive has the value, whether the disk records it or not.
    Sample s;
    s.axis = record.axis;
    s.point = write.point;
    s.value = order.value;
    s.at = now;
    s.source = a.source;
    a.reported[s.point] = s.value;
    publisher_.sample(s, now);
    twins_.save_memory(*a.drive);  // the twin's EEPROM is stored together with the value that it accepted
    host_.on_store(std::move(order));
}

/// The drive has accepted a motion. If a stop was requested after its order, the stop remains valid and is sent again. If
/// its client was lost meanwhile, the motion ends as the site says for that loss.
void Orders::motion_taken(Axis& a, Motion m, const OrderRecord& record, Ticket order, Instant now) {
    const bool behind_a_stop = order < a.stops.asked;
    motions_.acknowledged(a, std::move(m), behind_a_stop ? MotionOrder::behind_a_stop : MotionOrder::in_turn, record.client,
                          name_of(record.body), now);
    if (behind_a_stop) stop_behind(a, name_of(record.body), a.motion.origin, now);
    if (record.owner_lost != LossCause::none) loss_.act(a, record.owner_lost, now);
}

/// Applies the drive's answer to the records of motion.
void Orders::record_motion(Axis& a, OrderRecord& record, Ticket mover, const Result& r, Instant now) {
    const bool is_good = good(r);
    if (const auto* together = std::get_if<StartTogether>(&record.body)) {
        for (const AxisId id : together->axes) {
            Axis* other = machine_.axis(id);
            if (!other) continue;
            if (is_good) machine_.image.picture(id).motion_ticket = mover;
            auto m = other == &a ? std::nullopt : Motions::asked(*other, record.body, record.by);
            if (m && is_good) motion_taken(*other, std::move(*m), record, r.ticket, now);
            if (m && r.outcome == Outcome::failed) motions_.suspect(*other, std::move(*m));
            publisher_.publish(*other, now);
        }
    }
    if (record.motion) {
        Axis* const moves = machine_.axis(record.mover);
        if (!moves) return;
        if (moves->motions_asked > 0) --moves->motions_asked;
        if (moves->motions_asked == 0) moves->asked = {};
        if (is_good) {
            machine_.image.picture(moves->id).motion_ticket = mover;
            motion_taken(*moves, std::move(*record.motion), record, r.ticket, now);
        } else if (r.outcome == Outcome::failed) {
            motions_.suspect(*moves, std::move(*record.motion));
        }
    } else if (const auto kind = Stops::of(record.body)) {
        if (is_good) {
            machine_.image.picture(a.id).motion_ticket = no_ticket;
            motions_.stop_acknowledged(a, *kind, now);
        }
    } else if (is_good && stated(a, record.body).kind == Stated::Kind::unread) {
        Motion m;
        m.kind = Motion::Kind::statement;
        if (const auto c = pending_.clients.find(record.client); c != pending_.clients.end()) m.origin = c->second->origin;
        m.who = AuthorityClient::of(m.origin);
        if (r.ticket < a.stops.asked) return motions_.suspect(a, std::move(m));
        a.statement = std::move(m);
    }
}

void Orders::not_carried_out(const Axis& a, const CommandBody& body, const Result& r, Instant now) {
    if (std::holds_alternative<ReadParameter>(body)) return;
    Event e;
    e.severity = Severity::warning;
    e.kind = "command";
    e.axis = a.spec.name;
    e.code = r.code;
    e.text = fmt::format("{} was not carried out: {}", name_of(body), r.text);
    publisher_.event(std::move(e), now);
}

/// One order of a client has its answer. After the last one, the client gets its own answer or its motion is watched until the end.
void Orders::answer(std::uint64_t number, Axis& a, const Result& r, Instant now) {
    const auto c = pending_.clients.find(number);
    if (c == pending_.clients.end()) return;
    Client& client = *c->second;
    if (client.waiting > 0) --client.waiting;
    if (!good(r)) {
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
            a.spec.name);
        return clients_.finish(number, client.result);
    }
    if (!good(client.result)) return clients_.finish(number, client.result);
    client.accepted = true;
    client.accepted_at = now;
    clients_.track(a, now);
}

void Orders::on_stored(Ticket order, const std::string& fault, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->stored(order, fault, now);
    machine_.now = std::max(machine_.now, now);
    const auto it = pending_.orders.find(order);
    if (it == pending_.orders.end()) return;
    OrderRecord record = std::move(it->second);
    pending_.orders.erase(it);
    Axis* a = machine_.axis(record.axis);
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
        if (const auto c = pending_.clients.find(record.client); c != pending_.clients.end()) {
            e.who = c->second->origin.who ? *c->second->origin.who : "";
            e.door = std::string(name_of(c->second->origin.door));
        }
        publisher_.event(e, now);
        if (!fault.empty()) {
            r.outcome = Outcome::failed;
            r.reason = Reason::not_stored;
            r.text = e.text;
        }
    }
    if (fault.empty() && r.outcome == Outcome::accepted) r.outcome = Outcome::done;
    clients_.finish(record.client, std::move(r));
}

/// Checks an order against the site's limits, on the only way to the drives: orders that move the axis, now or together with others, or set
/// its position; values of registers that are kept for later; and modes that the drive does not have. Streamed set-points are checked here,
/// too, as the motion that they request.
std::optional<Refusal> Orders::beyond_limits(const Axis& a, const CommandBody& body) const {
    if (const auto* data = std::get_if<ProcessData>(&body)) {
        if (data->mode) {
            if (auto no = guard_mode(*data->mode, a.drive->catalogue->modes())) return no;
        }
        return guard_process_data(*data, a.limits);
    }
    const std::int64_t position = a.profile.feedback().position;
    if (const auto* m = std::get_if<Move>(&body)) {
        if (auto no = guard_move(*m, a.limits, position)) return no;
        // Some drives count a distance from the actual position, others from the previous target: neither may lead out of the limits.
        const auto from = m->kind == Move::Kind::relative ? a.profile.active_target() : std::nullopt;
        return from ? guard_move(*m, a.limits, *from) : std::nullopt;
    }
    if (const auto* set = std::get_if<SetPosition>(&body)) {
        Move probe;
        probe.target = set->position;
        return guard_move(probe, AxisLimits{}, 0);
    }
    if (const Stated said = stated(a, body); said.kind == Stated::Kind::motion || said.sets != DriveRates{})
        return beyond_by_statement(a, said);
    if (const auto* together = std::get_if<StartTogether>(&body)) {
        for (const AxisId id : together->axes) {
            const Axis* x = machine_.axis(id);
            if (!x || !x->prepared) continue;
            if (auto no = guard_move(*x->prepared, x->limits, x->profile.feedback().position)) {
                no->text = fmt::format("axis {}: {}", x->spec.name, no->text);
                return no;
            }
        }
    }
    return std::nullopt;
}

/// The positions and speeds that a statement in the drive's own language names are checked as in any order.
std::optional<Refusal> Orders::beyond_by_statement(const Axis& a, const Stated& said) const {
    const Axis& about = concerned(a, said);
    if (said.kind == Stated::Kind::motion) {
        if (auto no = beyond_limits(about, said.move)) return no;
    }
    return guard_rates(said.sets, about.limits);
}

/// The axis of the drive that the statement refers to.
Axis& Orders::concerned(const Axis& a, const Stated& said) const {
    for (const AxisId id : a.drive->axes) {
        if (Axis* x = machine_.axis(id); x && said.channel != 0 && said.channel == x->spec.channel) return *x;
    }
    return *machine_.axis(a.id);
}

/// A drive keeps the deceleration of the last move; any other order may have changed it.
void Orders::remember_ramp(Axis& a, const CommandBody& body) {
    const auto* m = std::get_if<Move>(&body);
    if (m && m->deceleration) a.last_deceleration = *m->deceleration;
    if (std::holds_alternative<WriteParameter>(body) || std::holds_alternative<Native>(body) || std::holds_alternative<Action>(body))
        a.last_deceleration = 0;
}

/// A prepared move is valid until the axis is moved or stopped.
void Orders::remember_prepared(Axis& a, const CommandBody& body) {
    if (const auto* m = std::get_if<Move>(&body)) {
        a.prepared = m->prepare_only ? std::optional<Move>(*m) : std::nullopt;
    } else if (const auto* together = std::get_if<StartTogether>(&body)) {
        for (const AxisId id : together->axes) {
            if (Axis* x = machine_.axis(id)) x->prepared.reset();
        }
    } else if (is_urgent(body) || std::holds_alternative<Home>(body)) {
        a.prepared.reset();
    }
}

}  // namespace axisgate::engine
