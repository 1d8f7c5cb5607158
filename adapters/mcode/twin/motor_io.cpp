// Motor: what edges of typed inputs do, what typed outputs show, currents, and the answers to supply and temperature.
// In: edges, figures. Out: events, stops, states of outputs.
// Never reads a pin: twin_io.cpp does.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {

void Motor::edge(const InputEdge& e, Instant now) {
    using Kind = MotorEvent::Kind;
    if (e.active && (te_ & 1) != 0 && ti_input_ == static_cast<int>(e.input) + 1) trip(Word::TI, now, true);
    switch (e.type) {
        case InputType::home:
            if (home_.word == Word::HM) mark(e.active, now);
            break;
        case InputType::limit_plus:
            if (e.active) limit_met(1, now);
            break;
        case InputType::limit_minus:
            if (e.active) limit_met(-1, now);
            break;
        case InputType::go:
            if (e.active) emit({Kind::go, 0, {}});
            break;
        case InputType::soft_stop:
            if (!e.active || paused_) break;  // ignored when the program is paused [L776]
            if (phase_ == Phase::steps) {
                aborted_ = true;
                hmt_.torque_runs = false;
                if (task_ == Task::homing || task_ == Task::torque || task_ == Task::calibration) task_ = Task::slew;
                brake(now);
                raise(err::motion_stopped);
            }
            if (program_running_) emit({Kind::end_program, err::program_stopped, {}});
            break;
        case InputType::pause:
            emit({e.active ? Kind::pause : Kind::resume, 0, {}});
            break;
        case InputType::jog_plus:
        case InputType::jog_minus:
            jog(now);
            break;
        case InputType::reset:
            if (e.active) emit({Kind::reset, 0, {}});
            break;
        case InputType::capture:
            if (e.active && (te_ & 4) != 0) trip(Word::TC, now, true);
            break;
        default:
            break;
    }
}

/// Percent of the full current: RC while moving and settling, then HC; HC = 0, or MT and HT both 0, leaves RC on [L3241, E-24].
int Motor::current(Instant now) const noexcept {
    if (setting(Word::DE) == 0 || bridge_off_ || !supply_.plus_v_good()) return 0;
    const int run = static_cast<int>(hmt_mode() == 3 ? whole(Word::TQ) : whole(Word::RC));
    const bool held = phase_ == Phase::rest && whole(Word::HC) != 0 && whole(Word::MT) + whole(Word::HT) != 0 && hmt_mode() != 3;
    if (held) return static_cast<int>(whole(Word::HC));
    if (hmt_mode() != 2) return run;
    // Variable current: what the load needs, and full for speed changes and make-up.
    if (command_.changing(now) != 0 || rotor_state_ != Rotor::follows) return run;
    return std::min(run, std::max(static_cast<int>(std::lround(load_ * 100)), std::max(1, run / 4)));
}

bool Motor::output(std::size_t n, Instant now) const noexcept {
    const bool moves = phase_ != Phase::rest;
    switch (outputs_.type(n)) {
        case OutputType::general:
            return outputs_.value(n);
        case OutputType::moving:
            return moves;
        case OutputType::error:
            return error_flag_;
        case OutputType::stall:
            return stall_flag_;
        case OutputType::velocity_changing:
            return phase_ == Phase::steps && command_.changing(now) != 0;
        case OutputType::locked_rotor:
            return hmt_.locked;
        case OutputType::to_position:
            return moves && task_ == Task::position && (!go_on_ || passing_ != never);
        case OutputType::hmt_active:
            return hmt_mode() != 0 && (hmt_.at_bounds || rotor_state_ == Rotor::catching_up);
        case OutputType::makeup_active:
            return rotor_state_ == Rotor::catching_up;
        case OutputType::encoder_a:
        case OutputType::encoder_b: {
            const auto phase = static_cast<std::int64_t>(std::floor(c2(now))) & 3;
            return outputs_.type(n) == OutputType::encoder_a ? phase == 1 || phase == 2 : phase >= 2;
        }
        case OutputType::attention: {
            const auto mask = static_cast<std::uint64_t>(setting(Word::AO));
            std::uint64_t on = 0;  // the bits that the damaged table leaves [E-32]
            if (error_flag_) on |= 1;
            if (hmt_.lead_limit) on |= 4;
            if (hmt_.lag_limit) on |= 8;
            if (!moves && current(now) == whole(Word::HC)) on |= 512;
            if (moves) on |= 16384;
            if (stall_flag_) on |= 32768;
            return (mask & on) != 0;
        }
        default:
            return false;  // trip: a pulse of CW*50 ns, over before anybody looks; trip_pulses counts
    }
}

void Motor::bridges_off(Instant now) {
    if (phase_ != Phase::rest) {
        aborted_ = true;
        freeze(now);
    }
}

void Motor::judge_supply(Instant now) {
    // Both out: 78 first and 79 last [E-33]. An unused aux supply is no error.
    const bool aux_bad = supply_.has_aux && !supply_.aux_unused() && !supply_.aux_good();
    if (aux_bad && !supply_.aux_told) raise(err::aux_out);
    supply_.aux_told = aux_bad;
    const bool plus_bad = !supply_.plus_v_good();
    if (plus_bad && !supply_.plus_v_told) {
        raise(err::plus_v_out);
        if ((te_ & 64) != 0 && supply_.plus_v < plus_v_low && supply_.aux_good()) trip(Word::TM, now, true);
        bridges_off(now);
    }
    supply_.plus_v_told = plus_bad;
    const bool is_warm = supply_.hottest() > setting(Word::WT);
    if (is_warm && !supply_.warned) raise(err::warm);
    supply_.warned = is_warm;
    const bool is_hot = supply_.hottest() >= shut_down_temperature;
    if (is_hot && !supply_.over_temperature) {
        raise(err::hot);
        set(Word::DE, 0);
        bridges_off(now);
    }
    supply_.over_temperature = is_hot;
}

}  // namespace axisgate::mcode::twin
