// Drive: the verbs of CiA 402 as lines of MCode, and the run of such a job to its one result.
// In: commands from the queue, the end of their steps. Out: steps one after the other, the result.
// Never starts what it could not set: a refused value ends the job before the motion. A relative move is sent as the absolute one that it
// means at standstill, so that a repeat cannot move twice.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

namespace {
/// QD and ^ choose who hears a line, not when it acts, and a line to * has one target for all [L4991, L5034].
constexpr std::string_view no_prepared_start =
    "MCode has no motion that is loaded now and started later, and one line to all drives has one target for all; a stored program in "
    "each drive that waits for the same input, or EX to each drive in turn, is what the language offers";
}  // namespace

/// What moves the axis, whoever words it: by a stop it is over, also while it waits. With the power off so is what would bring that back.
bool Drive::ended_by_stop(const CommandBody& b, bool power_off) const {
    if (std::holds_alternative<Move>(b) || std::holds_alternative<Home>(b) || std::holds_alternative<StartTogether>(b)) return true;
    if (power_off && std::holds_alternative<Enable>(b)) return true;
    const auto says = [&](std::string_view line) {
        constexpr std::array<std::string_view, 10> moving{"MA", "MR", "SL", "HM", "HI", "HF", "SC", "EX", "RS", "JE"};
        const std::string w = word_of(line);
        return std::ranges::find(moving, w) != moving.end() || (power_off && w == "DE");
    };
    if (const auto* native = std::get_if<Native>(&b)) return says(std::string(native->send.begin(), native->send.end()));
    if (const auto* write = std::get_if<WriteParameter>(&b)) {
        const Parameter* p = drive_catalogue().parameter(write->point);
        return p && says(word(*p));
    }
    const auto* action = std::get_if<Action>(&b);
    return action &&
           (action->name == "program.start" || action->name == "program.resume" || action->name == "calibrate" || says(action->name));
}

void Drive::submit(const Command& c, Turn& t) {
    if (phase_ == Phase::down) return result(c, Outcome::failed, Reason::line_down, "the line is down", t);
    const auto* action = std::get_if<Action>(&c.body);
    if (action && action->name == "line.setup" && phase_ != Phase::ready && job_.kind == JobKind::none) {
        plan(c, t);
        return;
    }
    if (phase_ == Phase::absent && !is_urgent(c.body)) {
        return result(c, Outcome::failed, Reason::no_answer, fmt::format("{} does not answer to {}", name(), setup_.address), t);
    }
    if (!is_urgent(c.body)) {
        if (queue_.size() >= queue_limit)
            return result(c, Outcome::refused, Reason::busy, fmt::format("{} commands of {} wait already", queue_limit, name()), t);
        queue_.push_back(c);
        return;
    }
    // A drive that is being looked for or set up again may be moving: its stop waits for that, which ends in `ready` or `absent`.
    if (stops_.size() >= urgent_limit) return result(c, Outcome::refused, Reason::busy, "too many stops wait", t);
    cancel_motions(name_of(c.body), std::holds_alternative<Disable>(c.body), t);
    Stop s;
    s.command = c;
    // Within PG every line would become part of the program: leaving() goes before this stop.
    if (job_.kind == JobKind::download) download_failed(fmt::format("{} came in between", name_of(c.body)), t);
    if (std::holds_alternative<Disable>(c.body)) {
        s.lines.emplace_back("DE=0");
    } else if (torque_) {
        s.lines = stop_of_torque();
    } else {
        s.lines.emplace_back("SL 0");
        if (std::holds_alternative<QuickStop>(c.body) && running_) {
            // A program would start the next motion: it is ended, and what it started meanwhile is stopped.
            s.lines.emplace_back("E");
            s.lines.emplace_back("SL 0");
        }
    }
    stops_.push_back(std::move(s));
}

void Drive::cancel_motions(std::string_view by, bool power_off, Turn& t) {
    zero_after_home_ = false;
    const bool waits_for_rest = job_.at < job_.steps.size() && job_.steps[job_.at].what == Step::What::standstill;
    const bool over = job_.kind == JobKind::move || job_.kind == JobKind::home || job_.kind == JobKind::enable || waits_for_rest;
    if (over && ended_by_stop(job_.command.body, power_off)) {
        const Command c = job_.command;
        if (job_.kind == JobKind::move) relearn_ = true;  // what it had planned to set may not have been
        job_ = {};
        result(c, Outcome::failed, Reason::interrupted, fmt::format("{}: ended by {}", name(), by), t);
    }
    std::deque<Command> kept;
    for (auto& c : queue_) {
        if (ended_by_stop(c.body, power_off)) {
            result(c, Outcome::failed, Reason::interrupted, fmt::format("{}: ended by {}", name(), by), t);
        } else if (c.ticket != no_ticket) {
            kept.push_back(std::move(c));
        }
    }
    queue_ = std::move(kept);
}

