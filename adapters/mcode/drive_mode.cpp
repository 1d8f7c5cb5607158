// Drive: out of program mode: after a broken download, and when somebody else has left the drive in it.
// In: lines PG as they are sent, their end; questions that were taken and not answered. Out: requests that lead the drive back to immediate
// mode, an event, and the removal of what it has stored of this gateway's questions.
// Never lets a stop, a poll or a command go to a drive that may take it as program text: PG toggles [L4778], so each PG is counted, and
// when its acknowledgement was lost a marked question tells the mode: data means immediate, an acknowledgement alone means stored.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/native_program.hpp"

namespace axisgate::mcode {

bool Drive::leaving() const noexcept { return mode_ != Mode::immediate && (job_.kind != JobKind::download || suspected_); }

/// PG while the mode is known, a question while it is not. The question that was stored is removed by CP with the rest of the half.
Request Drive::next_leave() {
    Request r;
    r.purpose = purpose_ = Request::Purpose::leave;
    r.urgent = true;
    r.wake = true;  // what stands half in its buffer ends before this
    purpose_was_question_ = mode_ != Mode::program;
    if (mode_ == Mode::program) {
        r.text = "PG";
        r.kind = Expect::Kind::command;
        note_mode_line(r.text);
    } else {
        r.text = "EM";
    }
    return r;
}

void Drive::note_mode_line(std::string_view line) {
    if (word_of(line) != "PG") return;
    mode_flight_ = true;
    evidence_ = 0;
    mode_before_ = mode_;
    mode_ = Mode::unknown;
}

void Drive::mode_line_ended(Verdict v) {
    if (!mode_flight_) return;
    mode_flight_ = false;
    if (v == Verdict::refused) {
        mode_ = mode_before_;
    } else if (v == Verdict::acknowledged || v == Verdict::answered) {
        mode_ = mode_before_ == Mode::immediate ? Mode::program : mode_before_ == Mode::program ? Mode::immediate : Mode::unknown;
    }
    if (mode_ == Mode::immediate && mode_doubt_) mode_ = Mode::unknown;
}

/// Bounded by presence: each round without a word counts as silence, and a silent drive becomes absent; its probes ask on.
void Drive::leave_ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (r.data().empty() && v == Verdict::waiting && r.raw().empty()) {
        // EM = 2 says nothing for a stored line either: PG is tried, and the next question tells.
        if (mode_ == Mode::unknown && quiet() && !suspected_) mode_ = Mode::program;
        return count_silence(t);
    }
    if (purpose_was_question_) {
        const bool nak_came = r.raw().find('\x15') != std::string::npos;
        if (v == Verdict::answered) {
            mode_ = Mode::immediate;
            mode_doubt_ = suspected_ = false;
            evidence_ = 0;
        } else if (suspected_ || !sums_ ? r.taken_without_answer() : !nak_came && v != Verdict::garbled) {
            ++stored_;
            evidence_ += led_ ? 1 : 0;
            if (proven(2)) {
                mode_ = Mode::program;  // taken and not answered: it was stored
                if (suspected_ && !found_) found_in_program();
            }
        }
    }
    if (mode_ == Mode::immediate) {
        leave_rounds_ = 0;
        if (found_) led_out(t);
        return;
    }
    if (++leave_rounds_ >= 12) {
        leave_rounds_ = 0;
        go_absent(t, fmt::format("{} does not leave program mode", name()));
    }
}

