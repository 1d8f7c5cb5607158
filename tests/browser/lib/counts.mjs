// Reporter: the closing line of a run, with counts. In: the events of node's test runner. Out: one line.
export default async function* counts(source) {
  let passed = 0;
  let failed = 0;
  for await (const event of source) {
    if ((event.type === 'test:pass' || event.type === 'test:fail') && event.data.details?.type !== 'suite') {
      if (event.type === 'test:pass') passed += 1;
      else failed += 1;
    }
  }
  yield `browser: ${passed + failed} tests, ${passed} passed, ${failed} failed\n`;
}