void Drive::take_next(Turn& t) {
    while (job_.kind == JobKind::none && !queue_.empty()) {
        const Command c = std::move(queue_.front());
        queue_.pop_front();
        plan(c, t);
    }
}

void Drive::plan(const Command& c, Turn& t) {
    job_ = {};
    job_.command = c;
    const CommandBody& b = c.body;
    if (std::holds_alternative<Enable>(b)) {
        job_.kind = JobKind::enable;
        job_.add(Step::What::send, "DE=1");
    } else if (std::holds_alternative<ResetFault>(b)) {
        job_.kind = JobKind::reset;
        if (stalled_) job_.add(Step::What::send, "ST=0");
        if (locked_) job_.add(Step::What::send, "CF");
        job_.add(Step::What::send, "ER=0");
    } else if (const auto* home = std::get_if<Home>(&b)) {
        job_.kind = JobKind::home;
        plan_home(*home, t);
    } else if (const auto* set = std::get_if<SetPosition>(&b)) {
        job_.kind = JobKind::set_position;
        if (fb_.moving) return job_over(Outcome::refused, Reason::wrong_state, fmt::format("{} moves: stop it first", name()), t);
        if (set->position < INT32_MIN || set->position > INT32_MAX) {
            return job_over(Outcome::refused, Reason::out_of_range,
                            fmt::format("position {}: P holds -2147483648..2147483647", set->position), t);
        }
        job_.add(Step::What::send, fmt::format("P={}", set->position));
    } else if (const auto* move = std::get_if<Move>(&b)) {
        job_.kind = JobKind::move;
        plan_move(*move, t);
    } else if (const auto* read = std::get_if<ReadParameter>(&b)) {
        job_.kind = JobKind::read;
        plan_read(*read, t);
    } else if (const auto* write = std::get_if<WriteParameter>(&b)) {
        job_.kind = JobKind::write;
        plan_write(*write, t);
    } else if (const auto* native = std::get_if<Native>(&b)) {
        job_.kind = JobKind::native;
        plan_native(*native, t);
    } else if (const auto* action = std::get_if<Action>(&b)) {
        job_.kind = JobKind::plain;
        plan_action(*action, t);
    } else {
        job_.kind = JobKind::plain;
        return job_over(Outcome::refused, Reason::not_supported, fmt::format("{}: {}", name_of(b), no_prepared_start), t);
    }
}

