// Error numbers of the drive that its twin raises (variable ER). In: nothing. Out: names for the numbers of the manual's list of error
// codes. Numbers that the twin never raises stand in the catalogue alone.
#pragma once

namespace axisgate::mcode::twin::err {

inline constexpr int already_so = 6;
inline constexpr int wrong_type = 8;
inline constexpr int typed = 9;
inline constexpr int no_such_point = 10;
inline constexpr int wrong_clock = 11;
inline constexpr int no_capture = 12;
inline constexpr int lmm_disabled = 14;
inline constexpr int unknown_set = 20;
inline constexpr int bad_value = 21;
inline constexpr int vi_too_large = 22;
inline constexpr int vm_too_small = 23;
inline constexpr int illegal_data = 24;
inline constexpr int read_only = 25;
inline constexpr int not_countable = 26;
inline constexpr int trip_undefined = 27;
inline constexpr int redefine_word = 29;
inline constexpr int unknown_name = 30;
inline constexpr int set_label = 32;
inline constexpr int set_instruction = 33;
inline constexpr int run_variable = 34;
inline constexpr int bad_print = 35;
inline constexpr int bad_ratio = 36;
inline constexpr int not_available = 37;
inline constexpr int separator = 38;
inline constexpr int two_trips = 39;
inline constexpr int not_running = 40;
inline constexpr int running = 41;
inline constexpr int bad_address = 42;
inline constexpr int stack_full = 43;
inline constexpr int locked = 44;
inline constexpr int not_program = 46;
inline constexpr int program_stopped = 48;
inline constexpr int unknown_command = 60;
inline constexpr int bad_baud = 61;
inline constexpr int already_pending = 62;
inline constexpr int warm = 71;
inline constexpr int hot = 72;
inline constexpr int saving_in_motion = 73;
inline constexpr int restoring_in_motion = 74;
inline constexpr int makeup_out = 76;
inline constexpr int too_large = 77;
inline constexpr int aux_out = 78;
inline constexpr int plus_v_out = 79;
inline constexpr int no_home_switch = 80;
inline constexpr int bad_type = 81;
inline constexpr int both_limits = 82;
inline constexpr int plus_limit = 83;
inline constexpr int minus_limit = 84;
inline constexpr int in_homing = 85;
inline constexpr int stall_detected = 86;
inline constexpr int in_motion = 87;
inline constexpr int in_calibration = 88;
inline constexpr int calibration_moving = 89;
inline constexpr int too_low = 90;
inline constexpr int motion_stopped = 91;
inline constexpr int position_error = 92;
inline constexpr int correcting = 93;
inline constexpr int disabled = 94;
inline constexpr int reverse_moving = 95;
inline constexpr int no_supply = 96;
inline constexpr int below_vi = 97;
inline constexpr int illegal_up = 98;
inline constexpr int illegal_down = 99;
inline constexpr int resolution_wrong = 100;
inline constexpr int calibration_disabled = 103;
inline constexpr int locked_rotor = 104;
inline constexpr int max_count = 105;
inline constexpr int lead_reached = 106;
inline constexpr int lag_reached = 107;
inline constexpr int calibration_lost = 109;
inline constexpr int makeup_stopped = 108;
inline constexpr int makeup_disabled = 110;

}  // namespace axisgate::mcode::twin::err
