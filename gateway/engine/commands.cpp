// Checks, plans and carries out a client's command; `on_command` shows the steps in order. Each check is made in one place only: authority,
// limits and profile in `plan_motion`.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/command_authority.hpp"
#include "gateway/engine/commands.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/motions.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/twins.hpp"

namespace axisgate::engine {

/// The plan for a client's command.
struct Commands::Plan {
    std::vector<CommandBody> orders;
    std::optional<Move> waits;  ///< a set-point that waits behind the running motion
    bool motion = false;        ///< a command of CiA 402, as a control word or by name
    bool stops = false;         ///< it only ends motion, so every client may give it
    bool lets_go = false;       ///< see Client
    bool unread = false;        ///< a native statement that cannot be read, so that its motion, if it begins one, was not compared with the
                                ///< limits
    bool answered = false;      ///< nothing more has to be done
    [[nodiscard]] bool empty() const { return orders.empty() && !waits; }
};

void Commands::on_command(Command c, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->command(c, now);
    machine_.now = machine_.last_stir = std::max(machine_.now, now);
    Axis* a = machine_.axis(c.axis);
    if (!a || machine_.closing) return publisher_.refuse(c, Reason::line_down, a ? "the gateway is stopping" : "there is no such axis");
    if (const auto no = turned_away(*a, c, now)) return publisher_.refuse(c, no->reason, no->text);
    if (const auto* wish = std::get_if<HoldAxis>(&c.body)) return authority_.hold(*a, c, *wish, now);
    if (const auto* hand = std::get_if<Hand>(&c.body)) return answer_hand(*a, c, *hand, now);

    Plan plan;
    auto no = plan_for(*a, c, plan, now);
    if (!no && !plan.stops && needs_authority(c, plan)) no = authority_.ask(*a, c, now);
    if (plan.answered) return;
    if (no) {
        if (plan.stops) give_the_stop_alone(c, now);
        return publisher_.refuse(c, no->reason, fmt::format("axis {}: {}", a->spec.name, no->text));
    }
    note_command(*a, c, plan, now);
    carry_out(*a, std::move(c), std::move(plan), now);
}

/// Refuses commands without further checks while too many are in progress, or while a site change is about to remove the axis.
std::optional<Refusal> Commands::turned_away(const Axis& a, const Command& c, Instant now) {
    if (a.clients.size() >= max_clients_per_axis && !is_urgent(c.body)) {
        return Refusal{Reason::busy, fmt::format("axis {}: {} commands are on their way already; wait for their answers", a.spec.name,
                                                 max_clients_per_axis)};
    }
    const bool free = std::holds_alternative<HoldAxis>(c.body) || std::holds_alternative<ReadParameter>(c.body);
    if (now < a.leaving_until && !free && !CommandAuthority::only_stops(a, c.body)) {
        return Refusal{
            Reason::busy,
            fmt::format("axis {}: a change of the site takes it away or makes it anew; come again when that is in force", a.spec.name)};
    }
    return std::nullopt;
}

void Commands::answer_hand(const Axis& a, const Command& c, const Hand& hand, Instant now) {
    const std::string wrong = twins_.use_hand(a.drive->id, {{hand.name, hand.value}}, c.origin, now);
    if (!wrong.empty()) return publisher_.refuse(c, Reason::out_of_range, wrong);
    Result r;
    r.ticket = c.ticket;
    r.axis = c.axis;
    publisher_.answer(r);
}

/// Empty, with `plan` filled in; or the refusal.
std::optional<Refusal> Commands::plan_for(Axis& a, Command& c, Plan& plan, Instant now) {
    if (std::holds_alternative<Native>(c.body) || std::holds_alternative<Action>(c.body)) {
        if (auto no = beyond_reading(a, c.body, plan)) return no;
        plan.orders.push_back(c.body);
        return std::nullopt;
    }
    if (std::holds_alternative<ReadParameter>(c.body) || std::holds_alternative<WriteParameter>(c.body))
        return plan_parameter(a, c.body, plan);
    return plan_motion(a, c, plan, now);
}

/// A statement in the drive's own language is checked against the same limits as an order, if its family can read it.
std::optional<Refusal> Commands::beyond_reading(const Axis& a, const CommandBody& body, Plan& plan) const {
    const Stated said = Orders::stated(a, body);
    const Axis& about = orders_.concerned(a, said);
    if (said.kind != Stated::Kind::nothing && about.stops.bars_motion()) return behind_a_stop();
    if (auto no = orders_.beyond_limits(a, body)) return no;
    if (said.kind != Stated::Kind::unread) return std::nullopt;
    if (!a.spec.unread_statements)
        return Refusal{Reason::not_supported,
                       "the gateway cannot read whether this begins a motion, and the site refuses such statements (unread_statements)"};
    plan.unread = a.limits.position_min || a.limits.position_max || a.limits.velocity_max;
    return std::nullopt;
}

Refusal Commands::behind_a_stop() {
    return {Reason::wrong_state, "a quick stop is on its way to the drive: nothing is begun until it is answered"};
}

std::optional<Refusal> Commands::plan_parameter(const Axis& a, CommandBody& body, Plan& plan) const {
    const Catalogue& catalogue = *a.drive->catalogue;
    auto* write = std::get_if<WriteParameter>(&body);
    const Point point = write ? write->point : std::get<ReadParameter>(body).point;
    const Parameter* p = catalogue.parameter(point);
    if (!p) return Refusal{Reason::unknown_point, fmt::format("{} has no such parameter", catalogue.family())};
    if (!write && !p->readable()) return Refusal{Reason::not_writable, fmt::format("{} can only be written", catalogue.id_of(point))};
    if (write) {
        if (!p->writable()) return Refusal{Reason::not_writable, fmt::format("{} can only be read", catalogue.id_of(point))};
        auto checked = catalogue.check_write(point, write->value);
        if (!checked.fault.empty()) return Refusal{Reason::out_of_range, std::move(checked.fault)};
        write->value = std::move(checked.value);
        if (auto no = orders_.beyond_limits(a, body)) return no;
    }
    plan.orders.push_back(body);
    return std::nullopt;
}

std::optional<Refusal> Commands::plan_motion(Axis& a, Command& c, Plan& plan, Instant now) {
    auto* data = std::get_if<ProcessData>(&c.body);
    plan.motion = true;
    plan.stops = CommandAuthority::only_stops(a, c.body);
    if (const auto v = authority_.may_command(a, c, now); !v.allowed) {
        if (!plan.stops) return Refusal{Reason::authority, v.text};
        // Every client may stop, but only a client that may command can give set-points in the same write.
        if (data) *data = stop_alone(*data);
    }
    if (std::holds_alternative<Disable>(c.body) || (data && data->controlword && !(*data->controlword & cia402::cw_enable_voltage))) {
        a.drive->device_lost_while_commanded = false;  // no client commands the axis any more, so its twin may take over
        plan.lets_go = a.drive->spec.presence == PresenceRule::automatic && a.drive->serving == Presence::device && !a.drive->device_online;
    }
    if (auto no = orders_.beyond_limits(a, c.body)) return no;
    if (motions_.hold_on(a, c, now)) {
        plan.answered = true;
        return std::nullopt;
    }
    const std::int64_t buffered_from = a.profile.active_target().value_or(a.profile.feedback().position);
    // A set-point that starts with this control word, or waits because of it, is checked as the move that it is.
    const auto look = [&](const Cia402Axis::Decision& d) -> std::optional<Refusal> {
        for (const auto& o : d.orders) {
            if (auto no = begins_too_early(a, o)) return no;
            if (auto no = orders_.beyond_limits(a, o)) return no;
        }
        return d.waits ? guard_move(*d.waits, a.limits, buffered_from) : std::nullopt;
    };
    if (!data) {
        if (auto no = begins_too_early(a, c.body)) return no;
    }
    auto decision = data ? a.profile.on_process_data(*data, c.origin, look) : a.profile.on_command(c.body, c.origin);
    if (decision.refused) {
        const Side* side = machine_.side_of(*a.drive);
        if (decision.reason == Reason::no_answer && side && !side->up)
            return Refusal{Reason::line_down, fmt::format("line {} is down: {}", side->unit.spec.name, side->why)};
        return Refusal{decision.reason, std::move(decision.text)};
    }
    plan.orders = std::move(decision.orders);
    plan.waits = std::move(decision.waits);
    for (auto& o : plan.orders) {
        if (auto* move = std::get_if<Move>(&o)) complete(a, *move);
    }
    return std::nullopt;
}

/// While a quick stop has no answer yet, nothing may begin behind it; a prepared move needs an axis that is free to move.
std::optional<Refusal> Commands::begins_too_early(const Axis& a, const CommandBody& body) const {
    const auto* together = std::get_if<StartTogether>(&body);
    const bool begins = std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) || std::holds_alternative<Enable>(body);
    if ((begins || together) && a.stops.bars_motion()) return behind_a_stop();
    if (!together) return std::nullopt;
    for (const AxisId id : together->axes) {
        const Axis* x = machine_.axis(id);
        if (!x) continue;
        if (x->stops.bars_motion()) return behind_a_stop();
        if (auto no = x->profile.may_follow(); no.refused)
            return Refusal{no.reason, fmt::format("axis {}: {}", x->spec.name, std::move(no.text))};
    }
    return std::nullopt;
}

