// Drive, part motion: the verbs of CiA 402 taken apart into instructions, and the run of such a job to its one result.
// In: commands from the queue, answers to their steps. Out: exchanges one after the other, the result.
// Never starts what it could not set: any refused or altered value ends the job before BG. Never repeats BG.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
constexpr std::int64_t ramp_rate_max = 65'000'000;  // pulse/s^2 [L1342]
constexpr std::int64_t ramp_time_max = 60'000;      // ms
constexpr std::int64_t i32_max = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t i32_min = std::numeric_limits<std::int32_t>::min();

/// What helps, by the code of a refusal.
std::string_view advice(std::uint8_t code, std::uint8_t function) {
    switch (code) {
        case 0x32:
            return function == cw::SP ? "; SP is taken only after PR or PA" : "";
        case 0x3C:
            return "; SD must not be below DC: raise SD first, or choose a smaller deceleration";
        case 0x3D:
            return "; stop the axis first";
        case 0x3E:
            return "; enable the axis first";
        case 0x3F:
            return "; wait until the stop has ended; if the drive is locked, reset the fault";
        case 0x41:
            return "; stop the axis first";
        default:
            return "";
    }
}
}  // namespace

std::string Drive::not_startable() const {
    if (!presence_.is(Phase::ready)) return fmt::format("{} does not answer", name());
    if (!status_.on) return fmt::format("{} is off", name());
    if (status_.lock) return fmt::format("{} is locked", name());
    if (stopping() || (stop_ramp_ && fb_.moving)) return fmt::format("{} is being stopped", name());
    return {};
}

// --- jobs ------------------------------------------------------------------------------------------------------------------------

void Drive::take_next(Turn& t) {
    const Command next = queue_.pop();
    if (!is_place(next)) return start_job(next, t);
    begin_job(JobKind::together, next);
    job_.waiting = true;
    bus_.part_ready(*this, t);
}

void Drive::begin_job(JobKind kind, const Command& command) {
    job_ = Job{};
    job_.active = true;
    job_.kind = kind;
    job_.command = command;
}

void Drive::start_job(const Command& command, Turn& t) {
    const CommandBody& body = command.body;
    if (std::holds_alternative<Enable>(body)) {
        begin_job(JobKind::enable, command);
        plan_enable(t);
    } else if (std::holds_alternative<ResetFault>(body)) {
        begin_job(JobKind::reset, command);
        plan_reset(t);
    } else if (const auto* home = std::get_if<Home>(&body)) {
        begin_job(JobKind::origin, command);
        plan_home(*home, t);
    } else if (const auto* to = std::get_if<SetPosition>(&body)) {
        begin_job(JobKind::origin, command);
        if (to->position != 0) {
            return refuse_job(Reason::not_supported, "the drive's only instruction for it is OG, which calls the present position 0", t);
        }
        job_.add(msg_act(cw::OG));
    } else if (const auto* move = std::get_if<Move>(&body)) {
        begin_job(JobKind::move, command);
        plan_move(*move, t);
    } else if (std::holds_alternative<StartTogether>(body)) {
        begin_job(JobKind::begin, command);
        if (!prepared_) return refuse_job(Reason::wrong_state, "no motion has been prepared", t);
        if (auto why = not_startable(); !why.empty()) return refuse_job(Reason::wrong_state, std::move(why), t);
        job_.add(msg_act(cw::BG));
    } else if (const auto* read = std::get_if<ReadParameter>(&body)) {
        begin_job(JobKind::read, command);
        plan_read(*read, t);
    } else if (const auto* write = std::get_if<WriteParameter>(&body)) {
        begin_job(JobKind::write, command);
        plan_write(*write, t);
    } else if (const auto* native = std::get_if<Native>(&body)) {
        begin_job(JobKind::native, command);
        plan_native(*native, t);
    } else if (const auto* action = std::get_if<Action>(&body)) {
        begin_job(JobKind::native, command);
        plan_action(*action, t);
    } else {
        begin_job(JobKind::native, command);
        return refuse_job(Reason::not_supported, fmt::format("{} is nothing that a drive can do", name_of(body)), t);
    }
    if (job_.active && !job_.waiting) run_job(t);
}

