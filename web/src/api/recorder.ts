// The recorder at the HTTP door: trends, captures, recordings. In: a client. Out: documents.
import type { Client } from './client';
import type { Capture, CaptureList, CaptureWish, CaptureWithRows, Playback, Recording, RecordedSteps, RecordingList, Trends } from './types';

const part = encodeURIComponent;
export interface TrendQuery {
  axes: readonly string[];
  points: readonly string[];
  from_ms: number;
  to_ms: number;
  columns: number;
}
const queryOf = (q: TrendQuery) => new URLSearchParams({ axes: q.axes.join(','), points: q.points.join(','), from: String(Math.round(q.from_ms)), to: String(Math.round(q.to_ms)), columns: String(q.columns) });

export class RecorderDoor {
  constructor(private readonly client: Client) {}
  trends = (q: TrendQuery, signal?: AbortSignal) => this.client.call<Trends>(`/recorder/trends?${queryOf(q)}`, signal ? { signal } : {});
  trendsCsv = async (q: TrendQuery) => (await this.client.whole(`/recorder/trends?${queryOf(q)}`, { headers: { accept: 'text/csv' } })).text;
  /** What was done to these axes, as steps of a recipe; without `from_ms` of the last minute. Times are the gateway's. */
  steps = (axes: readonly string[], from_ms?: number) => this.client.call<RecordedSteps>(`/recorder/steps?${new URLSearchParams({ axes: axes.join(','), ...(from_ms === undefined ? {} : { from: String(from_ms) }) })}`);
  captures = () => this.client.call<CaptureList>('/recorder/captures');
  arm = (wish: CaptureWish) => this.client.call<Capture>('/recorder/captures', { method: 'POST', body: wish });
  capture = (name: string) => this.client.call<CaptureWithRows>(`/recorder/captures/${part(name)}`, { timeout_ms: 60_000 });
  captureCsv = async (name: string) => (await this.client.whole(`/recorder/captures/${part(name)}`, { headers: { accept: 'text/csv' }, timeout_ms: 60_000 })).text;
  recordings = () => this.client.call<RecordingList>('/recorder/recordings');
  playback = (name: string, q: { at_ms?: number; frames: number; columns?: number }) => {
    const query = new URLSearchParams({ frames: String(q.frames) });
    if (q.at_ms !== undefined) query.set('at', String(Math.max(0, Math.round(q.at_ms))));
    if (q.columns) query.set('columns', String(q.columns));
    return this.client.call<Playback>(`/recorder/recordings/${part(name)}/playback?${query}`, { timeout_ms: 60_000 });
  };
  record = (name: string, why: string) => this.client.call<Recording>('/recorder/recordings', { method: 'POST', body: why ? { name, why } : { name }, timeout_ms: 60_000 });
  rename = (kind: 'captures' | 'recordings', name: string, to: string) => this.client.call<unknown>(`/recorder/${kind}/${part(name)}`, { method: 'PATCH', body: { name: to } });
  remove = (kind: 'captures' | 'recordings', name: string) => this.client.call<void>(`/recorder/${kind}/${part(name)}`, { method: 'DELETE' });
}
export const recordingFile = (name: string) => `/api/v1/recorder/recordings/${part(name)}`;
