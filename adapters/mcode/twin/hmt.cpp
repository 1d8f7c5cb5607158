// Motor: hMT (AS = 1, 2, 3), the held shaft, make-up and locked rotor [L7482-7590].
// In: the command, the hand's hold and load, MU, MF, CB, LT, LG, LD. Out: rotor states, codes 87, 104 to 110, conditions of TA.
// Never loses a step with AS = 1 or 2: what the rotor owes stays in LL until it is made up, or the bridges go off.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
constexpr int ta_active = 2, ta_locked = 4, ta_lag = 8, ta_lead = 16;
/// Make-up is planned at most this far ahead; a rotor that cannot catch up is planned anew with the next command.
constexpr double horizon_s = 1e6;

}  // namespace

int Motor::set_hmt_mode(std::int64_t mode, Instant now) {
    if (mode == hmt_mode() && mode != 3) return 0;
    if (phase_ != Phase::rest) return err::in_motion;
    if (mode != 0 && setting(Word::MS) < 10) return err::bad_value;  // [L1480]
    if (mode == 3 && !supply_.plus_v_good()) return err::no_supply;
    const Kept k = keep(now);
    // P goes on from its number; the rotor is taken as it stands.
    const double p = std::round(position(now).position);
    const bool counted = encoder_mode();
    set(Word::AS, static_cast<double>(mode));
    if (encoder_mode() != counted) {
        change_units(k, now);
    } else {
        command_ = Profile::rest(p);
        slip_ = 0;
        held_at_ = p;
        put_back(k, now);
    }
    hmt_.at_bounds = hmt_.lag_limit = hmt_.lead_limit = false;
    hmt_.torque_runs = mode == 3;
    if (mode == 3) run_torque(now);
    return 0;
}

/// Torque mode moves at TS in direction TD as soon as it is set [L1468]; a blocked rotor stands and the lock timer runs.
void Motor::run_torque(Instant now) {
    const double speed = setting(Word::TS);
    const bool may = hmt_.torque_runs && setting(Word::DE) != 0 && !bridge_off_ && supply_.plus_v_good() && speed > 0;
    if (!may) {
        if (phase_ == Phase::steps && task_ == Task::torque) brake(now);
        return;
    }
    task_ = Task::torque;
    braking_ = aborted_ = false;
    if (rotor_state_ == Rotor::held) {
        stand_at(held_at_, now);
        phase_ = Phase::steps;
        phase_end_ = never;
        if (hmt_.lock_due == never && !hmt_.locked) hmt_.lock_due = now + std::chrono::milliseconds(whole(Word::LT));
        hmt_.at_bounds = true;
        return;
    }
    hmt_.at_bounds = false;
    hmt_.lock_due = never;
    command_ = Profile::slew(now, command_.at(now), (setting(Word::TD) != 0 ? 1 : -1) * speed, kinematics());
    way_ = setting(Word::TD) != 0 ? 1 : -1;
    phase_ = Phase::steps;
    phase_end_ = never;
}

/// Does the shaft turn? A hold by the hand stops it, and so does a load above the current that the motor has.
void Motor::judge_rotor(Instant now) {
    const double torque = hmt_mode() == 3 ? setting(Word::TQ) : setting(Word::RC);
    const bool blocked = held_ || (phase_ == Phase::steps && load_ * 100 > torque);
    if (blocked == (rotor_state_ == Rotor::held)) return;
    if (blocked) {
        held_at_ = rotor(now).position;
        hmt_.while_braking = command_.changing(now) < 0;
        rotor_state_ = Rotor::held;
        meeting_ = never;
        stall_told_ = false;
        if (hmt_mode() == 3 && hmt_.torque_runs) run_torque(now);
        return;
    }
    switch (hmt_mode()) {
        case 0:
            slip_ = command_.at(now).position - held_at_;
            if (std::abs(slip_) < 1e-9) slip_ = 0;
            rotor_state_ = Rotor::follows;
            if (!encoder_mode()) return;  // an open-loop stepper has lost these steps
            maintain(now);
            return;
        case 3:
            stand_at(held_at_, now);
            rotor_state_ = Rotor::follows;
            slip_ = 0;
            run_torque(now);
            return;
        default:
            make_up(now);
            judge_lag(now);
            return;
    }
}

