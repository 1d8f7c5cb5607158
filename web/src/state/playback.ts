// Moments: which instant of a recording is shown while the wanted one moves on. In: the instant that is wanted, the answers of the gateway.
// Out: documents to show. One request at a time: whatever moves on meanwhile is asked for next, so that none starves. An answer is shown if it is
// nearer to what is wanted now than what is shown, also when the wanted instant has moved on. Never reads a clock.

export class Moments<T> {
  private wanted_ms = NaN;
  private shown_ms = NaN;
  private asking = false;
  private over = false;

  constructor(
    private readonly ask: (at_ms: number) => Promise<T>,
    private readonly show: (doc: T) => void,
    private readonly fail: (error: unknown) => void,
  ) {}

  /** `doc` was asked for elsewhere. */
  known(at_ms: number, doc: T): void {
    this.wanted_ms = at_ms;
    this.take(at_ms, doc);
  }

  want(at_ms: number): void {
    this.wanted_ms = at_ms;
    void this.turn();
  }

  /** No answer is shown from now on. */
  end(): void {
    this.over = true;
  }

  private async turn(): Promise<void> {
    if (this.asking) return;
    this.asking = true;
    let asked_ms = this.shown_ms;
    while (!this.over && asked_ms !== this.wanted_ms) {
      asked_ms = this.wanted_ms;
      try {
        const doc = await this.ask(asked_ms);
        if (!this.over) this.take(asked_ms, doc);
      } catch (error) {
        if (!this.over) this.fail(error);
      }
    }
    this.asking = false;
  }

  private take(at_ms: number, doc: T): void {
    if (Math.abs(at_ms - this.wanted_ms) > Math.abs(this.shown_ms - this.wanted_ms)) return;
    this.shown_ms = at_ms;
    this.show(doc);
  }
}
