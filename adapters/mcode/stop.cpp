// Drive: stops and confirmations, and what leaves a node: results, notices.
// In: the end of a stop's exchange, the poll or error code that confirms a line. Out: the next line of a stop, results, notices.
// Never takes an acknowledgement alone for a stop: a poll, and ER if it says that there is one, come behind it.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

void Drive::stop_ended(Verdict v, const ReplyReader&, Turn& t) {
    if (stops_.empty()) return;
    Stop& s = stops_.front();
    if (phase_ == Phase::absent) {
        return stop_over(Outcome::failed, Reason::no_answer,
                         fmt::format("{} does not answer to {}; {} was sent all the same, whether it was heard is not known", name(),
                                     setup_.address, s.lines.back()),
                         t);
    }
    const std::string& line = s.lines[s.at];
    if (v == Verdict::refused) demand_.refused();
    if (v != Verdict::refused) program_told(line);
    if (v == Verdict::waiting || v == Verdict::garbled) demand_.doubt(line);
    if (v == Verdict::acknowledged || v == Verdict::answered) demand_.said(line, heard_at_, true);
    s.said = v == Verdict::answered ? Verdict::acknowledged : v;
    s.confirming = true;
    s.to_all = false;
    if (v == Verdict::waiting) count_silence(t);
}

std::string_view Drive::stop_line() const noexcept {
    if (phase_ != Phase::ready || leaving() || stops_.empty()) return {};
    const Stop& s = stops_.front();
    return s.at == 0 && s.lines[0] != escape_key ? std::string_view(s.lines[0]) : std::string_view();
}

/// What stops without a ramp: the escape character if it can be meant for one drive alone, else the bridges.
std::string_view Drive::stop_at_once() const noexcept { return link().party() && es_ != 3 ? std::string_view("DE=0") : escape_key; }

/// AS = 3 presses until AS is another mode, and AS changes at rest only [L7495, E-26].
std::vector<std::string> Drive::stop_of_torque() const { return {std::string(stop_at_once()), "AS=0"}; }

bool Drive::stop_unsent() const noexcept {
    return phase_ == Phase::ready && (leaving() || (!stops_.empty() && !stops_.front().confirming));
}

void Drive::told_by_all(Instant heard) {
    if (stops_.empty() || stops_.front().confirming) return;
    Stop& s = stops_.front();
    demand_.said(s.lines[s.at], heard, true);  // who proves not to have heard it loses its demand
    s.confirming = s.to_all = true;
    s.said = Verdict::acknowledged;
    s.speed.reset();
}

/// Whether a line to all has reached this drive, by what was just read: off, at rest, or slower than a reading ago while its speed
/// changes. Nothing: read again. false: it is said to this drive alone, with an acknowledgement.
std::optional<bool> Drive::heard_all(Stop& s, const std::string& line) const {
    if (line == "DE=0") return !de_;
    const std::int64_t speed = std::llabs(fb_.velocity);
    if (speed == 0 && !vc_) return true;
    if (const auto before = std::exchange(s.speed, speed)) return vc_ && speed < *before;
    return vc_ ? std::nullopt : std::optional(false);
}

void Drive::stop_over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code) {
    const Command c = stops_.front().command;
    stops_.pop_front();
    result(c, o, r, std::move(text), t, code);
}