/// The rotor runs after the command at the speed that MU gives, until both meet [L7556-7578].
void Motor::make_up(Instant now) {
    const Travel from = rotor(now);
    const double owed = command_.at(now).position - from.position;
    hmt_.lock_due = never;
    hmt_.at_bounds = false;
    if (std::abs(owed) < 1e-9) {
        rotor_state_ = Rotor::follows;
        slip_ = 0;
        meeting_ = never;
        return;
    }
    const int way = owed < 0 ? -1 : 1;
    const double start_speed = from.velocity * way > 0 ? from.velocity : 0.0;
    rotor_state_ = Rotor::catching_up;
    if (phase_ != Phase::steps) {
        // The shaft was turned at rest: the drive moves without a command.
        if (phase_ == Phase::rest) task_ = Task::correction;
        phase_ = Phase::steps;
        phase_end_ = never;
    }
    if (whole(Word::MU) == 0 && command_.end() != never) {
        // Without regard to time: the rotor makes the rest of the move as a move of its own, or creeps if it was held in the deceleration.
        const double target = command_.end_position();
        catch_up_ = hmt_.while_braking ? Profile::creep(now, from.position, target, std::max(1.0, setting(Word::VI)))
                                       : Profile::move(now, {from.position, start_speed}, target, kinematics(), false);
        meeting_ = catch_up_.end();
        return;
    }
    const double scale = steps_per_turn() / 51200;
    const double run = std::max(setting(Word::VM), std::abs(command_.at(now).velocity));
    const bool at_rest = command_.end() <= now;
    double speed = run;
    if (whole(Word::MU) == 1) speed = at_rest ? setting(Word::MF) : std::max(2 * run, setting(Word::MF));
    if (whole(Word::MU) == 2) speed = top_turns_per_second * steps_per_turn();
    speed = std::clamp(speed, 1.0, top_turns_per_second * steps_per_turn());
    Kinematics k;
    k.vi = std::min(makeup_start * scale, speed);
    k.vm = speed;
    k.up.rate = k.down.rate = makeup_acceleration * scale;
    catch_up_ = Profile::slew(now, {from.position, start_speed}, way * speed, k);
    // Where both meet: the distance falls steadily once the rotor is the faster one.
    const auto open = [&](double s) {
        const Instant t = now + Duration{static_cast<std::int64_t>(s * 1e9)};
        return (command_.at(t).position - catch_up_.at(t).position) * way > 0;
    };
    double low = 0, high = 1e-6;
    while (open(high) && high < horizon_s) {
        low = high;
        high *= 2;
    }
    if (high >= horizon_s) {
        meeting_ = never;
    } else {
        for (int n = 0; n < 60 && high - low > 5e-10; ++n) {
            const double middle = (low + high) / 2;
            (open(middle) ? low : high) = middle;
        }
        meeting_ = now + Duration{static_cast<std::int64_t>(std::ceil(high * 1e9))};
    }
}

void Motor::caught_up(Instant) {
    rotor_state_ = Rotor::follows;
    slip_ = 0;
    meeting_ = never;
    hmt_.while_braking = hmt_.lag_limit = hmt_.lead_limit = hmt_.at_bounds = false;
}

/// The command may be over long before the motion is: the rotor owes steps, or stands against its torque.
bool Motor::waits_for_rotor() const noexcept {
    if (hmt_mode() == 3) return hmt_.torque_runs && rotor_state_ == Rotor::held;
    return hmt_mode() != 0 && rotor_state_ != Rotor::follows;
}

double Motor::bound() const noexcept {
    constexpr std::array full_steps{1.1, 1.3, 1.5, 1.7};
    const std::size_t n = hmt_mode() == 3 ? 0 : static_cast<std::size_t>(std::clamp<std::int64_t>(whole(Word::CB), 0, 3));
    return full_steps[n] * setting(Word::MS);
}

void Motor::judge_lag(Instant now) {
    if (hmt_mode() != 1 && hmt_mode() != 2) return;
    const double owed = this->owed(now);
    constexpr double slack = 1e-6;
    const bool at_bounds = rotor_state_ == Rotor::held && std::abs(owed) >= bound() - slack;
    if (at_bounds && !hmt_.at_bounds) {
        hmt_.lock_due = now + std::chrono::milliseconds(whole(Word::LT));
        status_trip(ta_active, now);
    }
    hmt_.at_bounds = at_bounds;
    const bool behind = owed >= setting(Word::LG) - slack;
    if (behind && !hmt_.lag_limit) {
        raise(err::lag_reached);
        status_trip(ta_lag, now);
    }
    hmt_.lag_limit = behind;
    const bool ahead = owed <= -setting(Word::LD) + slack;
    if (ahead && !hmt_.lead_limit) {
        raise(err::lead_reached);
        status_trip(ta_lead, now);
    }
    hmt_.lead_limit = ahead;
}

/// LR: with AS = 1 or 2 the bridges go off and what was owed is gone, with AS = 3 the torque stays on [L3983-3989, E-27].
void Motor::locked(Instant now) {
    hmt_.lock_due = never;
    hmt_.locked = true;
    raise(err::locked_rotor);
    status_trip(ta_locked, now);
    if (hmt_mode() == 3) return;
    bridge_off_ = true;
    aborted_ = true;
    freeze(now);
}

int Motor::clear_locked(Instant now) {
    hmt_.locked = false;
    bridge_off_ = !enable_input_;
    if (hmt_mode() == 3) run_torque(now);
    return 0;
}

int Motor::status(Instant now) const noexcept {
    int s = 128;  // initialised, as after each reset [L1339]
    if (hmt_.lead_limit) s |= 1;
    if (hmt_.lag_limit) s |= 2;
    if (hmt_.at_bounds) s |= 4;
    if (hmt_.locked) s |= 8;
    if (hmt_mode() != 0) s |= 16;
    if (supply_.over_temperature || !supply_.plus_v_good()) s |= 32;
    if (hmt_mode() != 0 && std::abs(lag(now)) < 0.5) s |= 64;
    return s;
}

void Motor::status_trip(int bit, Instant now) {
    if ((te_ & 32) != 0 && (ta_mask_ & bit) != 0) trip(Word::TA, now, true);
}

}  // namespace axisgate::mcode::twin
