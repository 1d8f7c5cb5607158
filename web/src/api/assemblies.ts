// Assemblies at the HTTP door: EtherNet/IP instances of the site's own and of its profiles. In: a client. Out: documents.
import type { Client } from './client';
import type { components } from './schema';

export type Assembly = components['schemas']['Assembly'];
export type AssemblyEntry = components['schemas']['AssemblyEntry'];
export type Assemblies = components['schemas']['Assemblies'];

export class AssemblyDoor {
  constructor(private readonly client: Client) {}
  all = () => this.client.call<Assemblies>('/assemblies');
  put = (instance: number, entry: AssemblyEntry) => this.client.call<AssemblyEntry>(`/assemblies/${instance}`, { method: 'PUT', body: entry });
  remove = (instance: number) => this.client.whole(`/assemblies/${instance}`, { method: 'DELETE' });
}
