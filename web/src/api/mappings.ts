// Mappings at the HTTP door: list, change, tables, lists for printing, registers as the Modbus door answers them. In: a client. Out: documents.
import type { Mapping, MappingPoint, MappingSpec, Table } from '../text/mapping';
import type { components } from './schema';
import type { Client } from './client';

export type ModbusUnit = components['schemas']['ModbusUnit'];
export type MappingImport = components['schemas']['MappingImport'];
export interface Registers {
  unit: number;
  table: Table;
  address: number;
  words?: number[];
  bits?: (boolean | number)[];
  exception: { code: number; text: string } | null;
  decoded?: { address: number; name?: string; mapping?: string; type: string; value: number | string | boolean | null; unit?: string | null; text?: string | null }[];
}
export interface MappingList {
  rows: Mapping[];
  /** Revision of the site, as If-Match takes it. */
  revision: string;
  /** The hash that registers 18 and 19 show; empty: this gateway does not say it here. */
  hash: string;
}

const part = encodeURIComponent;
const matching = (revision: string): Record<string, string> => (revision ? { 'if-match': `"${revision}"` } : {});
const listPath = (format: string) => `/mappings/list?format=${format}`;
/** The printable list as a file of the gateway's own. */
export const listAddress = (format: string): string => `/api/v1${listPath(format)}`;

export class MappingDoor {
  constructor(private readonly client: Client) {}

  async list(): Promise<MappingList> {
    const r = await this.client.whole('/mappings');
    return { rows: JSON.parse(r.text) as Mapping[], revision: r.head.get('site-revision') ?? '', hash: r.head.get('mapping-revision') ?? '' };
  }
  points = () => this.client.call<MappingPoint[]>('/mapping-points');
  /** Each answers the revision of the site after it. */
  async add(spec: MappingSpec, revision: string): Promise<string> {
    return after(await this.client.whole('/mappings', { method: 'POST', body: spec, headers: matching(revision) }));
  }
  async replace(id: string, spec: MappingSpec, revision: string): Promise<string> {
    return after(await this.client.whole(`/mappings/${part(id)}`, { method: 'PUT', body: spec, headers: matching(revision) }));
  }
  async remove(id: string, revision: string): Promise<string> {
    return after(await this.client.whole(`/mappings/${part(id)}`, { method: 'DELETE', headers: matching(revision) }));
  }
  /** A table, all or nothing. `replace`: in place of all mappings. */
  async table(csv: string, how: { replace: boolean; dryRun: boolean; revision?: string }): Promise<{ report: MappingImport; revision: string }> {
    const r = await this.client.whole(`/mappings.csv${how.dryRun ? '?dry_run=1' : ''}`, {
      method: how.replace ? 'PUT' : 'POST',
      content: { type: 'text/csv', data: csv },
      headers: matching(how.revision ?? ''),
    });
    return { report: JSON.parse(r.text) as MappingImport, revision: after(r) };
  }
  template = (body: { template: string; axis: string; unit: number; address: number; dry_run: boolean }) =>
    this.client.call<Partial<MappingImport> & { mappings?: unknown }>('/mappings/template', { method: 'POST', body });
  registers(at: { unit: number; table: Table; address: number; count: number }, signal?: AbortSignal) {
    const q = new URLSearchParams({ unit: String(at.unit), table: at.table, address: String(at.address), count: String(at.count) });
    return this.client.call<Registers>(`/registers?${q}`, signal ? { signal } : {});
  }
  units = () => this.client.call<ModbusUnit[]>('/mappings/units');
  /** null: as the host's configuration has it. */
  setGaps = (unit: number, gaps: ModbusUnit['gaps']) => this.client.call<ModbusUnit>(`/mappings/units/${unit}`, { method: 'PUT', body: { gaps } });
  /** Whether the gateway makes printable lists; asks once, with the smallest of them. */
  hasLists = async (): Promise<boolean> => (await this.client.whole(listPath('csv'))).status === 200;
}
const after = (r: { head: Headers }): string => r.head.get('site-revision') ?? '';
