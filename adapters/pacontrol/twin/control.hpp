// The control as a whole, whatever bus it hangs on: operating mode, axes, elements, parameters, system errors, the command in progress.
// In: commands (commands.hpp), control bits, axis tasks, outside conditions, time. Out: replies, states, its memory.
// Never knows bytes, frames or process images: the serial slave and the Profibus image both stand on this.
// Every call first lets time pass up to its `now`; events that were due happen at their own instants.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "adapters/pacontrol/twin/mode.hpp"
#include "adapters/pacontrol/twin/orders.hpp"
#include "adapters/pacontrol/twin/settings.hpp"
#include "adapters/pacontrol/twin/signals.hpp"
#include "adapters/pacontrol/twin/system_views.hpp"

namespace axisgate::pacontrol::twin {

/// Acknowledgement of a command without its transport: QUIT / KF, BE / BF, data.
struct CommandReply {
    std::uint16_t quit = 0;
    bool done = true;
    Datum data;
    /// Not done: when it is expected to be, if it is a matter of the mode machine's own times; `never` otherwise.
    Instant expected = never;
};

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
};

/// A traverse task of the module/axis interface [L660-L690].
struct AxisTask {
    enum class Kind : std::uint8_t {
        reference,  ///< G25
        set_g26,
        set_g29,  ///< with `value`
        absolute,
        relative,
        free_positive,
        free_negative,  ///< without reference and range check, `value` is the range
        to_max,
        to_min,
        delete_g29,
        reset_displaced
    };
    Kind kind = Kind::absolute;
    double value = 0;                            ///< AE
    std::uint32_t acceleration_permille = 1000;  ///< of axis parameter 06: 1..65535
    std::uint32_t speed_permille = 1000;         ///< of axis parameter 01: 1..1000
    std::optional<bool> while_input;             ///< control bits 8 / 9, absolute and relative only
    bool limits_monitored = true;                ///< false: G142
};

class Control {
public:
    explicit Control(const ControlSetup& setup);

    // --- commands: serial text and the CMD interface ---
    /// Executes one of the 66 commands. The acknowledgement is immediate; `done` false means end of processing is outstanding.
    CommandReply execute(std::uint16_t code, std::int64_t parameter, const Datum& data, Instant now);
    /// The acknowledgement of the last command as it is now: live position while it runs; the last one repeated after that (E-16).
    CommandReply progress(Instant now);
    [[nodiscard]] bool in_progress() const noexcept { return pending_.kind != Pending::Kind::none; }
    /// A frame error that a transport found takes the place of the last acknowledgement, unless a command is in progress.
    void note_frame_error(std::uint16_t quit) noexcept;

    // --- mode control: commands, control bits, keys, inputs; a command error or 0 ---
    std::uint16_t start_automatic(Instant now);  ///< also the resumption from 15
    std::uint16_t start_online(Instant now);     ///< also the resumption from 35
    std::uint16_t stop(Instant now);             ///< interrupts all positioning
    std::uint16_t cancel(Instant now);           ///< to home position, positions taken over
    /// Class 2 errors, in home position [L2770-2780]: 0, 14h elsewhere, 15h if it stays.
    std::uint16_t reset_error(Instant now);
    void emergency_stop(Instant now);  ///< (E-66)
    /// The operator at the front panel or with WINPAC: home, manual, winpac, automatic. Empty, or what is wrong.
    std::string panel(const std::string& mode, Instant now);

    // --- axes by the module interface; `n` = 1..axes() ---
    std::uint16_t start_task(int n, const AxisTask& task, Instant now);
    void set_axis_on(int n, bool on, Instant now);
    void disable_drive(int n, bool disabled, Instant now);
    void interrupt_axis(int n, Instant now);
    void resume_axis(int n, Instant now);
    void reset_axis_error(int n, Instant now);
    /// Speed given during a move; drives that cannot follow ignore it (E-12, E-67).
    void change_axis_speed(int n, std::uint32_t permille, Instant now);

