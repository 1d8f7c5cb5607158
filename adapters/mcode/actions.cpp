// ProgramEnd: what a started program waits for, which is no job: its end.
// In: polls, lines that the drive took, errors, the loss of the drive. Out: the one result of a start.
// Never calls a program done that somebody has ended, nor one that nobody has seen end.
#include "adapters/mcode/actions.hpp"

#include <fmt/core.h>

#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

void ProgramEnd::await(Command command, Turn& t) {
    lost(Reason::interrupted, "another program was started", t);
    started_ = Started{std::move(command), {}, 0};
}

void ProgramEnd::line_taken(std::string_view line) {
    const auto w = word_of(line);
    if (started_ && (line == escape_key || w == "E" || w == "CP" || w == "FD")) started_->ended_by = line;
}

void ProgramEnd::reported(int error) noexcept {
    if (started_) started_->error = error;
}
void ProgramEnd::reported_first(int error) noexcept {
    if (started_ && started_->error == 0) started_->error = error;
}

void ProgramEnd::lost(Reason reason, const std::string& why, Turn& t) {
    const auto p = std::exchange(started_, std::nullopt);
    if (!p) return;
    drive_.tickets.failed(p->command.ticket, reason,
                          fmt::format("{}: {}; whether its program has come to its end is not known", name(), why), t.out);
}

/// The poll that confirms EX may be older than BY: the first one after it is the first look.
void ProgramEnd::watch(Turn& t) {
    const auto& flags = feedback().flags();
    if (flags.by || flags.ef) return;  // the code of an error is asked for first; the next poll has EF = 0
    const auto p = std::exchange(started_, std::nullopt);
    if (!p) return;
    const auto answer = [&](Outcome o, Reason r, std::string text) {
        drive_.tickets.answer(p->command.ticket, o, r, std::move(text), t.out, p->ended_by.empty() ? p->error : 0);
    };
    const std::string error = p->error == 0 ? std::string() : drive_.errors.text_of(p->error);
    if (!p->ended_by.empty())
        return answer(Outcome::failed, Reason::interrupted, fmt::format("{}: its program was ended by {}", name(), p->ended_by));
    constexpr int soft_stop = 48;  // an input of type 5 [L776]
    if (p->error == soft_stop || is_fault_code(p->error))
        return answer(Outcome::failed, Reason::interrupted, fmt::format("{}: its program has ended with {}", name(), error));
    // Any other error only skips its line (E-38).
    answer(Outcome::done, Reason::none,
           error.empty() ? std::string() : fmt::format("{}: its program has ended; on its way {}", name(), error));
}

}  // namespace axisgate::mcode
