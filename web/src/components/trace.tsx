// Trace: the frames of a line as they cross it, newest first: bytes, their reading, and one of them byte by byte.
// In: the stream's frames. Out: a list that can be filtered, paused and saved. Holding still loses nothing that is still recorded.
import { t } from '../language';
import { useComputed, useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { bytesOf, idText, joined, matches, type Frame, type FrameFilter } from '../state/frames';
import { dateTime } from '../text/time';
import { Empty } from './lines';
import { Section } from './section';
import { TableHead } from './table-head';

/** Rows that are drawn; the filter looks at all that are kept. */
const mostShown = 300;
/** Before and after the instant that is asked for. */
const around_ms = 2_000;

/** `at_ms`: the frames around that instant, as far as the gateway still has them, held; else those that come. */
export function Trace({ line, at_ms }: { line: string; at_ms?: number | undefined }) {
  const gateway = useGateway();
  const frames = useSignal<Frame[]>([]);
  const held = useSignal<Frame[] | null>(null);
  const missed = useSignal(0);
  const filter = useSignal<FrameFilter>({ text: '', direction: 'both' });
  const open = useSignal<number | null>(null);
  const then = useSignal<'' | 'asked' | 'there' | 'gone'>(at_ms === undefined ? '' : 'asked');
  useEffect(() => {
    if (at_ms === undefined) return;
    const end = new AbortController();
    gateway.client.call<{ frames: Frame[] }>(`/lines/${encodeURIComponent(line)}/trace`, { signal: end.signal }).then(
      (all) => {
        const near = all.frames.filter((f) => Math.abs(Date.parse(f.at) - at_ms) <= around_ms);
        then.value = near.length > 0 ? 'there' : 'gone';
        if (near.length > 0) held.value = near;
      },
      () => !end.signal.aborted && (then.value = 'gone'),
    );
    return () => end.abort();
  }, [gateway, line, at_ms]);
  useEffect(
    () =>
      gateway.follow(`lines/${line}/frames`, 200, (m) => {
        const data = m.data as { missed: number; frames: Frame[] } | null;
        if (!data) return;
        missed.value += data.missed;
        frames.value = joined(frames.peek(), data.frames);
      }),
    [gateway, line],
  );
  const fitting = useComputed(() => {
    const source = held.value ?? frames.value;
    const f = filter.value;
    return f.text === '' && f.direction === 'both' ? source : source.filter((x) => matches(x, f));
  });
  const shown = fitting.value.slice(-mostShown).reverse();
  const file = (format: string) => `/api/v1/lines/${encodeURIComponent(line)}/trace?format=${format}`;
  const source = held.value ?? frames.value;
  return (
    <Section
      title={t('Frames')}
      beside={
        <>
          <input
            class="search"
            type="search"
            placeholder={t('Filter, -without')}
            aria-label={t('Filter frames by bytes or reading; a minus before a word leaves out what has it')}
            value={filter.value.text}
            onInput={(e) => (filter.value = { ...filter.peek(), text: e.currentTarget.value })}
          />
          <select aria-label={t('Direction')} value={filter.value.direction} onChange={(e) => (filter.value = { ...filter.peek(), direction: e.currentTarget.value as FrameFilter['direction'] })}>
            <option value="both">{t('both ways')}</option>
            <option value="to">{t('to the drive')}</option>
            <option value="from">{t('from the drive')}</option>
          </select>
          <button type="button" class="button hold" aria-pressed={held.value !== null} onClick={() => (held.value = held.peek() === null ? frames.peek() : null)}>
            {held.value === null ? t('Pause') : t('Paused')}
          </button>
          <button
            type="button"
            class="button"
            onClick={() => {
              frames.value = [];
              held.value = null;
            }}
          >
            {t('Clear')}
          </button>
          <a class="button" href={file('pcapng')} download={`${line}.pcapng`}>
            {'pcapng'}
          </a>
          <a class="button" href={file('candump')} download={`${line}.log`}>
            {'candump'}
          </a>
        </>
      }
    >
      {at_ms !== undefined && then.value === 'there' && <p class="notice" data-field="frames-then">{t('Held: the frames 2 s before and after {at}. Press Paused for those that come now.', { at: dateTime(new Date(at_ms).toISOString()) })}</p>}
      {at_ms !== undefined && then.value === 'gone' && <p class="notice" data-field="frames-then">{t('The line remembers no frames of {at} any more; a recording of that time has them.', { at: dateTime(new Date(at_ms).toISOString()) })}</p>}
      <p class="where trace-count" role="status">
        {fitting.value.length === source.length ? t('{n} frames', { n: source.length }) : t('{n} of {n2} frames', { n: fitting.value.length, n2: source.length })}
        {fitting.value.length > mostShown && `, ${t('the newest {mostShown} are shown', { mostShown })}`}
        {missed.value > 0 && `; ${t('{n} were overwritten before they could be shown', { n: missed.value })}`}
      </p>
      <div class="card scroll frames" tabIndex={0} role="region" aria-label={t('Frames, newest first')}>
        {shown.length === 0 ? (
          <Empty text={source.length > 0 ? t('No frame fits the filter.') : t('No frame has crossed the line since this page was opened.')} />
        ) : (
          <ol class="frame-list mono">
            {shown.map((f) => (
              <Row key={f.sequence} frame={f} open={open.value === f.sequence} toggle={() => (open.value = open.peek() === f.sequence ? null : f.sequence)} />
            ))}
          </ol>
        )}
      </div>
    </Section>
  );
}

/** The reading without the bytes that stand beside it already. */
const readingOf = (f: Frame, decoded: string) => (f.text !== '' && decoded.startsWith(`${f.text} `) ? decoded.slice(f.text.length + 1) : decoded);

function Row({ frame: f, open, toggle }: { frame: Frame; open: boolean; toggle: () => void }) {
  return (
    <li class={open ? 'is-open' : undefined} data-sequence={f.sequence}>
      <button type="button" class="frame-row" aria-expanded={open} onClick={toggle}>
        <span>{f.at.slice(11, 23)}</span>
        <span class={f.to_drive ? 'to' : 'from'}>{f.to_drive ? t('→ drive') : t('← drive')}</span>
        <span>{f.simulated ? t('simulated') : t('cable')}</span>
        <span class="bytes">{f.text || f.data}</span>
        <span class="reading">{f.decoded.map((d) => readingOf(f, d)).join(' · ')}</span>
      </button>
      {open && <Details frame={f} />}
    </li>
  );
}

function Details({ frame: f }: { frame: Frame }) {
  const rows = bytesOf(f.data);
  return (
    <div class="frame-details">
      <dl>
        <div>
          <dt>{t('Seen')}</dt>
          <dd>{f.at}</dd>
        </div>
        {f.id !== null && (
          <div>
            <dt>{t('Identifier')}</dt>
            <dd>{idText(f)}</dd>
          </div>
        )}
        {f.decoded.map((d, i) => (
          <div key={i}>
            <dt>{i === 0 ? t('Reading') : ''}</dt>
            <dd>{d}</dd>
          </div>
        ))}
      </dl>
      {rows.length > 0 && (
        <div class="scroll">
          <table class="byte-table">
            <TableHead of={[t('Byte'), t('Hex'), t('Dec'), t('Bits'), t('ASCII')]} />
            <tbody>
              {rows.map((r) => (
                <tr key={r.at}>
                  <th scope="row">{r.at}</th>
                  <td>{r.hex}</td>
                  <td>{r.decimal}</td>
                  <td>{r.bits}</td>
                  <td>{r.letter}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
    </div>
  );
}
