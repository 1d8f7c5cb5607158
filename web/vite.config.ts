// How the page is built: static files with hashed names under dist/, nothing inline, nothing from elsewhere, for the program to embed.
/// <reference types="vitest/config" />
import { defineConfig } from 'vite';

/** What is loaded later, a language and then the page itself, imports nothing that a browser could ask for beforehand. */
const nothingToPreload = {
  name: 'nothing-to-preload',
  enforce: 'pre' as const,
  load: (id: string) => (id === '\0vite/preload-helper.js' ? 'export const __vitePreload = (load) => load();' : undefined),
};

export default defineConfig({
  plugins: [nothingToPreload],
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
