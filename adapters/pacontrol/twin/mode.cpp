// Transitions of the operating mode. The manual prints no table of them: what it does not name is the model's own.
// In: commands, time, standstill. Out: the status. Never skips a transitional state.
#include "adapters/pacontrol/twin/mode.hpp"

#include <algorithm>

namespace axisgate::pacontrol::twin {

std::uint8_t column_of(std::uint8_t s) noexcept {
    if (s == status::home || s == status::home_error) return gate::home;
    if (s == status::manual || s == status::manual_moves || s == status::winpac) return gate::manual;
    if (s >= status::auto_started && s <= status::auto_malfunction_stopped) return gate::automatic;
    if (s >= status::online_started && s <= status::online_malfunction_stopped) return gate::online;
    return 0;
}

void Mode::reset() noexcept {
    status_ = status::home;
    leaving_ = false;
    until_ = never;
    left_ = {};
}

void Mode::initialise(Instant now) noexcept {
    reset();
    status_ = status::none;
    until_ = now + times_.initialise;
}

Mode::Entered Mode::enter(std::uint8_t s) noexcept {
    status_ = s;
    until_ = never;
    leaving_ = false;
    switch (s) {
        case status::home:
            return Entered::home;
        case status::manual:
        case status::winpac:
            return Entered::manual;
        case status::automatic:
            return Entered::automatic;
        case status::online:
            return Entered::online;
        default:
            return Entered::other;
    }
}

bool Mode::start_automatic(const Program& program, Instant now) {
    if (status_ != status::home) return false;
    program_ = program;
    left_ = program.duration;
    status_ = status::auto_started;
    until_ = now + times_.start;
    return true;
}

bool Mode::resume_automatic(Instant now) {
    if (status_ != status::auto_stopped || leaving_) return false;
    status_ = status::auto_after_stop;
    until_ = now + times_.start_after_stop;
    return true;
}

bool Mode::start_online(Instant now) {
    if (status_ != status::home) return false;
    status_ = status::online_started;
    until_ = now + times_.start;
    return true;
}

bool Mode::resume_online() noexcept {
    if (status_ != status::online_stopped || leaving_) return false;
    status_ = status::online;
    return true;
}

void Mode::keep_program_time(Instant now) noexcept {
    if (status_ == status::automatic) left_ = std::max(Duration::zero(), until_ - now);
}

bool Mode::stop(Instant now) noexcept {
    switch (status_) {
        case status::auto_started:
        case status::automatic:
        case status::auto_after_stop:
            keep_program_time(now);
            status_ = status::auto_stop;
            until_ = never;
            return true;
        case status::online_started:
        case status::online:
            status_ = status::online_stop;
            until_ = never;
            return true;
        default:
            return false;
    }
}

bool Mode::malfunction(Instant now) noexcept {
    if (status_ >= status::auto_started && status_ <= status::auto_after_stop) {
        keep_program_time(now);
        status_ = status::auto_malfunction;
    } else if (status_ >= status::online_started && status_ <= status::online_stopped) {
        status_ = status::online_malfunction;
    } else {
        return false;
    }
    until_ = never;
    return true;
}

void Mode::leave(std::uint8_t target) noexcept {
    target_ = target;
    leaving_ = true;
    until_ = never;
}

Mode::Entered Mode::step(Instant now, bool all_stand) {
    if (leaving_) {
        if (!all_stand) return Entered::nothing;
        if (until_ == never) until_ = now + times_.home;
        return now >= until_ ? enter(target_) : Entered::nothing;
    }
    const bool due = now >= until_;
    switch (status_) {
        case status::none:
            return due ? enter(status::home) : Entered::nothing;
        case status::auto_started:
        case status::auto_after_stop: {
            if (!due) break;
            const Instant from = until_;
            const Entered e = enter(status::automatic);
            until_ = from + left_;
            return e;
        }
        case status::automatic:
            if (!due) break;
            until_ = never;
            left_ = {};
            return Entered::program_ended;
        case status::auto_stop:
            if (!all_stand) break;
            status_ = status::auto_stop_program;
            until_ = now + times_.stop_program;
            return Entered::other;
        case status::auto_stop_program:
            return due ? enter(status::auto_stopped) : Entered::nothing;
        case status::auto_malfunction:
            if (!all_stand) break;
            status_ = status::auto_malfunction_program;
            until_ = now + times_.malfunction_program;
            return Entered::other;
        case status::auto_malfunction_program:
            return due ? enter(status::auto_malfunction_stopped) : Entered::nothing;
        case status::online_started:
            return due ? enter(status::online) : Entered::nothing;
        case status::online_stop:
            return all_stand ? enter(status::online_stopped) : Entered::nothing;
        case status::online_malfunction:
            return all_stand ? enter(status::online_malfunction_stopped) : Entered::nothing;
        default:
            break;
    }
    return Entered::nothing;
}

}  // namespace axisgate::pacontrol::twin