/// Fills in values that a move does not name: rates that the site limits, and, during a motion, the position from which a distance counts.
void Commands::complete(const Axis& a, Move& move) {
    name_rates(move, a.limits, a.profile.feedback().rates);
    if (move.kind != Move::Kind::relative || !a.motion.runs() || !a.profile.feedback().moving) return;
    const std::int64_t from = a.profile.active_target().value_or(a.profile.feedback().position);
    std::int64_t target = 0;
    if (__builtin_add_overflow(from, move.target, &target)) return;  // the range check has refused it already
    move.kind = Move::Kind::absolute;
    move.target = target;
}

ProcessData Commands::stop_alone(const ProcessData& data) {
    ProcessData stop;
    stop.controlword = data.controlword;
    return stop;
}

/// A block of registers with a stopping control word is not refused for a wrong value beside it: the stop is carried out, and the answer
/// reports the value.
void Commands::give_the_stop_alone(const Command& c, Instant now) {
    const auto* data = std::get_if<ProcessData>(&c.body);
    const bool values = data && (data->target_position || data->target_velocity || data->profile_velocity || data->profile_acceleration ||
                                 data->profile_deceleration || data->mode || data->homing_method);
    if (!values) return;
    Command only = c;
    only.ticket = make_ticket(engine_itself, pending_.next++);
    only.body = stop_alone(*data);
    on_command(std::move(only), now);
}