/// Sends the present step, or what has to go before it.
void Drive::run_job(Turn& t) {
    if (exchange_.active()) return;
    while (job_.active && !job_.waiting && job_.at < job_.count) {
        if (job_.again) {
            job_.again = false;
            if (job_.steps[job_.at].mf != 0 && job_.at > 0) --job_.at;
        }
        const Step& step = job_.steps[job_.at];
        const Instruction* i = instruction(step.message.cw);
        if (late_.has(mark_of(step.message)) || (step.select && late_.has(mark_of(job_.steps[job_.at + 1u].message)))) return go_barrier(t);
        const int retries = bus_.timing.retries;
        if (mf_unknown_ && i && i->takes_mf && step.mf == 0) {
            return send_exchange(msg_set(cw::MF, 0), Purpose::clear_mf, 0, retries, Priority::command, t);
        }
        if (!step.message.wants_ack()) {
            blind_ = step.message.function();
            if (blind_ == cw::MF) mf_unknown_ = true;
            bus_.transmit(step.message, Priority::command, t);
            const Step sent = step;
            ++job_.at;
            native_answered(sent, nullptr, t);
            continue;
        }
        if (step.select) mf_unknown_ = true;
        // A value for an input's group is not repeated alone: its MF is used up, and it would hit group 0.
        const bool repeatable = step.mf == 0 && (form_of(step.message) == Form::get || (i && i->repeatable));
        return send_exchange(step.message, Purpose::job, step.mf, repeatable ? retries : 0, Priority::command, t);
    }
    if (job_.active && !job_.waiting && job_.at >= job_.count) job_done(t);
}

void Drive::job_answered(const Message& m, Turn& t) {
    if (!job_.active || job_.at >= job_.count) return;
    const Step step = job_.steps[job_.at];
    job_.last = m;
    if (step.mf != 0) mf_unknown_ = false;
    if (step.select) {
        if (job_.again) {
            job_.again = false;
            return;
        }
        ++job_.at;
        if (job_.kind == JobKind::native) native_answered(step, &m, t);
        return;
    }
    ++job_.at;
    switch (job_.kind) {
        case JobKind::native:
        case JobKind::system:
            native_answered(step, &m, t);
            break;
        case JobKind::write:
            done_write(m, t);
            break;
        case JobKind::enable:
        case JobKind::move:
        case JobKind::search:
            if (job_.kind == JobKind::search && step.mf != 0 && search_.stage == Search::Stage::save) {
                const auto dc = static_cast<std::uint32_t>(value_of(step.message, m).value_or(0));
                (step.mf % 2 == 0 ? restore_.dc_rising : restore_.dc_falling) = dc;
            }
            if (!echoes(step.message, m)) {
                const std::string text =
                    fmt::format("{} was answered with {}: nothing was started", describe_request(step.message), describe_answer(m));
                if (job_.kind == JobKind::search) return search_over(false, Reason::drive_refused, text, t);
                return job_over(Outcome::failed, Reason::drive_refused, text, t);
            }
            break;
        default:
            break;
    }
    if (job_.active && job_.at >= job_.count) job_done(t);
}

void Drive::job_refused(const Message& m, Turn& t) {
    if (!job_.active) return;
    const Step step = job_.steps[std::min<std::size_t>(job_.at, job_.steps.size() - 1)];
    const auto report = error_report_of(m);
    const std::uint8_t code = report ? report->code : std::uint8_t{0};
    if (job_.kind == JobKind::reset && step.message.function() == cw::ER) return job_done(t);  // the flags are cleared; that counts
    std::string text =
        fmt::format("{}: the drive says {}{}", describe_request(step.message), describe_error(code), advice(code, step.message.function()));
    if (job_.kind == JobKind::search) return search_over(false, Reason::drive_refused, std::move(text), t);
    if (job_.kind == JobKind::native) {
        job_.bytes.insert(job_.bytes.end(), {m.cw, m.dl});
        job_.bytes.insert(job_.bytes.end(), m.d.begin(), m.d.begin() + m.dl);
    }
    const bool begun = job_.at > 0 && (job_.kind == JobKind::enable || job_.kind == JobKind::native || job_.kind == JobKind::reset);
    job_over(begun ? Outcome::failed : Outcome::refused, Reason::drive_refused, std::move(text), t, code);
}

