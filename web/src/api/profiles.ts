// Profiles at the HTTP door: the languages that units can speak, and which do. In: a client. Out: documents.
import type { Client } from './client';
import type { components } from './schema';

export type Profile = components['schemas']['ProfileSpec'];
export type ProfileEntry = components['schemas']['ProfileEntry'];
export type Language = components['schemas']['LanguagePage'];
export type LanguageRegister = components['schemas']['LanguageRegister'];
export type Profiles = components['schemas']['Profiles'];

export class ProfileDoor {
  constructor(private readonly client: Client) {}
  all = () => this.client.call<Profiles>('/profiles');
  put = (unit: number, entry: ProfileEntry) => this.client.call<Profile>(`/profiles/${unit}`, { method: 'PUT', body: entry });
  remove = (unit: number) => this.client.whole(`/profiles/${unit}`, { method: 'DELETE' });
}