void Drive::plan_move(const Move& m, Turn& t) {
    const auto refuse = [&](Reason r, std::string why) { job_over(Outcome::refused, r, std::move(why), t); };
    if (m.prepare_only) return refuse(Reason::not_supported, std::string(no_prepared_start));
    if (!de_) return refuse(Reason::wrong_state, fmt::format("{} is off (DE=0): enable it first", name()));
    const bool velocity = m.kind == Move::Kind::velocity;
    const std::int64_t least_rate = encoder_mode() ? 6 : 66, most_rate = encoder_mode() ? 44'000'000 : 1'100'000'000;
    const auto rate = [&](const std::optional<std::int64_t>& v, std::int64_t& known, char letter) -> std::string {
        if (!v) return {};
        if (*v < least_rate || *v > most_rate) return fmt::format("{}: {} is outside {}..{}", letter, *v, least_rate, most_rate);
        if (known != *v) job_.add(Step::What::send, fmt::format("{}={}", letter, *v));
        known = *v;
        return {};
    };
    if (velocity && (m.target < -5'000'000 || m.target > 5'000'000))
        return refuse(Reason::out_of_range, fmt::format("SL: {} is outside -5000000..5000000", m.target));
    if (!velocity && m.velocity) {
        const std::int64_t v = *m.velocity;
        if (v < 2)
            return refuse(Reason::out_of_range,
                          fmt::format("VM: {} is too low; the drive needs at least 2 (VI is at least 1 and below VM)", v));
        if (v > 2'560'000) return refuse(Reason::out_of_range, fmt::format("VM: {} is above 2560000", v));
    }
    const bool stop_first = !velocity && mv_ && fb_.moving;
    if (stop_first) {
        // A new MA is not taken during another one [L4110].
        job_.add(Step::What::send, "SL 0");
        job_.add(Step::What::standstill, "standstill");
    }
    if (!velocity && m.velocity) {
        const std::int64_t v = *m.velocity;
        const std::int64_t vi = std::min(user_vi_ > 0 ? user_vi_ : v - 1, v - 1);
        // VI must stay below VM: it goes down first and comes up last.
        if (vi < vi_ || vi_ == 0) job_.add(Step::What::send, fmt::format("VI={}", vi));
        if (v != vm_) job_.add(Step::What::send, fmt::format("VM={}", v));
        if (vi > vi_ && vi_ != 0) job_.add(Step::What::send, fmt::format("VI={}", vi));
        vi_ = vi;
        vm_ = v;
    }
    if (auto why = rate(m.acceleration, a_, 'A'); !why.empty()) return refuse(Reason::out_of_range, std::move(why));
    if (auto why = rate(m.deceleration, d_, 'D'); !why.empty()) return refuse(Reason::out_of_range, std::move(why));
    if (velocity) {
        // The drive refuses a speed below VI (error 97): VI goes down with it, and comes back at rest, where no motion feels it.
        const std::int64_t speed = std::abs(m.target);
        const std::int64_t vi = speed == 0 || user_vi_ == 0 ? vi_ : std::min(user_vi_, speed);
        if (vi != vi_ && vi_ != 0 && (vi < vi_ || (!mv_ && (vm_ == 0 || vi < vm_)))) {
            job_.add(Step::What::send, fmt::format("VI={}", vi));
            vi_ = vi;
        }
        job_.add(Step::What::send, fmt::format("SL {}", m.target));
        return;
    }
    std::int64_t target = m.target;
    if (m.kind == Move::Kind::relative) {
        if (!stop_first) target += fb_.position;
        job_.text = stop_first ? "relative" : "";
    }
    if (target < INT32_MIN || target > INT32_MAX)
        return refuse(Reason::out_of_range, fmt::format("target {} is outside -2147483648..2147483647", target));
    job_.add(Step::What::send, fmt::format("MA {}", target));
}

void Drive::plan_home(const Home& h, Turn& t) {
    if (h.method == 35 || h.method == 37) {
        if (fb_.moving) return job_over(Outcome::refused, Reason::wrong_state, fmt::format("{} moves: stop it first", name()), t);
        job_.add(Step::What::send, "P=0");
        return;
    }
    if (!de_) return job_over(Outcome::refused, Reason::wrong_state, fmt::format("{} is off (DE=0): enable it first", name()), t);
    int method = h.method;
    if (method == 0) {
        const std::string wanted = option(setup_.options, "home_method", "21");
        method = std::atoi(wanted.c_str());
    }
    // The input typed as home is the switch of every method; what differs is the way to it [L3206-3210].
    struct Row {
        int method;
        std::string_view line;
    };
    constexpr std::array rows{Row{21, "HM 1"}, Row{22, "HM 2"}, Row{19, "HM 3"}, Row{20, "HM 4"}, Row{33, "HI 1"},
                              Row{34, "HI 3"}, Row{-1, "HM 1"}, Row{-2, "HM 2"}, Row{-3, "HM 3"}, Row{-4, "HM 4"},
                              Row{-5, "HI 1"}, Row{-6, "HI 2"}, Row{-7, "HI 3"}, Row{-8, "HI 4"}};
    for (const auto& r : rows) {
        if (r.method == method) {
            // The search creeps with VI: not with what a slow move has left of it.
            if (vi_ != 0 && user_vi_ > vi_ && user_vi_ < vm_) {
                job_.add(Step::What::send, fmt::format("VI={}", user_vi_));
                vi_ = user_vi_;
            }
            job_.add(Step::What::send, std::string(r.line), false);
            return;
        }
    }
    job_over(
        Outcome::refused, Reason::not_supported,
        fmt::format("homing method {}: {}use 19..22 (home switch, HM), 33, 34 (index, HI), 35, 37 (here is 0), -1..-4 (HM 1..4) or -5..-8 "
                    "(HI 1..4)",
                    method, method == 17 || method == 18 ? "the drive has no homing on a limit switch; " : ""),
        t);
}

