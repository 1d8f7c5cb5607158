// Motor: the passing of time, events and trips.
// Motion is in twin_motor_motion.cpp, words in twin_motor_words.cpp, points and supply in twin_motor_io.cpp, the hand in
// twin_motor_hand.cpp, the frame and the encoder in twin_encoder.cpp, and twin_homing.cpp, twin_limits.cpp, twin_hmt.cpp say what they are.
// In: instants. Out: events.
// Never loses an event silently within its bound: beyond 64 waiting ones the newest is dropped, and no error raises more than one at once.
#include "adapters/mcode/twin/motor.hpp"
#include "adapters/mcode/twin/errors.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::mcode::twin {
namespace {
constexpr std::size_t event_limit = 64;
/// Happenings that one call works off; the rest stay due.
constexpr int happenings_per_call = 256;
/// 20 kHz, the highest rate of position trips [L5844]; those in between are lost.
constexpr Duration trip_pause = std::chrono::microseconds(50);

}  // namespace

std::unique_ptr<Mechanism> make_mechanism(const MechanismSetup& setup) { return std::make_unique<Motor>(setup); }

Motor::Motor(const MechanismSetup& setup)
    : setup_(setup),
      inputs_(setup.frame_size == 17 ? 3 : input_count, (setup.product & lmd) != 0),
      outputs_(setup.frame_size == 17, (setup.product & lmdc) != 0) {
    supply_.has_aux = (setup.product & lmd) != 0;
    defaults();
    inputs_.factory({});
    outputs_.factory();
}

void Motor::emit(const MotorEvent& e) {
    if (events_.size() < event_limit) events_.push_back(e);
}

std::optional<MotorEvent> Motor::next_event() {
    if (events_.empty()) return std::nullopt;
    const MotorEvent e = events_.front();
    events_.pop_front();
    return e;
}

void Motor::advance(Instant now) {
    for (int n = 0; n < happenings_per_call && next_ <= now; ++n) {
        const Instant t = std::max(next_, last_);
        last_ = t;
        handle(t);
        replan(t);
    }
    last_ = std::max(last_, now);
}

Instant Motor::position_crossing(double x, Instant now, int way) const noexcept {
    return feedback() ? rotor_crossing(x, now, way) : command_.crossing(now, x, way);
}

void Motor::replan(Instant now) {
    due_ = {};
    if (phase_ == Phase::steps) {
        if (soft_on_[0]) due_.soft = position_crossing(soft_limit_[0], now, -1);
        if (soft_on_[1]) due_.soft = std::min(due_.soft, position_crossing(soft_limit_[1], now, 1));
        if (task_ == Task::homing && home_.word != Word::HM) due_.mark = mark_crossing(now);
        if ((te_ & 2) != 0) due_.tp = position_crossing(tp_, now);
        if ((te_ & 16) != 0 && now < tr_pause_until_) {
            due_.trip_pause = tr_pause_until_;
        } else if ((te_ & 16) != 0) {
            // Multiples that passed within the pause are lost.
            if (tr_pause_until_ != Instant::min()) {
                tr_from_ += std::trunc((position(now).position - tr_from_) / tr_) * tr_;
                tr_pause_until_ = Instant::min();
            }
            due_.tr = std::min(position_crossing(tr_from_ + tr_, now), position_crossing(tr_from_ - tr_, now));
        }
        if (rotor_state_ == Rotor::held && encoder_mode() && !stall_told_) {
            const double sf = setting(Word::SF);
            due_.stall = std::min(command_.crossing(now, held_at_ + sf, 1), command_.crossing(now, held_at_ - sf, -1));
        }
        if (rotor_state_ == Rotor::held && (hmt_mode() == 1 || hmt_mode() == 2)) {
            for (const double limit : {bound(), setting(Word::LG), setting(Word::LD)}) {
                due_.lag = std::min({due_.lag, command_.crossing(now, held_at_ + limit, 1), command_.crossing(now, held_at_ - limit, -1)});
            }
        }
        if (hmt_mode() != 0) due_.wrap = std::min(position_crossing(2147483647.0, now, 1), position_crossing(-2147483648.0, now, -1));
        due_.cam = cam_crossing(now);
    }
    next_ = std::min({due_.soft, due_.mark, due_.tp, due_.tr, due_.trip_pause, due_.stall, due_.lag, due_.wrap, due_.cam,
                      inputs_.deadline(), passing_, phase_end_, hmt_.lock_due});
    if (rotor_state_ == Rotor::catching_up) next_ = std::min(next_, meeting_);
    if (phase_ == Phase::steps && !waits_for_rotor()) next_ = std::min(next_, command_.end());
}

