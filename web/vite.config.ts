// How the page is built: static files with hashed names under dist/, nothing inline, nothing from elsewhere, for the program to embed.
/// <reference types="vitest/config" />
import { defineConfig } from 'vite';

/** What is loaded later, a language and then the page itself, imports nothing that a browser could ask for beforehand. */
const nothingToPreload = {
  name: 'nothing-to-preload',
  enforce: 'pre' as const,
  load: (id: string) => (id === '\0vite/preload-helper.js' ? 'export const __vitePreload = (load) => load();' : undefined),
};

/** Of the library that draws plots only what this page uses: its bars and splines, and joining of tables, are parts that nothing here asks for. */
const unusedOfPlots = ['(paths.bars    = bars);', '(paths.spline  = monotoneCubic);', 'uPlot.join = join;'];
const plotsAsUsed = {
  name: 'plots-as-used',
  enforce: 'pre' as const,
  transform(code: string, id: string) {
    if (!/uPlot\.esm\.js$/.test(id)) return undefined;
    return unusedOfPlots.reduce((text, part) => {
      if (!text.includes(part)) throw new Error(`uPlot has no ${part} any more: look what this page needs of it`);
      return text.replace(part, '');
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
