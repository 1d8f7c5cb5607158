// Moves: how motions are started, paused and ended.
// In: fields, VM, VI, BL, BE, BM, LM, JE, FL. Out: what the course is to do.
// Never moves in a direction that a limit holds.
#include "adapters/mcode/twin/moves.hpp"

#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
using Task = Course::Task;
constexpr std::int64_t position_limit = 2147483647;  // [E-44]

int way_of(double v) noexcept { return v < 0 ? -1 : v > 0 ? 1 : 0; }

}  // namespace

void Moves::restart() noexcept {
    last_ = Word::MR;
    last_way_ = 0;
    forget_pause();
}

int Moves::start(Word word, std::span<const Number> fields, Instant now) {
    switch (word) {
        case Word::MA:
        case Word::MR:
            return start_move(word, fields, now);
        case Word::SL:
            return start_slew(fields[0].as_integer(), now);
        case Word::HM:
        case Word::HI:
        case Word::HF:
            return homing_.start(word, fields, now);
        case Word::SC:
            return start_calibration(fields, now);
        case Word::CF:
            course_.unlock(now);
            return 0;
        default:
            return err::bad_value;
    }
}

int Moves::start_move(Word word, std::span<const Number> f, Instant now) {
    if (f.empty() || f.size() > 3) return err::bad_value;
    const std::int64_t value = f[0].as_integer();
    if (value > position_limit || value < -position_limit - 1) return err::bad_value;
    for (std::size_t i = 1; i < f.size(); ++i) {
        if (f[i].as_integer() != 0 && f[i].as_integer() != 1) return err::bad_value;
    }
    if (const int code = course_.may_move(word); code != 0) return code;
    const bool go_on = f.size() == 3 && f[2].as_integer() == 1;
    if (!course_.steps()) course_.forget_corrections();
    course_.resync(now);
    const double here = std::round(p_.shaft.shown_position(now).position);
    double target = static_cast<double>(value) + (word == Word::MR ? here : 0.0);
    const int way = way_of(target - here);
    std::optional<double> second;
    const double backlash = p_.settings[Word::BL];
    if (p_.settings[Word::BE] != 0 && backlash != 0 && way != 0 && !go_on) {
        if (p_.settings[Word::BM] == 0) {
            // Once per reversal, and counted [L1693-1703].
            if (last_way_ != 0 && way != last_way_) target += way * std::abs(backlash);
        } else if (way != way_of(backlash)) {
            second = target;
            target -= backlash;
        }
    }
    if (const int code = way != 0 ? p_.limits.held(way, now) : 0; code != 0) return code;
    if (way != 0) last_way_ = way;
    last_ = word;
    position(target, second, go_on, now);
    if (go_on && target == here) course_.demand.passing = now;
    return 0;
}

void Moves::position(double target, std::optional<double> second, bool go_on, Instant now) {
    course_.begin(Task::position, now);
    course_.demand.target = target;
    course_.demand.second = second;
    course_.move(target, go_on, now);
    course_.demand.go_on = go_on;
    course_.demand.passing = go_on ? p_.shaft.command().crossing(now, target) : never;
}

int Moves::start_slew(std::int64_t velocity, Instant now) {
    const double v = static_cast<double>(velocity);
    const bool counts = p_.settings.encoder_mode();
    if (std::abs(v) > (counts ? p_.settings.speed_limit() : 5'000'000.0)) return err::bad_value;
    if (const int code = course_.may_move(Word::SL); code != 0) return code;
    if (!counts && p_.settings[Word::MS] < 256 && std::abs(v) > p_.settings.speed_limit()) return err::too_large;  // [E-67]
    if (velocity == 0) {
        last_ = Word::SL;
        if (course_.steps()) {
            course_.demand.task = Task::slew;
            course_.brake(now);
        }
        return 0;
    }
    if (std::abs(v) < p_.settings[Word::VI]) return err::below_vi;
    if (const int code = p_.limits.held(way_of(v), now); code != 0) return code;
    last_ = Word::SL;
    course_.begin(Task::slew, now);
    slew_ = v;
    course_.slew(v, now);
    return 0;
}

/// SC 1: half a turn, by which resolution and direction of the encoder are compared [L5343].
int Moves::start_calibration(std::span<const Number> f, Instant now) {
    if (f.size() != 1 || f[0].as_integer() != 1) return err::bad_value;
    if (course_.steps()) return err::calibration_moving;
    if (!p_.power.enabled()) return err::calibration_disabled;
    if (!p_.power.good()) return err::no_supply;
    course_.begin(Task::calibration, now);
    course_.move(p_.shaft.commanded(now).position + std::round(p_.settings.units_per_turn() / 2), false, now);
    return 0;
}

