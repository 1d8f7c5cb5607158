// Lines and drives, and one line with the frames that cross it. In: the store, the stream's frames. Out: two pages.
import { signal, type Signal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import type { components } from '../api/schema';
import { DriveList, Empty, LineList } from '../components/lines';
import { Section } from '../components/section';
import { useGateway } from '../gateway';

type Frame = components['schemas']['Frame'];
const mostFrames = 400;

export function LinesPage() {
  return (
    <main class="page">
      <h1 tabIndex={-1}>Lines and drives</h1>
      <div class="side-by-side">
        <Section title="Lines">
          <LineList />
        </Section>
        <Section title="Drives">
          <DriveList />
        </Section>
      </div>
    </main>
  );
}

export function LinePage({ name }: { name: string }) {
  const gateway = useGateway();
  const known = gateway.store.line(name)?.value;
  const frames: Signal<Frame[]> = useMemo(() => signal([]), [name]);
  const missed: Signal<number> = useMemo(() => signal(0), [name]);
  const paused: Signal<boolean> = useMemo(() => signal(false), [name]);
  useEffect(
    () =>
      gateway.follow(`lines/${name}/frames`, 200, (m) => {
        const data = m.data as { missed: number; frames: Frame[] } | null;
        if (!data || paused.peek()) return;
        missed.value += data.missed;
        const last = frames.peek().at(-1)?.sequence ?? -1;
        // After a reconnection the newest ones come once more.
        frames.value = [...frames.peek(), ...data.frames.filter((f) => f.sequence > last)].slice(-mostFrames);
      }),
    [gateway, name],
  );
  const trace = `/api/v1/lines/${encodeURIComponent(name)}/trace`;
  return (
    <main class="page">
      <p class="crumbs">
        <a href="/lines">Lines and drives</a>
      </p>
      <h1 tabIndex={-1}>{name}</h1>
      {known ? (
        <p class="where">
          {known.data.family} · <span class="mono">{known.data.uri}</span> · {known.data.status.state} {known.data.status.text}
        </p>
      ) : (
        gateway.store.listed.value && <Empty text={`There is no line ${name}.`} />
      )}
      <Section
        title="Frames"
        beside={
          <>
            <button type="button" class="button" aria-pressed={paused.value} onClick={() => (paused.value = !paused.value)}>
              {paused.value ? 'Paused' : 'Pause'}
            </button>
            <button type="button" class="button" onClick={() => (frames.value = [])}>
              Clear
            </button>
            <a class="button" href={`${trace}?format=pcapng`} download={`${name}.pcapng`}>
              pcapng
            </a>
            <a class="button" href={`${trace}?format=candump`} download={`${name}.log`}>
              candump
            </a>
          </>
        }
      >
        <div class="card scroll frames" tabIndex={0} role="region" aria-label="Frames, newest first">
          {missed.value > 0 && <p class="where">{missed.value} frames were overwritten before they could be shown.</p>}
          {frames.value.length === 0 ? (
            <Empty text="No frame has crossed the line since this page was opened." />
          ) : (
            <ol class="frame-list mono">
              {[...frames.value].reverse().map((f) => (
                <li key={f.sequence}>
                  <span>{f.at.slice(11, 23)}</span>
                  <span class={f.to_drive ? 'to' : 'from'}>{f.to_drive ? '→ drive' : '← drive'}</span>
                  <span>{f.simulated ? 'simulated' : 'cable'}</span>
                  <span class="bytes">{f.text || f.data}</span>
                </li>
              ))}
            </ol>
          )}
        </div>
      </Section>
    </main>
  );
}
