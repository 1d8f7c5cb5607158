// Each command is one request. The other gateway decides what the axis may do.
#include <fmt/core.h>

#include <utility>

#include "adapters/remote/drive.hpp"

namespace axisgate::remote {

void Drive::begin(Command command, Turn& t) {
    mirror::Order order;
    if (std::string why = plan(command.body, order); !why.empty())
        return void(tickets_.refused(command.ticket, Reason::not_supported, std::move(why), t.out));
    const bool moves = drive::is_motion(command.body);
    if (moves) asked_.reset();
    order.wait_ms = milliseconds_of(answer_time_);
    const std::uint64_t number = send(order, Priority::command, t);
    if (moves || std::holds_alternative<SetPosition>(command.body)) newest_ = number;
    if (order.hold_ms) {
        Renewal r{order, 0, t.now + renewed};
        r.order.renew = true;
        r.order.wait_ms = milliseconds_of(renewed);
        asked_ = std::move(r);
    }
    // Slightly longer than the other gateway waits: its answer is more precise than a time-out.
    running_ = Running{std::move(command), number, t.now + answer_time_ + line_.timing.reply_timeout};
}

/// Empty, or why it is refused.
std::string Drive::plan(const CommandBody& body, mirror::Order& o) const {
    o.verb = name_of(body);
    if (std::holds_alternative<Enable>(body) || std::holds_alternative<ResetFault>(body)) return {};
    if (const auto* home = std::get_if<Home>(&body)) return o.method = home->method, "";
    if (const auto* set = std::get_if<SetPosition>(&body)) return o.position = set->position, "";
    if (const auto* move = std::get_if<Move>(&body); move && !move->prepare_only) {
        const bool turns = move->kind == Move::Kind::velocity;
        (turns ? o.velocity : o.position) = move->target;
        if (!turns) o.velocity = move->velocity;
        o.acceleration = move->acceleration;
        o.deceleration = move->deceleration;
        if (turns) o.hold_ms = milliseconds_of(hold);
        return {};
    }
    if (const auto* read = std::get_if<ReadParameter>(&body)) {
        const Parameter* p = line_.catalogue.parameter(read->point);
        o.verb = "read";
        if (p) o.name = p->id;
        return p ? "" : "there is no such parameter";
    }
    const auto* action = std::get_if<Action>(&body);
    if (action && action->name == "refresh") {
        o.verb = "state";
        return action->argument.empty() ? "" : "refresh takes no argument";
    }
    return fmt::format("a mirrored axis has no {}: its own gateway has what its drive can beyond CiA 402",
                       action ? std::string_view(action->name) : name_of(body));
}

void Drive::answered(const mirror::Answer& answer, Turn& t) {
    const bool taken = answer.outcome == Outcome::accepted || answer.outcome == Outcome::done;
    const CommandBody& body = running_->command.body;
    if (!taken) {
        ++line_.counters.refused;
        if (drive::is_motion(body)) asked_.reset();
        return finish(answer, t);
    }
    const bool homes = std::holds_alternative<Home>(body);
    if (homes || std::holds_alternative<Move>(body)) {
        axis_.target_reached = false;  // "target reached" of the old target must not be reported for the new one
        axis_.moving = true;
        begun_ = t.now;
        axis_.homing = homes;
        axis_.homing_attained = axis_.homing_error = false;
        emit(t);
        renewal_ = std::exchange(asked_, std::nullopt);
        // A renewal that was sent before may be refused because it came before the motion.
        if (renewal_) renewal_->number = 0;
    }
    finish(answer, t);
}

void Drive::finish(const mirror::Answer& answer, Turn& t) {
    const auto* read = std::get_if<ReadParameter>(&running_->command.body);
    const Parameter* p = read ? line_.catalogue.parameter(read->point) : nullptr;
    const bool taken = answer.outcome == Outcome::accepted || answer.outcome == Outcome::done;
    if (p && taken) {
        const auto value = parse_value(answer.text, p->type);
        if (value) {
            tickets_.answer(running_->command.ticket, Outcome::done, Reason::none, {}, t.out, 0, *value);
        } else {
            tickets_.refused(running_->command.ticket, Reason::drive_refused, "its gateway has told no value", t.out);
        }
    } else {
        tickets_.answer(running_->command.ticket, taken ? Outcome::accepted : answer.outcome, answer.reason, answer.text, t.out,
                        answer.code);
    }
    running_.reset();
    if (presence_.online()) timer_.soon(t.now);
}

}  // namespace axisgate::remote