/// A probe that was taken and not answered, twice: the drive is in program mode. Once may be an answer that was lost, or a refusal.
/// Without checksums a line end may be another drive's, whose half line was ended, and two lines that were joined because an end was lost
/// look like one that prints nothing. So it takes questions in a row, each behind a LF of our own, and no time-out between them: what the
/// first has ended or joined cannot be in the way of the last. Silent drives are not led out on suspicion: EM = 2 acknowledges nothing, and
/// PG would put one that is only away into program mode.
bool Drive::probe_tells_mode(Verdict v, const ReplyReader& r, Turn& t) {
    if (v == Verdict::answered) {
        const bool short_question = std::exchange(suspected_, false) && r.data().size() == 1 && !manners_.ethernet;
        mode_ = Mode::immediate;
        mode_doubt_ = false;
        evidence_ = 0;
        if (found_) {
            led_out(t);
            leave_rounds_ = 0;
        }
        if (short_question && ++leave_rounds_ < 4) {
            next_probe_ = t.now;  // EM alone was asked: the whole question comes next
            return true;
        }
        leave_rounds_ = 0;
        return false;
    }
    if (v == Verdict::waiting && mode_ == Mode::unknown && r.raw().empty() && manners_.em == 2 && !found_) {
        mode_ = Mode::program;  // its own download, and it says nothing for stored lines
        return false;
    }
    if (!r.taken_without_answer()) {
        if (mode_ == Mode::immediate) suspected_ = false;
        return false;
    }
    evidence_ += led_ ? 1 : 0;
    if (mode_ == Mode::immediate && !suspected_) {
        suspected_ = true;
        stored_ = 1;
        next_probe_ = t.now;
        return true;
    }
    ++stored_;
    const bool in_vain = leave_rounds_ >= 3 && evidence_ == 1;  // PG was said, and the question behind it was stored again
    if (!in_vain && proven(found_ ? 2 : 3)) {
        if (suspected_ && !found_) found_in_program();
        mode_ = Mode::program;
        next_probe_ = t.now;
        ++leave_rounds_;
        return true;
    }
    if (!in_vain && stored_ % 4 != 0) {
        next_probe_ = t.now;
        return true;
    }
    // Each question is stored: from here on they come with the pauses of a drive that is away.
    retry_pause_ = std::min(retry_pause_ == Duration{} ? manners_.pause_min : 2 * retry_pause_, manners_.pause_max);
    go_absent(t, in_vain ? fmt::format("{} is in program mode and does not leave it: power it off and on, or use its maker's tool", name())
                         : not_understood());
    return true;
}

/// What was acknowledged last has been stored, not done: it is said again behind PG.
void Drive::found_in_program() {
    found_ = true;
    mode_doubt_ = true;  // a PG too many would put it into program mode: a question verifies
    leave_rounds_ = 0;
    if (!stops_.empty()) stops_.front().confirming = false;
    job_.confirming = false;
    need_error_ = false;
}

void Drive::led_out(Turn& t) {
    found_ = suspected_ = false;
    tidy_ = true;
    note(Severity::warning, "program_mode", 0,
         fmt::format("{} was in program mode and was led out (PG), because in it nothing is answered and every line, a stop too, becomes "
                     "program text; its program stays, with {} question{} of this gateway (PR \"#...) behind the last line",
                     name(), stored_, stored_ == 1 ? "" : "s"),
         t);
}

/// The drive was away: it may have restarted with the program that it had saved, which is none of this gateway's business.
void Drive::clear_if_half(std::string_view listing, Turn& t) {
    std::size_t i = half_was_away_ ? 0 : half_.size();
    for (const auto& l : half_was_away_ ? listed_lines(listing) : std::vector<std::string>()) {
        const auto w = word_of(l);
        const std::string have = normal_form(l);
        if (w == "PG" || w == "VA" || have.starts_with("PR\"#")) continue;
        // The last one may have been cut off.
        if (i + 1 < half_.size() ? have == half_[i] : i + 1 == half_.size() && half_[i].starts_with(have)) {
            ++i;
            continue;
        }
        note(Severity::info, "program", 0,
             fmt::format("{}: a download has broken off, but its program memory holds another program now: that is left alone", name()), t);
        half_.clear();
        return job_over(Outcome::done, Reason::none, {}, t);
    }
    half_was_away_ = false;
    job_.from = half_from_;
    if (half_from_.empty())
        job_.add(Step::What::send, "CP");
    else if (!clear_from(addressed_lines(listing), t) && job_.kind == JobKind::none)
        return;
    step_done(t);
}

void Drive::tidy_up(std::string_view listing, Turn& t) {
    const auto left = stored_questions(listing);
    if (left.count == 0) return job_over(Outcome::done, Reason::none, {}, t);
    if (!left.at_end || left.address.empty()) {
        return job_over(Outcome::failed, Reason::wrong_state,
                        left.address.empty()
                            ? std::string("the listing shows no addresses")
                            : fmt::format("the first stands at address {} and other lines follow: see program.list", left.address),
                        t);
    }
    job_.text = fmt::format("{}: {} stored question{} removed from the end of its program (CP 0,{}); the program is as it was found",
                            name(), left.count, left.count == 1 ? " was" : "s were", left.address);
    job_.add(Step::What::send, fmt::format("CP 0,{}", left.address), false);
    step_done(t);
}

}  // namespace axisgate::mcode
