// The process image of an IEF Werner PA-CONTROL in front of one to eight axes of any family: the CMD interface with its toggle, the CTRL
// interface with its low-active bits, one axis interface per axis; operating modes, flags, N and R registers. Reference: PA-CONTROL
// interfaces, chapters 2 (Profibus) and 5 (commands). There are no programs: AUTOMATIC is refused.
// Decisions where the manual is silent, or needs more than an axis: the CTRL and axis interfaces count as configured from the first write
// to them on. While an axis interface is configured, the axis commands of the CMD interface are blocked, as the manual says; without one,
// ONLINE enables the axes whose enable mode (axis parameter 32h) is 1, its value at the start.
#pragma once

#include <array>
#include <bitset>
#include <vector>

#include "gateway/registers/profiles/profile_map.hpp"

namespace axisgate::registers {

/// Command errors, chapter 9.2.
namespace pacontrol_errors {
inline constexpr std::uint16_t unknown_command = 0x13, inadmissible = 0x14, not_executable = 0x15, no_axis_of_number = 0x20,
                               no_axis_parameter = 0x21, no_system_parameter = 0x22, no_input = 0x23, no_output = 0x24, no_flag = 0x25,
                               no_integer = 0x26, no_real = 0x27, outside_value = 0x29, still_moves = 0x2A, no_reference = 0x2B,
                               switched_off = 0x37, outside_range = 0x41, no_measuring_mode = 0x6C;
}  // namespace pacontrol_errors

class PaControlMap final : public ProfileMap {
public:
    PaControlMap(const DoorPort& port, Setup setup);
    void on_own_result(std::uint32_t note, const Result& result) override;

private:
    static constexpr std::size_t elements = 1024;  ///< flags, N and R registers each
    enum class Meaning : std::uint8_t {
        cmd_data,
        cmd_parameter,
        cmd_code,
        ctrl,
        ack_data,
        ack_status,
        ack_code,
        ctrl_status,
        ctrl_error,
        axis_control,
        axis_acceleration,
        axis_speed,
        axis_target,
        axis_status,
        axis_cmd_error,
        axis_error,
        axis_position,
        other
    };
    enum class Mode : std::uint8_t { silent, home, online, stopping };
    enum class Asked : std::uint8_t { cmd, axis, power, nothing };  ///< the part that gets a result

    struct AxisState {
        double speed = 0, reference_speed = 0, manual_speed = 0, acceleration = 0;  ///< axis parameters 01, 02, 03, 06; 0: the drive's own
        double online_speed = 0, online_acceleration = 0;                           ///< of 0A8D and 0A8E, until ONLINE ends; 0: none
        double enable_mode = 1, target = 0;
        bool released = false;    ///< may move without a reference run: 0A83, G26
        bool configured = false;  ///< its axis interface was written
        bool based = false;       ///< the value before the first write is known: the base of an image
        std::uint32_t control = 0;
        bool active = false;         ///< a task of the axis interface is in progress
        std::uint32_t task_bit = 0;  ///< the bit of the control word that started it
        std::uint32_t sequence = 0;  ///< number of the task; the result of an older one is ignored
        std::uint16_t cmd_error = 0, axis_error = 0;
    };
    struct Reply {
        std::uint32_t data = 0;
        bool done = true, failed = false, live = false;  ///< BF, KF; the data are the axis' position until the task is done
        std::uint16_t error = 0;
        std::size_t axis = 0;
        std::uint32_t sequence = 0;
        unsigned waits = 0;  ///< number of outstanding results
    };

    [[nodiscard]] static Meaning meaning_of(const LanguageRow& row);
    bool shown(std::size_t row, Instant now, std::uint32_t& bits) override;
    Verdict taken(std::span<const Written> rows, WritePlan& plan) override;
    void adopted(std::span<const Written> rows, WritePlan& plan) override;

    // operating modes
    void take_ctrl(std::uint16_t word, WritePlan& plan);
    void start_online(WritePlan& plan);
    void stop_all(WritePlan& plan);
    void reset_faults(WritePlan& plan, Asked asked);
    void leave_online(WritePlan& plan);
    [[nodiscard]] std::uint16_t operating_status() const;
    [[nodiscard]] std::uint16_t ctrl_status() const;
    [[nodiscard]] bool any_moving() const;
    [[nodiscard]] std::uint16_t system_error() const;

    // CMD interface
    void execute(std::uint16_t code, std::uint16_t parameter, std::uint32_t data, WritePlan& plan);
    bool execute_mode(std::uint16_t code, WritePlan& plan);
    bool execute_element(std::uint16_t code, std::uint16_t parameter, std::uint32_t data);
    bool execute_parameter(std::uint16_t code, std::uint16_t parameter, std::uint32_t data);
    bool execute_read(std::uint16_t code, std::uint16_t parameter);
    bool execute_axis(std::uint16_t code, std::uint16_t parameter, std::uint32_t data, WritePlan& plan);
    void move_axis(std::size_t i, Move::Kind kind, double target, bool until_there, WritePlan& plan);
    [[nodiscard]] double* axis_parameter(std::size_t i, std::uint8_t number);
    void answer(std::uint32_t data);
    void answer(double value);
    void fail(std::uint16_t error);
    void wait_for(std::size_t i, CommandBody body, bool until_done, WritePlan& plan);

    // axis interfaces
    void take_axis(std::size_t i, std::uint32_t before, WritePlan& plan);
    void start_task(std::size_t i, WritePlan& plan);
    void switch_power(std::size_t i, bool on, WritePlan& plan);
    [[nodiscard]] std::uint32_t axis_status(std::size_t i) const;
    [[nodiscard]] std::uint16_t axis_number(std::size_t i) const;  ///< the value of 1910
    [[nodiscard]] bool referenced(std::size_t i) const { return axes_[i].released || flag(i, flag_referenced); }
    [[nodiscard]] Move move(std::size_t i, Move::Kind kind, double target, double speed, double acceleration) const;
    /// A position in the form of the axis interface: IEEE 754, or an integer in 1/1000.
    [[nodiscard]] std::uint32_t position_bits(double counts) const;
    [[nodiscard]] double position_of(std::uint32_t bits) const;
    [[nodiscard]] std::uint16_t error_of(const Result& result, bool motion) const;
    [[nodiscard]] static std::uint32_t note(Asked asked, std::size_t i, std::uint32_t sequence) {
        return (static_cast<std::uint32_t>(asked) << 28) | (static_cast<std::uint32_t>(i) << 24) | (sequence & 0xFF'FFFFu);
    }

    std::vector<Meaning> meanings_;                          // by row
    std::vector<std::uint32_t> values_;                      // by row: the words that the master wrote
    std::array<std::size_t, 3> cmd_rows_{};                  // data, parameter, code
    std::array<std::array<std::size_t, 4>, 8> axis_rows_{};  // control, acceleration, speed, target
    Mode mode_ = Mode::silent;
    bool integers_ = false, interfaces_ = false, ctrl_configured_ = false, ctrl_based_ = false;
    std::uint16_t ctrl_ = 0x0007;
    bool sf_ = false;
    Reply reply_;
    std::array<AxisState, 8> axes_;
    std::bitset<elements + 1> flags_;
    std::vector<std::uint32_t> integers_n_ = std::vector<std::uint32_t>(elements + 1), reals_ = std::vector<std::uint32_t>(elements + 1);
};

}  // namespace axisgate::registers
