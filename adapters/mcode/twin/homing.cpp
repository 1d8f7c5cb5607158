// Motor: homing by switch (HM), encoder index (HI) and index offset (HF), types 1 to 4 [L3184-3210].
// In: HM, HI, HF, the mark's edges and crossings. Out: legs of motion.
// Never searches for ever in one direction if a limit is there: LM says what a limit does.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {

int Motor::start_homing(Word word, std::span<const Number> f, Instant now) {
    if (f.size() != 1) return err::bad_value;
    const std::int64_t type = f[0].as_integer();
    if (type < 1 || type > 4) return err::bad_type;
    if (word == Word::HM && !inputs_.with_type(InputType::home)) return err::no_home_switch;
    if (const int code = may_move(word, now); code != 0) return code;
    home_ = {};
    home_.word = word;
    home_.type = static_cast<int>(type);
    home_.way = type <= 2 ? -1 : 1;
    home_.creep_way = type == 1 || type == 4 ? 1 : -1;
    const bool here = word == Word::HM ? inputs_.active(InputType::home) : word == Word::HI && index_here(now);
    if (!here && held_limit(home_.way, now) != 0) {
        // A held limit lets a homing begin only where it would turn back anyway.
        const std::int64_t mode = whole(Word::LM);
        if (word != Word::HM || (mode != 1 && mode != 4)) return held_limit(home_.way, now);
        home_.reversed = true;
        home_.way = -home_.way;
    }
    resync(now);
    task_ = Task::homing;
    braking_ = aborted_ = go_on_ = false;
    second_.reset();
    corrections_ = 0;
    if (!here) {
        seek(home_.way, now);
    } else if (word == Word::HM) {
        home_.seen = true;
        home_creep(now);
    } else {
        command(Profile::rest(command_.at(now).position), now);  // on the index already
        home_.stage = Homing::Stage::creep;
    }
    return 0;
}

void Motor::seek(int way, Instant now) {
    home_.way = way;
    home_.stage = Homing::Stage::seek;
    command(Profile::slew(now, command_.at(now), way * setting(Word::VM), kinematics()), now);
    if (home_.word == Word::HM && inputs_.active(InputType::home)) mark(true, now);
}

void Motor::home_creep(Instant now) {
    home_.stage = Homing::Stage::creep;
    command(Profile::slew(now, command_.at(now), home_.creep_way * std::max(1.0, setting(Word::VI)), kinematics()), now);
}

/// The switch changes, or the index passes (`active` only).
void Motor::mark(bool active, Instant now) {
    if (task_ != Task::homing || phase_ != Phase::steps || braking_) return;
    if (home_.stage == Homing::Stage::seek && active) {
        if (home_.way == home_.creep_way) {
            home_.seen = home_.word == Word::HM;
            home_creep(now);
        } else {
            home_.stage = Homing::Stage::turn;
            command(Profile::slew(now, command_.at(now), 0, kinematics()), now);
        }
        return;
    }
    if (home_.stage != Homing::Stage::creep) return;
    const bool slow = std::abs(command_.at(now).velocity) <= setting(Word::VI) * 1.0001;
    if (home_.word != Word::HM) {
        if (slow) homed(now);  // the slew's own index has passed at speed; the next one counts
        return;
    }
    if (active) {
        home_.seen = true;
    } else if (home_.seen) {
        if (slow) {
            homed(now);
        } else {
            brake(now);  // a switch shorter than the ramp
        }
    }
}

void Motor::home_leg_over(Instant now) {
    switch (braking_ ? Homing::Stage::creep : home_.stage) {
        case Homing::Stage::turn:
            home_.seen = home_.word == Word::HM && inputs_.active(InputType::home);
            home_creep(now);
            return;
        case Homing::Stage::back:
            seek(-home_.way, now);
            return;
        default:
            homed(now);
            return;
    }
}

void Motor::homed(Instant now) {
    const double here = std::round(position(now).position);
    // Less than a unit is lost in rounding, in command and rotor alike.
    command_ = Profile::rest(here);
    if (rotor_state_ == Rotor::catching_up) {
        rotor_state_ = Rotor::follows;
        meeting_ = never;
    }
    if (feedback()) slip_ = 0;
    target_ = here;
    braking_ = false;
    phase_ = Phase::settling;
    phase_end_ = now + std::chrono::milliseconds(whole(Word::MT));
}

/// When the rotor stands at the next index (HF: at the offset from it) in its direction.
Instant Motor::mark_crossing(Instant now) const noexcept {
    const double v = command_.at(now + Duration{1}).velocity;
    if (v == 0) return never;
    const double offset = home_.word == Word::HF ? index_offset_ / 51200.0 : 0.0;  // FS = counts * 12.8 [L3003]
    const double t = turns(now) - offset;
    const double next = v * direction() > 0 ? std::floor(t + 1e-7) + 1 : std::ceil(t - 1e-7) - 1;
    return shaft_crossing(next + offset, now);
}

}  // namespace axisgate::mcode::twin
