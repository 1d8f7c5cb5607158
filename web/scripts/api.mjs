// Makes src/api/schema.d.ts from schema/openapi.yaml, the description of the HTTP door. With --check it writes nothing and
// fails if the types are out of step. In: the OpenAPI file. Out: the type file. Never reached over a network.
import { readFile, writeFile } from 'node:fs/promises';
import openapiTS, { astToString } from 'openapi-typescript';

const source = new URL('../../schema/openapi.yaml', import.meta.url);
const target = new URL('../src/api/schema.d.ts', import.meta.url);

const head = `// Generated from schema/openapi.yaml by \`npm run api\`. Do not edit: change the description and run it again.\n`;
// Members that have a default stay optional in a request; that is what the door takes.
const text = head + astToString(await openapiTS(source, { defaultNonNullable: false, alphabetize: false }));

if (process.argv.includes('--check')) {
  const present = await readFile(target, 'utf8').catch(() => '');
  if (present !== text) {
    console.error('web/src/api/schema.d.ts is out of step with schema/openapi.yaml: run `npm --prefix web run api`');
    process.exit(1);
  }
  console.log('api types: in step with schema/openapi.yaml');
} else {
  await writeFile(target, text);
  console.log(`api types: ${text.split('\n').length} lines written`);
}
