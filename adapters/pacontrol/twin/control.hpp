// The control as a whole, whatever bus it hangs on: puts its parts together, takes commands and elements, and has their memory.
// In: commands (commands.hpp), control bits, axis tasks, outside conditions, time. Out: replies, states, its memory.
// Never knows bytes, frames or process images: the serial slave and the Profibus image both stand on this.
// Every call first lets time pass up to its `now`; events that were due happen at their own instants.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "adapters/pacontrol/twin/command_in_progress.hpp"
#include "adapters/pacontrol/twin/freedoms.hpp"
#include "adapters/pacontrol/twin/motions.hpp"
#include "adapters/pacontrol/twin/system_views.hpp"

namespace axisgate::pacontrol::twin {

struct ControlSetup {
    int axes = 1;  ///< built, 1..16
    AxisModel axis;
    ModeTimes times;
    std::vector<Program> programs{{"START", std::chrono::seconds(10), 0}};  ///< the first one is the START program, until it is changed
    std::size_t inputs = elements, outputs = elements, flags = elements, n = elements, r = elements;
    std::set<std::uint16_t> lasting{205};  ///< errors of class 2 that cannot be reset
    bool absolute = true;                  ///< factory value of axis parameter 25h
    bool axis_modules = false;  ///< the Profibus axis extension is configured: axis commands of the CMD interface are blocked [L640]
    int profibus_switches =
        0;  ///< 2..99: the address that the rotary switches hold; writing it is refused with 39h [L4072]. 1: E205 [L333-L335]
    Profile profile;
    std::map<int, double> rotary;  ///< axis: AE of a revolution
    ControlFreedoms freedoms;
};

class Control {
public:
    explicit Control(const ControlSetup& setup);
    Control(const Control&) = delete;
    Control& operator=(const Control&) = delete;

    // --- commands: serial text and the CMD interface ---
    /// Executes one of the 66 commands. The acknowledgement is immediate; `done` false means end of processing is outstanding.
    CommandReply execute(std::uint16_t code, std::int64_t parameter, const Datum& data, Instant now);
    /// The acknowledgement of the last command as it is now: live position while it runs; the last one repeated after that (E-16).
    CommandReply progress(Instant now);
    /// A command is in progress whose end of processing was not told.
    [[nodiscard]] bool pending() const noexcept { return in_progress_.pending(); }
    /// A frame error that a transport found takes the place of the last acknowledgement, unless a command is in progress.
    void note_frame_error(std::uint16_t quit) noexcept { in_progress_.note({quit, true, {}, never}); }
    /// For a command that is not done at once: settles what it has begun, and its acknowledgement.
    CommandReply begin(const CommandInProgress::Job& job, Instant now);

    // --- state ---
    void advance(Instant now) { operation_.advance(now); }
    void settle(Instant now) { operation_.settle(now); }
    [[nodiscard]] Instant deadline() const noexcept { return operation_.deadline(); }
    [[nodiscard]] std::uint8_t status() const noexcept { return operation_.status(); }   ///< operating status, decimal [L3991]
    [[nodiscard]] std::uint16_t error() const noexcept { return error_.number(); }       ///< PA-CONTROL error number, 0: none
    [[nodiscard]] std::uint16_t shown_error() const noexcept { return error_.shown(); }  ///< the one that is told
    [[nodiscard]] const ControlFreedoms& freedoms() const noexcept { return setup_.freedoms; }
    /// As many axes as this, 16 at most; those that come new are as the factory made them, the others go on as they are.
    void fit_axes(int n, Instant now);
    [[nodiscard]] int axes() const noexcept { return axes_.count(); }
    [[nodiscard]] const Axis& axis(int n) const { return axes_.at(n); }
    [[nodiscard]] Axis& axis(int n) { return axes_.at(n); }
    [[nodiscard]] const Settings& settings() const noexcept { return settings_; }
    [[nodiscard]] Settings& settings() noexcept { return settings_; }
    [[nodiscard]] const Signals& signals() const noexcept { return signals_; }
    [[nodiscard]] Orders& orders() noexcept { return orders_; }
    [[nodiscard]] Programs& programs() noexcept { return programs_; }
    [[nodiscard]] const Programs& programs() const noexcept { return programs_; }
    [[nodiscard]] Operation& operation() noexcept { return operation_; }
    [[nodiscard]] Motions& motions() noexcept { return motions_; }
    [[nodiscard]] const SystemViews& views() const noexcept { return views_; }

    // --- elements, also copied by the module interface in AUTOMATIC ---
    void set_output(std::int64_t n, bool on, Instant now);
    void set_flag(std::int64_t n, bool on, Instant now);
    void set_output_word(std::int64_t n, std::uint16_t word, Instant now);
    void set_flag_word(std::int64_t n, std::uint16_t word, Instant now);
    void set_n(std::int64_t n, std::int32_t v) noexcept { signals_.set_n(n, v); }
    void set_r(std::int64_t n, float v) noexcept { signals_.set_r(n, v); }

    // --- outside conditions (the tester's hand) ---
    void set_input(std::int64_t n, bool on, Instant now);
    void set_external_stop(bool powered, Instant now);

    // --- memory ---
    void power_on(const Memory& memory, Instant now);
    void power_off(Instant now) { operation_.power_off(now); }
    [[nodiscard]] Memory memory() const;
    [[nodiscard]] std::uint64_t revision() const noexcept {
        return power_ons_ + axes_.revision() + settings_.revision() + signals_.revision() + programs_.revision();
    }

private:
    /// 0, or the command error with which it is not even looked at.
    [[nodiscard]] std::uint16_t not_admitted(std::uint16_t code, Instant now) const;

    ControlSetup setup_;
    SystemError error_;
    Axes axes_;
    Settings settings_;
    Signals signals_;
    SystemViews views_;
    Orders orders_;
    Programs programs_;
    Operation operation_;
    Motions motions_;
    CommandInProgress in_progress_;
    Instant busy_until_ = Instant::min();
    std::uint64_t power_ons_ = 0;  ///< each of them is told as a change of the memory
};

}  // namespace axisgate::pacontrol::twin
