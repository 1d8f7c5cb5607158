// Motor: the passing of time, edges of inputs, types of outputs, supply and temperature.
// Words are in motor_words.cpp, the hand is in motor_hand.cpp.
// In: instants, edges, figures. Out: events, stops, states of outputs.
// Never works off more than 256 happenings in one call; the rest stay due.
#include "adapters/mcode/twin/motor.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
constexpr int happenings_per_call = 256;
/// A real rotor in motion is looked at this often, so that nobody learns of its stall much later.
constexpr Duration rotor_pause = std::chrono::milliseconds(20);

}  // namespace

std::unique_ptr<Mechanism> make_mechanism(const MechanismSetup& setup) { return std::make_unique<Motor>(setup); }

void Motor::advance(Instant now) {
    for (int n = 0; n < happenings_per_call; ++n) {
        const Instant t = std::max(std::min(next_, now), last_);
        if (!follow(t)) continue;
        if (next_ > now) break;
        last_ = t;
        handle(t);
        replan(t);
    }
    last_ = std::max(last_, now);
    if (rotor_tick_ <= last_) rotor_tick_ = course_.rests() ? never : last_ + rotor_pause;
}

bool Motor::follow(Instant until) {
    RealRotor& real = p_.real;
    if (!real.differs()) return true;
    Instant ended = never;
    if (p_.power.good()) {
        const double per_turn = p_.settings.direction() / p_.settings.units_per_turn();
        const auto field = [&](Instant at) {  // what it was before the last change is over
            const Instant t = std::max(at, last_);
            return RealRotor::Place{p_.shaft.turns(t), p_.shaft.rotor(t).velocity * per_turn};
        };
        const auto stalls = [&](Instant at, double shown) {
            const Instant t = std::max(at, last_);
            return course_.watched().rotor && twin::stalls(p_, t, shown - p_.shaft.turns(t));
        };
        ended = real.follow(until, !course_.watched().step, field, stalls);
    } else {
        real.drift(until);
    }
    const Instant t = std::max(last_, std::min(until, ended));
    p_.shaft.stray = real.shown() - p_.shaft.turns(std::max(real.at(), last_));
    if (ended == never || !course_.notice(t)) return true;
    last_ = t;
    replan(t);
    return false;
}

void Motor::replan(Instant now) {
    due_ = {};
    if (course_.steps()) {
        due_.soft = p_.limits.crossing(now);
        due_.index = homing_.index_due(now);
        due_.stall = course_.stall_due(now);
        due_.lag = p_.loop.lag_due(now);
        if (p_.settings.hmt_mode() != 0)
            due_.wrap = std::min(p_.shaft.position_crossing(2147483647.0, now, 1), p_.shaft.position_crossing(-2147483648.0, now, -1));
        due_.cam = p_.cams.crossing(now);
    }
    p_.trips.plan(course_.steps(), now);
    moving_.note(p_.settings.manners().moving_ends_with_steps ? course_.steps() : !course_.rests(), now);
    to_position_.note(course_.to_position(), now);
    if (p_.real.differs()) rotor_tick_ = course_.rests() ? never : std::min(rotor_tick_, now + rotor_pause);
    next_ = std::min({due_.soft, due_.index, p_.trips.deadline(), due_.stall, due_.lag, due_.wrap, due_.cam, p_.inputs.deadline(),
                      course_.demand.passing, course_.phase_end(), p_.loop.lock_due(), p_.shaft.meeting(), course_.steps_end()});
}

/// Everything that is due at `t`, causes before effects.
void Motor::handle(Instant t) {
    const Due due = due_;
    due_ = {};
    if (due.cam <= t) p_.cams.judge(t);
    while (const auto e = p_.inputs.next_edge(t))
        edge(*e, t);
    if (course_.demand.passing <= t) {
        course_.demand.passing = never;
        p_.events.emit(MotorEvent::Kind::finished);
    }
    if (p_.shaft.meeting() <= t) p_.loop.caught_up();
    if (due.stall <= t) course_.stalled(t);
    if (due.lag <= t) p_.loop.judge_lag(t);
    if (p_.loop.lock_due() <= t) course_.locked(t);
    if (due.wrap <= t) p_.events.raise(err::max_count);
    p_.trips.pass(t);
    if (due.soft <= t) moves_.limit_met(p_.shaft.commanded(t).velocity < 0 ? -1 : 1, t);
    if (due.index <= t) homing_.index(t);
    if (course_.steps_end() <= t) {
        moves_.steps_over(t);
    } else if (course_.phase_end() <= t) {
        moves_.phase_over(t);
    }
}

void Motor::edge(const InputEdge& e, Instant now) {
    using Kind = MotorEvent::Kind;
    p_.trips.input(e, now);
    switch (e.type) {
        case InputType::home:
            homing_.switched(e.active, now);
            break;
        case InputType::limit_plus:
            if (e.active) moves_.limit_met(1, now);
            break;
        case InputType::limit_minus:
            if (e.active) moves_.limit_met(-1, now);
            break;
        case InputType::go:
            if (e.active) p_.events.emit(Kind::go);
            break;
        case InputType::soft_stop:
            if (e.active) moves_.soft_stop(program_running_, now);
            break;
        case InputType::pause:
            p_.events.emit(e.active ? Kind::pause : Kind::resume);
            break;
        case InputType::jog_plus:
        case InputType::jog_minus:
            moves_.jog(now);
            break;
        case InputType::reset:
            if (e.active) p_.events.emit(Kind::reset);
            break;
        default:
            break;
    }
}