/// Everything that is due at `t`, causes before effects.
void Motor::handle(Instant t) {
    const Due due = due_;
    due_ = {};
    if (due.cam <= t) judge_cams(t);
    while (const auto e = inputs_.next_edge(t))
        edge(*e, t);
    if (passing_ <= t) {
        passing_ = never;
        emit({MotorEvent::Kind::finished, 0, {}});
    }
    if (rotor_state_ == Rotor::catching_up && meeting_ <= t) caught_up(t);
    if (due.stall <= t) stalled(t);
    if (due.lag <= t) judge_lag(t);
    if (hmt_.lock_due <= t) locked(t);
    if (due.wrap <= t) raise(err::max_count);
    if (due.tp <= t) trip(Word::TP, t, false);
    if (due.tr <= t) {
        trip(Word::TR, t, false);
        const double way = position(t).position < tr_from_ ? -1 : 1;
        tr_from_ += way * tr_;
        tr_pause_until_ = t + trip_pause;
    }
    if (due.soft <= t) limit_met(command_.at(t).velocity < 0 ? -1 : 1, t);
    if (due.mark <= t) mark(true, t);
    if (phase_ == Phase::steps && !waits_for_rotor() && command_.end() <= t) {
        steps_over(t);
    } else if (phase_end_ <= t) {
        phase_end_ = never;
        if (phase_ == Phase::settling) {
            settled(t);
        } else if (phase_ == Phase::holding) {
            finish(t);
        }
    }
}

void Motor::trip(Word w, Instant now, bool capture) {
    if (capture) captured_ = std::llround(position(now).position);
    if (outputs_.has(OutputType::trip)) ++trip_pulses_;
    emit({MotorEvent::Kind::trip, 0, w});
}

void Motor::capture(Instant now) {
    advance(now);
    captured_ = std::llround(position(now).position);
    if (outputs_.has(OutputType::trip)) ++trip_pulses_;
}

int Motor::arm(Word w, std::span<const Number> f, Instant now) {
    advance(now);
    if (const int code = available(w); code != 0) return code;
    const auto first = [&] { return f.empty() ? std::int64_t{0} : f[0].as_integer(); };
    switch (w) {
        case Word::TI:
            if (f.size() != 1 || first() < 1 || first() > static_cast<std::int64_t>(inputs_.fitted())) return err::bad_value;
            ti_input_ = static_cast<int>(first());
            break;
        case Word::TP:
            if (f.size() != 1 || std::abs(first()) > 2147483648LL) return err::bad_value;
            if ((te_ & 16) != 0) return err::two_trips;
            tp_ = static_cast<double>(first());
            break;
        case Word::TR:
            if (f.empty() || first() == 0 || std::abs(first()) > 2147483647LL) return err::bad_value;
            if ((te_ & 2) != 0) return err::two_trips;
            tr_ = static_cast<double>(std::abs(first()));
            tr_from_ = position(now).position;
            break;
        case Word::TC:
            if (!inputs_.with_type(InputType::capture)) return err::no_capture;
            break;
        case Word::TA:
            if (f.size() != 1 || first() < 0 || first() > 31) return err::bad_value;
            ta_mask_ = static_cast<int>(first());
            break;
        default:
            break;
    }
    replan(now);
    return 0;
}

void Motor::enable_trips(int te, Instant now) {
    advance(now);
    // TR counts from where it is switched on [L5828].
    if ((te & 16) != 0 && (te_ & 16) == 0) tr_from_ = position(now).position;
    te_ = te;
    replan(now);
}

void Motor::restart(Instant now) {
    advance(now);
    events_.clear();
    const double shaft = turns(now);
    hmt_ = {};
    task_ = Task::none;
    phase_ = Phase::rest;
    phase_end_ = passing_ = meeting_ = never;
    braking_ = go_on_ = aborted_ = paused_ = false;
    second_.reset();
    after_pause_.reset();
    last_way_ = 0;
    way_ = 1;
    corrections_ = 0;
    slip_ = held_at_ = 0;
    rotor_state_ = held_ ? Rotor::held : Rotor::follows;
    command_ = Profile::rest(0);
    put_back({0, 0, shaft}, now);
    captured_ = 0;
    stall_flag_ = stall_told_ = false;
    last_motion_ = Word::MR;
    index_offset_ = 0;
    te_ = 0;
    bridge_off_ = !enable_input_;
    error_flag_ = program_running_ = false;
    supply_.warned = supply_.over_temperature = supply_.plus_v_told = supply_.aux_told = false;
    replan(now);
}

void Motor::stop_at_once(Instant now) {
    advance(now);
    const bool unfinished = (hmt_mode() == 1 || hmt_mode() == 2) && phase_ == Phase::steps && std::abs(lag(now)) >= 1;
    freeze(now);
    if (unfinished) raise(108);
    replan(now);
}

bool Motor::moving(Instant now) {
    advance(now);
    return phase_ != Phase::rest;
}

bool Motor::busy(bool any, Instant now) {
    advance(now);
    if (phase_ == Phase::rest) return false;
    return any || task_ == Task::position || task_ == Task::homing || task_ == Task::calibration || task_ == Task::correction;
}

void Motor::tell(bool error_flag, bool program_running, Instant) {
    error_flag_ = error_flag;
    program_running_ = program_running;
    if (program_running) return;
    // A program that was ended while it was paused takes its pause along.
    paused_ = false;
    after_pause_.reset();
}

TwinMechanics Motor::mechanics(Instant now) const {
    const Travel r = rotor(std::max(now, last_));
    return {r.position, r.velocity, setting(Word::DE) != 0 && !bridge_off_ && supply_.plus_v_good()};
}

}  // namespace axisgate::mcode::twin
