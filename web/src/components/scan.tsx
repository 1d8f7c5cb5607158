// Scan: looking for drives on a line. In: the line's name, a range of addresses. Out: what was found, and whether the site knows it.
// Never adds a drive by itself, and never begins to look by itself.
import { gatewayText, t } from '../language';
import { marked } from './marked';
import { useBarred, Why } from './gate';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { ScanReport } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { Section } from './section';

const askAgain_ms = 300;
const askLater_ms = 2_000;

/** "3 of 8 addresses asked, done, 1 found". A line that is asked as a whole has no addresses to count: how it was found is told then. */
export function scanText(r: Pick<ScanReport, 'asked' | 'of' | 'state' | 'text' | 'found'>): string {
  const found = r.found.length === 1 ? t('1 found') : t('{n} found', { n: r.found.length });
  const how = r.of > 0 ? t('{asked} of {of} addresses asked, {state}, {found}', { asked: r.asked, of: r.of, state: r.state, found }) : t('The line was asked as a whole, not address by address: {state}, {found}', { state: r.state, found });
  return `${how}${r.text ? `: ${r.text}` : ''}`;
}

export function ScanSection({ line }: { line: string }) {
  const { client } = useGateway();
  const no = useBarred('engineer');
  const report = useSignal<ScanReport | null>(null);
  const from = useSignal('');
  const to = useSignal('');
  const fault = useSignal('');
  const running = report.value?.state === 'running';
  useEffect(() => {
    let here = true;
    let timer: ReturnType<typeof setTimeout>;
    const ask = () =>
      client.scan(line).then(
        (r) => {
          if (!here) return;
          report.value = r;
          if (r.state === 'running') timer = setTimeout(ask, askAgain_ms);
        },
        // Nobody answered: a scan that runs has an end all the same, and it is wanted.
        (error) => here && asProblem(error).status === 0 && (timer = setTimeout(ask, askLater_ms)),
      );
    void ask();
    return () => {
      here = false;
      clearTimeout(timer);
    };
  }, [client, line, running]);
  const act = async (what: () => Promise<ScanReport>) => {
    fault.value = '';
    try {
      report.value = await what();
    } catch (error) {
      fault.value = capital(asProblem(error).text);
    }
  };
  const r = report.value;
  return (
    <Section title={t('Scan')} help="commission#find-the-drives">
      <div class="card recipe-run" data-field="scan">
        <Why need="engineer" what={t('Looking for drives')} />
        <div class="recipe-buttons">
          <input class="search" type="text" aria-label={t('First address')} placeholder={t('first address')} autocomplete="off" value={from.value} onInput={(e) => (from.value = e.currentTarget.value)} />
          <input class="search" type="text" aria-label={t('Last address')} placeholder={t('last address')} autocomplete="off" value={to.value} onInput={(e) => (to.value = e.currentTarget.value)} />
          <button type="button" class="button primary" disabled={running} {...no} onClick={() => void act(() => client.startScan(line, { ...(from.peek() ? { from: from.peek() } : {}), ...(to.peek() ? { to: to.peek() } : {}) }))}>
            {t('Look for drives')}
          </button>
          {running && (
            <button type="button" class="button" {...no} onClick={() => void act(() => client.cancelScan(line))}>
              {t('End')}
            </button>
          )}
          {r && r.state !== 'none' && <progress max={1} value={r.state === 'done' ? 1 : r.progress} aria-label={t('Addresses asked')} />}
          {r && r.state !== 'none' && (
            <span class="where" role="status">
              {scanText(r)}
            </span>
          )}
        </div>
        <p class="result result-refused" role="status">
          <span>{marked(fault.value)}</span>
        </p>
        {r && r.found.length > 0 && (
          <ul aria-label={t('Drives found')}>
            {r.found.map((f) => (
              <li key={`${f.family ?? ""} ${f.address}`} class="row" data-found={f.address}>
                <div class="row-head">
                  <h3>
                    {t('{family} at {address}', { family: f.family, address: f.address })}
                  </h3>
                  <span class="where">{f.known_as ? t('is the drive {known_as}', { known_as: f.known_as }) : t('not in the site yet')}</span>
                </div>
                {f.text && <p class="why" {...gatewayText}>{f.text}</p>}
              </li>
            ))}
          </ul>
        )}
      </div>
    </Section>
  );
}
