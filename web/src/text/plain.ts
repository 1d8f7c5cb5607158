// Plain words: what the API calls states, reasons, commands, steps, points and settings, as people call them: in the gateway's English sentences,
// and by themselves in the reader's language. In: a sentence or a word of the gateway. Out: the same without words of the API. Pure. Names that people gave are left alone, unless somebody
// calls an axis `switch_on_disabled`.
import { word } from '../language';

const shown: Record<string, string> = {
  not_ready_to_switch_on: 'not ready',
  switch_on_disabled: 'disabled',
  operation_enabled: 'enabled',
  quick_stop_active: 'in quick stop',
  fault_reaction_active: 'reacting to a fault',
  move_absolute: 'move to',
  move_relative: 'move by',
  move_velocity: 'move at',
  wait_s: 'wait',
  wait_register: 'wait for a register',
  set_points: 'set-points',
  set_points_silent: 'set-points silent',
  dds_deadline: 'DDS deadline missed',
  wrong_state: 'not possible in this state',
  bus_off: 'off the bus',
  position_units: 'position in units',
  velocity_units: 'velocity in units',
};
/** States, commands and steps of which only the underscores go. */
const states = 'ready_to_switch_on switched_on set_position reset_fault quick_stop wait_for set_parameter read_parameter write_register read_register not_supported'.split(' ');
/** Points, settings and kinds of which only the underscores go; a unit at the end is told as one. */
const spaced =
  'profile_position profile_velocity profile_torque interpolated_position cyclic_position cyclic_velocity cyclic_torque holding_registers input_registers discrete_inputs high_first low_first ' +
  'position_min position_max velocity_max acceleration_max deceleration_max following_error_max silent_limit increments_per_unit fail_safe modbus_units default_bit_rate ' +
  'retry_pause_min_ms retry_pause_max_ms retry_pause_ms reply_timeout_ms poll_period_ms stale_after_ms pause_ms hold_ms watchdog_ms timeout_s ' +
  'target_reached internal_limit position_demand following_error target_position target_velocity position_increments velocity_increments error_code mode_number ' +
  'not_stored not_run no_answer line_down line_lost lease_ended modbus_closed modbus_silent enip_closed enip_idle enip_timed_out enip_session_closed enip_silent gateway_ends ethernet_ip open_loop ' +
  'fault_cleared can_error standard_map read_only word_order axis_number';
const unscored = (word: string): string => word.replace(/_(ms|s)$/, ' in $1').replaceAll('_', ' ');
// A point may stand behind its axis and a dot; a state, a command or a step never does: there it is a part of a name.
const known = new RegExp(`(?<![\\w/"'.])(?:${[...Object.keys(shown), ...states].join('|')})(?![\\w"'/])|(?<![\\w/"'])(?:position_units|velocity_units|${spaced.replaceAll(' ', '|')})(?![\\w"'/])`, 'g');

const english = (word: string): string => shown[word] ?? unscored(word);

/** A sentence of the gateway, which is English in every language of the page: so are the words in it. */
export const plain = (text: string): string => text.replace(known, english);

/** A word of a closed list, such as the kind of an event: `fault_cleared` is "fault cleared". */
export function plainWord(name: string): string {
  return word(english(name));
}
