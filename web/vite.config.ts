// How the page is built: static files with hashed names under dist/, nothing inline, nothing from elsewhere, for the program to embed.
/// <reference types="vitest/config" />
import { defineConfig } from 'vite';

export default defineConfig({
  oxc: { jsx: { runtime: 'automatic', importSource: 'preact' } },
  build: {
    target: 'es2023',
    cssTarget: ['chrome123', 'firefox120', 'safari17.5'], // light-dark() and nesting as they are written
    outDir: 'dist',
    emptyOutDir: true,
    assetsInlineLimit: 0, // data: addresses are not allowed by the content security policy
    modulePreload: { polyfill: false },
    sourcemap: false,
    reportCompressedSize: false,
    // One file but for the languages: what is packed together is smaller, and one request less is waited for.
    rolldownOptions: { output: { codeSplitting: { groups: [{ name: 'start', test: /node_modules|src\/(?!language\/(de|zh))/ }] } } },
  },
  test: {
    include: ['tests/**/*.test.{ts,tsx}'],
    restoreMocks: true,
  },
});