bool Motor::output(std::size_t n, Instant now) const noexcept {
    const bool moves = !course_.rests();
    switch (p_.outputs.type(n)) {
        case OutputType::general:
            return p_.outputs.value(n);
        case OutputType::moving:
            return moves;
        case OutputType::error:
            return error_flag_;
        case OutputType::stall:
            return course_.stall_flag();
        case OutputType::velocity_changing:
            return course_.velocity_changing(now);
        case OutputType::locked_rotor:
            return p_.loop.locked();
        case OutputType::to_position:
            return course_.to_position();
        case OutputType::hmt_active:
            return p_.settings.hmt_mode() != 0 && (p_.loop.at_bounds() || p_.shaft.state() == Shaft::Rotor::catching_up);
        case OutputType::makeup_active:
            return p_.shaft.state() == Shaft::Rotor::catching_up;
        case OutputType::encoder_a:
        case OutputType::encoder_b: {
            const auto phase = static_cast<std::int64_t>(std::floor(p_.shaft.c2(now))) & 3;
            return p_.outputs.type(n) == OutputType::encoder_a ? phase == 1 || phase == 2 : phase >= 2;
        }
        case OutputType::attention: {
            const auto mask = static_cast<std::uint64_t>(p_.settings[Word::AO]);
            std::uint64_t on = 0;  // the bits that the damaged table leaves [E-32]
            if (error_flag_) on |= 1;
            if (p_.loop.lead_limit()) on |= 4;
            if (p_.loop.lag_limit()) on |= 8;
            if (!moves && course_.current(now) == p_.settings.whole(Word::HC)) on |= 512;
            if (moves) on |= 16384;
            if (course_.stall_flag()) on |= 32768;
            return (mask & on) != 0;
        }
        default:
            return false;  // trip: a pulse of CW*50 ns, over before anybody looks; trip_pulses counts
    }
}

void Motor::judge_supply(Instant now) {
    Supply& supply = p_.power.supply;
    // Both out: 78 first and 79 last [E-33]. An unused aux supply is no error.
    const bool aux_bad = supply.has_aux && !supply.aux_unused() && !supply.aux_good();
    if (aux_bad && !supply.aux_reported) p_.events.raise(err::aux_out);
    supply.aux_reported = aux_bad;
    const bool plus_bad = !supply.plus_v_good();
    if (plus_bad && !supply.plus_v_reported) {
        p_.events.raise(err::plus_v_out);
        if (supply.plus_v < plus_v_low && supply.aux_good()) p_.trips.supply_low(now);
        bridges_off(now);
    }
    supply.plus_v_reported = plus_bad;
    const bool is_warm = supply.hottest() > p_.settings[Word::WT];
    if (is_warm && !supply.warned) p_.events.raise(err::warm);
    supply.warned = is_warm;
    const bool is_hot = supply.hottest() >= shut_down_temperature;
    if (is_hot && !supply.over_temperature) {
        p_.events.raise(err::hot);
        p_.settings.set(Word::DE, 0);
        bridges_off(now);
    }
    supply.over_temperature = is_hot;
}

void Motor::bridges_off(Instant now) {
    if (!course_.rests()) course_.abort(now);
}

bool Motor::owes(Instant now) const noexcept { return p_.settings.makes_up() && std::abs(p_.shaft.lag(now)) >= 1; }

int Motor::arm(Word w, std::span<const Number> f, Instant now) {
    advance(now);
    if (const int code = p_.settings.available(w); code != 0) return code;
    const int code = p_.trips.arm(w, f, now);
    if (code == 0) replan(now);
    return code;
}

void Motor::enable_trips(int te, Instant now) {
    advance(now);
    p_.trips.enable(te, now);
    replan(now);
}

void Motor::capture(Instant now) {
    advance(now);
    p_.trips.capture(now);
}

void Motor::restart(Instant now) {
    advance(now);
    p_.events.clear();
    p_.loop.restart();
    course_.restart(now);
    moves_.restart();
    p_.trips.restart();
    p_.settings.set(Word::FS, 0);
    p_.power.off = !p_.power.enable_input;
    error_flag_ = program_running_ = false;
    Supply& supply = p_.power.supply;
    supply.warned = supply.over_temperature = supply.plus_v_reported = supply.aux_reported = false;
    replan(now);
}

int Motor::start(Word word, std::span<const Number> fields, Instant now) {
    advance(now);
    int code = p_.settings.available(word);
    if (code == 0 && word == Word::SL && fields.size() != 1) return err::bad_value;
    if (code == 0) code = moves_.start(word, fields, now);
    replan(now);
    return code;
}

void Motor::stop_at_once(Instant now) {
    advance(now);
    const bool unfinished = course_.steps() && owes(now);
    course_.freeze(now);
    if (unfinished) p_.events.raise(err::makeup_stopped);
    replan(now);
}

void Motor::pause(Instant now) {
    advance(now);
    moves_.pause(now);
    replan(now);
}

void Motor::resume(Instant now) {
    advance(now);
    const auto code = moves_.resume(now);
    if (!code) return;
    if (*code != 0) p_.events.raise(*code);
    replan(now);
}

bool Motor::moving(Instant now) {
    advance(now);
    return !course_.rests();
}

bool Motor::busy(bool any, Instant now) {
    using Task = Course::Task;
    if (!moving(now)) return false;
    const Task task = course_.demand.task;
    return any || task == Task::position || task == Task::homing || task == Task::calibration || task == Task::correction;
}

void Motor::tell(bool error_flag, bool program_running, Instant) {
    error_flag_ = error_flag;
    program_running_ = program_running;
    // A program that was ended while it was paused takes its pause along.
    if (!program_running) moves_.forget_pause();
}

TwinMechanics Motor::mechanics(Instant now) const {
    const Travel r = p_.shaft.rotor(std::max(now, last_));
    return {r.position + p_.shaft.measured(now).position - p_.shaft.rotor(now).position, r.velocity, p_.power.good()};
}

}  // namespace axisgate::mcode::twin
