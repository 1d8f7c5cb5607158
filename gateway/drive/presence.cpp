#include "gateway/drive/presence.hpp"

#include <algorithm>

namespace axisgate::drive {

void Presence::begin(Instant now) noexcept {
    phase_ = Phase::probing;
    silent_ = 0;
    retry_pause_ = {};
    next_probe_ = now;
}

void Presence::close() noexcept {
    phase_ = Phase::down;
    next_probe_ = never;
}

void Presence::probe_sent() noexcept {
    if (phase_ == Phase::restarting) {
        phase_ = Phase::probing;
        silent_ = 0;
    }
    next_probe_ = never;
}

void Presence::found() noexcept {
    phase_ = Phase::starting;
    ever_found_ = true;
    silent_ = 0;
    next_probe_ = never;
}

Presence::Silence Presence::silent(Instant now) noexcept {
    ++silent_;
    switch (phase_) {
        case Phase::down:
        case Phase::restarting:
            return Silence::counted;
        case Phase::absent:
            retry_pause_ = std::min(2 * retry_pause_, std::max(timing_->pause_min, timing_->pause_max));
            next_probe_ = now + retry_pause_;
            return Silence::still_absent;
        case Phase::probing:
        case Phase::starting:
        case Phase::ready:
            break;
    }
    if (silent_ >= static_cast<std::uint32_t>(timing_->silent_limit)) {
        lose(now);
        return Silence::lost;
    }
    if (phase_ == Phase::probing) next_probe_ = now;
    return Silence::counted;
}

void Presence::lose(Instant now, Duration pause) noexcept {
    phase_ = Phase::absent;
    silent_ = std::max(silent_, static_cast<std::uint32_t>(timing_->silent_limit));
    retry_pause_ = pause > Duration::zero() ? pause : timing_->pause_min;
    next_probe_ = now + retry_pause_;
}

void Presence::received(Instant now) noexcept {
    // While a probe is outstanding, its answer or its time-out decides when the next one is due.
    if ((phase_ == Phase::absent || phase_ == Phase::probing) && next_probe_ != never) next_probe_ = std::min(next_probe_, now);
}

void Presence::restart(Instant now, Duration time) noexcept {
    phase_ = Phase::restarting;
    next_probe_ = now + time;
}

void Presence::beats(DriveBeats beats, Out& out) {
    beats_ = beats;
    if (reported_.drive == drive_) report(reported_.text, out);
}

void Presence::limited(DriveLimits limits, Out& out) {
    limits_ = std::move(limits);
    if (reported_.drive == drive_) report(reported_.text, out);
}

void Presence::report(std::string text, Out& out) {
    const Duration pause = phase_ == Phase::absent ? retry_pause_ : Duration{};
    if (reported_.drive == drive_ && reported_.online == online() && reported_.retry_pause == pause && reported_.text == text &&
        reported_.watchdog == watchdog_ && reported_.limits == limits_ && reported_.beats == beats_)
        return;
    reported_ = {drive_, online(), silent_, pause, std::move(text), watchdog_, limits_, beats_};
    out.links.push_back(reported_);
}

}  // namespace axisgate::drive