    // --- state ---
    void advance(Instant now);
    [[nodiscard]] Instant deadline() const noexcept;
    [[nodiscard]] std::uint8_t status() const noexcept;  ///< operating status, decimal [L3991]
    [[nodiscard]] std::uint8_t column() const noexcept { return column_of(status()); }
    [[nodiscard]] std::uint16_t error() const noexcept { return error_.number(); }  ///< PA-CONTROL error number, 0: none
    /// As many axes as this, 16 at most; those that come new are as the factory made them, the others go on as they are.
    void fit_axes(int n, Instant now);
    [[nodiscard]] int axes() const noexcept { return axes_.count(); }
    [[nodiscard]] const Axis& axis(int n) const { return axes_.at(n); }
    [[nodiscard]] Axis& axis(int n) { return axes_.at(n); }
    [[nodiscard]] bool axis_modules() const noexcept { return setup_.axis_modules; }
    [[nodiscard]] const Settings& settings() const noexcept { return settings_; }
    [[nodiscard]] Settings& settings() noexcept { return settings_; }
    [[nodiscard]] const Signals& signals() const noexcept { return signals_; }
    [[nodiscard]] const SystemViews& views() const noexcept { return views_; }

    // --- elements, also copied by the module interface in AUTOMATIC ---
    void set_output(std::int64_t n, bool on, Instant now);
    void set_flag(std::int64_t n, bool on, Instant now);
    void set_output_word(std::int64_t n, std::uint16_t word, Instant now);
    void set_flag_word(std::int64_t n, std::uint16_t word, Instant now);
    void set_n(std::int64_t n, std::int32_t v) noexcept { signals_.set_n(n, v); }
    void set_r(std::int64_t n, float v) noexcept { signals_.set_r(n, v); }
    // --- what the command table needs ---
    [[nodiscard]] Orders& orders() noexcept { return orders_; }
    /// A positioning of the CMD interface with the axis' condition; 0 or a command error.
    std::uint16_t start_move(int n, double value, bool relative, Task task, Instant now);
    struct Pending {
        enum class Kind : std::uint8_t { none, move, reference, halt, mode };
        Kind kind = Kind::none;
        int axis = 0;
        /// While it runs nothing but polls, 0600, 0603, 0A81 and 0A93 is taken (E-69).
        [[nodiscard]] bool exclusive() const noexcept { return kind == Kind::move || kind == Kind::reference; }
    };
    [[nodiscard]] const Pending& pending() const noexcept { return pending_; }
    CommandReply begin_pending(Pending::Kind kind, int axis, Instant now);

    // --- outside conditions (the tester's hand) ---
    void set_input(std::int64_t n, bool on, Instant now);
    void set_external_stop(bool powered, Instant now);
    /// A system error by its class [L2770]; 0 takes it away.
    void raise(std::uint16_t number, Instant now);
    void raise_axis(int n, std::uint16_t number, Instant now);
    bool select_program(const std::string& name);
    [[nodiscard]] const std::string& program() const { return setup_.programs.at(program_).name; }
    void jog(int n, int direction, Instant now);
    /// After the hand changed something of an axis: collects what it raised.
    void settle(Instant now);

    // --- memory ---
    void power_on(const Memory& memory, Instant now);
    void power_off(Instant now);
    [[nodiscard]] Memory memory() const;
    [[nodiscard]] std::uint64_t revision() const noexcept {
        return revision_ + axes_.revision() + settings_.revision() + signals_.revision();
    }

private:
    void step(Instant now);
    void collect(Instant now);
    void entered(Mode::Entered what, Instant now);
    void leave_to(std::uint8_t target, Instant now);
    void run_program(Instant now);
    void check_conditions(Instant now);
    void check_stop_input(Instant now);
    [[nodiscard]] bool fulfilled(const Condition& c) const noexcept;
    [[nodiscard]] CommandReply pending_reply(Instant now);
    [[nodiscard]] std::uint16_t start_with(int n, const Motion& m, const std::optional<Condition>& c, Instant now);

    ControlSetup setup_;
    Mode mode_;
    SystemError error_;
    Axes axes_;
    Settings settings_;
    Signals signals_;
    SystemViews views_;
    Orders orders_;
    std::size_t program_ = 0;
    std::size_t program_move_ = 0;     ///< of the program that runs: the next one
    std::optional<int> program_axis_;  ///< that it waits for
    Pending pending_;
    CommandReply last_;
    std::uint64_t revision_ = 0;
};

}  // namespace axisgate::pacontrol::twin
