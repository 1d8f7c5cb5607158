// Words about authority: who holds an axis, and how long still. In: an axis document, the gateway's time, the name of this tab. Out: text.
import type { Axis } from '../api/types';
import { t } from '../language';

export interface Held {
  /** Empty: nobody. */
  holder: string;
  rest_s: number;
  mine: boolean;
}
/** Somebody else may hold it by the same name of a user: only the name of the tab tells that it is this page. */
export function heldBy(axis: Pick<Axis, 'authority_holder' | 'authority_until'>, gatewayNow_ms: number, tab: string): Held {
  const holder = axis.authority_holder ?? '';
  const until = axis.authority_until ? Date.parse(axis.authority_until) : Number.NaN;
  const rest_s = Number.isNaN(until) ? 0 : Math.max(0, Math.ceil((until - gatewayNow_ms) / 1000));
  return { holder, rest_s, mine: tab !== '' && (holder === tab || holder.endsWith(` ${tab}`)) };
}

/** "anna page-1a2b3c" is anna to people. */
export const holderName = (holder: string): string => holder.replace(/ page-[0-9a-z]{6}$/, '');

/** Who did something, as the gateway writes it ("anna 10.0.0.7", "local 127.0.0.1", "token line (anna) 10.0.0.7"), to people: a machine is no name. */
export function personOf(by: string): string {
  const local = /^local(?: (.+))?$/.exec(by);
  if (local) return local[1] ? t('somebody at {address}', { address: local[1] }) : t('somebody else');
  return /^token \S+/.exec(by)?.[0] ?? by.split(' ')[0] ?? '';
}

/**
 * Whom a lease can be given to, as the gateway names them: clients of the last minutes and hosts connected by Modbus, and who holds another
 * axis. Of a page its user (or host) as well, before it: whichever page of hers comes first takes it. Never the page itself.
 */
export function handOverChoices(held: readonly { door: string; holder: string }[], clients: readonly string[], tab: string): string[] {
  const all = [...clients, ...held.filter((h) => h.holder !== '' && h.door !== 'none').map((h) => `${h.door} ${h.holder}`)].filter((c) => tab === '' || !c.endsWith(` ${tab}`));
  const users = all.filter((c) => / page-\w+$/.test(c)).map((c) => c.replace(/ page-\w+$/, ''));
  return [...new Set([...users, ...all])].sort();
}

/**
 * `door`: by which the last command came; `who`: by whom, as the gateway writes it, "http anna page-1a2b3c"; empty where it does not say. It says
 * nothing about who holds the axis now.
 */
export function commandedText(door: string, who: string, tab = ''): string {
  const by = clientText(who || door, tab);
  return by === 'none' || by === '' ? t('nobody has commanded it') : t('last commanded by {by}', { by });
}

/** A client as the gateway writes it, "http anna page-1a2b3c", to people; a door alone, where it names nobody. */
export function clientText(who: string, tab = ''): string {
  const [door = '', ...rest] = who.split(' ');
  const client = rest.join(' ');
  const by = door.replace('_', '/');
  if (tab !== '' && (client === tab || client.endsWith(` ${tab}`))) return t('this page');
  return client === '' ? by : `${holderName(client)} (${by})`;
}

export function heldText(h: Held): string {
  if (!h.holder) return t('Nobody holds it');
  const holder = holderName(h.holder), n = h.rest_s;
  if (h.mine) return n > 0 ? t('Held by this page, {n} s left', { n }) : t('Held by this page, about to end');
  return n > 0 ? t('Held by {holder}, {n} s left', { holder, n }) : t('Held by {holder}, about to end', { holder });
}
