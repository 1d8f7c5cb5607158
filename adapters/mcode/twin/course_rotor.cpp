// Course: the held shaft, make-up at rest, torque mode, and the current that the motor has.
// In: the hand's hold and load, AS, TS, TD, TQ, RC, HC. Out: rotor states, locked rotor.
// Never turns a rotor that is held.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/course.hpp"
#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {

/// Torque mode moves at TS in direction TD as soon as it is set [L1468]; a blocked rotor stands and the lock timer runs.
void Course::run_torque(Instant now) {
    const double speed = p_.settings[Word::TS];
    if (!p_.loop.torque_runs() || !p_.power.good() || speed <= 0) {
        if (steps(Task::torque)) brake(now);
        return;
    }
    demand.task = Task::torque;
    demand.braking = demand.aborted = false;
    step_on();
    if (p_.shaft.state() == Shaft::Rotor::held) {
        stand_at(p_.shaft.rotor(now).position, now);
        p_.loop.resist(now);
        return;
    }
    p_.loop.turns();
    const int way = p_.settings[Word::TD] != 0 ? 1 : -1;
    p_.shaft.give(Profile::slew(now, p_.shaft.commanded(now), way * speed, p_.settings.kinematics()));
    p_.shaft.set_way(way);
}

/// Does the shaft turn? A hold by the hand stops it, and so does a load above the current that the motor has.
void Course::judge_rotor(Instant now) {
    const int mode = p_.settings.hmt_mode();
    const double torque = p_.settings[mode == 3 ? Word::TQ : Word::RC];
    const bool blocked = touch.held || out_of_step_ || (steps() && touch.load * 100 > torque);
    if (blocked == (p_.shaft.state() == Shaft::Rotor::held)) return;
    if (blocked) {
        p_.loop.disturbed(now);
        p_.shaft.hold_at(p_.shaft.rotor(now).position);
        stall_reported_ = false;
        if (mode == 3 && p_.loop.torque_runs()) run_torque(now);
        return;
    }
    switch (mode) {
        case 0:
            p_.shaft.let_go(now);  // an open-loop stepper has lost these steps
            maintain(now);
            return;
        case 3:
            stand_at(p_.shaft.rotor(now).position, now);
            p_.shaft.join();
            run_torque(now);
            return;
        default:
            make_up(now);
            p_.loop.judge_lag(now);
            return;
    }
}

void Course::make_up(Instant now) {
    if (!p_.loop.make_up(now) || steps()) return;
    // The shaft was turned at rest: the drive moves without a command.
    if (rests()) demand.task = Task::correction;
    step_on();
}

void Course::turn_to(double position, Instant now) {
    const bool held = p_.shaft.state() == Shaft::Rotor::held;
    p_.shaft.turn_to(position, now);
    if (p_.real.differs()) {
        p_.real.set(p_.shaft.turns(now), now);
        p_.shaft.stray = 0;
    }
    if (!held) {
        if (p_.settings.makes_up()) {
            if (!p_.power.enabled()) {
                resync(now);
            } else if (std::abs(p_.shaft.commanded(now).position - position) > 1e-9) {
                p_.loop.judge_lag(now);
                p_.shaft.hold_at(position);  // where make-up takes it from
                make_up(now);
            }
        }
        maintain(now);
    }
    p_.cams.judge(now);
}

/// LR: with AS = 1 or 2 the bridges go off and what was owed is gone, with AS = 3 the torque stays on [L3983-3989, E-27].
void Course::locked(Instant now) {
    p_.loop.lock(now);
    if (p_.settings.hmt_mode() == 3) return;
    p_.power.off = true;
    abort(now);
}

/// CF.
void Course::unlock(Instant now) {
    p_.loop.unlock();
    p_.power.off = !p_.power.enable_input;
    if (p_.settings.hmt_mode() == 3) run_torque(now);
}

/// RC while moving and settling, then HC; HC = 0, or MT and HT both 0, leaves RC on [L3241, E-24].
int Course::current(Instant now) const noexcept {
    const Settings& s = p_.settings;
    if (!p_.power.good()) return 0;
    const int run = static_cast<int>(s.whole(s.hmt_mode() == 3 ? Word::TQ : Word::RC));
    const bool held = rests() && s.whole(Word::HC) != 0 && s.whole(Word::MT) + s.whole(Word::HT) != 0 && s.hmt_mode() != 3;
    if (held) return static_cast<int>(s.whole(Word::HC));
    if (s.hmt_mode() != 2) return run;
    // Variable current: what the load needs, and full for speed changes and make-up.
    if (p_.shaft.command().changing(now) != 0 || p_.shaft.state() != Shaft::Rotor::follows) return run;
    return std::min(run, std::max(static_cast<int>(std::lround(touch.load * 100)), std::max(1, run / 4)));
}

}  // namespace axisgate::mcode::twin
