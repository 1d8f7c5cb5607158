// Session: who this page is to the gateway, and what that role may do. In: GET /session, sign-in, sign-out. Out: a signal, and reasons in words.
// What the gateway has not answered forbids nothing here: the gateway itself refuses. Never keeps a password; the CSRF token lives in memory only.
import { computed, signal, type Signal } from '@preact/signals';
import type { Client } from '../api/client';
import { asProblem, type Problem } from '../api/problem';
import type { Role, SessionInfo } from '../api/types';
import { t } from '../language';
import type { TabChannel } from './tab';

export const roles: readonly Role[] = ['viewer', 'operator', 'engineer', 'administrator'];
const roleText: Record<Role, string> = { viewer: t('viewer'), operator: t('operator'), engineer: t('engineer'), administrator: t('administrator') };
export const roleWord = (r: Role): string => roleText[r] ?? r;

type Caller = Pick<Client, 'call'> & Partial<Pick<Client, 'csrf' | 'onUnauthorized'>>;

export class Session {
  /** null: the gateway has not said yet, or is older than the page. */
  readonly info = signal<SessionInfo | null>(null);
  /** The page has to be left for the sign-in: the gateway knows nobody here. */
  readonly needed = computed(() => this.ended.value !== '' || (this.info.value !== null && this.info.value.role === null));
  /** Why one is signed out without having asked for it; empty: one is not. What was typed waits behind the sign-in. */
  readonly ended = signal('');
  /** Why a stop of this page would be refused; empty: it would not. Only where the gateway has said that it serves nobody here. */
  readonly stopBarred = computed(() => (this.info.value !== null && this.info.value.role === null ? 'Nobody is signed in here: the gateway refuses a stop from this page. Use the machine’s own emergency stop.' : ''));
  /** After an ended session: the gateway serves this machine without a sign-in too. */
  readonly mayGoOn = computed(() => this.ended.value !== '' && this.info.value?.via === 'local' && this.info.value.role !== null);
  private asking: Promise<void> | null = null;
  private again = false;
  private change = 0;
  /** Signing out on purpose is no end that has to be told. */
  private leaving = false;

  constructor(
    private readonly client: Caller,
    /** Who one is has changed: the stream has to be opened anew. */
    private readonly onChange: () => void = () => undefined,
    /** The other tabs of this browser, which share its cookie. */
    private readonly channel: TabChannel | null = null,
    /** Who is signed in in this browser, kept over reloads and tabs: whose session has ended is asked, not made local access without a word. */
    private readonly signedIn: Signal<string> = signal(''),
  ) {
    if (channel) channel.onmessage = () => void this.ask();
    client.onUnauthorized = (problem) => {
      if (problem.is('session_ended')) this.end(problem.text);
      void this.ask();
    };
  }

  /** One question at a time; asked meanwhile, it is asked once more afterwards. */
  ask(): Promise<void> {
    if (this.asking) {
      this.again = true;
      return this.asking;
    }
    this.asking = this.askOnce().finally(() => {
      this.asking = null;
      if (this.again) {
        this.again = false;
        void this.ask();
      }
    });
    return this.asking;
  }

  private async askOnce(): Promise<void> {
    const before = this.change;
    try {
      const info = await this.client.call<SessionInfo>('/session', { urgent: true });
      if (before === this.change) this.set(info); // an answer from before a sign-in says nothing about after it
    } catch {
      // Not reached: what was known stays, the strip tells the loss.
    }
  }

  private set(info: SessionInfo): void {
    const old = this.info.peek();
    // The answer that tells the end takes the cookie away: who one is without it is asked at once.
    if (info.ended) {
      this.end(info.ended);
      this.again = true;
    } else if ((old?.via === 'cookie' || this.signedIn.peek() !== '') && info.via !== 'cookie' && !this.leaving) {
      this.end('');
    }
    if (info.via === 'cookie') this.signedIn.value = info.user ?? '';
    // Signed in again, perhaps in another tab.
    const back = this.ended.peek() !== '' && info.via === 'cookie' && info.role !== null;
    if (back) this.ended.value = '';
    this.client.csrf = info.csrf;
    this.info.value = info;
    if (back || (old && (old.user !== info.user || old.role !== info.role || old.via !== info.via))) this.onChange();
  }

