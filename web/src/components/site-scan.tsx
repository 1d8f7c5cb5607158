// Site scan: who answers on a line. In: a line of the site in force, a range of addresses. Out: what was found, and a drive with an axis in the draft
// for each that is not known yet. Asks for progress three times a second, for at most ten minutes; can be ended. Begins none that was not asked for.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { Scan, SiteDoor } from '../api/site';
import type { SiteDraft } from '../state/site-draft';
import { quiet, type Reported } from '../state/reported';
import { freeName, freeNumber, withEntry, type Entry } from '../text/site';
import { useBarred } from './gate';
import { notOffered, Tell, TextField } from './form';

const poll_ms = 300;
const longest_ms = 600_000;
const numberOf = (text: string): number | undefined => (/^\d+$/.test(text.trim()) ? Number(text) : undefined);

/** A drive that was found, and its first axis, into the draft. */
export function addFound(draft: SiteDraft, line: Entry, address: number | string, family?: string): void {
  const site = draft.draft.peek();
  const drive = freeName(site.drives, `${line.name}-${address}`);
  const axis = freeName(site.axes, drive);
  const withDrive = withEntry(site, 'drives', { name: drive, line: line.name, ...(family && family !== line.family ? { family } : {}), address, presence: 'auto' }, null);
  draft.edit(withEntry(withDrive, 'axes', { name: axis, drive, channel: 1, number: freeNumber(site) }, null));
}

/** `begin`: it was asked for already, by the button that led here. `headed`: it says whose it is, and the keyboard goes on there. */
export function ScanPanel({ line, door, draft, begin = false, headed = false }: { line: Entry; door: SiteDoor; draft: SiteDraft; begin?: boolean; headed?: boolean }) {
  const head = useRef<HTMLHeadingElement>(null);
  useEffect(() => {
    head.current?.focus({ preventScroll: true });
    head.current?.closest('form')?.scrollIntoView?.({ block: 'nearest' });
  }, []);
  const no = useBarred('engineer');
  const from = useSignal('');
  const to = useSignal('');
  const scan = useSignal<Scan | null>(null);
  const reported = useSignal<Reported>(quiet);
  const running = useRef<{ stop: boolean } | null>(null);
  useEffect(() => () => void (running.current && (running.current.stop = true)), []);

  const text = (s: Scan) => `${s.state === 'done' ? s.asked ? t('{n} found, {asked} asked.', { n: s.found.length, asked: s.asked }) : t('{n} found.', { n: s.found.length }) : t('The scan is {state}.', { state: s.state })} ${s.text ?? ''}`.trim();
  /** Until it has an end, whoever began it. */
  const follow = async (run: { stop: boolean }) => {
    const end = performance.now() + longest_ms;
    while (!run.stop && performance.now() < end) {
      const s = await door.scan(line.name);
      scan.value = s;
      if (s.state !== 'running') return void (reported.value = { tone: s.state === 'done' ? 'good' : 'refused', text: text(s) });
      reported.value = { tone: 'busy', text: t('Scanning, {percent} % …', { percent: Math.round(s.progress * 100) }) };
      await new Promise((r) => setTimeout(r, poll_ms));
    }
  };
  const watch = async (work: (run: { stop: boolean }) => Promise<void>) => {
    const run: { stop: boolean } = { stop: false };
    running.current = run;
    try {
      await work(run);
    } finally {
      if (running.current === run) running.current = null;
    }
  };
  const start = () =>
    watch(async (run) => {
      const range: { from?: number; to?: number } = {};
      const [a, b] = [numberOf(from.value), numberOf(to.value)];
      if (a !== undefined) range.from = a;
      if (b !== undefined) range.to = b;
      scan.value = null;
      reported.value = { tone: 'busy', text: t('Scanning …') };
      try {
        await door.startScan(line.name, range);
        await follow(run);
      } catch (error) {
        const p = asProblem(error);
        reported.value = { tone: 'refused', text: p.status === 405 || p.status === 501 || (p.status === 404 && !/line/.test(p.message)) || p.message.startsWith('there is nothing at') ? notOffered(t('a scan of its lines')) : p.text };
      }
    });
  /** One that runs already, begun before a reload or by somebody else, is followed to its end; what the last one has found is still there. */
  const look = () =>
    watch(async (run) => {
      const s = await door.scan(line.name);
      if (run.stop || reported.peek().tone !== 'none') return;
      if (s.state === 'running') return follow(run);
      if (s.found.length === 0) return;
      scan.value = s;
      reported.value = { tone: 'none', text: t('The last scan: {s}', { s: text(s) }) };
    }).catch(() => undefined); // a gateway that does not tell has nothing to go on with
  useEffect(() => {
    void (begin && !no.disabled ? start() : look());
  }, [begin]);
  // Drives of two families may have the same address on a line.
  const placeOf = (family: unknown, address: unknown) => `${String(family || line.family || '')} ${String(address)}`;
  const known = new Map((draft.draft.value.drives ?? []).filter((d) => d.line === line.name).map((d) => [placeOf(d.family, d.address), d.name]));
  return (
    <form
      class="form scan"
      noValidate
      aria-label={t('Scan line {name}', { name: line.name })}
      onSubmit={(e) => {
        e.preventDefault();
        void start();
      }}
    >
      {headed && (
        <h4 ref={head} tabIndex={-1} class="scan-head">
          {t('Scan of line {name}', { name: line.name })}
        </h4>
      )}
      <div class="form-foot">
        <TextField label={t('From address')} class="within" number value={from.value} onText={(t) => (from.value = t)} placeholder={t('first')} />
        <TextField label={t('to')} class="within" number value={to.value} onText={(t) => (to.value = t)} placeholder={t('last')} />
        <button type="submit" class="button primary" disabled={reported.value.tone === 'busy'} {...no}>
          {t('Scan')}
        </button>
        {reported.value.tone === 'busy' && (
          <button type="button" class="button" {...no} onClick={() => void door.endScan(line.name).catch(() => undefined)}>
            {t('End')}
          </button>
        )}
        <Tell reported={reported.value} field="scan-told" />
      </div>
      {scan.value && scan.value.state === 'running' && <progress max={1} value={scan.value.progress} aria-label={t('Progress of the scan')} />}
      {scan.value && scan.value.found.length > 0 && (
        <ul class="found" aria-label={t('Found')}>
          {scan.value.found.map((f) => {
            const name = f.known_as ?? known.get(placeOf(f.family, f.address));
            return (
              <li key={`${f.family ?? ''} ${f.address}`} data-found={f.address}>
                <b class="mono">{f.address}</b> <span>{f.text ?? ''}</span>{' '}
                {name ? (
                  <span class="where">{t('known as {name}', { name })}</span>
                ) : (
                  <button type="button" class="button small" {...no} onClick={() => addFound(draft, line, f.address, f.family)}>
                    {t('Add {address} as a drive', { address: f.address })}
                  </button>
                )}
              </li>
            );
          })}
        </ul>
      )}
    </form>
  );
}
