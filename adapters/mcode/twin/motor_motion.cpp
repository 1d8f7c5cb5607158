// Motor: MA, MR, SL, SC, jog, following, pause, and what happens when the steps of a motion are over.
// In: instructions with fields. Out: profiles, MCode error codes.
// Never starts what it cannot finish: every refusal comes before anything changes.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
constexpr std::int64_t position_limit = 2147483647;  // [E-44]
/// An S table of 256 points needs a point of 1 us at least; shorter ramps are errors 98 and 99. The manual gives no figure.
constexpr double shortest_table = 256e-6;

int way_of(double v) noexcept { return v < 0 ? -1 : v > 0 ? 1 : 0; }

}  // namespace

Kinematics Motor::kinematics() const noexcept {
    const auto integer = [&](Word w) { return static_cast<int>(whole(w)); };
    Kinematics k;
    k.vi = std::max(1.0, setting(Word::VI));
    k.vm = std::max(1.0, setting(Word::VM));
    k.up = {integer(Word::AT), integer(Word::AJ), std::max(1.0, setting(Word::A))};
    k.down = {integer(Word::DT), integer(Word::DJ), std::max(1.0, setting(Word::D))};
    return k;
}

double Motor::speed_limit() const noexcept {
    return encoder_mode() ? top_turns_per_second * counts_per_turn() : 10000.0 * setting(Word::MS);
}

int Motor::may_move(Word word, Instant) const {
    const bool stepping = phase_ == Phase::steps;
    const bool homes = word == Word::HM || word == Word::HI || word == Word::HF;
    if (task_ == Task::homing && phase_ != Phase::rest) return err::in_homing;
    if (task_ == Task::calibration && stepping) return err::in_calibration;
    if (homes && stepping) return err::in_homing;  // "HOME not allowed while MOVING"
    if (setting(Word::DE) == 0 || bridge_off_) return err::disabled;
    if (!supply_.plus_v_good()) return err::no_supply;
    if (hmt_mode() == 3) return err::in_homing;  // torque mode has no positions
    if (word != Word::SL) {
        if (stepping && (task_ == Task::correction || corrections_ > 0)) return err::correcting;
        // After SL 0 motion has to come to a stop first [L5404].
        if (stepping && braking_) return err::in_homing;
    }
    const double vi = setting(Word::VI), vm = setting(Word::VM);
    if (vi < 1 || (word != Word::SL && vm <= vi)) return err::too_low;
    if (word != Word::SL && vm > speed_limit()) return err::too_large;
    const Kinematics k = kinematics();
    if (k.up.type != 1 && (vm - vi) / k.up.mean() < shortest_table) return err::illegal_up;
    if (k.down.type != 1 && (vm - vi) / k.down.mean() < shortest_table) return err::illegal_down;
    return 0;
}

int Motor::start(Word word, std::span<const Number> fields, Instant now) {
    advance(now);
    int code = available(word);
    if (code == 0) {
        switch (word) {
            case Word::MA:
            case Word::MR:
                code = start_move(word, fields, now);
                break;
            case Word::SL:
                if (fields.size() != 1) return err::bad_value;
                code = start_slew(fields[0].as_integer(), now);
                break;
            case Word::HM:
            case Word::HI:
            case Word::HF:
                code = start_homing(word, fields, now);
                break;
            case Word::SC:
                code = start_calibration(fields, now);
                break;
            case Word::CF:
                code = clear_locked(now);
                break;
            default:
                code = err::bad_value;
                break;
        }
    }
    replan(now);
    return code;
}

int Motor::start_move(Word word, std::span<const Number> f, Instant now) {
    if (f.empty() || f.size() > 3) return err::bad_value;
    const std::int64_t value = f[0].as_integer();
    if (value > position_limit || value < -position_limit - 1) return err::bad_value;
    for (std::size_t i = 1; i < f.size(); ++i) {
        if (f[i].as_integer() != 0 && f[i].as_integer() != 1) return err::bad_value;
    }
    if (const int code = may_move(word, now); code != 0) return code;
    const bool go_on = f.size() == 3 && f[2].as_integer() == 1;
    if (phase_ != Phase::steps) corrections_ = 0;
    resync(now);
    const double here = std::round(position(now).position);
    double target = static_cast<double>(value) + (word == Word::MR ? here : 0.0);
    const int way = way_of(target - here);
    std::optional<double> second;
    const double backlash = setting(Word::BL);
    if (setting(Word::BE) != 0 && backlash != 0 && way != 0 && !go_on) {
        if (setting(Word::BM) == 0) {
            // Once per reversal, and counted [L1693-1703].
            if (last_way_ != 0 && way != last_way_) target += way * std::abs(backlash);
        } else if (way != way_of(backlash)) {
            second = target;
            target -= backlash;
        }
    }
    if (const int code = way != 0 ? held_limit(way, now) : 0; code != 0) return code;
    if (way != 0) last_way_ = way;
    last_motion_ = word;
    task_ = Task::position;
    braking_ = aborted_ = false;
    second_ = second;
    target_ = target;
    command(Profile::move(now, command_.at(now), target, kinematics(), go_on), now);
    go_on_ = go_on;
    passing_ = go_on ? (target == here ? now : command_.crossing(now, target)) : never;
    return 0;
}

