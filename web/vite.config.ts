// How the page is built: static files with hashed names under dist/, nothing inline, nothing from elsewhere, for the program to embed.
/// <reference types="vitest/config" />
import { defineConfig } from 'vite';

/** What is loaded later, a language and then the page itself, imports nothing that a browser could ask for beforehand. */
const nothingToPreload = {
  name: 'nothing-to-preload',
  enforce: 'pre' as const,
  load: (id: string) => (id === '\0vite/preload-helper.js' ? 'export const __vitePreload = (load) => load();' : undefined),
};

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
  },
  test: {
    include: ['tests/**/*.test.{ts,tsx}'],
    restoreMocks: true,
  },
});
