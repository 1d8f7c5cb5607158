// Motor: the frame of P, the counters C1 and C2, encoder mode (EE) with stall detection, dead band and position maintenance.
// In: instants, settings. Out: positions; corrections and stalls.
// Never changes what the shaft does by renumbering.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
/// Attempts to come into the dead band; then error 92. The manual gives no figure.
constexpr int correction_limit = 3;
constexpr std::array microsteps{1, 2, 4, 5, 8, 10, 16, 25, 32, 50, 64, 100, 108, 125, 127, 128, 180, 200, 250, 256};

}  // namespace

double Motor::counts_per_turn() const noexcept { return (setup_.product & lmm) != 0 ? 4 * setting(Word::EL) : 4000; }

double Motor::steps_per_turn() const noexcept { return 360.0 / setting(Word::SA) * setting(Word::MS); }

Travel Motor::rotor(Instant now) const noexcept {
    switch (rotor_state_) {
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

Travel Motor::position(Instant now) const noexcept { return feedback() ? rotor(now) : command_.at(now); }

double Motor::lag(Instant now) const noexcept { return command_.at(now).position - rotor(now).position; }

/// A reversal turns within one profile; after its end the last direction holds.
int Motor::command_way(Instant now) const noexcept {
    const Instant end = command_.end();
    const Instant moves = now < end || end == Instant::min() ? now : end - std::chrono::microseconds(1);
    const double v = command_.at(moves).velocity;
    return v < 0 ? -1 : v > 0 ? 1 : way_;
}

double Motor::c1(Instant now) const noexcept {
    const double pulses = hmt_mode() != 0 ? rotor(now).position : command_.at(now).position;
    return c1_.base + (pulses - c1_.at) * steps_per_turn() / units_per_turn();
}

double Motor::c2(Instant now) const noexcept { return c2_.base + (rotor(now).position - c2_.at) * counts_per_turn() / units_per_turn(); }

double Motor::turns(Instant now) const noexcept { return shaft_.base + direction() * (rotor(now).position - shaft_.at) / units_per_turn(); }

void Motor::put_back(const Kept& k, Instant now) noexcept {
    c1_ = {k.c1, hmt_mode() != 0 ? rotor(now).position : command_.at(now).position};
    c2_ = {k.c2, rotor(now).position};
    shaft_ = {k.turns, rotor(now).position};
}

void Motor::stand_at(double position, Instant now) noexcept {
    const Kept k = keep(now);
    const Travel r = rotor(now);
    command_ = Profile::rest(position);
    passing_ = meeting_ = never;
    go_on_ = false;
    if (feedback()) {
        slip_ = 0;
        if (rotor_state_ == Rotor::held) held_at_ = position;
        if (rotor_state_ == Rotor::catching_up) rotor_state_ = Rotor::follows;
    } else if (rotor_state_ == Rotor::follows) {
        slip_ = position - r.position;
        if (std::abs(slip_) < 1) slip_ = 0;
    }
    put_back(k, now);
}

void Motor::resync(Instant now) noexcept {
    if (!feedback() || phase_ == Phase::steps) return;
    if (std::abs(lag(now)) > 1e-9) stand_at(std::round(rotor(now).position), now);
}

/// Renumbers the frame; C1, C2 and the shaft stay.
void Motor::shift_frame(double by) noexcept {
    command_.shift(by);
    catch_up_.shift(by);
    held_at_ += by;
    c1_.at += by;
    c2_.at += by;
    shaft_.at += by;
    target_ += by;
    tr_from_ += by;
    if (second_) *second_ += by;
    if (pause_second_) *pause_second_ += by;
    if (after_pause_ == Word::MA) pause_value_ += by;
}

void Motor::write_counter(Word w, double value, Instant now) {
    switch (w) {
        case Word::P:
            shift_frame(value - nearest(position(now).position));
            break;
        case Word::C1: {
            const double by = value - nearest(c1(now));
            if (!feedback()) shift_frame(by);  // C1 supplies P [L1849]
            c1_.base += by;
            break;
        }
        default: {
            const double by = value - nearest(c2(now));
            if (encoder_mode()) shift_frame(by);  // C2 supplies P [L1906]
            c2_.base += by;
            break;
        }
    }
}

int Motor::set_encoder_mode(bool on, Instant now) {
    if (on == (setting(Word::EE) != 0)) return 0;
    // The unit of everything changes: only at rest.
    if (phase_ != Phase::rest) return err::bad_value;
    const double least = counts_per_turn() * 2 / (360.0 / setting(Word::SA));  // MS >= EL*8/full steps [L2624-2632]
    if (on && (setup_.product & lmm) != 0 && setting(Word::MS) < least) return err::bad_ratio;
    if (hmt_mode() != 0) {
        // Beside hMT it waits: motion stays in step pulses until AS is 0 [L696, L7520]. Only MS is locked at 256 already [L7194].
        const int code = on ? set_microsteps(256, now) : 0;
        if (code == 0) set(Word::EE, on ? 1 : 0);
        return code;
    }
    const Kept k = keep(now);
    set(Word::EE, on ? 1 : 0);
    change_units(k, now);
    return 0;
}

/// Steps have become counts or the other way round: the shaft stands where it is, P is the counter of the new unit.
void Motor::change_units(const Kept& k, Instant now) {
    set(Word::MS, 256);
    encoder_defaults();
    slip_ = 0;
    command_ = Profile::rest(std::round(encoder_mode() ? k.c2 : k.c1));
    held_at_ = command_.end_position();
    put_back(k, now);
}

void Motor::encoder_defaults() noexcept {
    const double scale = encoder_mode() ? counts_per_turn() / 4000 : 1;
    set(Word::VI, encoder_mode() ? std::max(1.0, std::round(78 * scale)) : 1000);
    set(Word::VM, encoder_mode() ? std::round(60000 * scale) : 768000);
    set(Word::A, encoder_mode() ? std::round(78125 * scale) : 1000000);
    set(Word::D, setting(Word::A));
}

int Motor::set_microsteps(std::int64_t ms, Instant now) {
    if (std::ranges::find(microsteps, ms) == microsteps.end()) return err::bad_value;
    const double old = setting(Word::MS);
    if (static_cast<double>(ms) == old) return 0;
    if (setting(Word::EE) != 0) return err::wrong_type;  // locked at 256 [L7194]
    if (phase_ != Phase::rest || (hmt_mode() != 0 && ms < 10)) return err::bad_value;
    const Kept k = keep(now);
    set(Word::MS, static_cast<double>(ms));
    for (const Word w : {Word::VI, Word::VM, Word::A, Word::D})
        set(w, std::round(setting(w) * static_cast<double>(ms) / old));
    slip_ = 0;
    held_at_ = command_.end_position();
    put_back(k, now);
    return 0;
}

/// The command is SF ahead of the rotor: nothing more is given, or with SM = 1 the move goes on; ST stays until ST = 0 [L7354, L5432].
void Motor::stalled(Instant now) {
    stall_told_ = true;
    stall_flag_ = true;
    raise(err::stall_detected);
    if (setting(Word::SM) != 0) return;
    aborted_ = true;
    freeze(now);
}

/// One attempt, at VI, to bring the rotor to where the move should have ended.
void Motor::correct(Instant now) {
    const double target = target_;
    stand_at(rotor(now).position, now);
    command_ = Profile::creep(now, command_.end_position(), target, std::max(1.0, setting(Word::VI)));
    phase_ = Phase::steps;
    phase_end_ = never;
    stall_told_ = setting(Word::SM) != 0;
}

void Motor::settled(Instant now) {
    const bool checked = encoder_mode() && (task_ == Task::position || task_ == Task::correction);
    if (checked && std::abs(target_ - rotor(now).position) > setting(Word::DB)) {
        if (corrections_ < correction_limit) {
            ++corrections_;
            correct(now);
            return;
        }
        raise(err::position_error);
        aborted_ = true;
    }
    if (task_ == Task::correction) {
        finish(now);
        return;
    }
    phase_ = Phase::holding;
    phase_end_ = now + std::chrono::milliseconds(whole(Word::HT));
}

/// PM = 1: a shaft that is pushed out of the dead band at rest is brought back; with SM = 0 only from within SF [L4835-4837].
void Motor::maintain(Instant now) {
    if (!encoder_mode() || setting(Word::PM) == 0 || phase_ != Phase::rest || rotor_state_ != Rotor::follows) return;
    if (setting(Word::DE) == 0 || bridge_off_ || !supply_.plus_v_good()) return;
    const double off = std::abs(lag(now));
    if (off <= setting(Word::DB) || (setting(Word::SM) == 0 && off > setting(Word::SF))) return;
    target_ = command_.end_position();
    task_ = Task::correction;
    corrections_ = 0;
    aborted_ = false;
    correct(now);
}

bool Motor::index_here(Instant now) const noexcept {
    const double counts = turns(now) * counts_per_turn();
    return std::abs(counts - std::round(turns(now)) * counts_per_turn()) < 0.5;
}

}  // namespace axisgate::mcode::twin