/// A step got no answer.
void Drive::job_silent(Turn& t) {
    if (!job_.active) return;
    const Step step = job_.steps[std::min<std::size_t>(job_.at, job_.steps.size() - 1)];
    if (step.mf != 0 && job_.rounds < bus_.timing.retries) {
        // Its MF may be used up: the pair is sent anew, never the value alone.
        ++job_.rounds;
        ++bus_.counters.retries;
        --job_.at;
        return;
    }
    std::string text;
    if (step.message.function() == cw::BG) {
        text = "BG was sent and not acknowledged: whether the axis moves is not known; its status is being read";
    } else if (form_of(step.message) == Form::get) {
        text = fmt::format("{} was not answered", describe_request(step.message));
    } else {
        text = fmt::format("{} was not acknowledged: whether the drive took it is not known", describe_request(step.message));
    }
    if (job_.kind == JobKind::search) return search_over(false, Reason::no_answer, std::move(text), t);
    job_over(Outcome::failed, Reason::no_answer, text, t);
    if (step.message.function() == cw::BG) begin_unknown_motion(t);
    poll_now(t);
}

/// Every step has been answered.
void Drive::job_done(Turn& t) {
    switch (job_.kind) {
        case JobKind::enable: {
            const Command c = job_.command;
            job_.active = false;
            poll_now(t);
            return accepted(c.ticket, c.until_done, WaitFor::on, 0, "", t);
        }
        case JobKind::reset:
            return done_reset(t);
        case JobKind::origin:
            return done_origin(t);
        case JobKind::move:
            return done_move(t);
        case JobKind::begin: {
            const Command c = job_.command;
            const Motion m = prepared_motion_;
            job_.active = false;
            begin_motion(m, t);
            return accepted(c.ticket, c.until_done, m.kind == Motion::Kind::velocity ? WaitFor::speed : WaitFor::target, m.target, "", t);
        }
        case JobKind::search:
            return search_next(t);
        case JobKind::read:
            return done_read(job_.last, t);
        case JobKind::write:
            return;  // done_write has ended it
        case JobKind::native:
        case JobKind::system:
            return done_native(t);
        case JobKind::restore:
            restore_ = {};
            job_.active = false;
            return;
        case JobKind::together:
            return;
    }
}

void Drive::job_over(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code, Value value) {
    if (!job_.active) return;
    job_.active = false;
    blind_.reset();
    const bool part = job_.kind == JobKind::together && outcome != Outcome::accepted && outcome != Outcome::done;
    if (part) bus_.part_done(*this, {false, reason, code, text}, t);
    result(job_.command.ticket, outcome, reason, std::move(text), t, code, std::move(value), std::move(job_.bytes));
}

// --- the verbs -------------------------------------------------------------------------------------------------------------------

/// A residual action may move the motor when the driver turns on [L1264]: ST before and after MO=1, and only then, with the
/// driver on as the manual wants it, a jog speed of 0 in place of whatever was set before.
void Drive::plan_enable(Turn& t) {
    if (status_.lock) return refuse_job(Reason::wrong_state, "the drive is locked after an emergency stop: reset the fault first", t);
    job_.add(msg_act(cw::ST));
    job_.add(msg_set(cw::MO, 1));
    job_.add(msg_act(cw::ST));
    job_.add(msg_set(cw::JV, 0));
    if (options_.notify && notifies_ == false) job_.add(msg_set(cw::IE, 1, 8));  // the driver is on: RAM alone
}

/// MS[0]=0 clears PAIF, TLIF and ERR [L920]; a lock is left by MO=0 (erratum E-39); ER[0]=0 takes the shown error away.
void Drive::plan_reset(Turn& t) {
    (void)t;
    if (status_.lock) job_.add(msg_set(cw::MO, 0));
    job_.add(msg_set(cw::MS, 0, 0));
    if (latest_error_ != 0) job_.add(msg_set(cw::ER, 0, 0));
}

