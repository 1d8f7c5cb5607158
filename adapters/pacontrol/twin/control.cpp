// The control: commands in progress, mode control, time.
// In: commands, conditions, time. Out: replies, states. Never lets an event wait for a call: each happens at its own instant.
#include "adapters/pacontrol/twin/control.hpp"

#include "adapters/pacontrol/twin/commands.hpp"

namespace axisgate::pacontrol::twin {
Control::Control(const ControlSetup& setup)
    : setup_(setup),
      axes_(setup.axes, setup.axis, setup.rotary, setup.profile.usual_axis(setup.absolute)),
      settings_(setup.profile, setup.profile.usual_axis(setup.absolute), setup.profibus_switches, axes_),
      signals_({Bits{setup.inputs}, Bits{setup.outputs}, Bits{setup.flags}, Registers<std::int32_t>{setup.n}, Registers<float>{setup.r}},
               settings_.system(), error_),
      views_(axes_, error_),
      orders_(axes()),
      programs_(setup.programs),
      operation_({setup.times, setup.lasting, setup.axis_modules}, {axes_, orders_, programs_, error_, settings_, signals_}),
      motions_(setup.axis, {axes_, orders_, operation_, settings_, signals_}) {}

void Control::fit_axes(int n, Instant now) {
    advance(now);
    settings_.fit(n);
    orders_.fit(axes());
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
    } else if ((row->gate & column_of(status())) == 0 || (row->blocked_by_modules && setup_.axis_modules)) {
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
            const std::uint8_t s = operation_.mode().status();
            const bool under_way = s == status::auto_started || s == status::auto_after_stop || s == status::online_started ||
                                   s == status::auto_stop || s == status::auto_stop_program || s == status::online_stop;
            r.done = !under_way && !operation_.mode().leaving();
            if (!r.done) r.expected = operation_.mode().deadline();
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

// --- elements ---

void Control::set_input(std::int64_t n, bool on, Instant now) {
    advance(now);
    const bool before = signals_.elements().inputs.get(n);
    signals_.set_input(n, on);
    if (on && !before && n == settings_.system()[sp::start_input]) (void)operation_.start_automatic(now);
    operation_.stop_if_open(now);
    motions_.check_conditions(now);
}

void Control::set_external_stop(bool powered, Instant now) {
    advance(now);
    signals_.set_external_stop(powered);
    operation_.stop_if_open(now);
    motions_.check_conditions(now);
}

void Control::set_output(std::int64_t n, bool on, Instant now) {
    signals_.set_output(n, on);
    motions_.check_conditions(now);
}

void Control::set_flag(std::int64_t n, bool on, Instant now) {
    signals_.set_flag(n, on);
    motions_.check_conditions(now);
}

void Control::set_output_word(std::int64_t n, std::uint16_t word, Instant now) {
    signals_.set_output_word(n, word);
    motions_.check_conditions(now);
}

void Control::set_flag_word(std::int64_t n, std::uint16_t word, Instant now) {
    signals_.set_flag_word(n, word);
    motions_.check_conditions(now);
}

// --- memory: each part keeps its own (E-65) ---

Memory Control::memory() const {
    Memory m;
    signals_.keep(m);
    settings_.keep(m);
    axes_.keep(m);
    programs_.keep(m);
    return m;
}

void Control::power_on(const Memory& memory, Instant now) {
    signals_.forget();
    settings_.forget();
    axes_.forget();
    orders_.forget();
    programs_.forget();
    for (const auto& [name, value] : memory) {
        (void)(signals_.restore(name, value) || settings_.restore(name, value) || axes_.restore(name, value) ||
               programs_.restore(name, value));
    }
    axes_.boot();
    operation_.reset();
    error_.clear();
    if (setup_.profibus_switches == 1) error_.note(error::rotary_switches);
    pending_ = {};
    last_ = {};
    ++power_ons_;
    if (settings_.system()[sp::autostart] != 0) (void)operation_.start_automatic(now);
}

}  // namespace axisgate::pacontrol::twin