void Drive::began_motion(Turn& t) {
    motion_ = {};
    motion_.ended = false;
    stopping_ = false;
    const std::string& line = job_.steps[job_.at].text;
    if (job_.kind == JobKind::home) {
        motion_.kind = Motion::Kind::home;
        fb_.homing_attained = fb_.homing_error = fb_.referenced = false;
    } else if (line.starts_with("MA ")) {
        motion_.kind = Motion::Kind::position;
        motion_.target = std::atoll(line.c_str() + 3);
    } else {
        motion_.kind = Motion::Kind::velocity;
        motion_.ended = std::atoll(line.c_str() + 3) == 0;
    }
    last_error_ = 0;
    fb_.target_reached = false;
    fb_.internal_limit = false;
    emit(t);  // before the acknowledgement of the command: the old "reached" must not stand for the new target
    derive(t);
}

void Drive::step_ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (job_.kind == JobKind::none || job_.at >= job_.steps.size()) {
        if (v == Verdict::waiting) count_silence(t);
        demand_.forget();  // the line was in flight when a stop has ended its job: it may have been a motion
        return;
    }
    if (job_.kind == JobKind::setup) return step_done(t);
    if (job_.kind == JobKind::factory && v != Verdict::refused) {
        demand_lost();
        // Echo, checksum and name are the factory's now: no poll would be understood.
        job_.give_up = t.now + 5s;
        enabled_ = false;
        fb_.referenced = fb_.homing_attained = fb_.target_reached = false;
        motion_ = {};
        tidy_ = clear_half_ = false;
        derive(t);
        emit(t);
        begin_probing(t);
        at_factory_rate_ = true;
        return;
    }
    if (job_.kind == JobKind::restart && job_.steps[job_.at].text == reset_key) {
        demand_lost();
        if (job_.command.until_done) {
            restart_ = std::move(job_.command);
            restart_until_ = t.now + restart_limit;
            job_ = {};
        } else {
            job_over(Outcome::accepted, Reason::none, fmt::format("{} restarts: it is looked for and set up again", name()), t);
        }
        fail_all(Reason::interrupted, fmt::format("{} was restarted by reset", name()), t);
        enabled_ = false;
        fb_.referenced = fb_.homing_attained = fb_.target_reached = false;
        motion_ = {};
        mode_ = Mode::immediate;
        clear_half_ = suspected_ = found_ = tidy_ = false;
        derive(t);
        emit(t);
        return begin_probing(t);
    }
    Step& step = job_.steps[job_.at];
    const std::string& came = step.what == Step::What::block ? r.block() : r.raw();
    if (job_.kind == JobKind::native && !came.empty()) job_.bytes.assign(came.begin(), came.end());
    switch (step.what) {
        case Step::What::send:
            job_.said = v;
            job_.confirming = true;
            step_said(step, v);
            if (v == Verdict::waiting && !quiet()) count_silence(t);
            return;
        case Step::What::bare:
            if (v == Verdict::acknowledged || v == Verdict::answered) return step_done(t);
            mode_doubt_ = v == Verdict::waiting;
            return download_failed(fmt::format("{}{} {}", step.line != 0 ? fmt::format("line {}: ", step.line) : std::string(), step.text,
                                               v == Verdict::refused ? "was refused by the drive" : "was not acknowledged"),
                                   t);
        case Step::What::query:
            if (v == Verdict::answered) return query_answered(r.data(), t);
            if (v == Verdict::waiting) count_silence(t);
            if (job_.kind == JobKind::none) return;
            if (++job_.tries <= manners_.retries) {
                ++counters_.retries;
                return;
            }
            if (v == Verdict::refused) {
                need_error_ = true;
                error_is_ours_ = true;
                return job_over(Outcome::refused, Reason::not_supported,
                                variable_hint().empty() ? fmt::format("{} does not have {}, or cannot show it now", name(), step.text)
                                                        : variable_hint(),
                                t);
            }
            return job_over(Outcome::failed, Reason::no_answer, fmt::format("{} did not answer PR {}", name(), step.text), t);
        case Step::What::block:
            return block_came(v, r, t);
        case Step::What::standstill:
            return;
    }
}

