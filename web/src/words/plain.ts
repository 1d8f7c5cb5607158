// Plain words: what the API calls states, commands and steps, as people call them. In: a sentence of the gateway. Out: the same sentence without
// words of the API. Pure. Names that people gave are left alone, unless somebody calls an axis `switch_on_disabled`.
const words: Record<string, string> = {
  not_ready_to_switch_on: 'not ready',
  switch_on_disabled: 'disabled',
  ready_to_switch_on: 'ready to switch on',
  switched_on: 'switched on',
  operation_enabled: 'enabled',
  quick_stop_active: 'in quick stop',
  fault_reaction_active: 'reacting to a fault',
  move_absolute: 'move to',
  move_relative: 'move by',
  move_velocity: 'move at',
  set_position: 'set position',
  reset_fault: 'reset fault',
  quick_stop: 'quick stop',
  wait_for: 'wait for',
  wait_s: 'wait',
  wait_register: 'wait for a register',
  set_parameter: 'set parameter',
  read_parameter: 'read parameter',
  write_register: 'write register',
  read_register: 'read register',
  profile_position: 'profile position',
  profile_velocity: 'profile velocity',
  set_points: 'set-points',
  set_points_silent: 'set-points silent',
};
const known = new RegExp(`(?<![\\w/"'.])(?:${Object.keys(words).join('|')})(?![\\w"'/])`, 'g');

export const plain = (text: string): string => text.replace(known, (w) => words[w] as string);
/** A word of a closed list, such as the kind of an event: `fault_cleared` is "fault cleared". */
export const plainWord = (word: string): string => words[word] ?? word.replaceAll('_', ' ');
