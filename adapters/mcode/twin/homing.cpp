// Homing: its legs, the mark and the limits.
// In: types, edges of the home switch, crossings of the index. Out: slews, and where it is home.
// Never ends at speed: what passes in the seek is come back to at VI.
#include "adapters/mcode/twin/homing.hpp"

#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {

int Homing::start(Word word, std::span<const Number> f, Instant now) {
    if (f.size() != 1) return err::bad_value;
    const std::int64_t type = f[0].as_integer();
    if (type < 1 || type > 4) return err::bad_type;
    if (word == Word::HM && !p_.inputs.with_type(InputType::home)) return err::no_home_switch;
    if (const int code = course_.may_move(word); code != 0) return code;
    is_ = {};
    is_.word = word;
    is_.type = static_cast<int>(type);
    is_.way = type <= 2 ? -1 : 1;
    is_.creep_way = type == 1 || type == 4 ? 1 : -1;
    const bool here = word == Word::HM ? p_.inputs.active(InputType::home) : word == Word::HI && p_.shaft.index_here(now);
    if (const int held = p_.limits.held(is_.way, now); !here && held != 0) {
        // A held limit lets a homing begin only where it would turn back anyway.
        const std::int64_t mode = p_.settings.whole(Word::LM);
        if (word != Word::HM || (mode != 1 && mode != 4)) return held;
        is_.reversed = true;
        is_.way = -is_.way;
    }
    course_.begin(Course::Task::homing, now);
    course_.forget_corrections();
    if (!here) {
        seek(is_.way, now);
    } else if (word == Word::HM) {
        is_.seen = true;
        creep(now);
    } else {
        course_.command(Profile::rest(p_.shaft.commanded(now).position), now);  // on the index already
        is_.stage = Stage::creep;
    }
    return 0;
}

void Homing::seek(int way, Instant now) {
    is_.way = way;
    is_.stage = Stage::seek;
    course_.slew(way * p_.settings[Word::VM], now);
    if (is_.word == Word::HM && p_.inputs.active(InputType::home)) mark(true, now);
}

void Homing::creep(Instant now) {
    is_.stage = Stage::creep;
    course_.slew(is_.creep_way * p_.settings.creep_speed(), now);
}

void Homing::switched(bool active, Instant now) {
    if (is_.word == Word::HM) mark(active, now);
}

void Homing::mark(bool active, Instant now) {
    if (!course_.steps(Course::Task::homing) || course_.demand.braking) return;
    if (is_.stage == Stage::seek && active) {
        if (is_.way == is_.creep_way) {
            is_.seen = is_.word == Word::HM;
            creep(now);
        } else {
            is_.stage = Stage::turn;
            course_.slew(0, now);
        }
        return;
    }
    if (is_.stage != Stage::creep) return;
    const bool slow = std::abs(p_.shaft.commanded(now).velocity) <= p_.settings[Word::VI] * 1.0001;
    if (is_.word != Word::HM) {
        if (slow) homed(now);  // the slew's own index has passed at speed; the next one counts
        return;
    }
    if (active) {
        is_.seen = true;
    } else if (is_.seen) {
        if (slow) {
            homed(now);
        } else {
            course_.brake(now);  // a switch shorter than the ramp
        }
    }
}

void Homing::leg_over(Instant now) {
    switch (course_.demand.braking ? Stage::creep : is_.stage) {
        case Stage::turn:
            is_.seen = is_.word == Word::HM && p_.inputs.active(InputType::home);
            creep(now);
            return;
        case Stage::back:
            seek(-is_.way, now);
            return;
        default:
            homed(now);
            return;
    }
}

void Homing::homed(Instant now) {
    const double here = std::round(p_.shaft.position(now).position);
    p_.shaft.settle_at(here);
    course_.demand.target = here;
    course_.settle(now);
}

Instant Homing::index_due(Instant now) const noexcept {
    if (!course_.steps(Course::Task::homing) || is_.word == Word::HM) return never;
    const double v = p_.shaft.commanded(now + Duration{1}).velocity;
    if (v == 0) return never;
    const double offset = is_.word == Word::HF ? p_.settings[Word::FS] / 51200.0 : 0.0;  // FS = counts * 12.8 [L3003]
    const double t = p_.shaft.turns(now) - offset;
    const double next = v * p_.settings.direction() > 0 ? std::floor(t + 1e-7) + 1 : std::ceil(t - 1e-7) - 1;
    return p_.shaft.turns_crossing(next + offset, now);
}

bool Homing::answers_limit() const noexcept {
    const std::int64_t mode = p_.settings.whole(Word::LM);
    return course_.demand.task == Course::Task::homing && is_.word == Word::HM && (mode == 1 || mode == 4) && !course_.demand.braking;
}

bool Homing::turn_back(bool at_once, Instant now) {
    if (is_.stage == Stage::back) return true;  // the same limit again, while braking at it
    if (is_.stage != Stage::seek || is_.reversed) return false;
    is_.reversed = true;
    if (at_once) {
        p_.shaft.give(Profile::rest(std::round(p_.shaft.commanded(now).position)));
        seek(-is_.way, now);
    } else {
        is_.stage = Stage::back;
        course_.slew(0, now);
    }
    return true;
}

}  // namespace axisgate::mcode::twin