void Drive::step_done(Turn& t) {
    const Step& step = job_.steps[job_.at];
    const bool last = job_.at + 1 == job_.steps.size();
    job_.tries = 0;
    if (last && (job_.kind == JobKind::move || (job_.kind == JobKind::home && !step.text.starts_with("P=")))) {
        began_motion(t);
        // The confirming poll was taken before `target_reached` was withdrawn: what it showed is said again.
        next_poll_ = t.now;
        return job_over(Outcome::accepted, Reason::none, {}, t);
    }
    ++job_.at;
    if (!last) {
        Step& coming = job_.steps[job_.at];
        if (coming.what == Step::What::standstill) {
            job_.give_up = t.now + 30s;
            next_poll_ = t.now;
        }
        if (job_.text == "relative" && coming.text.starts_with("MA ")) {
            const std::int64_t target = std::atoll(coming.text.c_str() + 3) + fb_.position;
            coming.text = fmt::format("MA {}", target);
            job_.text.clear();
        }
        return;
    }
    if (job_.awaits_end) {
        program_lost(Reason::interrupted, "another program was started", t);
        program_.emplace();
        program_->command = std::move(job_.command);
        job_ = {};
        next_poll_ = t.now;
        return;
    }
    switch (job_.kind) {
        case JobKind::enable:
            enabled_ = de_;
            derive(t);
            emit(t);
            if (!de_) return job_over(Outcome::failed, Reason::drive_refused, fmt::format("{} took DE=1 but is off", name()), t);
            break;
        case JobKind::reset:
            fault_ = 0;
            last_error_ = 0;
            derive(t);
            emit(t);
            break;
        case JobKind::home:
        case JobKind::set_position:
            fb_.referenced = true;
            if (job_.kind == JobKind::home || zero_after_home_) {
                fb_.homing_attained = true;
                fb_.homing_error = false;
                fb_.target_reached = true;
            }
            zero_after_home_ = false;
            derive(t);
            emit(t);
            break;
        case JobKind::clear:
            half_.clear();
            half_was_away_ = false;
            note(Severity::info, "program", 0, fmt::format("{}: the half that a broken download has left was removed (CP)", name()), t);
            half_from_.clear();
            return job_over(Outcome::done, Reason::none, {}, t);
        case JobKind::tidy:
            note(Severity::info, "program_mode", 0, job_.text, t);
            return job_over(Outcome::done, Reason::none, {}, t);
        case JobKind::setup: {
            // It is looked for by its name, and given EM, CK and ES; S comes behind them, so that they are kept too.
            const auto* action = std::get_if<Action>(&job_.command.body);
            job_.kind = JobKind::named;
            job_.steps.clear();
            job_.at = 0;
            job_.give_up = t.now + 5s;
            if (manners_.rate_code != 0) job_.add(Step::What::send, fmt::format("BD={}", manners_.rate_code));
            if (action && action->argument == "save") job_.add(Step::What::send, "S");
            return begin_probing(t);
        }
        default:
            break;
    }
    // A started program has begun; its end is another matter, and nobody waits for it.
    const auto* action = std::get_if<Action>(&job_.command.body);
    const bool begun = action && action->name == "program.start";
    job_over(begun ? Outcome::accepted : Outcome::done, Reason::none, job_.text, t);
}

void Drive::job_over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code, Value value) {
    const Command c = std::move(job_.command);
    const bool bad = o == Outcome::refused || o == Outcome::failed;
    if (bad && job_.kind == JobKind::tidy) {
        note(Severity::warning, "program_mode", code,
             fmt::format("{}: questions of this gateway may stand at the end of its program (PR \"#...): they could not be removed, {}",
                         name(), text),
             t);
    }
    if (bad && job_.kind == JobKind::clear) {
        note(Severity::warning, "program", code,
             fmt::format("{}: the half of a broken download stays in its program memory: it could not be removed, {}", name(), text), t);
    }
    if (bad && job_.kind == JobKind::move) vi_ = vm_ = a_ = d_ = 0;  // not known any more: set again next time
    if (bad && job_.kind == JobKind::shape) shape_refused_ = true;
    auto bytes = std::move(job_.bytes);
    job_ = {};
    result(c, o, r, std::move(text), t, code, std::move(value));
    if (!bytes.empty() && c.ticket != no_ticket) t.out.results.back().bytes = std::move(bytes);
}

}  // namespace axisgate::mcode