bool Commands::needs_authority(const Command& c, const Plan& plan) {
    return !std::holds_alternative<ReadParameter>(c.body) && !plan.empty();
}

void Commands::note_command(const Axis& a, const Command& c, const Plan& plan, Instant now) {
    const bool audited =
        // parameter writes are recorded when they are stored
        plan.motion || std::holds_alternative<Native>(c.body) || std::holds_alternative<Action>(c.body);
    if (plan.empty() || !audited || c.origin.door == Door::internal) return;
    Event e;
    e.kind = "command";
    e.axis = a.spec.name;
    e.who = c.origin.who ? *c.origin.who : "";
    e.door = std::string(name_of(c.origin.door));
    for (const auto& o : plan.orders) {
        e.text += (e.text.empty() ? "" : ", ") + std::string(name_of(o));
        if (const auto* m = std::get_if<Move>(&o)) e.text += fmt::format(" {}", m->target);
        if (const auto* n = std::get_if<Native>(&o); n && n->is_text) e.text += " " + std::string(n->send.begin(), n->send.end());
        if (const auto* x = std::get_if<Action>(&o)) e.text += " " + x->name;
    }
    if (plan.waits)
        e.text += fmt::format("{}{} {} waits for the running motion", e.text.empty() ? "" : ", ", name_of(CommandBody{*plan.waits}),
                              plan.waits->target);
    if (plan.unread) e.text += " (not compared with the axis' limits, because it cannot be read; the motion is watched)";
    publisher_.event(std::move(e), now);
}

/// The owner of a motion that another client has stopped can see this in registers and documents: this function sets the stop latch.
void Commands::note_stop(Axis& a, const AuthorityClient& by) {
    // no client has an interest in the axis any more
    const bool idle = a.owner().door == Door::none && !a.motion.runs() && a.profile.at_rest();
    if (by.door == Door::internal || idle || a.owner() == by) return;
    a.latch.bits = StopLatch::latched | StopLatch::by_client;
    a.latch.by = by;
}

void Commands::carry_out(Axis& a, Command&& c, Plan&& plan, Instant now) {
    auto client = std::make_unique<Client>();
    const auto number = client->number = pending_.next++;
    client->ticket = c.ticket;
    client->axis = c.axis;
    client->body = std::move(c.body);
    client->origin = c.origin;
    client->until_done = c.until_done;
    client->lets_go = plan.lets_go;
    client->waiting = plan.orders.size();
    client->result.outcome = Outcome::accepted;
    if (const auto* data = std::get_if<ProcessData>(&client->body);
        data && data->controlword && (*data->controlword & cia402::cw_new_setpoint))
        a.setpoint_ticket = client->ticket;
    if (plan.motion && !plan.stops && !plan.empty()) a.latch.cause = LossCause::none;
    if (plan.waits) a.waiting = c.origin;
    if (std::ranges::any_of(plan.orders, is_urgent)) note_stop(a, AuthorityClient::of(c.origin));
    if (plan.orders.empty()) {
        client->accepted = true;
        client->accepted_at = now;
    }
    a.clients.push_back(number);
    pending_.clients.emplace(number, std::move(client));
    publisher_.publish(a, now);
    if (plan.orders.empty()) return clients_.track(a, now);
    for (auto& o : plan.orders) {
        const auto still = pending_.clients.find(number);
        if (still == pending_.clients.end()) return;  // an earlier order of this command was refused at once
        orders_.give(a, still->second.get(), std::move(o), c.origin, now);
    }
}

}  // namespace axisgate::engine
