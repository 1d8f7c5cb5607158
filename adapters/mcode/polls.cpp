// Drive: what it wants and what it sends next: probes, its link, stops, errors, steps of a job, polls.
// In: its phase, its queue, the time. Out: one request.
// Never chooses a poll or a command while a stop waits, nor a stop while the drive may be in program mode (drive_mode.cpp).
#include <fmt/core.h>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;
using What = Request::Purpose;

Drive::Want Drive::wants(Instant now) const noexcept {
    switch (phase_) {
        case Phase::down:
            return Want::nothing;
        case Phase::probing:
        case Phase::absent:
            if (phase_ == Phase::absent && !stops_.empty()) return Want::urgent;
            if (job_.kind == JobKind::setup) return Want::urgent;  // nothing for others in between: the fresh drive would take it too
            return now >= next_probe_ ? Want::other : Want::nothing;
        case Phase::linking:
        case Phase::starting:
            return Want::other;
        case Phase::ready:
            break;
    }
    if (!stops_.empty() || leaving()) return Want::urgent;
    if ((clear_half_ || tidy_) && seen_ && !running_ && !mv_) return Want::other;
    if ((relearn_ || (demand_.wants_shape() && !shape_refused_)) && seen_ && job_.kind == JobKind::none) return Want::other;
    if (need_error_ || now >= next_poll_) return Want::other;
    if (job_.kind != JobKind::none) {
        return job_.at < job_.steps.size() && job_.steps[job_.at].what == Step::What::standstill ? Want::nothing : Want::other;
    }
    return queue_.empty() && !surveys(now) ? Want::nothing : Want::other;
}

bool Drive::wants_unmarked(Instant now) const noexcept {
    if (phase_ == Phase::linking) return true;
    if (phase_ != Phase::ready || !stops_.empty() || leaving() || need_error_ || !seen_) return false;
    if (job_.kind == JobKind::none) return !queue_.empty() || surveys(now) || ((clear_half_ || tidy_) && !running_ && !mv_);
    if (job_.confirming || job_.at >= job_.steps.size()) return false;
    const auto what = job_.steps[job_.at].what;
    return what == Step::What::send || what == Step::What::bare || what == Step::What::block;
}

Instant Drive::due() const noexcept {
    switch (phase_) {
        case Phase::down:
            return never;
        case Phase::probing:
        case Phase::absent:
            return next_probe_;
        default:
            return next_poll_;
    }
}

std::string Drive::poll_text(Instant now) {
    std::string s = R"(P,",",V,",",MV,MP,VC,DE,EF,BY)";
    if (encoder_) s += ",ST";
    if (hmt_) s += ",LR,AS";
    if (tells_input_) s += ",IF";
    // Only where it means something: LL is 0 or not measured in the other modes [L3872].
    asks_lag_ = (hmt_mode_ == 1 || hmt_mode_ == 2) && (lag_misses_ < 2 || now >= lag_again_);
    if (asks_lag_) s += R"(,",",LL)";
    return s;
}

std::string Drive::values_text() const { return std::string(R"(VI,",",VM,",",A,",",D)") + (encoder_ ? R"(,",",EE)" : ""); }

