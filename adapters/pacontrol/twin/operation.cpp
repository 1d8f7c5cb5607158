// Operation: transitions and what they do, errors, time. In: commands, conditions, time. Out: states, command errors.
// Never lets an event wait for a call: each happens at its own instant.
#include "adapters/pacontrol/twin/operation.hpp"

#include <algorithm>
#include <utility>

#include "adapters/pacontrol/twin/errors.hpp"

namespace axisgate::pacontrol::twin {
namespace {
constexpr int steps_per_call = 100'000;  // a bound of one advance; a control has a few events per motion
}

std::uint8_t Operation::status() const noexcept {
    const std::uint8_t s = mode_.status();
    if (s == status::home && with_.error.shown() != 0) return status::home_error;
    if (s == status::manual && !with_.axes.all_stand()) return status::manual_moves;
    return s;
}

// --- time ---

Instant Operation::deadline() const noexcept { return std::min({mode_.deadline(), with_.axes.deadline(), with_.error.due()}); }

void Operation::advance(Instant now) {
    for (int i = 0; i < steps_per_call; ++i) {
        const Instant next = deadline();
        if (next > now) break;
        step(next);
    }
    step(now);
}

void Operation::step(Instant now) {
    with_.axes.advance(now);
    settle(now);
}

void Operation::settle(Instant now) {
    collect(now);
    for (int i = 0; i < 64; ++i) {
        const Mode::Entered what = mode_.step(now, with_.axes.all_stand());
        if (what == Mode::Entered::nothing) break;
        entered(what, now);
    }
    run_program(now);
    with_.error.follow(now);
    with_.axes.settle(now);
}

void Operation::run_program(Instant now) {
    if (mode_.status() == status::automatic && !mode_.leaving()) {
        if (const std::uint16_t number = with_.programs.go_on(mode_.program(), with_.settings, with_.axes, now); number != 0)
            raise(number, now);
    } else if (mode_.column() != gate::automatic) {
        with_.programs.end();  // stopped, it goes on with the move that was interrupted
    }
}

/// Errors that axes found by themselves, and what they want kept.
void Operation::collect(Instant now) {
    for (int n = 1; n <= with_.axes.count(); ++n) {
        const std::uint16_t number = with_.axes.at(n).take_error();
        // With the axis extension an error stops its own axis only and is told in its module [L711].
        if (number != 0 && !rules_.axis_modules) raise(number, now);
        with_.axes.keep_of(n);
    }
}

void Operation::entered(Mode::Entered what, Instant now) {
    switch (what) {
        case Mode::Entered::home:
        case Mode::Entered::manual:
            // Errors of online and automatic go on the way to home position [L2774]; so do overrides and what was interrupted.
            if (with_.error.number() >= 500) with_.error.clear();
            for (int n = 1; n <= with_.axes.count(); ++n) {
                Axis& a = with_.axes.at(n);
                a.traverse().forget_interrupted();
                a.traverse().finish(now);
                if (a.state().fault >= 500 || a.state().fault == 0) a.clear_fault();
                a.clear_displaced();
                with_.orders.of(n).end();
                if (!rules_.reference_outlives && a.parameters()[ap::absolute] == 0 && a.state().referenced) a.set_referenced(false);
                if (static_cast<int>(a.parameters()[ap::enable_mode]) == 1) (void)a.switch_on(now, false);
            }
            if (std::exchange(autostart_, false)) (void)start_automatic(now);
            break;
        case Mode::Entered::automatic:
        case Mode::Entered::online:
            with_.orders.begin();
            break;
        case Mode::Entered::program_ended:
            if (mode_.program().error != 0) {
                raise(mode_.program().error, now);
            } else {
                mode_.leave(status::home);
            }
            break;
        default:
            break;
    }
}

// --- mode control ---

std::uint16_t Operation::start_automatic(Instant now) {
    advance(now);
    if (mode_.status() == status::auto_stopped) {
        if (with_.signals.external_stop_open()) return quit::no_external_stop;
        if (!mode_.resume_automatic(now)) return quit::inadmissible;
        with_.axes.resume(now);
        settle(now);
        return quit::ok;
    }
    if (mode_.status() != status::home || mode_.leaving()) return quit::inadmissible;
    if (with_.error.stands()) return quit::not_executable;
    if (const auto fault = with_.settings.inconsistency(); fault != 0) return fault;
    (void)mode_.start_automatic(with_.programs.chosen(), now);
    settle(now);
    return quit::ok;
}

std::uint16_t Operation::start_online(Instant now) {
    advance(now);
    const bool stopped = mode_.status() == status::online_stopped && !mode_.leaving();
    if (!stopped && (mode_.status() != status::home || mode_.leaving())) return quit::inadmissible;
    if (stopped && !rules_.resumes_online) return quit::inadmissible;
    if (with_.error.stands()) return quit::not_executable;
    if (!with_.signals.external_stop_powered()) return quit::no_external_stop;  // must be defined and carry power [L2037]
    if (stopped) {
        (void)mode_.resume_online();
        with_.axes.resume(now);
    } else {
        if (const auto fault = with_.settings.inconsistency(); fault != 0) return fault;
        (void)mode_.start_online(now);
    }
    settle(now);
    return quit::ok;
}

std::uint16_t Operation::stop(Instant now) {
    advance(now);
    const bool stopped_already = mode_.status() == status::auto_stop || mode_.status() == status::auto_stop_program ||
                                 mode_.status() == status::auto_stopped || mode_.status() == status::online_stop ||
                                 mode_.status() == status::online_stopped || mode_.status() == status::auto_malfunction ||
                                 mode_.status() == status::auto_malfunction_program || mode_.status() == status::auto_malfunction_stopped ||
                                 mode_.status() == status::online_malfunction || mode_.status() == status::online_malfunction_stopped;
    if (!mode_.stop(now) && !stopped_already) return quit::inadmissible;
    with_.axes.interrupt(now);
    settle(now);
    return quit::ok;
}

void Operation::leave_to(std::uint8_t target, Instant now) {
    with_.axes.finish(now);
    mode_.leave(target);
    settle(now);
}

std::uint16_t Operation::cancel(Instant now) {
    advance(now);
    if (mode_.column() != gate::automatic && mode_.column() != gate::online) return quit::inadmissible;
    leave_to(status::home, now);
    return quit::ok;
}

std::uint16_t Operation::reset_error(Instant now) {
    advance(now);
    if (mode_.status() != status::home) return quit::inadmissible;
    if (!with_.error.stands()) return quit::ok;
    // Class 1 goes by power off and on only; some of class 2 never [L2770-2780].
    if (with_.error.number() < 100 || rules_.lasting.contains(with_.error.number())) return quit::not_executable;
    with_.error.clear();
    with_.axes.clear_faults();
    settle(now);
    return quit::ok;
}

void Operation::emergency_stop(Instant now) {
    advance(now);
    with_.axes.interrupt(now);
    with_.axes.finish(now);
    (void)mode_.malfunction(now);
    settle(now);
}

std::string Operation::panel(const std::string& mode, Instant now) {
    advance(now);
    const bool busy = mode_.column() == gate::automatic || mode_.column() == gate::online;
    if (mode == "home") {
        leave_to(status::home, now);
        return {};
    }
    if (mode == "manual" || mode == "winpac") {
        leave_to(mode == "manual" ? status::manual : status::winpac, now);
        return {};
    }
    if (mode == "automatic") {
        if (busy) return "panel: the control is in operating status " + std::to_string(status()) + "; home first";
        if (mode_.column() == gate::manual) leave_to(status::home, now);
        const std::uint16_t q = start_automatic(now);
        if (q != 0) return "panel: AUTOMATIC is refused with command error " + std::to_string(q);
        return {};
    }
    return "panel: '" + mode + "' is none of home, manual, winpac, automatic";
}

// --- errors ---

void Operation::raise(std::uint16_t number, Instant now) {
    if (number == 0) {
        with_.error.clear();
        with_.axes.clear_faults();
        return settle(now);
    }
    with_.error.note(number);
    if (mode_.malfunction(now)) with_.axes.finish(now);
    settle(now);
}

void Operation::raise_axis(int n, std::uint16_t number, Instant now) {
    advance(now);
    if (number == 0) return reset_axis_error(n, now);
    with_.axes.at(n).set_fault(number, now);
    if (!rules_.axis_modules) raise(number, now);
    settle(now);
}

void Operation::reset_axis_error(int n, Instant now) {
    advance(now);
    with_.axes.at(n).clear_fault();
    settle(now);
}

void Operation::stop_if_open(Instant now) {
    if (!with_.signals.external_stop_open()) return;
    const std::uint8_t c = mode_.column();
    if (c == gate::automatic || c == gate::online) (void)stop(now);
}

void Operation::initialise(bool autostart, Instant now) noexcept {
    autostart_ = autostart;
    mode_.initialise(now);
}

void Operation::power_off(Instant now) {
    advance(now);
    with_.axes.lose_power(now);
    collect(now);
    mode_.reset();
}

}  // namespace axisgate::pacontrol::twin
