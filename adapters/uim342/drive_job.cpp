// Jobs: steps one after the other; a verb is asked what follows from each.
// In: commands, answers, refusals, silences. Out: exchanges, results.
// Never repeats what would act twice, nor the value of a group without its MF.
#include "adapters/uim342/drive_job.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
/// What helps, by the code of a refusal.
std::string_view advice(std::uint8_t code, std::uint8_t function) {
    switch (code) {
        case 0x32:
            return function == cw::SP ? "; SP is taken only after PR or PA" : "";
        case 0x3C:
            return "; SD must not be below DC: raise SD first, or choose a smaller deceleration";
        case 0x3D:
        case 0x41:
            return "; stop the axis first";
        case 0x3E:
            return "; enable the axis first";
        case 0x3F:
            return "; wait until the stop has ended; if the drive is locked, reset the fault";
        default:
            return "";
    }
}
}  // namespace

// --- verbs -----------------------------------------------------------------------------------------------------------------------

void Verb::without_success(Failure& how, Turn&) {
    if (how.dropped) drive_.exchanges.abandon_job();
}

void Verb::failed(const Step& step, Failure how, Turn& t) {
    const bool silent = how.reason == Reason::no_answer;
    drive_.jobs.over(std::move(how), t);
    if (!silent) return;
    if (step.message.function() == cw::BG) drive_.feedback.begin_motion({Motion::Kind::unknown}, t);
    drive_.polls.soon(t.now);
}

// --- what waits ------------------------------------------------------------------------------------------------------------------

Verb& Jobs::verb_of(const CommandBody& b) const noexcept {
    if (std::holds_alternative<Enable>(b)) return drive_.power;
    if (std::holds_alternative<ResetFault>(b)) return drive_.reset;
    if (const auto* home = std::get_if<Home>(&b); home && Homing::searches(home->method)) return drive_.homing;
    if (std::holds_alternative<Home>(b) || std::holds_alternative<SetPosition>(b)) return drive_.origin;
    if (std::holds_alternative<ReadParameter>(b) || std::holds_alternative<WriteParameter>(b)) return drive_.parameters;
    if (Together::is_place(b)) return drive_.together;
    if (std::holds_alternative<Move>(b) || std::holds_alternative<StartTogether>(b)) return drive_.moves;
    return drive_.native;
}

bool Jobs::ready() const noexcept {
    if (queue.empty() || !idle()) return false;
    return !drive_.homing.searching() || (drive_.homing.under_way() && std::holds_alternative<ReadParameter>(queue.front().body));
}

void Jobs::take_next(Turn& t) {
    const Command command = queue.pop();
    begin(verb_of(command.body), command).verb->plan(command, t);
    if (job_.runs()) run(t);
}

// --- steps -----------------------------------------------------------------------------------------------------------------------

void Jobs::run(Turn& t) {
    Exchanges& wire = drive_.exchanges;
    while (!wire.active() && job_.runs() && job_.at < job_.count) {
        if (job_.again) {
            job_.again = false;
            if (job_.steps[job_.at].mf != 0 && job_.at > 0) --job_.at;
        }
        const Step step = job_.steps[job_.at];
        const Message& m = step.message;
        if (wire.makes_way(m, step.mf, Priority::command, t)) return;
        if (step.select) {
            const Step& value = job_.steps[job_.at + 1u];
            if (wire.makes_way(value.message, value.mf, Priority::command, t)) return;
        }
        if (step.select || (m.function() == cw::MF && !m.wants_ack())) wire.mf_unknown = true;
        if (m.wants_ack()) {
            // A value for an input's group is not repeated alone: its MF is used up, and it would hit group 0.
            const Instruction* i = instruction(m.cw);
            const bool repeatable = step.mf == 0 && (form_of(m) == Form::get || (i && i->repeatable));
            return wire.send({m, Purpose::job, step.mf}, repeatable ? drive_.bus.timing.retries : 0, Priority::command, t);
        }
        job_.blind = m.function();
        drive_.bus.transmit(m, Priority::command, t, job_.command.ticket);
        ++job_.at;
        job_.verb->answered(step, nullptr, t);
    }
    if (!wire.active() && job_.runs() && job_.at >= job_.count) job_.verb->done(t);
}

void Jobs::answered(const Message& m, Turn& t) {
    if (idle() || job_.at >= job_.count) return;
    const Step step = job_.steps[job_.at];
    if (step.mf != 0) drive_.exchanges.mf_unknown = false;
    if (step.select && std::exchange(job_.again, false)) return;
    ++job_.at;
    if (job_.exact && !step.select && !echoes(step.message, m)) {
        std::string text = fmt::format("{} was answered with {}: nothing was started", describe_request(step.message), describe_answer(m));
        return job_.verb->failed(step, {Outcome::failed, Reason::drive_refused, std::move(text)}, t);
    }
    job_.verb->answered(step, &m, t);
    if (!idle() && job_.at >= job_.count) job_.verb->done(t);
}

void Jobs::refused(const Message& m, Turn& t) {
    if (idle()) return;
    const Step step = job_.steps[here()];
    const auto report = error_report_of(m);
    const std::uint8_t code = report ? report->code : std::uint8_t{0};
    std::string text =
        fmt::format("{}: the drive says {}{}", describe_request(step.message), describe_error(code), advice(code, step.message.function()));
    if (is(drive_.native)) NativeLines::keep(m, job_.bytes);
    const bool begun = job_.partial && job_.at > 0;
    job_.verb->failed(step, {begun ? Outcome::failed : Outcome::refused, Reason::drive_refused, std::move(text), code}, t);
}

void Jobs::silent(Turn& t) {
    if (idle()) return;
    const Step step = job_.steps[here()];
    if (step.mf != 0 && job_.rounds < drive_.bus.timing.retries) {
        // Its MF may be used up: the pair is sent anew, never the value alone.
        ++job_.rounds;
        ++drive_.bus.counters.retries;
        --job_.at;
        return;
    }
    std::string text = describe_request(step.message);
    if (step.message.function() == cw::BG) {
        text = "BG was sent and not acknowledged: whether the axis moves is not known; its status is being read";
    } else {
        text += form_of(step.message) == Form::get ? " was not answered" : " was not acknowledged: whether the drive took it is not known";
    }
    job_.verb->failed(step, {Outcome::failed, Reason::no_answer, std::move(text)}, t);
}

void Jobs::disturbed() noexcept {
    if (idle() || job_.at >= job_.count) return;
    const Step& step = job_.steps[job_.at];
    const Request* r = drive_.exchanges.on_its_way();
    const bool own = r && r->purpose == Purpose::job;
    if ((step.select && own) || (step.mf != 0 && !own)) job_.again = true;
}

}  // namespace axisgate::uim342
