// Jobs: steps one after the other, each confirmed; a verb is asked where the way of all is not its own.
// In: the ends of exchanges, polls. Out: requests, results.
// Never repeats a line that would move the axis twice.
#include "adapters/mcode/drive_job.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/parameters_variables.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;
using What = Request::Purpose;

// --- verbs -----------------------------------------------------------------------------------------------------------------------

void Verb::answered(const std::string&, Turn& t) { drive_.jobs.step_done(t); }
void Verb::listed(const std::string& text, Turn& t) { succeed(text, t, Value{text}); }
void Verb::done(Turn& t) { succeed(job().text, t); }

bool Verb::wait_for_rest(Turn& t) {
    if (!feedback().flags().mv && !feedback().moving()) return true;
    if (feedback().goes()) {
        refuse(Reason::wrong_state, fmt::format("{} moves: stop it first", name()), t);
        return false;
    }
    job().standstill();
    job().give_up = t.now + 70s;  // MT + HT are 65.535 s at most [L3241]
    drive_.poll.soon(t.now);
    return true;
}

// --- what waits ------------------------------------------------------------------------------------------------------------------

Verb& Jobs::verb_of(const CommandBody& b) const noexcept {
    if (std::holds_alternative<Enable>(b) || std::holds_alternative<ResetFault>(b)) return drive_.power;
    if (std::holds_alternative<Home>(b)) return drive_.homing;
    if (std::holds_alternative<ReadParameter>(b) || std::holds_alternative<WriteParameter>(b)) return drive_.parameters;
    if (std::holds_alternative<Native>(b)) return drive_.native;
    const auto* action = std::get_if<Action>(&b);
    if (!action) return drive_.motion;
    const std::string& name = action->name;
    if (name == "program.upload" || name == "program.download" || name == "program.edit") return drive_.programs;
    if (name == "line.setup") return drive_.line_setup;
    if (name == "reset" || name == "factory_defaults") return drive_.restart;
    return drive_.plain_actions;
}

void Jobs::take(const Command& command, Turn& t) { begin(verb_of(command.body), command).verb->plan(command, t); }

void Jobs::take_next(Turn& t) {
    // What it does of its own accord goes first: commands rest on it.
    if (idle()) drive_.programs.clean_up();
    if (idle()) drive_.survey.read_again();
    if (idle() && feedback().take_zero()) {
        Command zero;
        zero.axis = drive_.axis();
        zero.body = SetPosition{0};
        take(zero, t);
    }
    while (idle() && !queue.empty())
        take(queue.pop(), t);
    if (idle()) drive_.survey.list_variables(t.now);
}

/// What moves the axis, whoever words it.
bool Jobs::ended_by_stop(const CommandBody& b, bool power_off) const {
    if (drive::is_motion(b) || (power_off && std::holds_alternative<Enable>(b))) return true;
    const auto says = [&](std::string_view line) {
        constexpr std::array<std::string_view, 10> moving{"MA", "MR", "SL", "HM", "HI", "HF", "SC", "EX", "RS", "JE"};
        const std::string w = word_of(line);
        return std::ranges::find(moving, w) != moving.end() || (power_off && w == "DE");
    };
    if (const auto* native = std::get_if<Native>(&b)) return says(std::string(native->send.begin(), native->send.end()));
    if (const auto* write = std::get_if<WriteParameter>(&b)) {
        const Parameter* p = drive_.catalogue().parameter(write->point);
        return p && says(word_of_parameter(*p));
    }
    const auto* action = std::get_if<Action>(&b);
    return action &&
           (action->name == "program.start" || action->name == "program.resume" || action->name == "calibrate" || says(action->name));
}

void Jobs::cancel_motions(std::string_view by, bool power_off, Turn& t) {
    feedback().no_zero();
    const auto ends = [&](const Command& c) {
        const bool in_hand = &c == &job_.command;
        return (!in_hand || job_.verb->moves() || job_.waits_for_rest()) && ended_by_stop(c.body, power_off);
    };
    interrupt(ends, by, t);
}

// --- steps -----------------------------------------------------------------------------------------------------------------------

Request Jobs::next(Instant now) {
    Step& step = job_.steps[job_.at];
    if (job_.confirming) return Request::ask(What::confirm, feedback().poll_items(now));
    Request r = step.what == Step::What::query ? Request::ask(What::step, step.text) : Request::say(What::step, step.text);
    r.end_mark = step.end_mark;
    r.ends = step.what == Step::What::block;
    if (r.ends) r.kind = Expect::Kind::block;
    if (word_of(step.text) == "EX") feedback().program_starts(now);
    job_.verb->sending(step, r);
    return r;
}

void Jobs::ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (!job_.pending()) {
        if (v == Verdict::waiting) drive_.start.silent(t);
        feedback().demand.forget();  // the line was in flight when a stop has ended its job: it may have been a motion
        return;
    }
    const Step& step = job_.steps[job_.at];
    const std::string& came = step.what == Step::What::block ? r.block() : r.raw();
    if (is(drive_.native) && !came.empty()) job_.bytes.assign(came.begin(), came.end());
    if (job_.verb->ended(step, v, t)) return;
    switch (step.what) {
        case Step::What::send:
            return line_sent(v, t);
        case Step::What::query:
            return query_ended(v, r, t);
        case Step::What::block:
            return block_ended(v, r, t);
        case Step::What::bare:
        case Step::What::standstill:
            return step_done(t);
    }
}

void Jobs::line_sent(Verdict v, Turn& t) {
    job_.acknowledgement = v;
    job_.confirming = true;
    job_.at_once = drive_.turnaround.at_once();
    job_.said = t.now;
    drive_.line_ended(job_.steps[job_.at].text, v, job_.verb->own_lines());
    if (v == Verdict::waiting && !drive_.quiet()) drive_.start.silent(t);
}