void Drive::done_reset(Turn& t) {
    poll_now(t);
    fb_.homing_error = false;
    if (status_.err || status_.tlif || status_.lock) {
        derive(t);
        return job_over(Outcome::failed, Reason::drive_refused,
                        fmt::format("after MS[0]=0 the drive still shows{}{}{}", status_.tlif ? " a stall" : "",
                                    status_.lock ? " a lock" : "", status_.err ? " an error" : ""),
                        t, fb_.error_code);
    }
    latest_error_ = 0;
    alarm_ = 0;
    cause_ = Cause::none;
    derive(t);
    emit(t);
    job_over(job_.command.until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t);
}

void Drive::plan_home(const Home& home, Turn& t) {
    const int m = home.method;
    if (m == 0 || m == 35 || m == 37) {
        job_.add(msg_act(cw::OG));
        fb_.homing_attained = false;
        fb_.homing_error = false;
        return;
    }
    if (m >= 17 && m <= 22) {
        job_.kind = JobKind::search;
        return plan_search(home.method, t);
    }
    std::string why = fmt::format("homing method {}: ", m);
    if (m >= 23 && m <= 30) {
        why += "the drive cannot turn round at a limit switch by itself; methods 17 to 22 use one switch";
    } else if ((m >= 1 && m <= 14) || m == 33 || m == 34) {
        why += "the drive has no instruction for the index pulse of the encoder";
    } else {
        why += "unknown";
    }
    refuse_job(Reason::not_supported, why + "; 35 and 37 call the present position 0", t);
}

void Drive::done_origin(Turn& t) {
    fb_.referenced = true;
    fb_.homing_error = false;
    if (std::holds_alternative<Home>(job_.command.body)) fb_.homing_attained = true;
    demand_rests(fb_.position = 0);  // "clear the position counter" [L1508], and it was acknowledged
    position_at_ = t.now;
    motion_ = {};
    derive(t);
    emit(t);
    poll_now(t);
    job_over(job_.command.until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t);
}

/// AC or DC for an acceleration in pulse/s^2. With IC[4] = 1 they are the time between cut-in speed and speed, in ms. Nothing and
/// no fault: no ramp is needed.
std::optional<std::uint32_t> Drive::ramp(std::int64_t rate, std::int64_t speed, std::string_view what, std::string& text,
                                         std::string& fault) const {
    if (!time_ramps_) {
        fault = fmt::format("IC[4] could not be read, so the unit of {} is not known", what);
        return std::nullopt;
    }
    if (!*time_ramps_) {
        if (rate >= 1 && rate <= ramp_rate_max) return static_cast<std::uint32_t>(rate);
        fault = fmt::format("{}: {} is outside 1..{} pulse/s^2", what, rate, ramp_rate_max);
        return std::nullopt;
    }
    if (!ss_) {
        fault = fmt::format("SS could not be read, so {} cannot be converted to a time (IC[4] = 1)", what);
        return std::nullopt;
    }
    if (rate < 1) {
        fault = fmt::format("{}: {} pulse/s^2 is not above 0", what, rate);
        return std::nullopt;
    }
    const std::int64_t step = speed - static_cast<std::int64_t>(*ss_);
    if (step <= 0) return std::nullopt;  // the speed is reached at once
    const double ms = 1000.0 * static_cast<double>(step) / static_cast<double>(rate);
    const auto rounded = std::max<std::int64_t>(1, std::llround(ms));
    if (rounded > ramp_time_max) {
        fault = fmt::format("{}: {} pulse/s^2 up to {} pulse/s takes {} ms; the drive allows 1..{} ms (IC[4] = 1)", what, rate, speed,
                            rounded, ramp_time_max);
        return std::nullopt;
    }
    fmt::format_to(std::back_inserter(text), "{}{} = {} ms", text.empty() ? "" : ", ", what, rounded);
    return static_cast<std::uint32_t>(rounded);
}

