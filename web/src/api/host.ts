// The gateway's machine at the HTTP door: where a line can be. In: a client. Out: documents.
import type { Client } from './client';
import type { components } from './schema';

export type HostPort = components['schemas']['HostPort'];
export const hostPorts = (client: Client): Promise<HostPort[]> => client.call<HostPort[]>('/host/ports');
