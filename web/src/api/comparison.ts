// Comparison at the HTTP door: the real drive of an axis beside its twin, and the adoption of its values by the twin. In: a client. Out: reports.
import type { Client } from './client';
import type { components } from './schema';

export type DriveComparison = components['schemas']['DriveComparison'];
export type ComparedValue = components['schemas']['ComparedValue'];
export type TwinAdoption = components['schemas']['TwinAdoption'];
type Progress = components['schemas']['JobProgress'];
type Running = components['schemas']['JobRunning'];

const part = encodeURIComponent;
const pause = (ms: number) => new Promise<void>((then) => setTimeout(then, ms));
/** How long the report may take after the drive was read, and how often it is asked for. */
const longest_wait_ms = 60_000;
const period_ms = 500;

export class ComparisonDoor {
  constructor(
    private readonly client: Client,
    private readonly axis: string,
  ) {}
  private path = (rest: string) => `/axes/${part(this.axis)}/${rest}`;

  newest = () => this.client.call<DriveComparison>(this.path('comparison'));
  adopt = () => this.client.call<TwinAdoption>(this.path('comparison/adopt'), { method: 'POST' });
  /** The gateway answers at once if the drive is read within some seconds; otherwise the report is waited for. `told`: values read, of how many. */
  async compare(told: (done: number, of: number) => void): Promise<DriveComparison> {
    const before = await this.newest().then((r) => r.at, () => '');
    const answer = await this.client.call<DriveComparison | Running>(this.path('comparison'), { method: 'POST', timeout_ms: 60_000 });
    if ('rows' in answer) return answer;
    for (let end = Date.now() + longest_wait_ms; Date.now() < end; await pause(period_ms)) {
      const progress = await this.client.call<Progress>(this.path('snapshot-progress'));
      if (progress.state === 'running') {
        end = Date.now() + longest_wait_ms;
        told(progress.done, progress.of);
        continue;
      }
      const report = await this.newest().catch(() => null);
      if (report && report.at !== before) return report;
      if (progress.state === 'failed') throw new Error(progress.text);
    }
    return this.newest();
  }
}
