// The site at the HTTP door: the document, the staged change, history, scan of a line, backup. In: a client. Out: documents.
// `revision` is the entity tag that If-Match takes: a change against an older site is refused with 412.
import type { Site } from '../text/site';
import type { Client } from './client';
import type { components } from './schema';

export type SiteFault = components['schemas']['Fault'];
export type SiteChange = components['schemas']['SiteChange'];
export interface StageDiff {
  kind: 'added' | 'removed' | 'changed';
  what: string;
  before?: Record<string, unknown> | null;
  after?: Record<string, unknown> | null;
}
export interface Stage {
  state: 'none' | 'staged' | 'applying' | 'applied' | 'rolling_back';
  /** Text: apply takes it, so that only what was shown is applied. A number: an older gateway, which cannot be asked for that. */
  id?: string | number | null;
  faults?: SiteFault[];
  diff?: StageDiff[];
  /** Axes that lose their connection for a moment. */
  disturbs?: string[];
  /** Connections that applying closes; null: the doors did not say. */
  closes?: { id: string; kind: string; peer: string; axes: string[] }[] | null;
  /** The gateway's clock; only while applied. */
  confirm_by?: string | null;
  /** Who staged or applied it: the name and where from. */
  by?: string | null;
  /** The client that did, with its X-Client; it alone can keep what was applied. */
  client?: string | null;
}
/** A restore that waits for the next start. */
export type Pending = components['schemas']['PendingBackup'];

const sealing = (passphrase: string): Record<string, string> => (passphrase === '' ? {} : { 'x-backup-passphrase': encodeURIComponent(passphrase) });
export interface HistoryEntry {
  revision: number;
  at: string;
  who: string | null;
  bytes: number;
}
export interface Scan {
  /** none: never scanned. */
  state: 'none' | 'running' | 'done' | 'failed' | 'cancelled';
  progress: number;
  found: { address: number | string; family?: string; text?: string; known_as?: string | null }[];
  asked?: number;
  text?: string;
}

const part = encodeURIComponent;

export class SiteDoor {
  constructor(private readonly client: Client) {}

  async read(): Promise<{ site: Site; tag: string }> {
    const r = await this.client.whole('/site');
    return { site: JSON.parse(r.text) as Site, tag: r.head.get('etag') ?? '' };
  }
  /** Without `tag` nothing is said about the site it is meant for; only a dry run may do that. */
  replace = (site: Site, how: { dryRun: boolean; tag: string }) =>
    this.client.call<SiteChange>(`/site${how.dryRun ? '?dry_run=1' : ''}`, { method: 'PUT', body: site, headers: how.tag ? { 'if-match': how.tag } : {} });

  stage = () => this.client.call<Stage>('/site/stage');
  /** `replace`: also in place of what another client has staged. */
  putStage = (site: Site, tag: string, replace = false) => this.client.call<Stage>(`/site/stage${replace ? '?replace=true' : ''}`, { method: 'POST', body: site, headers: tag ? { 'if-match': tag } : {} });
  discard = () => this.client.call<unknown>('/site/stage', { method: 'DELETE' });
  /** `stage`: the id of the stage that was shown; another one is not applied. Empty: whatever is staged, at an older gateway. */
  apply = (confirm_within_s: number, stage = '') =>
    this.client.call<Partial<Stage>>('/site/stage/apply', { method: 'POST', body: stage ? { confirm_within_s, stage } : { confirm_within_s }, timeout_ms: 60_000 });
  confirm = () => this.client.call<unknown>('/site/stage/confirm', { method: 'POST', body: {} });
  rollBack = () => this.client.call<unknown>('/site/stage/roll-back', { method: 'POST', body: {}, timeout_ms: 60_000 });

  /** The newest, or with `before` those below that revision. */
  history = (limit: number, before = 0) => this.client.call<HistoryEntry[]>(`/site/history?limit=${limit}${before > 0 ? `&before=${before}` : ''}`);
  old = (revision: number) => this.client.call<Site>(`/site/history/${revision}`);
  restore = (revision: number) => this.client.call<Stage>(`/site/history/${revision}/restore`, { method: 'POST', body: {} });

  startScan = (line: string, range: { from?: number; to?: number }) => this.client.whole(`/lines/${part(line)}/scan`, { method: 'POST', body: range });
  scan = (line: string) => this.client.call<Scan>(`/lines/${part(line)}/scan`);
  endScan = (line: string) => this.client.call<unknown>(`/lines/${part(line)}/scan`, { method: 'DELETE' });

  pending = () => this.client.call<Pending>('/backup/pending');
  dropPending = () => this.client.call<unknown>('/backup/pending', { method: 'DELETE' });
  /** With a passphrase it is sealed, and has the private keys in it. */
  backup = (passphrase: string) =>
    this.client.bytes('/backup', { timeout_ms: 120_000, headers: { accept: 'application/octet-stream, application/problem+json', ...sealing(passphrase) } });
  async restoreBackup(file: Blob, passphrase: string): Promise<{ text?: string; restart_needed?: boolean; detail?: string }> {
    const r = await this.client.whole('/backup', { method: 'PUT', content: { type: 'application/octet-stream', data: file }, timeout_ms: 120_000, headers: sealing(passphrase) });
    try {
      return JSON.parse(r.text) as { text?: string };
    } catch {
      return {};
    }
  }
}
