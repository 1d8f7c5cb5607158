// Coded values of a MACS: parameters whose digits or bits have separate meanings. A value without a meaning is refused; there are no
// defaults. [L2941-3177, L3178-3260, L4303-4418, L4508-4616, L4784-5003, L6529-6583, L6832-6971]
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace axisgate::aposs {

enum class Encoder : std::uint8_t { incremental, absolute, linear_absolute, sine_cosine, simulation, axis_command, can, ethercat };
/// ENCODERTYPE, MENCODERTYPE.
struct EncoderCode {
    Encoder source = Encoder::incremental;
    int number = 0;        ///< local terminal 1 to 3, axis of a linked command value, node on a bus; 0: none
    bool guarded = false;  ///< its node is guarded: error 88
    bool slave_bus = false;
    int device = 0;               ///< kind of bus device, 0 to 99
    int pdo = 0, first_long = 0;  /// EtherCAT: position in this 32-bit word, index in the next one; CAN: 2 or 3
    [[nodiscard]] bool absolute() const {
        return source == Encoder::absolute || source == Encoder::linear_absolute || (source == Encoder::can && device == 50);
    }
    bool operator==(const EncoderCode&) const = default;
};
[[nodiscard]] std::optional<EncoderCode> encoder_of(std::int64_t value, bool of_master);

/// REVERS: mode + 10 * direction output + 100 * node on the bus; -10 to -90: two enable outputs.
struct ReversCode {
    int mode = 0;              ///< 0: reversing is allowed, 1: only while the master reverses, 2: never
    int direction_output = 0;  ///< 0: bipolar reference
    bool two_outputs = false;  ///< this output and the next one enable the two directions
    int node = 0;
    bool operator==(const ReversCode&) const = default;
};
[[nodiscard]] std::optional<ReversCode> revers_of(std::int64_t value);

/// POSDRCT.
struct DirectionCode {
    bool velocity_inverse = false, position_inverse = false, units_inverse = false;
    bool operator==(const DirectionCode&) const = default;
};
[[nodiscard]] std::optional<DirectionCode> direction_of(std::int64_t value);

/// SYNCMTYPM, SYNCMTYPS, VMENCMTYP: units are the kind, tens the latch input, hundreds a gate (SYNCMTYPM only).
struct MarkerCode {
    bool external = false, falling = false;
    int input = 0;  ///< 1 to 9; 0: the input with the number of the encoder
    int gate = 0;   ///< input that must be high, if negative low; 0: none
    bool operator==(const MarkerCode&) const = default;
};
[[nodiscard]] std::optional<MarkerCode> marker_of(std::int64_t value, bool with_gate);

/// DRIVETYPE.
struct DriveCode {
    int type = 0;           ///< 0: local analog output
    bool guarded = false;   ///< its node is guarded: error 88
    bool own_word = false;  ///< +/-100: the controller does not change the control word
    bool operator==(const DriveCode&) const = default;
};
[[nodiscard]] std::optional<DriveCode> drive_of(std::int64_t value);

/// PRGPAR: the program after the autostart program, and whether the motors stay off at power-on.
struct ProgramCode {
    int program = -1;
    bool motors_off = false;
    bool operator==(const ProgramCode&) const = default;
};
[[nodiscard]] std::optional<ProgramCode> program_of(std::int64_t value);

/// The inputs from I_PRGCHOICE to the one before I_PRGSTART as a binary number, the lowest input as bit 0; empty: it is not 0 to 89 (E-34).
[[nodiscard]] std::optional<int> chosen_program(std::uint32_t inputs, std::int64_t choice, std::int64_t start);

/// VMENCTYP: the source of the virtual master's speed.
struct VirtualMasterCode {
    int axis = 0;  ///< 0: PULSVEL; n: command velocity of axis n
    int encoder = 0;
    bool no_output = false;
    bool operator==(const VirtualMasterCode&) const = default;
};
[[nodiscard]] std::optional<VirtualMasterCode> virtual_master_of(std::int64_t value);

/// CANBAUD of a controller with two buses: master, slave, in kBaud; a single digit sets both.
[[nodiscard]] std::optional<std::pair<int, int>> baud_of(std::int64_t value);

/// False: the parameter is coded and the value has no meaning. True for every other parameter.
[[nodiscard]] bool means_something(std::string_view id, std::int64_t value);

}  // namespace axisgate::aposs
