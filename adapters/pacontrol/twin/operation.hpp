// Operation: the operating mode with what it does to axes and errors, and the time of the control.
// In: starts, stops, errors, time. Out: the operating status, command errors; axes that stop, go on, are let go.
// Never starts a move but those of a program. Events that were due happen at their own instants, before what the call wants.
#pragma once

#include <set>
#include <string>

#include "adapters/pacontrol/twin/orders.hpp"
#include "adapters/pacontrol/twin/programs.hpp"
#include "adapters/pacontrol/twin/signals.hpp"

namespace axisgate::pacontrol::twin {

struct OperationRules {
    ModeTimes times;
    std::set<std::uint16_t> lasting;  ///< errors of class 2 that cannot be reset
    bool resumes_online = true;       ///< 0603 is admitted in status 35 (E-20)
    bool reference_outlives = true;   ///< without an absolute system, the reference flag outlives ONLINE
    bool axis_modules = false;        ///< an error of an axis stops that axis only and is told in its module [L711]
};

/// What the operating mode acts upon and asks.
struct OperationParts {
    Axes& axes;
    Orders& orders;
    Programs& programs;
    SystemError& error;
    const Settings& settings;
    const Signals& signals;
};

class Operation {
public:
    Operation(OperationRules rules, const OperationParts& parts) : rules_(std::move(rules)), mode_(rules_.times), with_(parts) {}

    [[nodiscard]] std::uint8_t status() const noexcept;  ///< operating status, decimal [L3991]
    [[nodiscard]] const Mode& mode() const noexcept { return mode_; }
    [[nodiscard]] bool online() const noexcept { return mode_.status() == status::online; }

    // --- time ---
    void advance(Instant now);
    [[nodiscard]] Instant deadline() const noexcept;
    /// After something of an axis changed: collects what it raised, and goes on with the mode and its program.
    void settle(Instant now);

    // --- commands, control bits, keys, inputs; a command error or 0 ---
    std::uint16_t start_automatic(Instant now);  ///< also the resumption from 15
    std::uint16_t start_online(Instant now);     ///< also the resumption from 35
    std::uint16_t stop(Instant now);             ///< interrupts all positioning
    /// `stop`, if AUTOMATIC or ONLINE is there and the external stop carries no power.
    void stop_if_open(Instant now);
    std::uint16_t cancel(Instant now);  ///< to home position, positions taken over
    /// Class 2 errors, in home position [L2770-2780]: 0, 14h elsewhere, 15h if it stays.
    std::uint16_t reset_error(Instant now);
    void emergency_stop(Instant now);  ///< (E-66)
    /// The operator at the front panel or with WINPAC: home, manual, winpac, automatic. Empty, or what is wrong.
    std::string panel(const std::string& mode, Instant now);

    // --- errors ---
    /// A system error by its class [L2770]; 0 takes it away.
    void raise(std::uint16_t number, Instant now);
    void raise_axis(int n, std::uint16_t number, Instant now);
    void reset_axis_error(int n, Instant now);

    // --- supply ---
    /// Home position, as after power on.
    void reset() noexcept { mode_.reset(); }
    /// The same, after the time of initialisation; AUTOMATIC starts by itself then.
    void initialise(bool autostart, Instant now) noexcept;
    /// The axes stand where they are, and what they want kept is taken over.
    void power_off(Instant now);

private:
    void step(Instant now);
    void collect(Instant now);
    void entered(Mode::Entered what, Instant now);
    void leave_to(std::uint8_t target, Instant now);
    void run_program(Instant now);

    OperationRules rules_;
    Mode mode_;
    OperationParts with_;
    bool autostart_ = false;  ///< when it is initialised
};

}  // namespace axisgate::pacontrol::twin
