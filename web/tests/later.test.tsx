// @vitest-environment happy-dom
// A page whose code comes later: what is shown before, what is said when it does not come, who has the keyboard when it is there.
import { signal } from '@preact/signals';
import { render } from 'preact';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { later } from '../src/components/later';
import { GatewayProvider, type Gateway } from '../src/gateway';
import { go } from '../src/router';

vi.mock('../src/state/upgrade', () => ({ followUpgrade: async () => 'away' }));

const connection = signal({ phase: 'live', epoch: 1, attempts: 0 });
const gateway = { store: { connection } } as unknown as Gateway;
let root: HTMLElement;
beforeEach(() => {
  root = document.createElement('div');
  document.body.append(root);
});
afterEach(() => {
  render(null, root);
  root.remove();
});

function shown() {
  let come: (there: boolean) => void = () => undefined;
  let asked = 0;
  const Page = () => (
    <main>
      <h1 tabIndex={-1}>Mappings</h1>
    </main>
  );
  const Later = later(() => {
    asked += 1;
    return new Promise<typeof Page>((resolve, reject) => (come = (there) => (there ? resolve(Page) : reject(new TypeError('Failed to fetch')))));
  });
  render(<GatewayProvider value={gateway}>{<Later />}</GatewayProvider>, root);
  return { come: (there: boolean) => come(there), asked: () => asked, text: () => root.textContent ?? '' };
}

it('shows that something comes, then the page, which gets the keyboard when a link has led here', async () => {
  go('/mappings');
  const p = shown();
  expect(root.querySelector('main')?.getAttribute('aria-busy')).toBe('true');
  expect(root.querySelector('h1')).toBeNull();
  await vi.waitFor(() => expect(p.asked()).toBe(1));
  p.come(true);
  await vi.waitFor(() => expect(document.activeElement).toBe(root.querySelector('main h1')));
  expect(p.text()).toBe('Mappings');
});

it('says why it has not come, under the title of the page; tries again when it is asked to, and when the gateway is back', async () => {
  go('/mappings');
  const p = shown();
  await vi.waitFor(() => expect(p.asked()).toBe(1));
  p.come(false);
  await vi.waitFor(() => expect(p.text()).toContain('the gateway cannot be reached'));
  expect(root.querySelector('main h1')?.textContent).toBe('Mappings');
  root.querySelector('button')?.click();
  await vi.waitFor(() => expect(p.asked()).toBe(2));
  p.come(false);
  await vi.waitFor(() => expect(p.text()).toContain('the gateway cannot be reached'));
  connection.value = { ...connection.value, epoch: 2 };
  await vi.waitFor(() => expect(p.asked()).toBe(3));
  p.come(true);
  await vi.waitFor(() => expect(p.text()).toBe('Mappings'));
});
