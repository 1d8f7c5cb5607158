// One drive: which verb a command is, and how a job ends.
// In: commands in order, answers. Out: the verb's telegrams, exactly one result. Never two jobs at once.
#include "adapters/linmot/drive.hpp"

#include <fmt/core.h>

namespace axisgate::linmot {

void Drive::begin_job(Turn& t) {
    job_ = {};
    job_.active = true;
    job_.command = queue_.pop();
    const CommandBody& body = job_.command.body;
    if (const auto* move = std::get_if<Move>(&body)) return begin_move(*move, t);
    if (const auto* home = std::get_if<Home>(&body)) return begin_home(*home, t);
    if (const auto* place = std::get_if<SetPosition>(&body)) {
        if (status_.state() != state::enabled)
            return end_job(Outcome::refused, Reason::wrong_state,
                           fmt::format("drive {} is in {}: its position is set while it is enabled", title(), state_text()), t);
        if (place->position < INT32_MIN || place->position > INT32_MAX)
            return end_job(Outcome::refused, Reason::out_of_range, "the position is beyond what the drive can count", t);
        to_target_ = false;
        return begin_motion(*bus_.motions.named("009xh"), {place->position}, t);
    }
    if (std::holds_alternative<Action>(body)) return begin_action(t);
    if (std::holds_alternative<StartTogether>(body))
        return end_job(Outcome::refused, Reason::not_supported, "LinMot drives cannot be started together", t);
}

std::optional<Telegram> Drive::job_request(Turn& t) {
    const CommandBody& body = job_.command.body;
    if (job_.number == -1) return motion_request(t);
    if (job_.transfer.active) return transfer_request();
    if (std::holds_alternative<Enable>(body)) return power_request(t);
    if (std::holds_alternative<ResetFault>(body)) return reset_request(t);
    if (std::holds_alternative<Home>(body)) return home_request(t);
    if (std::holds_alternative<ReadParameter>(body) || std::holds_alternative<WriteParameter>(body)) return parameter_request(t);
    if (std::holds_alternative<Native>(body)) return native_request(t);
    if (std::holds_alternative<Action>(body)) return action_request(t);
    end_job(Outcome::refused, Reason::not_supported, fmt::format("a LinMot drive has no {}", name_of(body)), t);
    return std::nullopt;
}

/// A motion command once, with a new count; then its count is looked for.
std::optional<Telegram> Drive::motion_request(Turn&) {
    if (job_.step > 0) return request(id_, Main::response, 1);
    job_.step = 1;
    job_.count = next_count();
    std::vector<std::uint8_t> bytes = job_.bytes;
    bytes[0] = static_cast<std::uint8_t>((bytes[0] & 0xF0) | job_.count);
    Telegram telegram = request(id_, Main::motion, 0);
    for (const auto b : bytes)
        telegram.add(b);
    return telegram;
}

void Drive::job_answered(const Telegram& telegram, Turn& t) {
    const CommandBody& body = job_.command.body;
    if (job_.number == -1) return motion_answered(t);
    if (std::holds_alternative<ReadParameter>(body) || std::holds_alternative<WriteParameter>(body)) return parameter_answered(telegram, t);
    if (std::holds_alternative<Native>(body)) return native_answered(telegram, t);
    if (std::holds_alternative<Action>(body)) return action_answered(telegram, t);
}

void Drive::job_failed_silent(Turn& t) {
    if (transfer_again()) return;
    to_target_ = false;
    demand_.forget();
    end_job(Outcome::failed, Reason::no_answer, fmt::format("drive {} does not answer", title()), t);
}

void Drive::end_job(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code, Value value) {
    const Ticket ticket = job_.command.ticket;
    std::vector<std::uint8_t> bytes =
        std::holds_alternative<Native>(job_.command.body) ? std::move(job_.bytes) : std::vector<std::uint8_t>();
    if (outcome == Outcome::refused && reason == Reason::drive_refused) ++bus_.counters.refused;
    const bool streamed = ticket == no_ticket && std::holds_alternative<Move>(job_.command.body);
    job_ = {};
    if (streamed && outcome != Outcome::accepted && reason != Reason::interrupted) t.out.stream_ends.push_back({axis_, reason, text});
    tickets_.answer(ticket, outcome, reason, std::move(text), t.out, code, std::move(value), std::move(bytes));
}

}  // namespace axisgate::linmot
