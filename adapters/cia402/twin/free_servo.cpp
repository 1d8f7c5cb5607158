#include "adapters/cia402/twin/free_servo.hpp"

#include <cmath>
#include <utility>

namespace axisgate::cia402_drive::twin {
namespace {
constexpr unsigned acknowledge_bit = 0x1000, halt_bit = 0x100;
constexpr std::uint16_t sync_controller = 0x8700, target_missed = 0x8250;
}  // namespace

void FreeServo::set_freedoms(const Freedoms& freedoms, Instant now) {
    if (!(freedoms.shaft == free_.shaft)) m_.set_shaft(freedoms.shaft, freedoms.seed, now);
    free_ = freedoms;
    for (LateBit& b : bits_)
        b.due = never;
    orders_.knows_target_time = !free_.lacks(0x60C2);
    switches_.hysteresis = free_.switch_hysteresis;
    // A shaft without freedoms is looked at only while it is blocked; one with freedoms in each motion, and therefore less often.
    set_watch(m_.differs() || switches_.hysteresis > 0 ? std::chrono::milliseconds(5) : std::chrono::milliseconds(1));
}

void FreeServo::power_on(Instant now) {
    late_ = {};
    stream_ = {};
    waiting_ = false;
    Servo::power_on(now);
}

canopen::Abort FreeServo::may_write(canopen::Address a, std::int64_t v, Instant now) const {
    if (a.index == 0x6060 && !free_.refuses_mode_silently && refuses_mode(v, now)) return canopen::Abort::device_state;
    return Servo::may_write(a, v, now);
}
bool FreeServo::refuses_mode(std::int64_t mode, Instant now) const {
    if (mode == 0 || mode == orders_.mode()) return false;
    return (free_.refuses_mode_halted && (cw_ & halt_bit) != 0) || (free_.refuses_mode_moving && powered() && !stands(now));
}

void FreeServo::written(canopen::Address a, Instant now) {
    take(a, now);
    note_bits(now);
}
void FreeServo::take(canopen::Address a, Instant now) {
    const Duration every = free_.control_sample;
    switch (a.index) {
        case 0x6040:
            if (every == Duration::zero()) return sample(now);
            if (late_.sample == never) late_.sample = now + every - now.time_since_epoch() % every;
            return;
        case 0x6060:
            if (refuses_mode(o_.get(0x6060), now)) return;
            stream_ = {};
            if (free_.mode_shown == Duration::zero()) return set_mode(now);
            late_.mode = now + free_.mode_shown;
            return;
        case 0x607A:
        case 0x60C1:
        case 0x60FF:
        case 0x6071:
            stream_.fresh = true;
            return Servo::written(a, now);
        default:
            return Servo::written(a, now);
    }
}

void FreeServo::sample(Instant now) {
    const bool before = orders_.acknowledged();
    control(now);
    if (before || !orders_.acknowledged()) return;
    waiting_ = free_.acknowledges_when_taken && orders_.buffers();
    acknowledge(now);
}
void FreeServo::acknowledge(Instant now) {
    const bool may = free_.acknowledges && !waiting_;
    shown_ = may && free_.acknowledge == Duration::zero();
    late_.shown = may && !shown_ ? now + free_.acknowledge : never;
}

/// The next SYNC, and the next target, must come in time; half a period is permitted for their jitter.
void FreeServo::on_sync(Instant now) {
    Servo::on_sync(now);
    const bool fresh = std::exchange(stream_.fresh, false);
    if (!orders_.cyclic() || !takes_orders()) {
        stream_ = {};
        return;
    }
    const auto after = [now](int periods, Duration one) {
        return periods > 0 && one > Duration::zero() ? now + periods * one + one / 2 : never;
    };
    stream_.sync = after(free_.sync_watch_periods, orders_.sync_time());
    if (fresh) stream_.target = after(free_.target_watch_periods, Duration{std::llround(orders_.target_time() * 1e9)});
}
void FreeServo::stream_stopped(Instant at) {
    const bool sync = stream_.sync <= at;
    stream_ = {};
    if (orders_.cyclic() && takes_orders()) fail(sync ? sync_controller : target_missed, at);
}

/// A control word that was written before and is sampled now, a mode that was ordered before, an acknowledgement.
void FreeServo::take_late(Instant at) {
    if (late_.sample <= at) late_.sample = never, sample(at);
    if (late_.mode <= at) late_.mode = never, stream_ = {}, set_mode(at);
    if (late_.shown <= at) late_.shown = never, shown_ = true;
}
Instant FreeServo::next_event(Instant now) const {
    Instant next = std::min({Servo::next_event(now), late_.first(), stream_.first()});
    for (const LateBit& b : bits_)
        next = std::min(next, b.due);
    return next;
}
void FreeServo::on_event(Instant at) {
    if (late_.first() <= at) {
        take_late(at);
    } else if (stream_.first() <= at) {
        stream_stopped(at);
    } else if (Servo::next_event(at) <= at) {
        Servo::on_event(at);
        if (waiting_ && !orders_.buffers()) {
            waiting_ = false;
            acknowledge(at);
        }
    }
    note_bits(at);
}

/// The bits that this drive sets late are due from the first look that finds them set.
void FreeServo::note_bits(Instant now) {
    if (free_.status_bits == Duration::zero()) return;
    const unsigned sw = statusword(now);
    for (LateBit& b : bits_) {
        if ((sw & b.bit) == 0) {
            b.set = false;
            b.due = never;
        } else if (!b.set) {
            if (b.due == never) b.due = now + free_.status_bits;
            b.set = b.due <= now;
            if (b.set) b.due = never;
        }
    }
}
std::uint16_t FreeServo::shown_statusword(Instant now) const {
    unsigned sw = statusword(now);
    const bool set_point = orders_.mode() == 1;
    if (set_point && !shown_) sw &= ~acknowledge_bit;
    if (free_.status_bits == Duration::zero()) return static_cast<std::uint16_t>(sw);
    for (const LateBit& b : bits_)
        if (!b.set && !(b.bit == acknowledge_bit && set_point)) sw &= ~b.bit;
    return static_cast<std::uint16_t>(sw);
}
void FreeServo::refresh(Instant now) {
    Servo::refresh(now);
    note_bits(now);
    o_.put(0x6041, shown_statusword(now));
}

}  // namespace axisgate::cia402_drive::twin
