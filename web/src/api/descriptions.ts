// Descriptions at the HTTP door: makers' EDS and DCF files, what each holds, its objects. In: a client. Out: documents.
import type { Client } from './client';
import type { components } from './schema';

export type DescriptionEntry = components['schemas']['DescriptionEntry'];
export type Description = components['schemas']['Description'];
export type DescriptionObject = components['schemas']['DescriptionObject'];

const pathOf = (name: string): string => `/descriptions/${encodeURIComponent(name)}`;
/** The file itself, as it was received. */
export const descriptionFile = (name: string): string => `/api/v1${pathOf(name)}?format=eds`;

export class DescriptionDoor {
  constructor(private readonly client: Client) {}

  list = () => this.client.call<DescriptionEntry[]>('/descriptions');
  one = (name: string) => this.client.call<Description>(pathOf(name), { headers: { accept: 'application/json' } });
  objects = (name: string) => this.client.call<DescriptionObject[]>(`${pathOf(name)}/objects`);
  /** Byte by byte: such files come in several codings. */
  async add(name: string, file: Blob): Promise<Description> {
    const r = await this.client.whole(`/descriptions?name=${encodeURIComponent(name)}`, { method: 'POST', content: { type: 'application/octet-stream', data: file }, timeout_ms: 60_000 });
    return JSON.parse(r.text) as Description;
  }
  remove = (name: string) => this.client.call<unknown>(pathOf(name), { method: 'DELETE' });
}
