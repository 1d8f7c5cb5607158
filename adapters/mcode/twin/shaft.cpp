// Shaft: where command and rotor are, and when they reach a place.
// In: instants. Out: places in the unit of P, turns, counts.
// Never ticks: a shaft that nobody asks costs nothing.
#include "adapters/mcode/twin/shaft.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::mcode::twin {

Travel Shaft::rotor(Instant now) const noexcept {
    switch (state_) {
        case Rotor::held:
            return {held_at_, 0};
        case Rotor::catching_up:
            if (now < meeting_) return catch_up_.at(now);
            return command_.at(now);
        default:
            break;
    }
    Travel t = command_.at(now);
    t.position -= slip_;
    return t;
}

Travel Shaft::measured(Instant now) const noexcept {
    Travel t = rotor(now);
    t.position += settings_.direction() * stray * settings_.units_per_turn();
    return t;
}

int Shaft::way(Instant now) const noexcept {
    const Instant end = command_.end();
    const Instant moves = now < end || end == Instant::min() ? now : end - std::chrono::microseconds(1);
    const double v = command_.at(moves).velocity;
    return v < 0 ? -1 : v > 0 ? 1 : way_;
}

double Shaft::c1(Instant now) const noexcept {
    return c1_.base + (pulses(now) - c1_.at) * settings_.steps_per_turn() / settings_.units_per_turn();
}

double Shaft::c2(Instant now) const noexcept {
    return c2_.base + (measured(now).position - c2_.at) * settings_.counts_per_turn() / settings_.units_per_turn();
}

double Shaft::turns(Instant now) const noexcept {
    return turns_.base + settings_.direction() * (rotor(now).position - turns_.at) / settings_.units_per_turn();
}

bool Shaft::index_here(Instant now) const noexcept {
    const double counts = turns(now) * settings_.counts_per_turn();
    return std::abs(counts - std::round(turns(now)) * settings_.counts_per_turn()) < 0.5;
}

Instant Shaft::rotor_crossing(double x, Instant now, int way) const noexcept {
    switch (state_) {
        case Rotor::held:
            return never;
        case Rotor::catching_up: {
            const Instant t = catch_up_.crossing(now, x, way);
            return t <= meeting_ ? t : meeting_ == never ? never : command_.crossing(meeting_, x, way);
        }
        default:
            return command_.crossing(now, x + slip_, way);
    }
}

Instant Shaft::position_crossing(double x, Instant now, int way) const noexcept {
    return settings_.feedback() ? rotor_crossing(x, now, way) : command_.crossing(now, x, way);
}

Instant Shaft::turns_crossing(double t, Instant now) const noexcept {
    return rotor_crossing(turns_.at + settings_.direction() * (t - turns_.base) * settings_.units_per_turn(), now, 0);
}

Instant Shaft::lag_crossing(double limit, Instant now) const noexcept {
    if (state_ != Rotor::held) return never;
    return std::min(command_.crossing(now, held_at_ + limit, 1), command_.crossing(now, held_at_ - limit, -1));
}

void Shaft::stand_at(double position, Instant now) noexcept {
    const Kept k = keep(now);
    const Travel r = rotor(now);
    command_ = Profile::rest(position);
    meeting_ = never;
    if (settings_.feedback()) {
        slip_ = 0;
        if (state_ == Rotor::held) held_at_ = position;
        if (state_ == Rotor::catching_up) state_ = Rotor::follows;
    } else if (state_ == Rotor::follows) {
        slip_ = position - r.position;
        if (std::abs(slip_) < 1) slip_ = 0;
    }
    put_back(k, now);
}

void Shaft::settle_at(double position) noexcept {
    command_ = Profile::rest(position);
    if (state_ == Rotor::catching_up) join();
    if (settings_.feedback()) slip_ = 0;
}

void Shaft::freeze(Instant now) noexcept {
    const double here = std::round(position(now).position);
    const bool slipped = state_ == Rotor::held || slip_ != 0;
    if (slipped && settings_.feedback()) {
        stand_at(here, now);
        return;
    }
    command_ = Profile::rest(here);
    if (!slipped) join();
}

void Shaft::hold_at(double position) noexcept {
    held_at_ = position;
    state_ = Rotor::held;
    meeting_ = never;
}

void Shaft::let_go(Instant now) noexcept {
    slip_ = command_.at(now).position - held_at_;
    if (std::abs(slip_) < 1e-9) slip_ = 0;
    state_ = Rotor::follows;
}

void Shaft::turn_to(double position, Instant now) noexcept {
    if (state_ == Rotor::held) {
        held_at_ = position;
    } else {
        slip_ = command_.at(now).position - position;
    }
}

void Shaft::chase(Profile p, Instant meeting) noexcept {
    state_ = Rotor::catching_up;
    catch_up_ = std::move(p);
    meeting_ = meeting;
}

void Shaft::join() noexcept {
    state_ = Rotor::follows;
    slip_ = 0;
    meeting_ = never;
}

void Shaft::restart(bool held, Instant now) noexcept {
    const double kept = turns(now);
    state_ = held ? Rotor::held : Rotor::follows;
    meeting_ = never;
    way_ = 1;
    const MotorManners& m = settings_.manners();
    const auto c1 = static_cast<double>(m.counter_start);
    renumber(c1, {c1, static_cast<double>(m.encoder_start), kept}, now);
}

void Shaft::put_back(const Kept& k, Instant now) noexcept {
    c1_ = {k.c1, pulses(now)};
    c2_ = {k.c2, measured(now).position};
    turns_ = {k.turns, rotor(now).position};
}

void Shaft::rescale(const Kept& k, Instant now) noexcept {
    slip_ = 0;
    held_at_ = command_.end_position();
    put_back(k, now);
}

void Shaft::renumber(double position, const Kept& k, Instant now) noexcept {
    if (settings_.feedback()) position -= settings_.direction() * stray * settings_.units_per_turn();
    command_ = Profile::rest(position);
    rescale(k, now);
}

void Shaft::shift(double by) noexcept {
    command_.shift(by);
    catch_up_.shift(by);
    held_at_ += by;
    c1_.at += by;
    c2_.at += by;
    turns_.at += by;
}

}  // namespace axisgate::mcode::twin