int Motor::start_slew(std::int64_t velocity, Instant now) {
    const double v = static_cast<double>(velocity);
    if (std::abs(v) > (encoder_mode() ? speed_limit() : 5'000'000.0)) return err::bad_value;
    if (const int code = may_move(Word::SL, now); code != 0) return code;
    if (!encoder_mode() && setting(Word::MS) < 256 && std::abs(v) > speed_limit()) return err::too_large;  // [E-67]
    if (velocity != 0 && std::abs(v) < setting(Word::VI)) return err::below_vi;
    if (velocity != 0) {
        if (const int code = held_limit(way_of(v), now); code != 0) return code;
    }
    last_motion_ = Word::SL;
    if (velocity == 0) {
        if (phase_ == Phase::steps) {
            task_ = Task::slew;
            brake(now);
        }
        return 0;
    }
    resync(now);
    task_ = Task::slew;
    braking_ = aborted_ = go_on_ = false;
    second_.reset();
    passing_ = never;
    slew_ = v;
    command(Profile::slew(now, command_.at(now), v, kinematics()), now);
    return 0;
}

/// SC 1: half a turn, by which resolution and direction of the encoder are compared [L5343].
int Motor::start_calibration(std::span<const Number> f, Instant now) {
    if (f.size() != 1 || f[0].as_integer() != 1) return err::bad_value;
    if (phase_ == Phase::steps) return err::calibration_moving;
    if (setting(Word::DE) == 0 || bridge_off_) return err::calibration_disabled;
    if (!supply_.plus_v_good()) return err::no_supply;
    resync(now);
    task_ = Task::calibration;
    braking_ = aborted_ = go_on_ = false;
    command(Profile::move(now, command_.at(now), command_.at(now).position + std::round(units_per_turn() / 2), kinematics(), false), now);
    return 0;
}

/// A new profile of the command; the rotor follows it as it did before.
void Motor::command(Profile p, Instant now) {
    command_ = std::move(p);
    phase_ = Phase::steps;
    phase_end_ = never;
    const int way = way_of(command_.at(now + Duration{1}).velocity);
    if (way != 0) way_ = way;
    if (std::abs(lag(now)) < setting(Word::SF)) stall_told_ = false;
    judge_rotor(now);
    if (rotor_state_ == Rotor::catching_up) make_up(now);
}

void Motor::brake(Instant now) {
    if (phase_ != Phase::steps) return;
    passing_ = never;
    go_on_ = false;
    second_.reset();
    command(Profile::slew(now, command_.at(now), 0, kinematics()), now);
    braking_ = true;
}

/// Stands at once, without a ramp.
void Motor::freeze(Instant now) {
    if (task_ == Task::calibration && phase_ == Phase::steps) raise(err::calibration_lost);
    const double here = std::round(position(now).position);
    const bool slipped = !feedback() && (rotor_state_ == Rotor::held || slip_ != 0);
    if (phase_ == Phase::steps || feedback()) {
        if (slipped) {
            command_ = Profile::rest(here);
        } else if (feedback() && (rotor_state_ == Rotor::held || slip_ != 0)) {
            stand_at(here, now);
        } else {
            // Less than a step is lost in rounding, in both alike.
            command_ = Profile::rest(here);
            slip_ = 0;
            rotor_state_ = Rotor::follows;
        }
    }
    passing_ = meeting_ = phase_end_ = never;
    go_on_ = braking_ = false;
    second_.reset();
    phase_ = Phase::rest;
    task_ = Task::none;
    corrections_ = 0;
    hmt_.torque_runs = false;
    hmt_.lock_due = never;
    hmt_.at_bounds = hmt_.lag_limit = hmt_.lead_limit = false;
    judge_cams(now);
}

