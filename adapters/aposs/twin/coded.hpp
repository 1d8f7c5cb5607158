// Coded values of a MACS: parameters whose digits or bits mean something each, taken apart.
// In: the number as it is written. Out: what it says, or nothing if it says nothing: such a value is refused. Never a default.
// [L2941-3177, L3178-3260, L4303-4418, L4508-4616, L4784-5003, L6529-6583, L6832-6971]
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
    int number = 0;        ///< local terminal 1 to 3, axis of a linked command value, node on a bus; 0: none is named
    bool guarded = false;  ///< its node is watched: error 88
    bool slave_bus = false;
    int device = 0;               ///< kind of bus device, 0 to 99
    int pdo = 0, first_long = 0;  /// EtherCAT: place at this long, index at the one behind; CAN: 2 or 3
    [[nodiscard]] bool absolute() const {
        return source == Encoder::absolute || source == Encoder::linear_absolute || (source == Encoder::can && device == 50);
    }
    bool operator==(const EncoderCode&) const = default;
};
[[nodiscard]] std::optional<EncoderCode> encoder_of(std::int64_t value, bool of_master);

/// REVERS: mode + 10 * direction output + 100 * node on the bus; -10 to -90: two enable outputs.
struct ReversCode {
    int mode = 0;              ///< 0: reverse is allowed, 1: only while the master reverses, 2: never
    int direction_output = 0;  ///< 0: bipolar reference
    bool two_outputs = false;  ///< that output and the next one enable the two directions
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

/// SYNCMTYPM, SYNCMTYPS, VMENCMTYP: units kind, tens latch input, hundreds a gate (SYNCMTYPM alone).
struct MarkerCode {
    bool external = false, falling = false;
    int input = 0;  ///< 1 to 9; 0: that of the encoder's number
    int gate = 0;   ///< input that must be high, below 0: low; 0: none
    bool operator==(const MarkerCode&) const = default;
};
[[nodiscard]] std::optional<MarkerCode> marker_of(std::int64_t value, bool with_gate);

/// DRIVETYPE.
struct DriveCode {
    int type = 0;           ///< 0: local analog output
    bool guarded = false;   ///< its node is watched: error 88
    bool own_word = false;  ///< +/-100: the controller leaves the control word alone
    bool operator==(const DriveCode&) const = default;
};
[[nodiscard]] std::optional<DriveCode> drive_of(std::int64_t value);

/// PRGPAR: the program after the autostart program, and whether motors stay off at power-on.
struct ProgramCode {
    int program = -1;
    bool motors_off = false;
    bool operator==(const ProgramCode&) const = default;
};
[[nodiscard]] std::optional<ProgramCode> program_of(std::int64_t value);

/// I_PRGCHOICE up to the input before I_PRGSTART, as a binary number, the lowest input its lowest bit; nothing: none of 0 to 89 (E-34).
[[nodiscard]] std::optional<int> chosen_program(std::uint32_t inputs, std::int64_t choice, std::int64_t start);

/// VMENCTYP: where the virtual master's speed comes from.
struct VirtualMasterCode {
    int axis = 0;  ///< 0: PULSVEL; n: command velocity of axis n
    int encoder = 0;
    bool no_output = false;
    bool operator==(const VirtualMasterCode&) const = default;
};
[[nodiscard]] std::optional<VirtualMasterCode> virtual_master_of(std::int64_t value);

/// CANBAUD of a controller with two buses: master, slave, in kBaud; one digit is both.
[[nodiscard]] std::optional<std::pair<int, int>> baud_of(std::int64_t value);

/// False: a coded parameter that does not mean anything with this value. True of every other parameter.
[[nodiscard]] bool means_something(std::string_view id, std::int64_t value);

}  // namespace axisgate::aposs
