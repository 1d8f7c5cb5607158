// Motions: what starts, changes and ends the moves of single axes, by command, by module and by hand, and under which condition they run.
// In: tasks, orders, time. Out: moves, command errors. Never starts one outside of ONLINE, but by the front panel in the manual mode;
// whether a command is allowed in a mode is the commands' gate.
#pragma once

#include "adapters/pacontrol/twin/operation.hpp"

namespace axisgate::pacontrol::twin {

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

struct MotionParts {
    Axes& axes;
    Orders& orders;
    Operation& operation;
    const Settings& settings;
    const Signals& signals;
};

/// Axes `n` = 1.. that are built.
class Motions {
public:
    Motions(const AxisModel& model, const MotionParts& parts) : model_(model), with_(parts) {}

    // --- 0 or a command error ---
    /// A positioning of the CMD interface with the axis' condition.
    [[nodiscard]] std::uint16_t start_move(int n, double value, bool relative, Task task, Instant now);
    [[nodiscard]] std::uint16_t start_task(int n, const AxisTask& task, Instant now);

    void set_axis_on(int n, bool on, Instant now);
    void disable_drive(int n, bool disabled, Instant now);
    void interrupt_axis(int n, Instant now);
    /// Speed given during a move; drives that cannot follow ignore it (E-12, E-67).
    void change_axis_speed(int n, std::uint32_t permille, Instant now);
    /// Front panel in the manual mode: -1, 1 moves, 0 stops.
    void jog(int n, int direction, Instant now);
    /// After an element changed: ends the moves whose condition does not hold any more.
    void check_conditions(Instant now);

private:
    [[nodiscard]] bool fulfilled(const Condition& c) const noexcept;
    [[nodiscard]] std::uint16_t start_with(int n, const Motion& m, const std::optional<Condition>& c, Instant now);

    AxisModel model_;
    MotionParts with_;
};

}  // namespace axisgate::pacontrol::twin
