// TripConditions: arming, and what makes each of them true.
// In: fields, edges, instants. Out: MCode error codes, events.
// Never fires TP or TR more often than 20 kHz.
#include "adapters/mcode/twin/trip_conditions.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
/// 20 kHz, the highest rate of position trips [L5844]; those in between are lost.
constexpr Duration trip_pause = std::chrono::microseconds(50);

}  // namespace

int TripConditions::arm(Word w, std::span<const Number> f, Instant now) {
    const std::int64_t first = f.empty() ? 0 : f[0].as_integer();
    switch (w) {
        case Word::TI:
            if (f.size() != 1 || first < 1 || first > static_cast<std::int64_t>(inputs_.fitted())) return err::bad_value;
            input_ = static_cast<int>(first);
            break;
        case Word::TP:
            if (f.size() != 1 || std::abs(first) > 2147483648LL) return err::bad_value;
            if (enabled(Word::TR)) return err::two_trips;
            position_ = static_cast<double>(first);
            break;
        case Word::TR:
            if (f.empty() || first == 0 || std::abs(first) > 2147483647LL) return err::bad_value;
            if (enabled(Word::TP)) return err::two_trips;
            distance_ = static_cast<double>(std::abs(first));
            distance_from_ = shaft_.position(now).position;
            break;
        case Word::TC:
            if (!inputs_.with_type(InputType::capture)) return err::no_capture;
            break;
        case Word::TA:
            if (f.size() != 1 || first < 0 || first > 31) return err::bad_value;
            mask_ = static_cast<int>(first);
            break;
        default:
            break;
    }
    return 0;
}

void TripConditions::enable(int te, Instant now) noexcept {
    const bool counted = enabled(Word::TR);
    te_ = te;
    // TR counts from where it is switched on [L5828].
    if (enabled(Word::TR) && !counted) distance_from_ = shaft_.position(now).position;
}

void TripConditions::restart() noexcept {
    te_ = 0;
    captured_ = 0;
}

void TripConditions::input(const InputEdge& e, Instant now) {
    if (!e.active) return;
    if (enabled(Word::TI) && input_ == static_cast<int>(e.input) + 1) fire(Word::TI, now);
    if (enabled(Word::TC) && e.type == InputType::capture) fire(Word::TC, now);
}

void TripConditions::status(int bit, Instant now) {
    if (enabled(Word::TA) && (mask_ & bit) != 0) fire(Word::TA, now);
}

void TripConditions::supply_low(Instant now) {
    if (enabled(Word::TM)) fire(Word::TM, now);
}

void TripConditions::capture(Instant now) noexcept {
    captured_ = std::llround(shaft_.shown_position(now).position);
    if (outputs_.has(OutputType::trip)) ++pulses_;
}

/// TP and TR are told by the place alone and leave PC.
void TripConditions::fire(Word trip, Instant now) {
    if (trip == Word::TP || trip == Word::TR) {
        if (outputs_.has(OutputType::trip)) ++pulses_;
    } else {
        capture(now);
    }
    events_.emit(MotorEvent::Kind::trip, 0, trip);
}

void TripConditions::plan(bool stepping, Instant now) noexcept {
    position_due_ = distance_due_ = pause_due_ = never;
    if (!stepping) return;
    if (enabled(Word::TP)) position_due_ = shaft_.position_crossing(position_, now);
    if (!enabled(Word::TR)) return;
    if (now < pause_until_) {
        pause_due_ = pause_until_;
        return;
    }
    // Multiples that passed within the pause are lost.
    if (pause_until_ != Instant::min()) {
        distance_from_ += std::trunc((shaft_.position(now).position - distance_from_) / distance_) * distance_;
        pause_until_ = Instant::min();
    }
    distance_due_ =
        std::min(shaft_.position_crossing(distance_from_ + distance_, now), shaft_.position_crossing(distance_from_ - distance_, now));
}

Instant TripConditions::deadline() const noexcept { return std::min({position_due_, distance_due_, pause_due_}); }

void TripConditions::pass(Instant t) {
    if (position_due_ <= t) fire(Word::TP, t);
    if (distance_due_ > t) return;
    fire(Word::TR, t);
    distance_from_ += shaft_.position(t).position < distance_from_ ? -distance_ : distance_;
    pause_until_ = t + trip_pause;
}

}  // namespace axisgate::mcode::twin
