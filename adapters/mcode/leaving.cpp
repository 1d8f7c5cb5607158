// Node: out of program mode: what a broken download must do before anything else may be said to the drive.
// In: lines PG as they are sent, their end. Out: the requests that lead the drive back to immediate mode.
// Never lets a stop, a poll or a command go to a drive that may take it as program text: PG toggles [L4778], so each PG is counted, and
// when its acknowledgement was lost a marked question tells the mode: data means immediate, an acknowledgement alone means stored.
#include <fmt/format.h>

#include "adapters/mcode/node.hpp"

namespace axisgate::mcode {

bool Node::leaving() const noexcept { return mode_ != Mode::immediate && job_.kind != JobKind::download; }

/// PG while the mode is known, a question while it is not. The question that was stored is removed by CP with the rest of the half.
Request Node::next_leave() {
    Request r;
    r.purpose = purpose_ = Request::Purpose::leave;
    r.urgent = true;
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

void Node::note_mode_line(std::string_view line) {
    if (word_of(line) != "PG") return;
    mode_flight_ = true;
    mode_before_ = mode_;
    mode_ = Mode::unknown;
}

void Node::mode_line_ended(Verdict v) {
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
void Node::leave_ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (r.data().empty() && v == Verdict::waiting && r.raw().empty()) {
        // EM = 2 says nothing for a stored line either: PG is tried, and the next question tells.
        if (mode_ == Mode::unknown && quiet()) mode_ = Mode::program;
        return count_silence(t);
    }
    if (purpose_was_question_) {
        const bool nak_came = r.raw().find('\x15') != std::string::npos;
        if (v == Verdict::answered) {
            mode_ = Mode::immediate;
            mode_doubt_ = false;
        } else if (!nak_came && v != Verdict::garbled) {
            mode_ = Mode::program;  // taken and not answered: it was stored
        }
    }
    if (mode_ == Mode::immediate) {
        leave_rounds_ = 0;
        return;
    }
    if (++leave_rounds_ >= 12) {
        leave_rounds_ = 0;
        go_absent(t, fmt::format("{} does not leave program mode", name()));
    }
}

}  // namespace axisgate::mcode