void Motor::steps_over(Instant now) {
    judge_cams(now);
    way_ = command_way(now);
    if (task_ == Task::homing) {
        home_leg_over(now);
        return;
    }
    if (second_ && !braking_) {
        target_ = *second_;
        second_.reset();
        command(Profile::move(now, command_.at(now), target_, kinematics(), false), now);
        return;
    }
    if (task_ == Task::calibration && !braking_) {
        const int fault = std::abs(lag(now)) > 1 ? err::resolution_wrong
                          : encoder_fault_ != 0  ? err::resolution_wrong + encoder_fault_ - 1
                                                 : 0;
        if (fault != 0) raise(fault);
        status_trip(1, now);
    }
    if (braking_ || task_ != Task::correction) target_ = task_ == Task::position && !braking_ ? target_ : command_.end_position();
    braking_ = false;
    phase_ = Phase::settling;
    phase_end_ = now + std::chrono::milliseconds(whole(Word::MT));
}

void Motor::finish(Instant now) {
    const bool told = !aborted_ && (task_ == Task::position || task_ == Task::slew || task_ == Task::homing);
    phase_ = Phase::rest;
    phase_end_ = never;
    task_ = Task::none;
    corrections_ = 0;
    if (told) emit({MotorEvent::Kind::finished, 0, {}});
    jog(now);
    maintain(now);
}

/// JE = 1: an active jog input runs the motor at VM, and its release stops it [L778, L3694-3697].
void Motor::jog(Instant now) {
    int way = (inputs_.active(InputType::jog_plus) ? 1 : 0) - (inputs_.active(InputType::jog_minus) ? 1 : 0);
    if (setting(Word::JE) == 0) way = 0;
    if (phase_ == Phase::steps) {
        if (task_ != Task::jog) return;
        if (way == 0) {
            if (!braking_) brake(now);
            return;
        }
        if (!braking_ && way == way_of(slew_)) return;
    }
    if (way == 0 || paused_ || may_move(Word::SL, now) != 0 || setting(Word::VM) < 1 || held_limit(way, now) != 0) return;
    resync(now);
    task_ = Task::jog;
    braking_ = aborted_ = go_on_ = false;
    slew_ = way * setting(Word::VM);
    command(Profile::slew(now, command_.at(now), slew_, kinematics()), now);
}

/// FL = 1: pulses at inputs 3 and 4 move the axis one to one, at the moment at which they come [L2912].
void Motor::follow(double steps, Instant now) {
    const InputType type = inputs_.fitted() < input_count ? InputType::general : inputs_.type(2);
    const bool clock = type == InputType::step_direction || type == InputType::encoder_ab || type == InputType::up_down;
    if (setting(Word::FL) == 0 || !clock || phase_ != Phase::rest || setting(Word::DE) == 0 || bridge_off_) return;
    // The frame stays and the command moves in it, so C1 and C2 count.
    command_ = Profile::rest(command_.end_position() + steps);
    judge_cams(now);
}

void Motor::pause(Instant now) {
    advance(now);
    paused_ = true;
    after_pause_.reset();
    if (phase_ == Phase::steps && !braking_) {
        if (task_ == Task::position) {
            after_pause_ = Word::MA;
            pause_value_ = target_;
            pause_go_on_ = go_on_;
            pause_second_ = second_;
        } else if (task_ == Task::slew) {
            after_pause_ = Word::SL;
            pause_value_ = slew_;
        } else if (task_ == Task::homing) {
            after_pause_ = home_.word;  // begins anew
            pause_value_ = home_.type;
            task_ = Task::slew;
        }
        if (after_pause_) {
            aborted_ = true;
            brake(now);
        }
    }
    replan(now);
}

void Motor::resume(Instant now) {
    advance(now);
    paused_ = false;
    const auto word = after_pause_;
    after_pause_.reset();
    if (!word) return;
    const Word last = last_motion_;
    int code = 0;
    if (*word == Word::MA) {
        braking_ = false;  // it may go on before it stands
        code = may_move(Word::MA, now);
        if (code == 0) {
            resync(now);
            task_ = Task::position;
            aborted_ = false;
            target_ = pause_value_;
            second_ = pause_second_;
            command(Profile::move(now, command_.at(now), target_, kinematics(), pause_go_on_), now);
            go_on_ = pause_go_on_;
            passing_ = go_on_ ? command_.crossing(now, target_) : never;
        }
    } else if (*word == Word::SL) {
        code = start_slew(static_cast<std::int64_t>(pause_value_), now);
    } else {
        if (phase_ == Phase::steps) freeze(now);
        const Number type = Number::of(static_cast<std::int64_t>(pause_value_));
        code = start_homing(*word, {&type, 1}, now);
    }
    last_motion_ = last;
    if (code != 0) raise(code);
    replan(now);
}

}  // namespace axisgate::mcode::twin
