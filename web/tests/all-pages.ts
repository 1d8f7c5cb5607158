// Every page's code, loaded before a test begins: a test of a page is none of how long its code takes to come (later.test.tsx is).
import.meta.glob('../src/pages/*.tsx', { eager: true });
