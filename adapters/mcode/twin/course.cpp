// Course: how a motion goes on and ends, and what the rotor makes of it.
// In: profiles, the hand, EE, SF, SM, DB, PM, MT, HT, AS. Out: phases, codes 86 and 92.
// Never starts what the bridges cannot do: may_move is asked before anything changes.
#include "adapters/mcode/twin/course.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
/// An S table of 256 points needs a point of 1 us at least; shorter ramps are errors 98 and 99. The manual gives no figure.
constexpr double shortest_table = 256e-6;
/// Attempts to come into the dead band; then error 92. The manual gives no figure.
constexpr int correction_limit = 3;

}  // namespace

void Course::restart(Instant now) noexcept {
    demand = {};
    phase_ = Phase::rest;
    phase_end_ = never;
    corrections_ = 0;
    out_of_step_ = false;
    clear_stall();
    p_.shaft.restart(touch.held, now);
}

bool Course::to_position() const noexcept {
    return !rests() && demand.task == Task::position && (!demand.go_on || demand.passing != never);
}

int Course::may_move(Word word) const {
    const Settings& s = p_.settings;
    const bool homes = word == Word::HM || word == Word::HI || word == Word::HF;
    if (demand.task == Task::homing && !rests()) return err::in_homing;
    if (steps(Task::calibration)) return err::in_calibration;
    if (homes && steps()) return err::in_homing;  // "HOME not allowed while MOVING"
    if (!p_.power.enabled()) return err::disabled;
    if (!p_.power.good()) return err::no_supply;
    if (s.hmt_mode() == 3) return err::in_homing;  // torque mode has no positions
    if (word != Word::SL) {
        if (steps() && (demand.task == Task::correction || corrections_ > 0)) return err::correcting;
        // After SL 0 motion has to come to a stop first [L5404].
        if (steps() && demand.braking) return err::in_homing;
    }
    const double vi = s[Word::VI], vm = s[Word::VM];
    if (vi < 1 || (word != Word::SL && vm <= vi)) return err::too_low;
    if (word != Word::SL && vm > s.speed_limit()) return err::too_large;
    const Kinematics k = s.kinematics();
    if (k.up.type != 1 && (vm - vi) / k.up.mean() < shortest_table) return err::illegal_up;
    if (k.down.type != 1 && (vm - vi) / k.down.mean() < shortest_table) return err::illegal_down;
    return 0;
}

void Course::step_on() noexcept {
    phase_ = Phase::steps;
    phase_end_ = never;
}

void Course::begin(Task task, Instant now) noexcept {
    resync(now);
    demand.task = task;
    demand.braking = demand.aborted = demand.go_on = false;
    demand.second.reset();
    demand.passing = never;
}

void Course::command(Profile p, Instant now) {
    p_.shaft.give(std::move(p));
    step_on();
    const double v = p_.shaft.commanded(now + Duration{1}).velocity;
    if (v != 0) p_.shaft.set_way(v < 0 ? -1 : 1);
    if (std::abs(p_.shaft.lag(now)) < p_.settings[Word::SF]) stall_reported_ = false;
    judge_rotor(now);
    if (p_.shaft.state() == Shaft::Rotor::catching_up) make_up(now);
}

void Course::slew(double velocity, Instant now) {
    command(Profile::slew(now, p_.shaft.commanded(now), velocity, p_.settings.kinematics()), now);
}

void Course::move(double target, bool go_on, Instant now) {
    command(Profile::move(now, p_.shaft.commanded(now), target, p_.settings.kinematics(), go_on), now);
}

void Course::brake(Instant now) {
    if (!steps()) return;
    demand.passing = never;
    demand.go_on = false;
    demand.second.reset();
    slew(0, now);
    demand.braking = true;
}

void Course::freeze(Instant now) {
    if (steps(Task::calibration)) p_.events.raise(err::calibration_lost);
    if (steps() || p_.settings.feedback()) p_.shaft.freeze(now);
    const bool aborted = demand.aborted;
    const double target = demand.target;
    demand = {};
    demand.aborted = aborted;
    demand.target = target;
    phase_ = Phase::rest;
    phase_end_ = never;
    corrections_ = 0;
    in_step(now);
    p_.loop.stop();
    p_.cams.judge(now);
}

void Course::abort(Instant now) {
    demand.aborted = true;
    freeze(now);
}

void Course::give_up() noexcept {
    demand.aborted = true;
    if (demand.task == Task::homing || demand.task == Task::calibration || demand.task == Task::torque) demand.task = Task::slew;
    p_.loop.set_torque(false);
}

void Course::stand_at(double position, Instant now) noexcept {
    p_.shaft.stand_at(position, now);
    demand.passing = never;
    demand.go_on = false;
}

