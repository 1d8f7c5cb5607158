// Language lists: what is no text for people although it looks like some, by file, each with its reason; and words that the page makes of names of the
// API, and so says without a literal. In: nothing. Out: lists for language.mjs.

/** @type {Record<string, RegExp[]>} */
export const exempt = {
  // The gateway's sentences are English in every language, and the words in them with it; by themselves the same words are said through t().
  'text/plain.ts': [/^[a-z_ -]+$/, /^DDS deadline missed$/],
  // Units of the SI, and the form of a date by ISO 8601, are the same in every language.
  'text/time.ts': [/^(< 1 s|\{…\} (s|min|h|d))$/],
  // A request's header, and what a programmer is told.
  'api/client.ts': [/^application\//],
  'api/site.ts': [/^application\//],
  'api/problem.ts': [/^Problem$/],
  'gateway.ts': [/^no gateway around/],
  // Names: of the product, of files, of a door and its client.
  'app.tsx': [/axisgate$/],
  'components/frame.tsx': [/^axisgate$/],
  'components/strip.tsx': [/^counted/],
  'components/authority.tsx': [/^modbus 192/],
  'components/language.tsx': [/^\{…\} · Language$/],
  'components/icon.tsx': [/^false$/],
  'pages/gateway.tsx': [/^API$/, /^openapi\.yaml$/],
  'pages/sign-in.tsx': [/^K7QF/],
  // What stands in a file that programs read, or in the file that the gateway writes: its columns and keys are the same in every language.
  'text/alarm.ts': [/^\(code \{…\}\)$/, /^by \{…\}$/],
  'state/scope.ts': [/^ ?\(mixed: \{…\}\)$/],
  'text/transfer.ts': [/^\{"parameter", "value"\}$/],
  'text/site.ts': [/^URI$/, /^can:can0/, /^lines, drives, axes/],
  'components/mapping-paste.tsx': [/^unit[,\t]/],
  'components/assembly-table.tsx': [/^instance(, |\t)direction/],
  'components/mapping-list.tsx': [/^RW$/],
  'components/description-objects.tsx': [/^PDO$/],
  'text/help.ts': [/^descriptions$/],
  // Words of a recipe's JSON, by which its steps are told apart; the label beside each is said through t().
  'text/recipe.ts': [/^(enable|disable|home|command|set_parameter|read_parameter|action|write_register|simulate|wait_for|check|wait_s|if|repeat|message)$/],
  // Keys of lists and choices.
  'text/errors.ts': [/^(axis|line|drive|offline) \{…\}( \{…\})?$/],
  'components/parameter-compare.tsx': [/^snapshot:\{…\}$/],
  // Measures of the style sheet, and names within a drawing.
  'components/mapping-map.tsx': [/^\{…\}px$/],
  'components/mapping-row.tsx': [/^\{…\}px$/, /^\{…\} \/ span \{…\}$/],
  'components/state-machine.tsx': [/^url\(#arrow\)$/, /^auto-start-reverse$/],
  // Forms of files, and the line of a program, as a shell takes it.
  'components/trace.tsx': [/^(pcapng|candump)$/],
  'text/hmi-line.ts': [/^mbpoll /],
  // Units.
  'text/site-files.ts': [/^\{…\} (KiB|MiB)$/],
  'text/site-tree.ts': [/^\{…\} bit\/s$/],
};

/** What `word()` is asked for: states, points, settings, kinds and reasons of the API (text/plain.ts); conditions of twins (text/hand.ts). */
export const derived = [
  'DDS deadline missed', 'acceleration max', 'accepted', 'access', 'alarm', 'authority', 'axis number', 'can error', 'capture', 'command', 'cyclic position',
  'cyclic torque', 'cyclic velocity', 'deceleration max', 'default bit rate', 'demand', 'disable', 'disabled', 'discrete inputs', 'done', 'drive', 'enable', 'enabled',
  'enip closed', 'enip idle', 'enip timed out', 'error', 'error code', 'ethernet ip', 'event', 'fail safe', 'false', 'fault', 'fault cleared', 'fleet', 'following error',
  'following error max', 'gap', 'gateway ends', 'halt', 'hand', 'high first', 'hold', 'hold in ms', 'holding registers', 'home', 'in quick stop', 'increments per unit',
  'info', 'input', 'input registers', 'internal limit', 'interpolated position', 'kind', 'lease ended', 'limit', 'line', 'line down', 'line lost', 'log', 'low first',
  'message', 'modbus closed', 'modbus rtu', 'modbus silent', 'modbus units', 'mode number', 'move at', 'move by', 'move to', 'moving', 'no answer',
  'not possible in this state', 'not ready', 'not run', 'not stored', 'not supported', 'off the bus', 'online', 'open loop', 'output', 'parameters', 'parameters differ',
  'pause in ms', 'poll period in ms', 'position', 'position demand', 'position in units', 'position increments', 'position max', 'position min', 'presence',
  'profile position', 'profile torque', 'profile velocity', 'quick stop', 'reacting to a fault', 'read only', 'read parameter', 'read register', 'ready to switch on',
  'recipe', 'recording', 'referenced', 'refused', 'rehearsal', 'reply timeout in ms', 'reset fault', 'retry pause in ms', 'retry pause max in ms', 'retry pause min in ms',
  'scan', 'set parameter', 'set position', 'set-points', 'set-points silent', 'setup', 'silent limit', 'site', 'snapshot', 'stale after in ms', 'standard map', 'state',
  'store', 'switched on', 'target position', 'target reached', 'target velocity', 'timeout in s', 'true', 'velocity', 'velocity in units', 'velocity increments',
  'velocity max', 'wait', 'wait for', 'wait for a register', 'warning', 'watchdog in ms', 'word order', 'write', 'write register',
  'Active inputs', 'Address input', 'Analog', 'Analog signal', 'Aux voltage', 'Battery low', 'Bit rate code', 'Bus silent', 'Capture', 'Clock pulses',
  'Control mask', 'Control word', 'Controller temperature', 'Copy mask', 'Current', 'Direct', 'Emergency stop', 'Enable input', 'Encoder', 'Encoder broken',
  'Encoder error', 'Encoder fault', 'Encoder speed', 'External stop', 'Following error', 'Force', 'Gear', 'Home position', 'Home switch', 'Index',
  'Inject error', 'Inputs', 'Limit negative', 'Limit negative position', 'Limit positive', 'Limit positive position', 'Load', 'Logic supply',
  'Lost pulses', 'Misread', 'Motor hot', 'Motor supply', 'Output fault', 'Outputs', 'Panel', 'Position', 'Power', 'Power pack', 'Program', 'Program number',
  'Reset parameters', 'Safe voltage enable', 'Sensor', 'Shaft turns', 'Silent', 'Stall', 'Supply voltage', 'Swing', 'Temperature', 'Trigger',
  'Trip pulses', 'Unmodelled',
];
