// The control: commands in progress, mode control, time.
// In: commands, conditions, time. Out: replies, states. Never lets an event wait for a call: each happens at its own instant.
#include "adapters/pacontrol/twin/control.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/commands.hpp"

namespace axisgate::pacontrol::twin {
namespace {
constexpr int steps_per_call = 100'000;  // a bound of one advance; a control has a few events per motion
}

Control::Control(const ControlSetup& setup)
    : setup_(setup),
      mode_(setup.times),
      axes_(setup.axes, setup.axis, setup.rotary, setup.profile.usual_axis(setup.absolute)),
      settings_(setup.profile, setup.profile.usual_axis(setup.absolute), setup.profibus_switches, axes_),
      signals_({Bits{setup.inputs}, Bits{setup.outputs}, Bits{setup.flags}, Registers<std::int32_t>{setup.n}, Registers<float>{setup.r}},
               settings_.system(), error_),
      views_(axes_, error_),
      orders_(axes()) {
    if (setup_.programs.empty()) setup_.programs.push_back({"START", std::chrono::seconds(10), 0});
}

void Control::fit_axes(int n, Instant now) {
    advance(now);
    settings_.fit(n);
    orders_.fit(axes());
}

std::uint8_t Control::status() const noexcept {
    const std::uint8_t s = mode_.status();
    if (s == status::home && error_.stands()) return status::home_error;
    if (s == status::manual && !axes_.all_stand()) return status::manual_moves;
    return s;
}

// --- time ---

Instant Control::deadline() const noexcept { return std::min(mode_.deadline(), axes_.deadline()); }

void Control::advance(Instant now) {
    for (int i = 0; i < steps_per_call; ++i) {
        const Instant next = deadline();
        if (next > now) break;
        step(next);
    }
    step(now);
}

void Control::step(Instant now) {
    axes_.advance(now);
    settle(now);
}

void Control::settle(Instant now) {
    collect(now);
    for (int i = 0; i < 64; ++i) {
        const Mode::Entered what = mode_.step(now, axes_.all_stand());
        if (what == Mode::Entered::nothing) break;
        entered(what, now);
    }
    run_program(now);
}

/// The moves of the program that runs: the next one begins when the axis of the one before has come to its end. A round that moves nothing
/// is waited for no further.
void Control::run_program(Instant now) {
    const std::vector<ProgramMove>& moves = mode_.program().moves;
    if (mode_.status() != status::automatic || mode_.leaving()) {
        // Stopped, it goes on with the move that was interrupted; anywhere else it has ended.
        if (mode_.column() != gate::automatic) {
            program_move_ = 0;
            program_axis_.reset();
        }
        return;
    }
    for (std::size_t tried = 0; tried < moves.size(); ++tried) {
        if (program_axis_ && axis(*program_axis_).traverse().busy()) return;
        const ProgramMove& next = moves[program_move_ % moves.size()];
        if (!settings_.has_axis(next.axis)) return;
        Axis& a = axis(next.axis);
        Motion m;
        m.target = next.target;
        m.speed = static_cast<double>(a.parameters()[ap::traverse_speed]);
        m.acceleration = static_cast<double>(a.parameters()[ap::acceleration]);
        if (const std::uint16_t q = a.traverse().may_start(m, now); q != quit::ok)
            return raise(q == quit::no_reference ? error::no_reference : error::program_move, now);
        a.traverse().start(m, now);
        ++program_move_;
        program_axis_ = next.axis;
    }
}

/// Errors that axes found by themselves, and what they want kept.
void Control::collect(Instant now) {
    for (int n = 1; n <= axes(); ++n) {
        const std::uint16_t number = axis(n).take_error();
        // With the axis extension an error stops its own axis only and is told in its module [L711].
        if (number != 0 && !setup_.axis_modules) raise(number, now);
        axes_.keep_of(n);
    }
}

void Control::entered(Mode::Entered what, Instant now) {
    switch (what) {
        case Mode::Entered::home:
        case Mode::Entered::manual:
            // Errors of online and automatic go on the way to home position [L2774]; so do overrides and what was interrupted.
            if (error_.number() >= 500) error_.clear();
            for (int n = 1; n <= axes(); ++n) {
                Axis& a = axis(n);
                a.traverse().forget_interrupted();
                a.traverse().finish(now);
                if (a.state().fault >= 500 || a.state().fault == 0) a.clear_fault();
                a.clear_displaced();
                orders_.of(n).end();
                if (static_cast<int>(a.parameters()[ap::enable_mode]) == 1) (void)a.switch_on(now, false);
            }
            break;
        case Mode::Entered::automatic:
        case Mode::Entered::online:
            orders_.begin();
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

std::uint16_t Control::start_automatic(Instant now) {
    advance(now);
    if (mode_.status() == status::auto_stopped) {
        if (signals_.external_stop_open()) return quit::no_external_stop;
        if (!mode_.resume_automatic(now)) return quit::inadmissible;
        axes_.resume(now);
        settle(now);
        return quit::ok;
    }
    if (mode_.status() != status::home || mode_.leaving()) return quit::inadmissible;
    if (error_.stands()) return quit::not_executable;
    if (const auto fault = settings_.inconsistency(); fault != 0) return fault;
    (void)mode_.start_automatic(setup_.programs[program_], now);
    settle(now);
    return quit::ok;
}

std::uint16_t Control::start_online(Instant now) {
    advance(now);
    const bool stopped = mode_.status() == status::online_stopped && !mode_.leaving();
    if (!stopped && (mode_.status() != status::home || mode_.leaving())) return quit::inadmissible;
    if (error_.stands()) return quit::not_executable;
    if (!signals_.external_stop_powered()) return quit::no_external_stop;  // must be defined and carry power [L2037]
    if (stopped) {
        (void)mode_.resume_online();
        axes_.resume(now);
    } else {
        if (const auto fault = settings_.inconsistency(); fault != 0) return fault;
        (void)mode_.start_online(now);
    }
    settle(now);
    return quit::ok;
}

std::uint16_t Control::stop(Instant now) {
    advance(now);
    const bool stopped_already = mode_.status() == status::auto_stop || mode_.status() == status::auto_stop_program ||
                                 mode_.status() == status::auto_stopped || mode_.status() == status::online_stop ||
                                 mode_.status() == status::online_stopped || mode_.status() == status::auto_malfunction ||
                                 mode_.status() == status::auto_malfunction_program || mode_.status() == status::auto_malfunction_stopped ||
                                 mode_.status() == status::online_malfunction || mode_.status() == status::online_malfunction_stopped;
    if (!mode_.stop(now) && !stopped_already) return quit::inadmissible;
    axes_.interrupt(now);
    settle(now);
    return quit::ok;
}

void Control::leave_to(std::uint8_t target, Instant now) {
    axes_.finish(now);
    mode_.leave(target);
    settle(now);
}

std::uint16_t Control::cancel(Instant now) {
    advance(now);
    if (mode_.column() != gate::automatic && mode_.column() != gate::online) return quit::inadmissible;
    leave_to(status::home, now);
    return quit::ok;
}

std::uint16_t Control::reset_error(Instant now) {
    advance(now);
    if (mode_.status() != status::home) return quit::inadmissible;
    if (!error_.stands()) return quit::ok;
    // Class 1 goes by power off and on only; some of class 2 never [L2770-2780].
    if (error_.number() < 100 || setup_.lasting.contains(error_.number())) return quit::not_executable;
    error_.clear();
    axes_.clear_faults();
    return quit::ok;
}

void Control::emergency_stop(Instant now) {
    advance(now);
    axes_.interrupt(now);
    axes_.finish(now);
    (void)mode_.malfunction(now);
    settle(now);
}

std::string Control::panel(const std::string& mode, Instant now) {
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

void Control::jog(int n, int direction, Instant now) {
    advance(now);
    Axis& a = axis(n);
    a.traverse().finish(now);
    if (direction == 0 || a.running() || mode_.column() != gate::manual) return settle(now);
    Motion m;
    m.task = Task::jog;
    m.free = true;
    m.target = direction > 0 ? a.traverse().area_max() : a.traverse().area_min();
    m.speed = static_cast<double>(a.parameters()[ap::manual_speed]);
    m.acceleration = static_cast<double>(a.parameters()[ap::acceleration]);
    if (a.traverse().may_start(m, now) == quit::ok) a.traverse().start(m, now);
    settle(now);
}

// --- errors ---

void Control::raise(std::uint16_t number, Instant now) {
    if (number == 0) {
        error_.clear();
        axes_.clear_faults();
        return settle(now);
    }
    error_.note(number);
    if (mode_.malfunction(now)) axes_.finish(now);
    settle(now);
}

void Control::raise_axis(int n, std::uint16_t number, Instant now) {
    advance(now);
    if (number == 0) return reset_axis_error(n, now);
    axis(n).set_fault(number, now);
    if (!setup_.axis_modules) raise(number, now);
    settle(now);
}

void Control::reset_axis_error(int n, Instant now) {
    advance(now);
    axis(n).clear_fault();
    settle(now);
}

// --- the command in progress ---

void Control::note_frame_error(std::uint16_t q) noexcept {
    if (pending_.kind == Pending::Kind::none) last_ = {q, true, {}, never};
}

CommandReply Control::execute(std::uint16_t code, std::int64_t parameter, const Datum& data, Instant now) {
    advance(now);
    const CommandRow* row = find_command(code);
    CommandReply reply;
    bool refused = true;
    // Precedence: unknown, inadmissible (mode, blocked, another one in progress), then the command's own: parameter, value, state.
    if (row == nullptr) {
        reply.quit = 0x13;
    } else if ((row->gate & column()) == 0 || (row->blocked_by_modules && setup_.axis_modules)) {
        reply.quit = quit::inadmissible;
    } else if ((void)pending_reply(now), pending_.exclusive() && code != 0x0600 && code != 0x0603 && code != 0x0A81 && code != 0x0A93) {
        reply.quit = quit::inadmissible;  // the move goes on (E-69)
    } else {
        const Pending before = pending_;
        pending_ = {};
        reply = row->run(*this, Call{code, parameter, data, now});
        // One of those that pass, but refused: what runs keeps its end of processing.
        if (reply.quit != 0 && before.exclusive()) pending_ = before;
        refused = reply.quit != 0;
    }
    if (refused) reply.done = true;
    if (pending_.kind == Pending::Kind::none) last_ = reply;
    return reply;
}

CommandReply Control::begin_pending(Pending::Kind kind, int n, Instant now) {
    pending_ = {kind, n};
    settle(now);
    CommandReply r = pending_reply(now);
    if ((kind == Pending::Kind::move || kind == Pending::Kind::reference) && r.done && r.quit == 0 && axis(n).running()) r.done = false;
    return r;
}

CommandReply Control::pending_reply(Instant now) {
    CommandReply r;
    switch (pending_.kind) {
        case Pending::Kind::none:
            return last_;
        case Pending::Kind::move:
        case Pending::Kind::reference:
        case Pending::Kind::halt: {
            const Axis& a = axis(pending_.axis);
            r.data = pending_.kind == Pending::Kind::reference ? Datum{} : Datum::number(a.shaft().position(now));
            r.done = pending_.kind == Pending::Kind::halt ? !a.running() : !a.traverse().busy();
            if (r.done && pending_.kind != Pending::Kind::halt) r.quit = a.traverse().ended_with();
            break;
        }
        case Pending::Kind::mode: {
            const std::uint8_t s = mode_.status();
            const bool under_way = s == status::auto_started || s == status::auto_after_stop || s == status::online_started ||
                                   s == status::auto_stop || s == status::auto_stop_program || s == status::online_stop;
            r.done = !under_way && !mode_.leaving();
            if (!r.done) r.expected = mode_.deadline();
            break;
        }
    }
    if (r.done) {
        pending_ = {};
        last_ = r;
    }
    return r;
}

CommandReply Control::progress(Instant now) {
    advance(now);
    return pending_reply(now);
}

}  // namespace axisgate::pacontrol::twin
