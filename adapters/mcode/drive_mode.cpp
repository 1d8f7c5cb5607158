// ProgramMode: the evidence for it, and PG until a question is answered.
// In: the ends of PG lines, probes and questions. Out: the mode; requests; a drive that is given up as absent.
// Never says PG on a suspicion alone: it would put a drive that is only away into program mode.
#include "adapters/mcode/drive_mode.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

bool ProgramMode::leaving() const noexcept {
    return !drive_.bus.only_reads && !immediate() && (!drive_.programs.downloads() || suspected_);
}

bool ProgramMode::proven(int questions) const noexcept { return drive_.words.sums || evidence_ >= questions; }

/// PG while the mode is known, a question while it is not. The question that was stored is removed by CP with the rest of the half.
Request ProgramMode::next() {
    asks_ = mode_ != Mode::program;
    Request r = asks_ ? Request::ask(Request::Purpose::leave, "EM") : Request::say(Request::Purpose::leave, "PG");
    r.urgent = true;
    r.wake = true;  // what stands half in its buffer ends before this
    sending(r.text);
    return r;
}

void ProgramMode::sending(std::string_view line) {
    if (word_of(line) != "PG") return;
    in_flight_ = true;
    evidence_ = 0;
    before_ = std::exchange(mode_, Mode::unknown);
}

bool ProgramMode::line_ended(Verdict v) {
    if (!std::exchange(in_flight_, false)) return false;
    if (v == Verdict::refused) {
        mode_ = before_;
    } else if (v == Verdict::acknowledged || v == Verdict::answered) {
        mode_ = before_ == Mode::immediate ? Mode::program : before_ == Mode::program ? Mode::immediate : Mode::unknown;
    }
    if (immediate() && doubt_) mode_ = Mode::unknown;
    return true;
}

void ProgramMode::suspect() noexcept {
    mode_ = Mode::unknown;
    suspected_ = true;
    stored_ = 1;
    evidence_ = 0;
}

/// It may restart meanwhile: PG would put it into program mode then.
void ProgramMode::away(bool line_down) noexcept {
    if (line_down) in_flight_ = false;  // a PG that nobody can answer any more: the mode stays unknown
    if (mode_ == Mode::program) mode_ = Mode::unknown;
}

/// Bounded by presence: each round without a word counts as silence, and a silent drive becomes absent; its probes ask on.
void ProgramMode::ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (r.data().empty() && v == Verdict::waiting && r.raw().empty()) {
        // EM = 2 says nothing for a stored line either: PG is tried, and the next question tells.
        if (mode_ == Mode::unknown && drive_.quiet() && !suspected_) mode_ = Mode::program;
        return drive_.start.silent(t);
    }
    if (asks_) {
        const bool nak_came = r.raw().find(nak) != std::string::npos;
        if (v == Verdict::answered) {
            mode_ = Mode::immediate;
            doubt_ = suspected_ = false;
            evidence_ = 0;
        } else if (suspected_ || !drive_.words.sums ? r.taken_without_answer() : !nak_came && v != Verdict::garbled) {
            ++stored_;
            evidence_ += led_ ? 1 : 0;
            if (proven(2)) {
                mode_ = Mode::program;  // taken and not answered: it was stored
                if (suspected_ && !found_) found();
            }
        }
    }
    if (immediate()) {
        rounds_ = 0;
        if (found_) led_out(t);
        return;
    }
    if (++rounds_ >= 12) {
        rounds_ = 0;
        drive_.start.lose(fmt::format("{} does not leave program mode", name()), t);
    }
}

/// A probe that was taken and not answered, twice: the drive is in program mode. Once may be an answer that was lost, or a refusal.
/// Without checksums a line end may be another drive's, whose half line was ended, and two lines that were joined because an end was lost
/// look like one that prints nothing. So it takes questions in a row, each behind a LF of our own, and no time-out between them: what the
/// first has ended or joined cannot be in the way of the last. Silent drives are not led out on suspicion: EM = 2 acknowledges nothing, and
/// PG would put one that is only away into program mode.
bool ProgramMode::probed(Verdict v, const ReplyReader& r, Turn& t) {
    if (v == Verdict::answered) {
        const bool short_question = std::exchange(suspected_, false) && r.data().size() <= 2 && !drive_.bus.ethernet;
        mode_ = Mode::immediate;
        doubt_ = false;
        evidence_ = 0;
        if (found_) {
            led_out(t);
            rounds_ = 0;
        }
        if (short_question && ++rounds_ < 4) {
            drive_.start.again(t);  // EM alone was asked: the whole question comes next
            return true;
        }
        rounds_ = 0;
        return false;
    }
    if (v == Verdict::waiting && mode_ == Mode::unknown && r.raw().empty() && drive_.bus.em == 2 && !found_) {
        mode_ = Mode::program;  // its own download, and it says nothing for stored lines
        return false;
    }
    if (!r.taken_without_answer()) {
        if (immediate()) suspected_ = false;
        return false;
    }
    evidence_ += led_ ? 1 : 0;
    if (immediate() && !suspected_) {
        suspected_ = true;
        stored_ = 1;
        drive_.start.again(t);
        return true;
    }
    ++stored_;
    const bool in_vain = rounds_ >= 3 && evidence_ == 1;  // PG was said, and the question behind it was stored again
    if (!in_vain && proven(found_ ? 2 : 3)) {
        if (suspected_ && !found_) found();
        mode_ = Mode::program;
        drive_.start.again(t);
        ++rounds_;
        return true;
    }
    if (!in_vain && stored_ % 4 != 0) {
        drive_.start.again(t);
        return true;
    }
    // Each question is stored: from here on they come with the pauses of a drive that is away.
    drive_.start.lose_longer(
        in_vain ? fmt::format("{} is in program mode and does not leave it: power it off and on, or use its maker's tool", name())
                : drive_.start.not_understood(),
        t);
    return true;
}

/// What was acknowledged last has been stored, not done: it is said again behind PG.
void ProgramMode::found() {
    found_ = true;
    doubt_ = true;  // a PG too many would put it into program mode: a question verifies
    rounds_ = 0;
    drive_.stops.say_again();
    drive_.jobs.say_again();
    drive_.errors.stop_asking();
}

void ProgramMode::led_out(Turn& t) {
    found_ = suspected_ = false;
    drive_.programs.tidy();
    note(Severity::warning, "program_mode", 0,
         fmt::format("{} was in program mode and was led out (PG), because in it nothing is answered and every line, a stop too, "
                     "becomes program text; its program stays, with {} question{} of this gateway (PR \"#...) behind the last line",
                     name(), stored_, stored_ == 1 ? "" : "s"),
         t);
}

}  // namespace axisgate::mcode
