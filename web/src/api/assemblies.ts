// Assemblies at the HTTP door: EtherNet/IP instances of the site's own and of its profiles. In: a client. Out: documents.
import type { Client } from './client';
import type { components } from './schema';

export type Assembly = components['schemas']['Assembly'];
export type AssemblyEntry = components['schemas']['AssemblyEntry'];
export type Assemblies = components['schemas']['Assemblies'];
export type AssemblyImport = components['schemas']['AssemblyImport'];
/** The site's own as a file. */
export const assembliesAddress = '/api/v1/assemblies.csv';

export class AssemblyDoor {
  constructor(private readonly client: Client) {}
  all = () => this.client.call<Assemblies>('/assemblies');
  put = (instance: number, entry: AssemblyEntry) => this.client.call<AssemblyEntry>(`/assemblies/${instance}`, { method: 'PUT', body: entry });
  /** A table, all or nothing. `replace`: in place of all of the site's own. */
  table = async (csv: string, how: { replace: boolean; dryRun: boolean }): Promise<AssemblyImport> => {
    const r = await this.client.whole(`/assemblies.csv${how.dryRun ? '?dry_run=1' : ''}`, { method: how.replace ? 'PUT' : 'POST', content: { type: 'text/csv', data: csv } });
    return JSON.parse(r.text) as AssemblyImport;
  };
  remove = (instance: number) => this.client.whole(`/assemblies/${instance}`, { method: 'DELETE' });
}
