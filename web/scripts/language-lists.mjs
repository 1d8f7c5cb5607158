// Language lists: what is no text for people although it looks like some, by file, each with its reason.
// In: nothing. Out: a list for language.mjs.

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
  'components/frame.tsx': [/^axisgate$/, /^counted/],
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
  // Words of a recipe's JSON, by which its steps are told apart; the label beside each is said through t().
  'text/recipe.ts': [/^(enable|disable|home|command|set_parameter|read_parameter|action|write_register|simulate|wait_for|check|wait_s|if|repeat|message)$/],
  // Keys of lists and choices.
  'text/errors.ts': [/^(axis|line|drive|offline) \{…\}( \{…\})?$/],
  'components/parameter-compare.tsx': [/^snapshot:\{…\}$/],
  // Measures of the style sheet, and names within a drawing.
  'components/mapping-map.tsx': [/^\{…\}px$/, /^\{…\} \/ span \{…\}$/],
  'components/state-machine.tsx': [/^url\(#arrow\)$/, /^auto-start-reverse$/],
  // Forms of files, and the line of a program, as a shell takes it.
  'components/trace.tsx': [/^(pcapng|candump)$/],
  'text/hmi-line.ts': [/^mbpoll /],
  // Units.
  'text/site-files.ts': [/^\{…\} (KiB|MiB)$/],
  'text/site-tree.ts': [/^\{…\} bit\/s$/],
};
