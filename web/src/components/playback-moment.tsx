// Playback moment: the axes as they were at one instant of a recording, their registers, the frames before it in words, and what had happened. In: the answer
// of the gateway for that instant. Out: tables and lists that say of which instant they are. Nothing in it can be commanded.
import type { Playback } from '../api/types';
import { t } from '../language';
import { formatNumber } from '../text/number';
import { plainWord } from '../text/plain';
import { instantText, registerText } from '../text/recorder';
import { TableHead } from './table-head';

interface FrameRow {
  line: string;
  at: string;
  to_drive: boolean;
  simulated: boolean;
  text?: string;
  data: string;
  decoded: string[];
  command: number | null;
}
interface AxisRow {
  name: string;
  unit: string;
  state: string;
  position: number | null;
  velocity: number | null;
  following_error: number | null;
  error: { code: number; text: string };
  presence: string;
}

const stateText = (a: AxisRow) => (a.presence === 'twin' ? t('{state} (simulated)', { state: plainWord(a.state) }) : a.presence === 'offline' ? t('{state} (offline)', { state: plainWord(a.state) }) : plainWord(a.state));

export function PlaybackMoment({ now }: { now: Playback }) {
  return (
    <>
      <p data-field="playback-shown">{t('Axes, registers, frames and events at {at}', { at: instantText(Date.parse(now.at) / 1000, 1) })}</p>
      <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Axes at that instant')}>
        <table class="table">
          <TableHead of={[t('Axis'), t('State'), t('Position'), t('Velocity'), t('Following error'), t('Error'), t('Registers')]} figures={[2, 3, 4, 5]} />
          <tbody>
            {(now.axes as unknown as AxisRow[]).map((a) => (
              <tr key={a.name} data-axis={a.name}>
                <th scope="row">{a.name}</th>
                <td data-label={t('State')}>{stateText(a)}</td>
                <td data-label={t('Position')} class="num">{formatNumber(a.position, 3)} {a.unit}</td>
                <td data-label={t('Velocity')} class="num">{formatNumber(a.velocity, 3)}</td>
                <td data-label={t('Following error')} class="num">{formatNumber(a.following_error, 3)}</td>
                <td data-label={t('Error')} class="num" title={a.error.text || undefined}>{a.error.code || '–'}</td>
                <td data-label={t('Registers')} class="mono playback-words">{registerText(now.registers.find((r) => r.axis === a.name))}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <h3>{t('Frames before it')}</h3>
      <div class="card scroll frames" tabIndex={0} role="region" aria-label={t('Frames before that instant, newest first')}>
        <ol class="frame-list mono">
          {(now.frames as unknown as FrameRow[]).toReversed().map((f, i) => (
            <li key={i} class="frame-row">
              <span>{f.at.slice(11, 23)}</span>
              <span class={f.to_drive ? 'to' : 'from'}>{f.to_drive ? t('→ drive') : t('← drive')}</span>
              <span>{f.line}</span>
              <span class="bytes">{f.text || f.data}</span>
              <span class="reading">
                {f.decoded.join(' · ')}
                {f.command !== null && <b> {t('for command {n}', { n: f.command })}</b>}
              </span>
            </li>
          ))}
        </ol>
      </div>
      <h3>{t('What had happened')}</h3>
      <div class="card scroll playback-happened" tabIndex={0} role="region" aria-label={t('What had happened, newest first')}>
        <ol class="frame-list mono">
          {now.happened.toReversed().map((h, i) => (
            <li key={i}>
              {h.at.slice(11, 23)} {h.axis ? `${h.axis}: ` : ''}
              {h.text}
            </li>
          ))}
        </ol>
      </div>
    </>
  );
}