void Drive::confirmed(Turn& t) {
    if (!stops_.empty() && stops_.front().confirming) {
        Stop& s = stops_.front();
        const std::string line = s.lines[s.at];
        if (last_error_ == 85 && line == "SL 0") {
            // During a homing only the escape character stops [L4106].
            s.lines[s.at] = stop_at_once();
            s.confirming = false;
            return;
        }
        if (torque_ && line == "SL 0") {
            // It went into torque mode since it was last asked: a program did that, or a native line.
            s.lines = stop_of_torque();
            s.at = 0;
            s.confirming = s.to_all = false;
            return;
        }
        if (s.to_all && last_error_ == 0) {
            const auto heard = heard_all(s, line);
            if (!heard) return;
            s.to_all = false;
            if (!*heard) {
                demand_.forget();
                ++counters_.retries;
                s.confirming = false;
                return;
            }
        }
        if (last_error_ != 0) demand_.withdraw();
        const bool off = line == "DE=0" && !de_;
        const bool harmless = last_error_ == 40 || last_error_ == 94;  // no program ran; nothing can move with the drive off
        const bool taken = s.said == Verdict::acknowledged && last_error_ == 0 && (line != "DE=0" || off);
        if (taken || off || harmless) {
            s.tries = 0;
            s.confirming = false;
            if (++s.at < s.lines.size()) return;
            fb_.target_reached = false;
            motion_.ended = true;
            stopping_ = true;
            if (s.lines[0] == "DE=0") enabled_ = false;
            if (line == "AS=0") {
                vi_ = user_vi_ = vm_ = a_ = d_ = 0;  // the drive may have scaled them
                relearn_ = true;
                note(Severity::warning, "torque", 0,
                     fmt::format("{}: the stop has ended its torque mode: AS is 0 now, and 3 starts it again", name()), t);
            }
            derive(t);
            emit(t);
            return stop_over(std::holds_alternative<Disable>(s.command.body) ? Outcome::done : Outcome::accepted, Reason::none, {}, t);
        }
        if (last_error_ != 0 && s.tries >= manners_.retries) {
            return stop_over(Outcome::refused, Reason::drive_refused,
                             fmt::format("{}: {} was refused with error {}", name(), line, last_error_), t, last_error_);
        }
        if (++s.tries > manners_.retries) {
            return stop_over(Outcome::failed, Reason::no_answer, fmt::format("{} did not take {}", name(), line), t);
        }
        ++counters_.retries;
        s.confirming = false;
        return;
    }
    if (job_.kind == JobKind::none || !job_.confirming) return;
    job_.confirming = false;
    if (last_error_ != 0) demand_.withdraw();
    const std::string& line = job_.steps[job_.at].text;
    if (last_error_ == 6 && job_.kind == JobKind::write && (line.starts_with("IS=") || line.starts_with("OS="))) {
        // Another point has the type, or this one has it: what is read tells.
        last_error_ = 0;
        job_.text = already_typed;
        return step_done(t);
    }
    if (job_.kind == JobKind::download && job_.steps[job_.at].line != 0) {
        if (last_error_ == 6) {
            // A point has this type: perhaps as the line wants it. What is read tells.
            last_error_ = 0;
            Step s = job_.steps[job_.at];
            s.what = Step::What::query;
            s.text = word_of(line);
            s.end_mark = true;
            job_.steps.insert(job_.steps.begin() + static_cast<std::ptrdiff_t>(job_.at) + 1, std::move(s));
            return step_done(t);
        }
        const bool again = last_error_ == 28 && job_.tries > 0;  // VA that was done, and whose acknowledgement was lost
        if (last_error_ != 0 && !again) return setting_refused(fmt::format("was refused with error {}", last_error_), t);
        if (again) last_error_ = 0, job_.said = Verdict::acknowledged;
    }
    if (const auto hint = variable_hint(); last_error_ == 20 && !hint.empty()) {
        return job_over(Outcome::refused, Reason::drive_refused, hint, t, last_error_);
    }
    if (last_error_ != 0) {
        const ErrorCode* e = catalogue_.error(last_error_);
        const bool changed = job_.at > 0 && job_.kind == JobKind::move;
        return job_over(Outcome::refused, Reason::drive_refused,
                        fmt::format("{}: {} was refused with error {}{}{}", name(), line, last_error_, e ? ", " + e->text : std::string(),
                                    changed ? "; values set before it stay" : ""),
                        t, last_error_);
    }
    if (job_.steps[job_.at].what == Step::What::block) return block_ended(t);
    if (job_.said == Verdict::acknowledged || job_.said == Verdict::answered) return step_done(t);
    if (job_.steps[job_.at].repeatable && ++job_.tries <= manners_.retries) {
        ++counters_.retries;
        return;
    }
    if (job_.kind == JobKind::download && job_.steps[job_.at].line != 0) return setting_refused("was not acknowledged", t);
    job_over(Outcome::failed, Reason::no_answer, fmt::format("{} did not acknowledge {}", name(), line), t);
}

// --- results and notices ---------------------------------------------------------------------------------------------------------

void Drive::result(const Command& c, Outcome o, Reason r, std::string text, Turn& t, std::int32_t code, Value value) {
    if (c.ticket == no_ticket) return;
    t.out.results.push_back({c.ticket, axis_, o, r, code, std::move(text), std::move(value), {}});
}

void Drive::fail_all(Reason reason, const std::string& text, Turn& t) {
    program_lost(reason, text, t);
    while (!stops_.empty()) {
        const Command c = std::move(stops_.front().command);
        stops_.pop_front();
        result(c, Outcome::failed, reason, text, t);
    }
    if (job_.kind != JobKind::none) {
        std::string said = text;
        if (job_.memory_touched) said += "; " + memory_is_half();
        if (job_.kind == JobKind::named) said += "; no fresh drive took the name, or more than one did: power up one alone";
        if (job_.memory_touched) keep_half();
        if (job_.kind == JobKind::clear) clear_half_ = true;
        const Command c = job_.command;
        job_ = {};
        result(c, Outcome::failed, reason, std::move(said), t);
    }
    while (!queue_.empty()) {
        const Command c = std::move(queue_.front());
        queue_.pop_front();
        result(c, Outcome::failed, reason, text, t);
    }
}

/// At most 20 at once and 10 in a second, alarms excepted.
void Drive::note(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t) {
    if (severity != Severity::alarm) {
        const auto earned = (t.now - notice_refilled_) / 100ms;
        if (earned > 0) {
            notice_tokens_ = static_cast<int>(std::min<std::int64_t>(20, notice_tokens_ + earned));
            notice_refilled_ = t.now;
        }
        if (notice_tokens_ == 0) return;
        --notice_tokens_;
    }
    t.out.notices.push_back({severity, setup_.id, axis_, std::string(kind), code, std::move(text), t.now});
}

void Drive::trouble(Trouble::Kind kind, Turn& t) {
    const bool doubled = kind == Trouble::Kind::twice;
    const std::string counts = (doubled ? twice_ : trouble_).add(kind, t.now);
    if (counts.empty()) return;
    note(
        Severity::warning, "protocol", 0,
        doubled
            ? fmt::format("{} answered the same question twice ({}): two drives may have the same name {}", name(), counts, setup_.address)
            : fmt::format("{}: answers of the drive at {} are spoiled again and again ({}): look at its cable, its rate and its reply time",
                          name(), setup_.address, counts),
        t);
}

void Drive::foreign(std::string_view text, Turn& t) {
    ++counters_.unexpected;
    std::string shown;
    for (const char c : text) {
        if (c >= 0x20 && c <= 0x7E) shown += c;
    }
    if (shown.size() < 2 || shown.find("PR \"#") != std::string::npos || shown.size() > 200) return;
    note(Severity::info, "output", 0, fmt::format("{}: {}", name(), shown), t);
}

}  // namespace axisgate::mcode