  private end(why: string): void {
    if (this.ended.peek() !== '') return;
    const known = why && !/session has ended/.test(why) ? why : t('it was ended elsewhere, it expired, or the gateway was restarted');
    this.change += 1; // what was asked before says nothing about after it
    this.ended.value = t('Your session has ended: {why}. Sign in again; what you typed is kept.', { why: known.replace(/[.\s]+$/, '') });
    this.onChange();
  }

  signIn = (user: string, password: string) => this.enter('/session', { user, password });
  first = (code: string, user: string, password: string) => this.enter('/session/first', { code, user, password });

  private async enter(path: string, body: object): Promise<Problem | null> {
    try {
      const info = await this.client.call<SessionInfo>(path, { method: 'POST', body });
      this.change += 1;
      const again = this.ended.peek() !== '';
      this.ended.value = '';
      this.set(info);
      if (again) this.onChange();
      this.tellOthers();
      return null;
    } catch (error) {
      const problem = asProblem(error);
      if (problem.status === 409) void this.ask();
      return problem;
    }
  }

  async signOut(): Promise<Problem | null> {
    try {
      await this.client.call<undefined>('/session', { method: 'DELETE' });
    } catch (error) {
      return asProblem(error);
    }
    this.change += 1;
    this.client.csrf = null;
    this.signedIn.value = '';
    this.leaving = true;
    await this.ask();
    this.leaving = false;
    this.tellOthers();
    return null;
  }

  /** On purpose from now on: without a session, with what the gateway gives this machine. */
  goOn(): void {
    this.signedIn.value = '';
    this.ended.value = '';
  }

  private tellOthers(): void {
    try {
      this.channel?.postMessage('changed');
    } catch {
      // A channel that is shut tells nobody: they ask when they are looked at.
    }
  }

  /** Why one may not do what needs this role; empty: one may. `what` begins the sentence. */
  mayNot(need: Role, what = t('This')): string {
    const info = this.info.value;
    if (!info || (info.role && roles.indexOf(info.role) >= roles.indexOf(need))) return '';
    return info.role ? t('{what} needs the role {need}. Yours is {role}.', { what, need: roleWord(need), role: roleWord(info.role) }) : t('{what} needs the role {need}. You are not signed in.', { what, need: roleWord(need) });
  }
}

/** "anna, engineer"; "local access, engineer". */
export function whoText(info: SessionInfo): string {
  if (!info.role) return t('not signed in');
  return `${info.user ?? (info.via === 'local' ? t('local access') : info.via)}, ${roleWord(info.role)}`;
}

/** What a disabled control tells about itself. */
export const barred = (why: string): { disabled?: true; title?: string; 'aria-description'?: string } => (why ? { disabled: true, title: why, 'aria-description': why } : {});

/** Why a sign-in did not work; for a lockout with the seconds to wait. */
export function signInText(p: Problem): string {
  if (p.status !== 429) return p.text;
  return p.retryAfter_s > 0 ? t('Too many wrong attempts. Try again in {n} s.', { n: p.retryAfter_s }) : p.text;
}

/** Rules of a password, told before the gateway has to. */
export function passwordFault(first: string, second: string): string {
  const n = [...first].length;
  if (n < 12) return t('A password has at least 12 characters; this one has {n}.', { n });
  if (n > 256) return t('A password has at most 256 characters.');
  return first === second ? '' : t('The two passwords are not the same.');
}
export const userFault = (name: string): string => (/^[a-z0-9._@-]{1,64}$/.test(name) ? '' : t('A name has 1 to 64 of a-z, 0-9, point, _ - and @.'));
