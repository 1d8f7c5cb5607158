// Makes src/api/schema.d.ts, which is not kept in the sources, from schema/openapi.yaml, the description of the HTTP door.
// In: the OpenAPI file. Out: the type file. Never reached over a network.
import { writeFile } from 'node:fs/promises';
import openapiTS, { astToString } from 'openapi-typescript';

const source = new URL('../../schema/openapi.yaml', import.meta.url);
const target = new URL('../src/api/schema.d.ts', import.meta.url);

const head = `// Made from schema/openapi.yaml by \`npm run api\`, which \`npm run check\` begins with.\n`;
// Members that have a default stay optional in a request; that is what the door takes.
const text = head + astToString(await openapiTS(source, { defaultNonNullable: false, alphabetize: false }));
await writeFile(target, text);
console.log(`api types: ${text.split('\n').length} lines`);
