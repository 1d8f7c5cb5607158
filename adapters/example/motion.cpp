// A motion is ordered only after the drive has accepted its values.
#include <fmt/core.h>

#include "adapters/example/drive.hpp"

namespace axisgate::example {
using Kind = Telegram::Kind;

Telegram Drive::stop(const Command& c) const {
    const int channel = channel_of(c.axis);
    return std::holds_alternative<Disable>(c.body) ? write(channel, "R20", 0)
                                                   : write(channel, "R23", std::holds_alternative<QuickStop>(c.body) ? 1 : 0);
}

std::string Drive::plan(Job& job, Reason& reason) const {
    const CommandBody& body = job.command.body;
    const int channel = channel_of(job.command.axis);
    const auto add = [&](Telegram t) { return job.steps.push_back(std::move(t)), std::string(); };
    if (std::holds_alternative<Enable>(body)) return add(write(channel, "R20", 1));
    if (std::holds_alternative<ResetFault>(body)) return add(write(channel, "R24", 1));
    if (const auto* home = std::get_if<Home>(&body); home && (home->method == 0 || home->method == 35 || home->method == 37))
        return add(write(channel, "R25", 0));
    if (const auto* set = std::get_if<SetPosition>(&body)) {
        job.steps.push_back(write(channel, "R25", set->position));
        return add(poll(channel));  // complete when the axis shows it
    }
    if (const auto* move = std::get_if<Move>(&body); move && !move->prepare_only) return plan_move(job, *move, reason);
    if (const auto* native = std::get_if<Native>(&body)) return plan_native(job, *native, reason);
    const auto item = [&](const Point& point) {
        const Parameter* p = catalogue().parameter(point);
        return fmt::format("R{:02}", p->wire.at("register").as_int64() + (p->count ? point.element - p->first : 0));
    };
    if (const auto* r = std::get_if<ReadParameter>(&body); r && catalogue().parameter(r->point)) return add(read(channel, item(r->point)));
    if (const auto* w = std::get_if<WriteParameter>(&body); w && catalogue().parameter(w->point))
        return add({address_, channel, item(w->point), Kind::value, to_text(w->value)});
    const auto* action = std::get_if<Action>(&body);
    if (!action || action->name != "identify")
        return fmt::format("an example drive has no {}", action ? std::string_view(action->name) : name_of(body));
    reason = Reason::out_of_range;
    return action->argument.empty() ? add(write(channel, "R26", 1)) : "identify takes no argument";
}

std::string Drive::plan_move(Job& job, const Move& move, Reason& reason) const {
    const int channel = channel_of(job.command.axis);
    const bool turns = move.kind == Move::Kind::velocity;
    reason = Reason::wrong_state;
    if (axis(channel).power != AxisFeedback::Power::on) return "the axis is off: enable it first";
    if (move.acceleration) job.steps.push_back(write(channel, "R07", *move.acceleration));
    if (move.deceleration) job.steps.push_back(write(channel, "R08", *move.deceleration));
    if (move.velocity && !turns) job.steps.push_back(write(channel, "R06", *move.velocity));
    // A distance is converted to its final position, so that a repetition does not move twice; `stepped` adds the motion.
    const bool relative = move.kind == Move::Kind::relative;
    job.steps.push_back(relative ? poll(channel) : write(channel, turns ? "R22" : "R21", move.target));
    return {};
}

void Drive::stepped(Job& job, const Telegram& answer) {
    const auto* move = std::get_if<Move>(&job.command.body);
    if (move && move->kind == Move::Kind::relative && answer.item == "S00")
        job.steps.push_back(write(answer.axis, "R21", axis(answer.axis).position + move->target));
}

/// "R06?" or "R06=1000".
std::string Drive::plan_native(Job& job, const Native& native, Reason& reason) const {
    const std::string s(native.send.begin(), native.send.end());
    reason = Reason::out_of_range;
    if (s.size() < 4 || s.size() > 20 || ((s[3] != '?' || s.size() > 4) && s[3] != '='))
        return "write R06? to read a register or R06=1000 to write one";
    if (s.find_first_of("@#\r\n") != s.npos) return "a telegram has no control characters";
    job.steps.push_back({address_, channel_of(job.command.axis), s.substr(0, 3), static_cast<Kind>(s[3]), s.substr(4)});
    return {};
}

void Drive::acted(const CommandBody& body, AxisFeedback& axis) {
    if (std::holds_alternative<Home>(body)) axis.homing_attained = axis.referenced = true;
    if (const auto* move = std::get_if<Move>(&body)) axis.course = move->kind == Move::Kind::velocity ? Course::endless : Course::to_target;
}

std::string Drive::words_of(const Telegram& request) const {
    return request.kind == Kind::value ? request.item + "=" + request.text : request.item;
}

}  // namespace axisgate::example