Request Drive::next(Turn& t) {
    Request r;
    const auto ask = [&](What purpose, std::string items) {
        r.purpose = purpose_ = purpose;
        r.text = std::move(items);
        return r;
    };
    const auto say = [&](What purpose, std::string line) {
        r.purpose = purpose_ = purpose;
        r.text = std::move(line);
        r.kind = Expect::Kind::command;
        r.urgent = purpose == What::stop;
        if (word_of(r.text) == "S" || word_of(r.text) == "FD" || word_of(r.text) == "CP" || word_of(r.text) == "IP") r.patience = 2s;
        return r;
    };
    if (job_.kind == JobKind::setup && phase_ != Phase::ready) {
        const Step& step = job_.steps[job_.at];
        r = say(What::step, {});
        r.raw = step.text;
        r.kind = Expect::Kind::block;  // EM is not known: nothing may be said before its last prompt is over
        return r;
    }
    switch (phase_) {
        case Phase::probing:
        case Phase::absent:
            r.wake = true;
            if (phase_ == Phase::absent && !stops_.empty()) {
                // Perhaps it hears: a stop is sent all the same, with and without checksum, since nobody says which it would take.
                const Stop& s = stops_.front();
                r = say(What::stop, s.lines.front());
                for (const auto& line : s.lines) {
                    for (const bool sums : {known_sums_, !known_sums_})
                        if (!sums || !manners_.ethernet) r.raw += line == escape_key ? escape(link()) : request({link().name, sums}, line);
                }
                r.kind = Expect::Kind::nothing;
                r.wake = true;
                return r;
            }
            if (mode_ == Mode::program) {
                // It went away in program mode, where a probe is stored and not answered.
                r = say(What::probe, "PG");
                r.wake = true;
                note_mode_line(r.text);
                return r;
            }
            // Perhaps stored, perhaps refused: the second question is one that cannot be refused.
            return ask(What::probe, manners_.ethernet || suspected_ ? "EM" : "EM,CK,ES,CE");
        case Phase::linking:
            return say(What::link, link_line_);
        case Phase::starting:
            return ask(What::startup,
                       startup_items[startup_at_].starts_with("VI") ? values_text() : std::string(startup_items[startup_at_]));
        default:
            break;
    }
    if (leaving()) return next_leave();
    if (!stops_.empty()) {
        Stop& s = stops_.front();
        if (s.confirming) {
            if (need_error_) return ask(What::error, "ER");
            return ask(What::confirm, poll_text(t.now));
        }
        r = say(What::stop, s.lines[s.at]);
        if (r.text == escape_key) {
            r.raw = escape(link());
            r.kind = Expect::Kind::nothing;
        }
        return r;
    }
    if (need_error_) return ask(What::error, "ER");
    if (!seen_) {
        // Before the first command: an error that stands from before must not count as its own.
        next_poll_ = t.now + manners_.poll_period;
        return ask(What::poll, poll_text(t.now));
    }
    if (clear_half_ && !running_ && !mv_ && job_.kind == JobKind::none) {
        clear_half_ = false;
        job_.kind = JobKind::clear;
        const bool looks = half_was_away_ || !half_from_.empty();
        job_.add(looks ? Step::What::block : Step::What::send, looks ? "L" : "CP");
    }
    if (tidy_ && !running_ && !mv_ && job_.kind == JobKind::none) {
        tidy_ = false;
        job_.kind = JobKind::tidy;
        job_.add(Step::What::block, "L");
    }
    if (relearn_ && job_.kind == JobKind::none) {
        relearn_ = false;
        job_.kind = JobKind::relearn;
        job_.add(Step::What::query, values_text());
    } else if (demand_.wants_shape() && !shape_refused_ && job_.kind == JobKind::none) {
        job_.kind = JobKind::shape;
        job_.add(Step::What::query, R"(BE,",",AT,",",DT)");
    }
    if (job_.kind == JobKind::none && !queue_.empty()) take_next(t);
    if (job_.kind == JobKind::none && surveys(t.now)) {
        survey_ = false;
        job_.kind = JobKind::survey;
        job_.add(Step::What::block, "PR UV");
    }
    if (job_.kind != JobKind::none && job_.at < job_.steps.size()) {
        const Step& step = job_.steps[job_.at];
        if (job_.confirming) return ask(What::confirm, poll_text(t.now));
        switch (step.what) {
            case Step::What::send:
            case Step::What::bare:
                r = say(What::step, step.text);
                if (word_of(step.text) == "EX") prints_until_ = t.now + 3s;
                if (job_.kind == JobKind::download || job_.kind == JobKind::edit) {
                    job_.memory_touched = true;  // CP is its first line
                    clear_half_ = false;
                    note_mode_line(step.text);
                }
                if (job_.kind == JobKind::restart && step.text == reset_key) {
                    // With CE = 2 the name stands right before it, at the beginning of a line.
                    if (link().party()) r.raw = std::string(1, lf) + link().name;
                    r.raw += ctrl_c;
                    r.kind = Expect::Kind::nothing;
                }
                return r;
            case Step::What::query:
                r.end_mark = step.end_mark;
                return ask(What::step, step.text);
            case Step::What::block:
                r = say(What::step, step.text);
                r.kind = Expect::Kind::block;
                r.ends = true;
                return r;
            case Step::What::standstill:
                break;
        }
    }
    next_poll_ = t.now + manners_.poll_period;
    return ask(What::poll, poll_text(t.now));
}

}  // namespace axisgate::mcode
