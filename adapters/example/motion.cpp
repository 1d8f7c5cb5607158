// Drive, part motion: each command as a short list of exchanges, and what follows from their answers.
// In: commands from the queue, answers to their steps. Out: steps, the one result. Never begins a motion whose values were refused.
#include <fmt/core.h>

#include "adapters/example/drive.hpp"

namespace axisgate::example {
using Kind = Telegram::Kind;

void Drive::begin(Command command, Turn& t) {
    Job job{std::move(command), {}, 0};
    Reason reason = Reason::not_supported;
    std::string why = plan(job, reason);
    if (!why.empty()) return void(tickets_.refused(job.command.ticket, reason, std::move(why), t.out));
    followed_[static_cast<std::size_t>(channel_of(job.command.axis))] = {};  // it may set what a stream has set
    job_ = std::move(job);
}

/// A motion without a ticket. Speed and ramps are settings that the drive keeps: they are told again only where they change.
Drive::Job Drive::job_for(const SetPoint& p) {
    Job job{{}, {}, 0};
    job.command.axis = p.axis;
    const Move wanted = p.as_move();
    job.command.body = wanted;
    Move& told = followed_[static_cast<std::size_t>(channel_of(p.axis))];
    const auto write = [&](const char* item, std::int64_t v) { job.steps.push_back({item, Kind::value, std::to_string(v)}); };
    const auto setting = [&](const char* item, const std::optional<std::int64_t>& v, std::optional<std::int64_t>& before) {
        if (v && v != before) write(item, *(before = v));
    };
    setting("R07", wanted.acceleration, told.acceleration);
    setting("R08", wanted.deceleration, told.deceleration);
    setting("R06", wanted.velocity, told.velocity);
    write(p.mode == SetPoint::Mode::velocity ? "R22" : "R21", p.value);
    return job;
}

/// Empty, or why it is refused.
std::string Drive::plan(Job& job, Reason& reason) const {
    const auto write = [&](const char* item, std::int64_t v, bool from_here = false) {
        job.steps.push_back({item, Kind::value, std::to_string(v), from_here});
    };
    const CommandBody& body = job.command.body;
    const AxisFeedback& axis = axes_[static_cast<std::size_t>(channel_of(job.command.axis))];
    if (std::holds_alternative<Enable>(body)) return write("R20", 1), "";
    if (std::holds_alternative<ResetFault>(body)) return write("R24", 1), "";
    if (const auto* home = std::get_if<Home>(&body); home && (home->method == 0 || home->method == 35 || home->method == 37))
        return write("R25", 0), "";
    if (const auto* set = std::get_if<SetPosition>(&body)) return write("R25", set->position), "";
    if (const auto* move = std::get_if<Move>(&body); move && !move->prepare_only) {
        reason = Reason::wrong_state;
        if (axis.power != AxisFeedback::Power::on) return "the axis is off: enable it first";
        if (move->acceleration) write("R07", *move->acceleration);
        if (move->deceleration) write("R08", *move->deceleration);
        if (move->velocity && move->kind != Move::Kind::velocity) write("R06", *move->velocity);
        if (move->kind == Move::Kind::relative) job.steps.push_back({"S00", Kind::read, {}});
        write(move->kind == Move::Kind::velocity ? "R22" : "R21", move->target, move->kind == Move::Kind::relative);
        return {};
    }
    const auto* read = std::get_if<ReadParameter>(&body);
    const auto* to = std::get_if<WriteParameter>(&body);
    if (const Parameter* p = read ? line_.catalogue.parameter(read->point) : to ? line_.catalogue.parameter(to->point) : nullptr) {
        const Point point = read ? read->point : to->point;
        const auto number = p->wire.at("register").as_int64() + (p->count ? point.element - p->first : 0);
        job.steps.push_back({fmt::format("R{:02}", number), read ? Kind::read : Kind::value, read ? "" : to_text(to->value)});
        return {};
    }
    if (const auto* native = std::get_if<Native>(&body); native && native->send.size() >= 4 && native->send.size() <= 20) {
        const std::string s(native->send.begin(), native->send.end());  // "R06?" or "R06=1000"
        reason = Reason::out_of_range;
        if ((s[3] != '?' || s.size() > 4) && s[3] != '=') return "write R06? to read a register or R06=1000 to write one";
        if (s.find_first_of("@#\r\n") != s.npos) return "a telegram has no control characters";
        job.steps.push_back({s.substr(0, 3), static_cast<Kind>(s[3]), s.substr(4)});
        return {};
    }
    if (const auto* action = std::get_if<Action>(&body); action && action->name == "identify") {
        reason = Reason::out_of_range;
        return action->argument.empty() ? (write("R26", 1), "") : "identify takes no argument";
    }
    const auto* unknown = std::get_if<Action>(&body);
    return fmt::format("an example drive has no {}", unknown ? std::string_view(unknown->name) : name_of(body));
}

void Drive::step_answered(const Telegram& answer, Turn& t) {
    Job& job = *job_;
    const Command& c = job.command;
    const bool last = job.at + 1 == job.steps.size();
    if (answer.kind == Kind::refused && !std::holds_alternative<Native>(c.body)) {
        const int code = std::atoi(answer.text.c_str());
        const ErrorCode* known = line_.catalogue.error(code);
        if (c.ticket == no_ticket && std::holds_alternative<Move>(c.body)) {
            followed_[static_cast<std::size_t>(channel_of(c.axis))] = {};
            t.out.stream_ends.push_back(
                {c.axis, Reason::drive_refused,
                 fmt::format("{}={}: {}", answer.item, job.steps[job.at].text, known ? known->text : "code " + answer.text)});
        }
        tickets_.refused(c.ticket, Reason::drive_refused,
                         fmt::format("{}={}: {}", answer.item, job.steps[job.at].text, known ? known->text : "code " + answer.text), t.out,
                         code);
        return job_.reset();
    }
    if (!last) return void(++job.at);
    const int channel = channel_of(c.axis);
    AxisFeedback& fb = axes_[static_cast<std::size_t>(channel)];
    if (c.ticket == no_ticket) {
        if (!fb.moving) (void)polls_.soon(static_cast<drive::Polls::Item>(channel), t.now);
        return job_.reset();
    }
    if (std::holds_alternative<Move>(c.body)) {
        fb.target_reached = false;  // the old "reached" must not stand for the new target
        fb.moving = true;
        emit(channel, t);
    }
    if (std::holds_alternative<Home>(c.body)) fb.homing_attained = fb.referenced = true;
    Value value;
    const auto* read = std::get_if<ReadParameter>(&c.body);
    const auto* to = std::get_if<WriteParameter>(&c.body);
    const Parameter* p = read ? line_.catalogue.parameter(read->point) : to ? line_.catalogue.parameter(to->point) : nullptr;
    if (p) value = parse_value(answer.text, p->type).value_or(Value{});
    tickets_.answer(c.ticket, p ? Outcome::done : Outcome::accepted, Reason::none,
                    std::holds_alternative<Native>(c.body) ? answer.text : "", t.out, 0, std::move(value),
                    {answer.text.begin(), answer.text.end()});
    (void)polls_.soon(static_cast<drive::Polls::Item>(channel), t.now);
    job_.reset();
}

}  // namespace axisgate::example