void Drive::plan_move(const Move& move, Turn& t) {
    // With the driver off PA would be kept, and act as a residual motion when it turns on.
    if (!status_.on) return refuse_job(Reason::wrong_state, "the driver is off: enable the axis first", t);
    if (status_.lock) return refuse_job(Reason::wrong_state, "the drive is locked after an emergency stop: reset the fault first", t);
    if (move.target < i32_min || move.target > i32_max) {
        return refuse_job(Reason::out_of_range, fmt::format("target {} is outside {}..{}", move.target, i32_min, i32_max), t);
    }
    const bool jog = move.kind == Move::Kind::velocity;
    std::int64_t speed = 0;
    if (jog) {
        speed = std::llabs(move.target);
    } else {
        // JV and SP share one register of the desired speed: SP is sent with every motion, or an old JV would decide (erratum E-46).
        speed = move.velocity.value_or(ptp_speed_.value_or(0));
        if (speed < 1 || speed > i32_max) {
            return refuse_job(Reason::out_of_range,
                              move.velocity ? fmt::format("velocity {} is outside 1..{} pulse/s", speed, i32_max)
                                            : std::string("the drive has no speed for a positioning motion yet: give a velocity"),
                              t);
        }
    }
    std::string fault, text;
    // DC first: it is the one that can be refused for its relation to SD, and then nothing has changed.
    for (const bool down : {true, false}) {
        const auto& wanted = down ? move.deceleration : move.acceleration;
        if (!wanted) continue;
        const std::uint8_t which = down ? cw::DC : cw::AC;
        const auto v = ramp(*wanted, speed, down ? "DC" : "AC", text, fault);
        if (!fault.empty()) return refuse_job(Reason::out_of_range, std::move(fault), t);
        if (v && (down ? dc_ : ac_) != *v) job_.add(msg_set(which, *v));
    }
    job_.text = std::move(text);
    job_.wanted = speed;
    switch (move.kind) {
        case Move::Kind::absolute:
            job_.add(msg_set(cw::PA, move.target));
            break;
        case Move::Kind::relative:
            job_.add(msg_set(cw::PR, move.target));
            break;
        case Move::Kind::velocity:
            job_.add(msg_set(cw::JV, move.target));
            break;
    }
    if (!jog) job_.add(msg_set(cw::SP, speed));  // after PA or PR, else 0x32 [L1453]
    prepared_ = false;
    if (!move.prepare_only) job_.add(msg_act(cw::BG));
}

void Drive::done_move(Turn& t) {
    const Command c = job_.command;
    const Move& move = std::get<Move>(c.body);
    Motion m;
    m.kind = move.kind == Move::Kind::absolute   ? Motion::Kind::absolute
             : move.kind == Move::Kind::relative ? Motion::Kind::relative
                                                 : Motion::Kind::velocity;
    m.target = move.target;
    m.speed = job_.wanted;
    std::string text = std::move(job_.text);
    job_.active = false;
    if (move.prepare_only) {
        prepared_ = true;
        prepared_motion_ = m;
        if (!text.empty()) text += "; ";
        return result(c.ticket, Outcome::accepted, Reason::none, text + "prepared: start_together starts it", t);
    }
    begin_motion(m, t);
    accepted(c.ticket, c.until_done, m.kind == Motion::Kind::velocity ? WaitFor::speed : WaitFor::target, m.target, std::move(text), t);
}

// --- joint start -----------------------------------------------------------------------------------------------------------------

bool Drive::join() { return queue_.push(Command{no_ticket, axis_, StartTogether{}, false, {}}); }

bool Drive::is_place(const Command& command) noexcept {
    const auto* together = std::get_if<StartTogether>(&command.body);
    return together && together->axes.empty();
}

void Drive::begun_by_group(bool until_done, Turn& t) {
    if (job_.active && job_.kind == JobKind::together) job_.active = false;
    broadcast_until_ = t.now + 4 * bus_.timing.reply_timeout;  // it may wait in the line's queue behind other frames
    if (prepared_) {
        begin_motion(prepared_motion_, t);
    } else {
        begin_unknown_motion(t);
    }
    part_pending_ = true;
    part_until_done_ = until_done;
}

void Drive::leave(Turn& t) {
    if (job_.active && job_.kind == JobKind::together) job_.active = false;
    (void)queue_.interrupt(is_place, "", tickets_, t);
    part_pending_ = false;
    std::erase_if(waits_, [](const Wait& w) { return w.what == WaitFor::part; });
}

}  // namespace axisgate::uim342
