// Problem: what went wrong with a request, always with a sentence for people.
// In: a response that is not good, or what fetch threw. Out: a Problem. Never shows a status number where the gateway gave words.
import { language, t, theirs } from '../language';
import { plain } from '../text/plain';
import { reasonWord } from '../text/reason';
import type { ProblemDocument } from './types';

export type ProblemKind =
  | 'answered' // the gateway said no, and why
  | 'unreachable' // nobody answered
  | 'timed_out' // no answer within the limit
  | 'cancelled' // the page itself gave it up
  | 'crowded'; // too many requests wait in the page

export class Problem extends Error {
  override readonly name = 'Problem';
  constructor(
    readonly kind: ProblemKind,
    detail: string,
    readonly status = 0,
    readonly document: ProblemDocument = {},
    /** Seconds that the gateway asks to wait; 0: it did not. */
    readonly retryAfter_s = 0,
  ) {
    super(plain(detail));
  }

  /** The stable word of the gateway ("wrong_state"), or the kind where the gateway said nothing. */
  get reason(): string {
    return this.document.reason ?? this.kind;
  }

  /** Whether it is of this type, such as `stage_taken`. */
  is(type: string): boolean {
    return this.document.reason === type || (this.document.type ?? '').endsWith(`:${type}`) || (this.document.type ?? '').endsWith(`/${type}`);
  }

  /** The gateway's sentence, every fault of a document that is wrong, and the drive's own code. */
  get text(): string {
    const faults = (this.document.faults ?? []).map((f) => f.text).filter((t) => t && !this.message.includes(t));
    const code = this.document.code;
    const own = [this.message, ...faults.map(plain)].join('; ');
    const published = this.document.detail || this.document.title ? theirs(own) : own;
    // The gateway speaks English; what kind of refusal it is stands before its own words in the reader's language.
    const kind = language() === 'en' || this.kind !== 'answered' ? '' : reasonWord(this.reason);
    const text = kind ? `${kind}: ${published}` : published;
    return code !== null && code !== undefined ? t("{text} (drive's code {code})", { text, code }) : text;
  }
}

/** Reads the body of a response that is not good. Something else than a problem document becomes one. */
export async function problemOf(response: Response): Promise<Problem> {
  const text = await response.text().catch(() => '');
  const wait = Number(response.headers.get('retry-after') ?? 0);
  const retryAfter_s = Number.isFinite(wait) && wait > 0 ? Math.ceil(wait) : 0;
  const type = response.headers.get('content-type') ?? '';
  if (/^application\/(problem\+)?json\b/.test(type)) {
    try {
      const document = JSON.parse(text) as ProblemDocument;
      const detail = document.detail || document.title;
      if (typeof detail === 'string' && detail) return new Problem('answered', detail, response.status, document, retryAfter_s);
    } catch {
      // Half a document says nothing: the status has to do.
    }
  }
  return new Problem('answered', t('the gateway answered {status}', { status: `${response.status} ${response.statusText}`.trim() }), response.status, {}, retryAfter_s);
}

export function asProblem(error: unknown): Problem {
  return error instanceof Problem ? error : new Problem('unreachable', error instanceof Error ? error.message : String(error));
}
