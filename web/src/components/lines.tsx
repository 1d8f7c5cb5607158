// Lines and drives, as rows of cards: state in words, load, what the protocol counted; who serves each drive, and why.
// In: the store. Out: two lists that become stacked cards on a narrow screen. Old values are greyed like those of an axis.
import { gatewayText, t, theirs } from '../language';
import { marked } from './marked';
import { useGateway } from '../gateway';
import { linePath } from '../router';
import type { Drive, Line } from '../api/types';
import { wordOf, type Word } from '../text/axis';
import { formatExact, localFigures } from '../text/number';
import { presenceText } from '../text/presence';
import { Icon } from './icon';
import { AxisName } from './name';
import { Pill } from './pill';

export function lineWord(state: Line['status']['state']): Word {
  switch (state) {
    case 'up': return { text: t('Up'), icon: 'check', tone: 'good', long: t('The line is up') };
    case 'opening': return { text: t('Opening'), icon: 'clock', tone: 'neutral', long: t('The line is being opened') };
    case 'down': return { text: t('Down'), icon: 'unplugged', tone: 'fault', long: t('The line is down') };
    case 'bus_off': return { text: t('Bus off'), icon: 'triangle', tone: 'fault', long: t('The CAN controller has left the bus') };
    case 'closed': return { text: t('Closed'), icon: 'circle-dashed', tone: 'muted', long: t('The line is closed') };
  }
}

export function presenceWord(drive: Drive): Word {
  switch (drive.status.presence) {
    case 'device': return { text: t('Real drive'), icon: 'plug', tone: 'good', long: t('The real drive answers') };
    case 'twin': return { text: t('Simulated'), icon: 'chip', tone: 'simulated', long: t('The embedded model answers') };
    case 'offline': return { text: t('Offline'), icon: 'unplugged', tone: 'warning', long: t('Nobody answers') };
  }
}

function Load({ share }: { share: number }) {
  const percent = Math.min(100, Math.max(0, share * 100));
  return (
    <span class="load" title={t('Share of the bit rate used in the last second')}>
      <meter min={0} max={100} high={70} optimum={0} value={percent} aria-label={t('Load')} />
      <span class="figure-small">{percent < 10 ? localFigures(percent.toFixed(1)) : Math.round(percent)} %</span>
    </span>
  );
}

export function Count({ label, value, bad = false, title }: { label: string; value: number; bad?: boolean; title?: string }) {
  return (
    <div class={`count${bad && value > 0 ? ' is-bad' : ''}`} title={title}>
      <dt>{label}</dt>
      <dd>{formatExact(value)}</dd>
    </div>
  );
}

export function LineCard({ name }: { name: string }) {
  const { store } = useGateway();
  const known = store.line(name)?.value;
  if (!known) return null;
  const line = known.data;
  const s = line.status;
  const live = store.connected.value && known.epoch === store.connection.value.epoch;
  const scanned = s.scan_counters.exchanges + s.scan_counters.timeouts;
  return (
    <li class={`row${live ? '' : ' is-old'}`} data-line={name}>
      <div class="row-head">
        <h3>
          <a href={linePath(name)}>{name}</a>
        </h3>
        <Pill label={t('State')} word={wordOf(lineWord(s.state), live)} />
        <Load share={s.load} />
      </div>
      <p class="where">
        {s.families?.length ? s.families.map((f) => f.family).join(', ') : line.family} · <span class="mono">{line.uri}</span>
        {s.text && s.text !== 'up' ? marked(` · ${theirs(s.text)}`) : ''}
      </p>
      <dl class="counts">
        <Count label={t('Exchanges')} value={s.counters.exchanges} />
        <Count label={t('Time-outs')} value={s.counters.timeouts} bad />
        <Count label={t('Retries')} value={s.counters.retries} bad />
        <Count label={t('Garbled')} value={s.counters.garbled} bad />
        <Count label={t('Refused')} value={s.counters.refused} />
        <Count label={t('Dropped')} value={s.dropped} bad title={t('Frames that found the queue full')} />
        <Count label={t('Queued')} value={s.queued} />
        <Count label={t('Reopened')} value={s.reopened} />
      </dl>
      {scanned > 0 && (
        <p class="where" data-field="scan-counters">
          {t('Scans apart: {exchanges} exchanges, {timeouts} addresses or retries without an answer', { exchanges: formatExact(s.scan_counters.exchanges), timeouts: formatExact(s.scan_counters.timeouts) })}
        </p>
      )}
    </li>
  );
}

function DriveCard({ name }: { name: string }) {
  const { store } = useGateway();
  const known = store.drive(name)?.value;
  if (!known) return null;
  const drive = known.data;
  const s = drive.status;
  const live = store.connected.value && known.epoch === store.connection.value.epoch;
  return (
    <li class={`row${live ? '' : ' is-old'}`} data-drive={name}>
      <div class="row-head">
        <h3>{name}</h3>
        <Pill label={t('Presence')} word={wordOf(presenceWord(drive), live)} />
      </div>
      <p class="where">
        {t('{family} · {line} · address', { family: drive.family, line: drive.line })}{' '}<span class="mono">{String(drive.address)}</span> · {presenceText(drive.presence)}
      </p>
      <p class="why" {...gatewayText}>{s.text || '\u00a0'}</p>
      <p class="where">
        {drive.axes.length === 0 ? t('no axis') : <>{t('Axes:')} </>}
        {drive.axes.map((a, i) => (
          <>
            {i > 0 && ', '}
            <AxisName name={a} />
          </>
        ))}
        {s.sync && <> · {t('its axes tell of themselves each {cycle_ms} ms: {turns} × {beat_ms} ms', { cycle_ms: s.sync.cycle_ms, turns: s.sync.turns, beat_ms: s.sync.beat_ms })}</>}
        {s.silent_exchanges > 0 && <> · {t('silent {silent_exchanges} times, next try within {retry_pause_ms} ms', { silent_exchanges: s.silent_exchanges, retry_pause_ms: s.retry_pause_ms })}</>}
      </p>
    </li>
  );
}

export function LineList() {
  const names = useGateway().store.lineNames.value;
  if (names.length === 0) return <Empty text={t('No line is configured.')} />;
  return (
    <ul class="rows card">
      {names.map((n) => (
        <LineCard key={n} name={n} />
      ))}
    </ul>
  );
}

/** All drives, or some of them. */
export function DriveList({ of }: { of?: string[] }) {
  const all = useGateway().store.driveNames.value;
  const names = of ?? all;
  if (names.length === 0) return <Empty text={t('No drive is configured.')} />;
  return (
    <ul class="rows card">
      {names.map((n) => (
        <DriveCard key={n} name={n} />
      ))}
    </ul>
  );
}

export function Empty({ text }: { text: string }) {
  return (
    <p class="empty">
      <Icon name="info" /> {marked(text)}
    </p>
  );
}
