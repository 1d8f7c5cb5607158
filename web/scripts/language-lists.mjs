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
};
