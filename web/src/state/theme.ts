// Theme: as the system has it, or light, or dark. In: the choice. Out: the attribute that the styles look at, and a signal for canvases.
import { computed, effect, signal } from '@preact/signals';
import { persisted } from './persisted';

export type Theme = 'system' | 'light' | 'dark';
const choice = persisted('theme', 'system', 'browser');
const media = globalThis.matchMedia?.('(prefers-color-scheme: dark)');
const systemDark = signal(media?.matches ?? false);
media?.addEventListener?.('change', (e) => (systemDark.value = e.matches));

export const theme = computed<Theme>(() => (choice.value === 'light' || choice.value === 'dark' ? choice.value : 'system'));
export const dark = computed(() => theme.value === 'dark' || (theme.value === 'system' && systemDark.value));

export function applyTheme(): void {
  effect(() => {
    if (theme.value === 'system') document.documentElement.removeAttribute('data-theme');
    else document.documentElement.setAttribute('data-theme', theme.value);
  });
}

export const nextTheme = (): void => {
  choice.value = theme.value === 'system' ? (dark.value ? 'light' : 'dark') : theme.value === 'light' ? 'dark' : 'light';
};
export const setTheme = (t: Theme): void => {
  choice.value = t;
};
