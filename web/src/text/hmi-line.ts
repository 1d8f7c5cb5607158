// The first reading of an axis over Modbus/TCP: where it stands, what its words say, a line for mbpoll. In: doors, numbers, words. Out: text. Pure.
// The standard map of unit 1: axis n has 64 registers from (n - 1) * 64 on; 0 is its status word, 2 and 3 its position, high word first.
export const standardAddress = (number: number): number => (number - 1) * 64;

export interface Place {
  host: string;
  port: string;
  /** Nobody else reaches it. */
  local: boolean;
}
/** Where the Modbus/TCP door is for somebody who sees this page; null: it is shut. */
export function modbusPlace(doors: readonly { name: string; address: string }[], pageHost: string): Place | null {
  const door = doors.find((d) => d.name === 'modbus');
  const m = /^(.*):(\d+)$/.exec(door?.address ?? '');
  if (!m) return null;
  const bound = (m[1] ?? '').replace(/^\[|\]$/g, '');
  const local = /^(127\.|::1$|localhost$)/.test(bound);
  const any = bound === '0.0.0.0' || bound === '::' || bound === '';
  return { host: any ? pageHost : bound, port: m[2] as string, local };
}

export const mbpollLine = (p: Place, address: number): string => `mbpoll -m tcp -p ${p.port} -a 1 -t 4:int -B -0 -r ${address} -c 1 -1 ${p.host}`;

/** Of four words from the axis' first register. */
export function wordsOf(words: readonly number[] | undefined, exception: { code: number; text: string } | null): { status: number | null; position: number | null; text: string; fault: string } {
  const [status, , high, low] = words ?? [];
  if (exception || status === undefined || high === undefined || low === undefined) return { status: null, position: null, text: '', fault: exception ? `${exception.code}: ${exception.text}` : '' };
  const four = (n: number) => n.toString(16).toUpperCase().padStart(4, '0');
  return { status, position: (high << 16) | low, text: `${four(high)} ${four(low)}`, fault: '' };
}
