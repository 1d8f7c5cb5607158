// Report of the page's benchmarks: one line with the ratio, the limit it is measured against, and both figures, as tests/bench/run.sh counts.
// In: figures. Out: text on standard output. Never judges by itself what is not limited.

export const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

function line(what, ratio, relation, limit, kept, rest) {
  console.log(`    ${what.padEnd(36)} ratio ${ratio.toFixed(3).padStart(8)}  limit ${relation} ${limit}  ${(kept ? 'kept' : 'NOT KEPT').padEnd(8)}  ${rest}`);
  return kept;
}

/** Not more than an absolute limit; a limit of 0 is one of counts. */
export function say(what, ours, limit, unit) {
  const ratio = limit > 0 ? ours / limit : ours;
  return line(what, ratio, '<=', limit > 0 ? 1 : 0, ours <= limit, `axisgate ${ours.toFixed(limit > 0 ? 1 : 0)} ${unit}, limit ${limit} ${unit}`);
}

/** At least so much of something else that was measured in the same run. */
export function sayOf(what, ours, theirs, least, name, unit) {
  const ratio = theirs > 0 ? ours / theirs : 0;
  return line(what, ratio, '>=', least, ratio >= least, `axisgate ${ours.toFixed(1)} ${unit}, ${name} ${theirs.toFixed(1)} ${unit}`);
}