void Moves::steps_over(Instant now) {
    p_.cams.judge(now);
    p_.shaft.set_way(p_.shaft.way(now));
    Course::Demand& demand = course_.demand;
    if (demand.task == Task::homing) {
        homing_.leg_over(now);
        return;
    }
    if (demand.second && !demand.braking) {
        demand.target = *demand.second;
        demand.second.reset();
        course_.move(demand.target, false, now);
        return;
    }
    if (demand.task == Task::calibration && !demand.braking) {
        const int fault = std::abs(p_.shaft.lag(now)) > 1 ? err::resolution_wrong
                          : course_.touch.encoder != 0    ? err::resolution_wrong + course_.touch.encoder - 1
                                                          : 0;
        if (fault != 0) p_.events.raise(fault);
        p_.trips.status(1, now);
    }
    const bool reached = demand.task == Task::position || demand.task == Task::correction;
    if (demand.braking || !reached) demand.target = p_.shaft.command().end_position();
    course_.settle(now);
}

void Moves::phase_over(Instant now) {
    if (!course_.pass_phase(now)) return;
    jog(now);
    course_.maintain(now);
}

void Moves::limit_met(int way, Instant now) {
    if (!course_.steps() || p_.shaft.commanded(now).velocity * way <= 0) return;
    const std::int64_t mode = p_.settings.whole(Word::LM);
    const bool at_once = mode >= 4;
    const bool homing = homing_.answers_limit();
    if (homing && homing_.turn_back(at_once, now)) return;
    if (course_.demand.braking && !at_once) return;
    p_.events.raise(homing && homing_.reversed() ? err::both_limits : way > 0 ? err::plus_limit : err::minus_limit);
    course_.give_up();
    after_pause_.reset();
    if (at_once) {
        course_.freeze(now);
    } else {
        course_.brake(now);
    }
    if (mode == 3 || mode == 6) p_.events.emit(MotorEvent::Kind::end_program);
}

void Moves::soft_stop(bool ends_program, Instant now) {
    if (paused_) return;
    if (course_.steps()) {
        course_.give_up();
        course_.brake(now);
        p_.events.raise(err::motion_stopped);
    }
    if (ends_program) p_.events.emit(MotorEvent::Kind::end_program, err::program_stopped);
}

void Moves::jog(Instant now) {
    int way = (p_.inputs.active(InputType::jog_plus) ? 1 : 0) - (p_.inputs.active(InputType::jog_minus) ? 1 : 0);
    if (p_.settings[Word::JE] == 0) way = 0;
    if (course_.steps()) {
        if (course_.demand.task != Task::jog) return;
        if (way == 0) {
            if (!course_.demand.braking) course_.brake(now);
            return;
        }
        if (!course_.demand.braking && way == way_of(slew_)) return;
    }
    const double speed = p_.settings[Word::VM];
    if (way == 0 || paused_ || course_.may_move(Word::SL) != 0 || speed < 1 || p_.limits.held(way, now) != 0) return;
    course_.begin(Task::jog, now);
    slew_ = way * speed;
    course_.slew(slew_, now);
}

void Moves::follow(double steps, Instant now) {
    const InputType type = p_.inputs.fitted() < input_count ? InputType::general : p_.inputs.type(2);
    const bool clock = type == InputType::step_direction || type == InputType::encoder_ab || type == InputType::up_down;
    if (p_.settings[Word::FL] == 0 || !clock || !course_.rests() || !p_.power.enabled()) return;
    // The frame stays and the command moves in it, so C1 and C2 count.
    p_.shaft.give(Profile::rest(p_.shaft.command().end_position() + steps));
    p_.cams.judge(now);
}

void Moves::pause(Instant now) {
    forget_pause();
    paused_ = true;
    Course::Demand& demand = course_.demand;
    if (!course_.steps() || demand.braking) return;
    if (demand.task == Task::position) {
        after_pause_ = Word::MA;
        paused_demand_ = demand;
    } else if (demand.task == Task::slew) {
        after_pause_ = Word::SL;
        pause_value_ = static_cast<std::int64_t>(slew_);
    } else if (demand.task == Task::homing) {
        after_pause_ = homing_.word();  // begins anew
        pause_value_ = homing_.type();
        demand.task = Task::slew;
    }
    if (!after_pause_) return;
    demand.aborted = true;
    course_.brake(now);
}

std::optional<int> Moves::resume(Instant now) {
    const auto word = after_pause_;
    forget_pause();
    if (!word) return std::nullopt;
    if (*word == Word::MA) {
        course_.demand.braking = false;  // it may go on before it stands
        const int code = course_.may_move(Word::MA);
        if (code == 0) position(paused_demand_.target, paused_demand_.second, paused_demand_.go_on, now);
        return code;
    }
    const Word last = last_;
    int code = 0;
    if (*word == Word::SL) {
        code = start_slew(pause_value_, now);
    } else {
        if (course_.steps()) course_.freeze(now);
        const Number type = Number::of(pause_value_);
        code = homing_.start(*word, {&type, 1}, now);
    }
    last_ = last;
    return code;
}

void Moves::forget_pause() noexcept {
    paused_ = false;
    after_pause_.reset();
}

void Moves::shift(double by) noexcept { paused_demand_.shift(by); }

}  // namespace axisgate::mcode::twin
