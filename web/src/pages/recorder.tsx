// Recorder: what the gateway remembers: trends of axes, fast captures, recordings; each a tab with an address of its own.
// In: which tab, perhaps an axis and an instant (a link from an alarm). Out: a page.
import { midSentence, t } from '../language';
import { CapturesPart } from '../components/recorder-captures';
import { RecordingsPart } from '../components/recorder-recordings';
import { TrendsPart } from '../components/recorder-trends';
import { recorderPath, recorderTabs, type RecorderTab } from '../router';
import { recorderTitles } from '../text/recorder';

export function RecorderPage({ tab, axis, at_ms }: { tab: RecorderTab; axis?: string | undefined; at_ms?: number | undefined }) {
  return (
    <main class="page recorder-page">
      <h1 tabIndex={-1}>{t('Recorder: {n}', { n: midSentence(recorderTitles[tab]) })}</h1>
      <nav class="axis-tabs" aria-label={t('Parts of the recorder')}>
        {recorderTabs.map((part) => (
          <a key={part} href={recorderPath(part)} aria-current={part === tab ? 'page' : undefined}>
            {recorderTitles[part]}
          </a>
        ))}
      </nav>
      {tab === 'trends' && <TrendsPart at_ms={at_ms} axis={axis} />}
      {tab === 'captures' && <CapturesPart axis={axis} />}
      {tab === 'recordings' && <RecordingsPart key={`${axis} ${at_ms}`} first={axis} at_ms={at_ms} />}
    </main>
  );
}
