// Ports of the gateway's machine in words, and lines' URIs from them. In: ports as the gateway lists them, what stands in the field. Out: text. Pure.
import type { HostPort } from '../api/host';
import { t } from '../language';
import { freeName, type Entry } from './site';

const bare = (uri: string): string => uri.split('?')[0] ?? '';
/** "can", "serial"; empty: a line that is at no port. */
export const portKind = (uri: string): HostPort['kind'] | '' => (uri.startsWith('can:') ? 'can' : uri.startsWith('serial:') ? 'serial' : '');
export const portOf = (ports: readonly HostPort[], uri: string): HostPort | undefined =>
  ports.find((p) => p.uri === bare(uri) || (p.kind === 'serial' && bare(uri) === `serial:/dev/${p.name}`));
/** The same line at another port: its bit rate and form stay. */
export const atPort = (port: HostPort, uri: string): string => {
  const query = portKind(uri) === port.kind && uri.includes('?') ? uri.slice(uri.indexOf('?')) : '';
  return port.uri + query;
};
/** `own`: the line whose form it is; that it is there is no news. */
export function portText(p: HostPort, own: string): string {
  const more = [p.text, p.up ? '' : t('switched off'), p.line && p.line !== own ? t('line {line} is there', { line: p.line }) : ''].filter(Boolean);
  return [p.name, ...more].join(' · ');
}

const wishes: Record<string, string> = { serial: 'serial', tcp: 'tcp', 'tcp-listen': 'tcp', udp: 'udp', pty: 'pty', dds: 'fleet' };
/** A name that one would keep: a CAN interface's own, else the kind with a number. */
export function lineNameFor(uri: string, lines: readonly Entry[] | undefined): string {
  const kind = uri.split(':')[0] ?? '';
  if (kind === 'can') return freeName(lines, bare(uri).slice(4) || 'can0');
  return numbered(lines, wishes[kind] ?? 'line');
}
/** "feeder1", "feeder2": the first that is free. */
export function numbered(list: readonly Entry[] | undefined, wish: string): string {
  for (let i = 1; ; i += 1) {
    if (!(list ?? []).some((e) => e.name === `${wish}${i}`)) return `${wish}${i}`;
  }
}
