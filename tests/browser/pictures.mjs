// Makes the pictures of README and handbook anew: docs/handbook/pictures. In: AXISGATE_BIN, CHROMIUM, another folder as an argument. Out: the files.
import { folder, make } from './lib/pictures.mjs';

for (const p of await make(process.argv[2] ?? folder)) console.log(`${p.name.padEnd(16)} ${String(p.bytes).padStart(6)} bytes  ${p.kept ? 'as it was' : 'written'}`);