void Course::resync(Instant now) noexcept {
    if (!p_.settings.feedback() || steps()) return;
    if (std::abs(p_.shaft.lag(now)) > 1e-9) stand_at(std::round(p_.shaft.rotor(now).position), now);
}

void Course::settle(Instant now) noexcept {
    demand.braking = false;
    in_step(now);
    phase_ = Phase::settling;
    phase_end_ = now + std::chrono::milliseconds(p_.settings.whole(Word::MT));
}

bool Course::pass_phase(Instant now) {
    phase_end_ = never;
    if (phase_ == Phase::settling) {
        const bool checked = p_.settings.encoder_mode() && (demand.task == Task::position || demand.task == Task::correction);
        if (checked && std::abs(demand.target - p_.shaft.measured(now).position) > p_.settings[Word::DB]) {
            if (corrections_ < correction_limit) {
                ++corrections_;
                correct(now);
                return false;
            }
            p_.events.raise(err::position_error);
            demand.aborted = true;
        }
        if (demand.task != Task::correction) {
            phase_ = Phase::holding;
            phase_end_ = now + std::chrono::milliseconds(p_.settings.whole(Word::HT));
            return false;
        }
    } else if (phase_ != Phase::holding) {
        return false;
    }
    const bool reported = !demand.aborted && (demand.task == Task::position || demand.task == Task::slew || demand.task == Task::homing);
    phase_ = Phase::rest;
    demand.task = Task::none;
    corrections_ = 0;
    if (reported) p_.events.emit(MotorEvent::Kind::finished);
    return true;
}

/// Nothing more is given, or with SM = 1 the move goes on; ST stays until ST = 0 [L7354, L5432].
void Course::stalled(Instant now) {
    stall_reported_ = true;
    stall_flag_ = true;
    p_.events.raise(err::stall_detected);
    if (p_.settings[Word::SM] == 0) abort(now);
}

Course::Watched Course::watched() const noexcept {
    return {steps() && p_.settings.encoder_mode() && !stall_reported_ && p_.shaft.state() != Shaft::Rotor::held,
            steps() && p_.settings.hmt_mode() == 0 && !out_of_step_};
}

bool stalls(const Parts& p, Instant now, double stray) noexcept {
    const double shown = p.shaft.rotor(now).position + p.settings.direction() * stray * p.settings.units_per_turn();
    return std::abs(p.shaft.commanded(now).position - shown) > p.settings[Word::SF];
}

bool Course::notice(Instant now) {
    if (watched().rotor && stalls(p_, now, p_.shaft.stray)) {
        stalled(now);
        return true;
    }
    if (!watched().step || !p_.real.out_of_step()) return false;
    // It stands until the motion is over; without an encoder nobody notices.
    out_of_step_ = true;
    judge_rotor(now);
    p_.real.set(p_.shaft.turns(now), now);
    p_.shaft.stray = 0;
    return true;
}

/// The rotor finds a field that stands.
void Course::in_step(Instant now) {
    if (!std::exchange(out_of_step_, false)) return;
    judge_rotor(now);
}

/// One attempt, at VI, to bring the rotor to where the move should have ended.
void Course::correct(Instant now) {
    const double missing = demand.target - p_.shaft.measured(now).position;
    stand_at(p_.shaft.rotor(now).position, now);
    const double from = p_.shaft.command().end_position();
    p_.shaft.give(Profile::creep(now, from, from + missing, p_.settings.creep_speed()));
    step_on();
    stall_reported_ = p_.settings[Word::SM] != 0;
}

/// PM = 1: a shaft that is pushed out of the dead band at rest is brought back; with SM = 0 only from within SF [L4835-4837].
void Course::maintain(Instant now) {
    const Settings& s = p_.settings;
    if (!s.encoder_mode() || s[Word::PM] == 0 || !rests() || p_.shaft.state() != Shaft::Rotor::follows || !p_.power.good()) return;
    const double off = std::abs(p_.shaft.lag(now));
    if (off <= s[Word::DB] || (s[Word::SM] == 0 && off > s[Word::SF])) return;
    demand.target = p_.shaft.command().end_position();
    demand.task = Task::correction;
    corrections_ = 0;
    demand.aborted = false;
    correct(now);
}

Instant Course::steps_end() const noexcept { return steps() && !p_.loop.waits_for_rotor() ? p_.shaft.command().end() : never; }

Instant Course::stall_due(Instant now) const noexcept {
    return p_.settings.encoder_mode() && !stall_reported_ ? p_.shaft.lag_crossing(p_.settings[Word::SF], now) : never;
}

}  // namespace axisgate::mcode::twin
