// Drive: what is waited for beside its jobs: the end of a program (BY tells it, and what else may have ended it), the return of a drive
// that was restarted.
// In: polls, lines that the drive took, errors, the loss of the drive. Out: the one result of the command that began it.
// Never calls a program done that somebody has ended, nor one that nobody has seen end.
#include <fmt/core.h>

#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

void Drive::restart_over(Outcome o, Reason r, std::string_view what, Turn& t) {
    if (!restart_) return;
    const Command c = std::move(*restart_);
    restart_.reset();
    result(c, o, r, fmt::format("{}: {}", name(), what), t);
}

/// A line that the drive took, or may have taken: does it end programs?
void Drive::program_told(std::string_view line) {
    const auto w = word_of(line);
    if (program_ && (line == escape_key || w == "E" || w == "CP" || w == "FD")) program_->ended_by = line;
}

void Drive::program_lost(Reason reason, const std::string& why, Turn& t) {
    if (!program_) return;
    const Command c = std::move(program_->command);
    program_.reset();
    result(c, Outcome::failed, reason, fmt::format("{}: {}; whether its program has come to its end is not known", name(), why), t);
}

/// Behind a poll. The poll that confirms EX may be older than BY: the first one after it is the first look.
void Drive::watch_program(Turn& t) {
    if (!program_ || running_ || ef_) return;  // the code of an error is asked for first; the next poll has EF = 0
    const StartedProgram p = std::move(*program_);
    program_.reset();
    const ErrorCode* e = p.code != 0 ? catalogue_.error(p.code) : nullptr;
    const std::string error = p.code == 0 ? std::string() : fmt::format("error {}{}", p.code, e ? ", " + e->text : std::string());
    if (!p.ended_by.empty()) {
        return result(p.command, Outcome::failed, Reason::interrupted, fmt::format("{}: its program was ended by {}", name(), p.ended_by),
                      t);
    }
    constexpr int soft_stop = 48;  // an input of type 5 [L776]
    if (p.code == soft_stop || is_fault_code(p.code)) {
        return result(p.command, Outcome::failed, Reason::interrupted, fmt::format("{}: its program has ended with {}", name(), error), t,
                      p.code);
    }
    // Any other error only skips its line (E-38).
    result(p.command, Outcome::done, Reason::none,
           error.empty() ? std::string() : fmt::format("{}: its program has ended; on its way {}", name(), error), t, p.code);
}

}  // namespace axisgate::mcode
