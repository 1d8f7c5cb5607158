// Mock families: what the catalogues say of whole families, as far as the page reads it. In: nothing. Out: documents of GET /families.
// A stand-in for the page's author: a few options of each kind, no catalogue.

/** @type {import('../../src/text/options').Family[]} */
export const families = [
  {
    name: 'mcode', title: 'Schneider Electric Lexium MCode', position_unit: 'step',
    options: [
      { name: 'ck', of: ['line'], min: 0, max: 2, default: '1', description: 'checksum mode that the drives are set to' },
      { name: 'pad', of: ['twin'], values: ['on', 'off', 'true', 'false', '1', '0'], default: 'off', description: 'real numbers are filled with blanks' },
    ],
  },
  {
    name: 'pacontrol', title: 'IEF Werner PA-CONTROL', position_unit: '0.001 AE',
    options: [{ name: 'reference_order', of: ['drive'], default: null, description: 'channels with commas, as in 3,1,2; without it rising' }],
  },
  {
    name: 'uim342', title: 'UIROBOT UIM342', position_unit: 'pulse',
    options: [
      { name: 'crc', of: ['line', 'twin'], values: ['12', '13', 'auto', 'none'], default: '12', description: 'bytes under the CRC of a UIMessage' },
      { name: 'notify', of: ['drive'], values: ['on', 'off'], default: 'off', description: '"move finished" is switched on after each enable' },
      { name: 'home_input', of: ['drive'], min: 1, max: 3, default: null, description: 'input of the home or limit switch' },
      { name: 'home_timeout_s', of: ['drive'], min: 1, max: 3600, unit: 's', default: '60', description: 'the search is given up and stopped after that' },
      { name: 'boot_ms', of: ['twin'], min: 0, max: 60000, unit: 'ms', default: '0', description: 'how long the simulated drive is silent after power-on' },
    ],
    freedoms: [
      { name: 'reply_ms', unit: 'ms', min: 0, max: 200, default: 0, values: {}, named: { slow: 200 }, source: 'silent', description: 'an answer is sent this long after its request' },
      { name: 'notices', unit: null, min: 0, max: 1, default: 1, values: { 0: 'off', 1: 'on' }, named: { sparse: 0 }, source: 'L210', description: 'the end of a motion is told without a question' },
    ],
  },
];

/** One specimen: a seed has half of its range here. @param {string} family @param {string} specimen */
export function specimen(family, specimen) {
  const freedoms = families.find((f) => f.name === family)?.freedoms ?? [];
  const known = /^(0|[1-9]\d{0,8}|slow|sparse|strict|chatty|weak|old)$/.test(specimen);
  if (!known) return null;
  const values = Object.fromEntries(freedoms.map((f) => [f.name, f.named[specimen] ?? (/^[1-9]/.test(specimen) ? Math.ceil(f.max / 2) : f.default)]));
  const words = freedoms.filter((f) => values[f.name] !== f.default).map((f) => `${f.name} = ${values[f.name]}: ${f.description}`);
  return { family, specimen, values, words };
}

const argument = { unit: null, scale: 1, min: null, max: null, default: null, description: null };
/** Actions that every mock family has: one that takes nothing, one with numbers, one with a text and a switch. @type {import('../../src/text/action').CatalogueCommand[]} */
export const commands = [
  { id: 'save', name: 'save', description: 'Keeps the settings.', completes: 'acknowledged', confirm: 'What has been saved is replaced.', arguments: [] },
  {
    id: '010xh', name: 'Go To Pos', description: 'Moves to a position.', completes: 'target_reached', confirm: null,
    arguments: [
      { ...argument, name: 'position', type: 'i32', unit: 'mm', scale: 0.0001, description: 'Where to.' },
      { ...argument, name: 'velocity', type: 'u32', unit: 'm/s', scale: 1e-6 },
      { ...argument, name: 'entry', type: 'u16', min: 1, max: 255, default: 1 },
    ],
  },
  { id: 'row', name: 'row.write', description: 'Writes a row.', completes: 'acknowledged', confirm: null, arguments: [{ ...argument, name: 'content', type: 'text' }, { ...argument, name: 'kept', type: 'bool', default: false }] },
];
