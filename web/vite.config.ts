// How the page is built: static files with hashed names under dist/, nothing inline, nothing from elsewhere, for the program to embed.
/// <reference types="vitest/config" />
import { defineConfig } from 'vite';

/** What is loaded later, a language and then the page itself, imports nothing that a browser could ask for beforehand. */
const nothingToPreload = {
  name: 'nothing-to-preload',
  enforce: 'pre' as const,
  load: (id: string) => (id === '\0vite/preload-helper.js' ? 'export const __vitePreload = (load) => load();' : undefined),
};

/** What tells about modules while bundles are made. */
interface Modules {
  getModuleInfo(id: string): { importers: readonly string[] } | null;
}
/** The modules that a file imports, those that they import, and so on; itself, too. Whatever is imported later (`import()`) is none of them. */
function reachedFrom(file: RegExp): (id: string, modules: Modules) => boolean {
  const known = new Map<string, boolean>();
  return function reached(id: string, modules: Modules): boolean {
    const before = known.get(id);
    if (before !== undefined) return before;
    known.set(id, false); // modules may import each other
    const yes: boolean = file.test(id) || (modules.getModuleInfo(id)?.importers ?? []).some((by) => reached(by, modules));
    known.set(id, yes);
    return yes;
  };
}
const inFirstScript = reachedFrom(/\/src\/main\.tsx$/);
const inBeginning = reachedFrom(/\/src\/start\.tsx$/);
/**
 * One bundle has everything that each visit needs, one small parts that many pages share; the others are made by who imports what. The first script
 * stays apart: it runs before the language is there, and nothing that holds sentences may run with it.
 */
const groups = [
  { debugName: 'first', name: (id: string, modules: Modules) => (inFirstScript(id, modules) ? 'first' : null), priority: 3 },
  { debugName: 'beginning', name: (id: string, modules: Modules) => (inBeginning(id, modules) ? 'beginning' : null), priority: 2 },
  { name: 'common', minShareCount: 4, priority: 1 },
];

/**
 * Of the library that draws plots only the parts that this page uses. Its times are plain numbers with texts of the page, its scales are linear, its
 * curves have neither fill nor bands, and the legend is the page's own. Each pair is a text of the library and its replacement.
 */
const unusedOfPlots: readonly (readonly [string, string])[] = [
  ['(paths.bars    = bars);', ''],
  ['(paths.spline  = monotoneCubic);', ''],
  ['uPlot.join = join;', ''],
  ['uPlot.rangeLog = rangeLog;', ''],
  ['uPlot.rangeAsinh = rangeAsinh;', ''],
  ['uPlot.fmtDate = fmtDate;', ''],
  ['uPlot.tzDate  = tzDate;', ''],
  ['const localTz = new Intl.DateTimeFormat().resolvedOptions().timeZone;', 'const localTz = 0;'],
  ['const [ timeIncrsMs, _timeAxisStampsMs, timeAxisSplitsMs ] = genTimeStuffs(1);', ''],
  ['const [ timeIncrsS,  _timeAxisStampsS,  timeAxisSplitsS  ] = genTimeStuffs(1e-3);', ''],
  ['const _fmtDate = (opts.fmtDate || fmtDate);', ''],
  ['const _timeAxisSplits = (ms == 1 ? timeAxisSplitsMs(_tzDate) : timeAxisSplitsS(_tzDate));', ''],
  ['const _timeAxisVals   = timeAxisVals(_tzDate, timeAxisStamps((ms == 1 ? _timeAxisStampsMs : _timeAxisStampsS), _fmtDate));', ''],
  ['const _timeSeriesVal  = timeSeriesVal(_tzDate, timeSeriesStamp(_timeSeriesStamp, _fmtDate));', ''],
  ['let isTime = sc.time;', 'const isTime = false;'],
  ['let isTime = mode == 1 && scales[s.scale].time;', 'const isTime = false;'],
  ['const showLegend = legend.show;', 'const showLegend = false;'],
  ['sc.distr == 3 ? logAxisSplits : sc.distr == 4 ? asinhAxisSplits : numAxisSplits', 'numAxisSplits'],
  ['sc.distr >= 3 && sc.log == 10 ? log10AxisValsFilt : sc.distr == 3 && sc.log == 2 ? log2AxisValsFilt : retArg1', 'retArg1'],
  ['(sc.distr == 3 ? snapLogX : sc.distr == 4 ? snapAsinhX : snapNumX)', 'snapNumX'],
  ['(sc.distr == 3 ? snapLogY : sc.distr == 4 ? snapAsinhY : snapNumY)', 'snapNumY'],
  ['if (xScaleDistr == 3)', 'if (false)'],
  ['if (xScaleDistr == 4)', 'if (false)'],
  ['let [ bandFillDir, bandClipDir ] = bandFillClipDirs(u, seriesIdx);', 'const bandFillDir = 0, bandClipDir = 0;'],
  ['if (series.fill != null || bandFillDir != 0) {', 'if (false) {'],
];
const plotsAsUsed = {
  name: 'plots-as-used',
  enforce: 'pre' as const,
  transform(code: string, id: string) {
    if (!/uPlot\.esm\.js$/.test(id)) return undefined;
    return unusedOfPlots.reduce((text, [part, instead]) => {
      if (!text.includes(part)) throw new Error(`uPlot has no ${part} any more: look what this page needs of it`);
      return text.replaceAll(part, instead);
    }, code);
  },
};

export default defineConfig({
  plugins: [nothingToPreload, plotsAsUsed],
  oxc: { jsx: { runtime: 'automatic', importSource: 'preact' } },
  build: {
    target: 'es2023',
    cssTarget: ['chrome123', 'firefox120', 'safari17.5'], // light-dark() and nesting as they are written
    outDir: 'dist',
    emptyOutDir: true,
    assetsInlineLimit: 0, // data: addresses are not allowed by the content security policy
    modulePreload: false,
    cssCodeSplit: false,
    sourcemap: false,
    reportCompressedSize: false,
    manifest: true, // for scripts/check-build.mjs, which removes it
    rolldownOptions: {
      output: {
        codeSplitting: { groups },
      },
    },
  },
  test: {
    include: ['tests/**/*.test.{ts,tsx}'],
    restoreMocks: true,
  },
});