void Jobs::query_ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (v == Verdict::answered) return job_.verb->answered(r.data(), t);
    if (v == Verdict::waiting) drive_.start.silent(t);
    if (idle()) return;
    if (++job_.tries <= drive_.bus.timing.retries) {
        ++drive_.bus.counters.retries;
        return;
    }
    const std::string items = job_.steps[job_.at].text;
    if (v != Verdict::refused) return fail(Reason::no_answer, fmt::format("{} did not answer PR {}", name(), items), t);
    // Where an error stood before this one, it is left as it is.
    if (!drive_.bus.only_reads || !feedback().flags().ef) drive_.errors.ask(true);
    const auto hint = drive_.parameters.variable_hint();
    refuse(Reason::not_supported, hint.empty() ? fmt::format("{} does not have {}, or cannot show it now", name(), items) : hint, t);
}

/// A block is over when the question behind it was answered, which is a poll: it tells as well whether the drive complained.
void Jobs::block_ended(Verdict v, const ReplyReader& r, Turn& t) {
    const std::string line = job_.steps[job_.at].text;
    if (v != Verdict::answered || r.overflowed() || !feedback().learn_poll(r.data(), t)) {
        if (v == Verdict::waiting) drive_.start.silent(t);
        if (idle()) return;
        return fail(Reason::no_answer,
                    r.raw().empty() ? fmt::format("{} did not answer {}", name(), line)
                                    : fmt::format("the end of what {} answers to {} was not heard: ask again", name(), line),
                    t);
    }
    job_.listing = r.block();
    if (!feedback().flags().ef) {
        drive_.errors.clear_last();
        return block_read(t);
    }
    const bool refused = drive_.words.sums && job_.listing.find(nak) != std::string::npos;
    job_.acknowledgement = refused ? Verdict::refused : Verdict::acknowledged;
    job_.confirming = true;
    drive_.errors.ask(refused || !drive_.words.sums || drive_.quiet());  // an ACK means: no error [L2081]
}

void Jobs::block_read(Turn& t) {
    const bool sums = drive_.words.sums;
    const std::string line = job_.steps[job_.at].text, sent = request(drive_.link(), line);
    const std::string text = plain_text(job_.listing, std::string_view(sent).substr(0, sent.size() - 1), sums);
    if (sums && job_.listing.find(nak) != std::string::npos && text.empty())
        return refuse(Reason::drive_refused, fmt::format("{} refused {}", name(), line), t);
    if (sums && !block_sums_good(job_.listing)) {
        ++drive_.bus.counters.garbled;
        if (++job_.tries <= drive_.bus.timing.retries) return;  // PR and L change nothing, so they are asked again
        return fail(Reason::no_answer, fmt::format("what {} answers to {} does not fit its checksum", name(), line), t);
    }
    job_.verb->listed(text, t);
}

/// A line without an acknowledgement, since the drive gives none (EM = 2) or it was lost: what was read behind it tells whether the drive
/// has received it. False: it has not, or nobody knows. True: it has, or with `confirming` it is read once more.
bool Jobs::judged(const Step& step, Turn& t) {
    const bool quiet = job_.acknowledgement == Verdict::answered;
    if (job_.acknowledgement == Verdict::refused) return false;
    switch (job_.verb->proof(step, t.now - job_.said)) {
        case Verb::Proof::none:
            return quiet;
        case Verb::Proof::open:
            job_.confirming = true;
            return true;
        case Verb::Proof::taken:
            if (quiet) drive_.turnaround.received(job_.at_once);
            return true;
        case Verb::Proof::lost:
            if (quiet) (void)drive_.turnaround.lost(job_.at_once);
            return false;
    }
    return false;
}

void Jobs::confirmed(Turn& t) {
    job_.confirming = false;
    const int error = drive_.errors.last();
    if (error != 0) feedback().demand.withdraw();
    const Step step = job_.steps[job_.at];
    if (error != 0) {
        if (job_.verb->complained(step, error, t)) return;
        const auto hint = error == 20 ? drive_.parameters.variable_hint() : std::string();
        return refuse(Reason::drive_refused,
                      hint.empty() ? fmt::format("{}: {} was refused with {}{}", name(), step.text, drive_.errors.text_of(error),
                                                 job_.at > 0 && is(drive_.motion) ? "; values set before it stay" : "")
                                   : hint,
                      t, error);
    }
    if (step.what == Step::What::block) return block_read(t);
    if (job_.acknowledgement == Verdict::acknowledged || judged(step, t)) return job_.confirming ? void() : step_done(t);
    if (step.repeatable && ++job_.tries <= drive_.bus.timing.retries) {
        ++drive_.bus.counters.retries;
        return;
    }
    if (job_.verb->complained(step, 0, t)) return;
    fail(Reason::no_answer, fmt::format("{} did not acknowledge {}", name(), step.text), t);
}

void Jobs::missed(Turn& t) {
    if (!idle() && ++job_.tries > drive_.bus.timing.retries + 3)
        fail(Reason::no_answer, fmt::format("{} did not say whether it took {}", name(), job_.steps[job_.at].text), t);
}

void Jobs::watch(Turn& t) {
    if (job_.confirming || !job_.waits_for_rest()) return;
    if (!feedback().flags().mv) return step_done(t);
    if (t.now >= job_.give_up) fail(Reason::wrong_state, fmt::format("{} does not come to a standstill", name()), t);
}

void Jobs::step_done(Turn& t) {
    job_.tries = 0;
    if (++job_.at == job_.steps.size()) return job_.verb->done(t);
    if (!job_.waits_for_rest()) return;
    job_.give_up = t.now + 30s;
    drive_.poll.soon(t.now);
}

}  // namespace axisgate::mcode
