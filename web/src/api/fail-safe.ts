// Fail-safe at the HTTP door: what happens to each axis when who commands it is lost, and the rehearsal of it. In: a client. Out: documents.
import type { Client } from './client';
import type { components } from './schema';

export type Matrix = components['schemas']['FailSafeMatrix'];
export type FailSafeRow = components['schemas']['FailSafeRow'];
export type Choice = components['schemas']['FailSafeChoice'];
export type Action = components['schemas']['FailSafeAction'];
export type Rehearsal = components['schemas']['FailSafeRehearsal'];
export type Cell = components['schemas']['FailSafeCell'];
export type Step = components['schemas']['RehearsalStep'];

export class FailSafeDoor {
  constructor(private readonly client: Client) {}
  matrix = () => this.client.call<Matrix>('/fail_safe');
  put = (axis: string, choice: Choice) => this.client.call<FailSafeRow>(`/fail_safe/${encodeURIComponent(axis)}`, { method: 'PUT', body: choice });
  rehearsal = () => this.client.call<Rehearsal>('/fail_safe/rehearsal');
  rehearse = (steps: Step[]) => this.client.call<Rehearsal>('/fail_safe/rehearsal', { method: 'POST', body: { steps } });
}
