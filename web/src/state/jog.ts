// Jog: the axis moves while a button is held, and stops when it is let go, whatever happens first. In: press and release. Out: one
// move_velocity with a dead-man time-out, renewed while held, then halts. The halt is sent at once, and again when the move has been answered
// if that came later; if it fails it is tried again for three seconds, and then said loudly. A renewal that fails or is not answered, and the
// loss of the connection, end the jog at once. Never moves again without a new press.
import { asProblem, Problem } from '../api/problem';
import type { Client } from '../api/client';
import { t } from '../language';
import type { Commander } from './commander';

/** The gateway halts the axis by itself when it has not heard of the jog for so long: the page may be gone, or its network. */
const hold_ms = 1000;
const renew_ms = 250;
/** A renewal that is not answered for so long has failed: what the page shows as held the gateway has nearly given up. */
const renewLimit_ms = 700;
const retry_ms = 300;
const mostRetries = 10;

export class Jog {
  private held = 0;

  constructor(
    private readonly client: Pick<Client, 'command'>,
    private readonly commander: Pick<Commander, 'send' | 'tell'>,
    private readonly axis: string,
  ) {}

  get active(): boolean {
    return this.held !== 0;
  }

  press(velocity: number, text: string): void {
    if (this.held) return;
    const mine = (this.held = Math.random());
    void this.commander.send(this.axis, { command: 'move_velocity', velocity, hold_ms }, text).then((answer) => {
      const taken = 'result' in answer;
      const certainlyNot = !taken && (answer.kind === 'cancelled' || (answer.kind === 'answered' && answer.status < 500));
      const stillHeld = this.held === mine;
      if (!taken && stillHeld) this.held = 0;
      // Let go before the answer: the first halt may have overtaken the move. No answer: the move may have been taken.
      if (!certainlyNot && !(taken && stillHeld)) void this.halt(false);
      if (taken && stillHeld) void this.renew(mine, velocity);
    });
  }

  /** The page hears nothing more: nobody jogs what he cannot see. */
  lost(): void {
    if (this.held) this.giveUp(t('the connection to the gateway is lost'));
  }

  /** Says again and again that the hand is still there. What fails is not made good: the jog is over, here and by the gateway's own time-out. */
  private async renew(mine: number, velocity: number): Promise<void> {
    for (;;) {
      await new Promise((r) => setTimeout(r, renew_ms));
      if (this.held !== mine) return;
      try {
        await inTime(this.client.command(this.axis, { command: 'move_velocity', velocity, hold_ms, renew: true }, true), renewLimit_ms);
      } catch (error) {
        const problem = asProblem(error);
        if (this.held !== mine) return;
        if (problem.kind === 'answered' && problem.status < 500) {
          this.held = 0;
          this.commander.tell(this.axis, 'refused', t('Jog: ended. {why}', { why: problem.text }));
          void this.halt(false);
        } else {
          this.giveUp(problem.text);
        }
        return;
      }
    }
  }

  private giveUp(why: string): void {
    this.held = 0;
    this.commander.tell(this.axis, 'refused', t('Jog: ended, {why}. The gateway halts the axis by itself {n} s after it last heard of the jog.', { why, n: hold_ms / 1000 }));
    void this.halt(true);
  }

  release(): void {
    if (!this.held) return;
    this.held = 0;
    void this.halt(true);
  }

  private async halt(say: boolean): Promise<void> {
    for (let i = 0; ; i += 1) {
      try {
        await this.client.command(this.axis, { command: 'halt' }, true);
        if (say) this.commander.tell(this.axis, 'good', t('Jog: ended, halt accepted'));
        return;
      } catch (error) {
        const problem = asProblem(error);
        // The drive said no: it is not moving by this jog, or it never will listen. Trying again changes nothing.
        if (problem.kind === 'answered' && problem.status < 500) {
          this.commander.tell(this.axis, 'refused', t('Jog: halt refused. {why}', { why: problem.text }));
          return;
        }
        this.commander.tell(this.axis, 'refused', t('Jog: the halt is NOT confirmed: {why}', { why: problem.text }));
        if (i >= mostRetries || this.held) return;
        await new Promise((r) => setTimeout(r, retry_ms));
      }
    }
  }
}

function inTime<T>(work: Promise<T>, limit_ms: number): Promise<T> {
  return new Promise((good, bad) => {
    const timer = setTimeout(() => bad(new Problem('timed_out', t('the gateway does not answer'))), limit_ms);
    work.then(good, bad).finally(() => clearTimeout(timer));
  });
}
