// The control: what a command, an element and the supply cause in its parts. In: commands, values, memory. Out: replies, memory.
// Never decides what a part can decide by itself.
#include "adapters/pacontrol/twin/control.hpp"

#include "adapters/pacontrol/twin/commands.hpp"

namespace axisgate::pacontrol::twin {
namespace {
bool is_stop(std::uint16_t code) { return code == 0x0600 || code == 0x0A41 || code == 0x0A81 || code == 0x0A93 || code == 0x0A98; }
bool changes_mode(std::uint16_t code) { return code == 0x0600 || code == 0x0602 || code == 0x0603 || code == 0x0A41 || code == 0x0A81; }
}  // namespace

Control::Control(const ControlSetup& setup)
    : setup_(setup),
      error_(setup.freedoms.error_shown, setup.freedoms.error_cleared),
      axes_(setup.axes, setup.axis, setup.rotary, setup.profile.usual_axis(setup.absolute)),
      settings_(setup.profile, setup.profile.usual_axis(setup.absolute), setup.profibus_switches, axes_),
      signals_({Bits{setup.inputs}, Bits{setup.outputs}, Bits{setup.flags}, Registers<std::int32_t>{setup.n}, Registers<float>{setup.r}},
               settings_.system(), error_, setup.freedoms.io_scan),
      views_(axes_, error_),
      orders_(axes()),
      programs_(setup.programs),
      operation_({setup.times, setup.lasting, setup.freedoms.online_resumes, setup.freedoms.reference_outlives, setup.axis_modules},
                 {axes_, orders_, programs_, error_, settings_, signals_}),
      motions_(setup.axis, {axes_, orders_, operation_, settings_, signals_}),
      in_progress_(axes_, operation_) {}

void Control::fit_axes(int n, Instant now) {
    advance(now);
    settings_.fit(n);
    orders_.fit(axes());
}

// --- commands ---

/// Precedence: unknown, not initialised, inadmissible in this mode or blocked by modules, not executable yet.
std::uint16_t Control::not_admitted(std::uint16_t code, Instant now) const {
    const CommandRow* row = find_command(code);
    const bool listed_elsewhere = code == 0x0A96 || code == 0x0A97 || code == 0x0A98 || code == 0x0A9A;
    const bool of_system = code == 0x1934 || code == 0x1935 || code == 0x1937;
    if (row == nullptr || (listed_elsewhere && setup_.freedoms.switching == Switching::unknown) ||
        (of_system && !setup_.freedoms.system_elements))
        return quit::unknown_command;
    if (status() == status::none) return quit::not_initialised;
    if ((row->gate & column_of(status())) == 0) return setup_.freedoms.wrong_mode;
    if (row->blocked_by_modules && setup_.axis_modules) return quit::inadmissible;
    return now < busy_until_ && !is_stop(code) ? quit::not_executable : quit::ok;
}

CommandReply Control::execute(std::uint16_t code, std::int64_t parameter, const Datum& data, Instant now) {
    advance(now);
    signals_.scan(now);
    const CommandRow* row = find_command(code);
    CommandReply reply;
    bool refused = true;
    // Not admitted, another one in progress, then the command's own: parameter, value, state.
    if (const std::uint16_t q = not_admitted(code, now); q != 0) {
        reply.quit = q;
    } else if ((void)in_progress_.reply(now),
               in_progress_.exclusive() && code != 0x0600 && code != 0x0603 && code != 0x0A81 && code != 0x0A93) {
        reply.quit = quit::inadmissible;  // the move goes on (E-69)
        reply.unanswered = setup_.freedoms.excluded_unanswered;
    } else {
        const auto before = in_progress_.set_aside();
        reply = row->run(*this, Call{code, parameter, data, now});
        // One of those that pass, but refused: what runs keeps its end of processing.
        if (reply.quit != 0) in_progress_.take_up(before);
        refused = reply.quit != 0;
        if (!refused && changes_mode(code)) busy_until_ = now + setup_.freedoms.busy;
    }
    if (refused) reply.done = true;
    in_progress_.note(reply);
    return reply;
}

CommandReply Control::begin(const CommandInProgress::Job& job, Instant now) {
    settle(now);
    return in_progress_.begin(job, now);
}

CommandReply Control::progress(Instant now) {
    advance(now);
    return in_progress_.reply(now);
}

// --- elements ---

void Control::set_input(std::int64_t n, bool on, Instant now) {
    advance(now);
    signals_.scan(now);
    const bool before = signals_.elements().inputs.get(n);
    signals_.set_input(n, on);
    if (on && !before && n == settings_.system()[sp::start_input]) (void)operation_.start_automatic(now);
    operation_.stop_if_open(now);
    motions_.check_conditions(now);
}

void Control::set_external_stop(bool powered, Instant now) {
    advance(now);
    signals_.scan(now);
    signals_.set_external_stop(powered);
    operation_.stop_if_open(now);
    motions_.check_conditions(now);
}

void Control::set_output(std::int64_t n, bool on, Instant now) {
    signals_.scan(now);
    signals_.set_output(n, on);
    motions_.check_conditions(now);
}

void Control::set_flag(std::int64_t n, bool on, Instant now) {
    signals_.set_flag(n, on);
    motions_.check_conditions(now);
}

void Control::set_output_word(std::int64_t n, std::uint16_t word, Instant now) {
    signals_.scan(now);
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
    error_.forget();
    busy_until_ = Instant::min();
    const bool autostart = settings_.system()[sp::autostart] != 0;
    const bool initialises = setup_.times.initialise > Duration::zero();
    if (initialises) {
        operation_.initialise(autostart, now);
    } else {
        operation_.reset();
    }
    if (setup_.profibus_switches == 1) error_.note(error::rotary_switches);
    in_progress_.forget();
    ++power_ons_;
    if (autostart && !initialises) (void)operation_.start_automatic(now);
}

}  // namespace axisgate::pacontrol::twin
