// Marked: a sentence in which the gateway, a catalogue or a drive may have a say: their words in an element of their own that says `lang="en"`, for screen
// readers. In: a sentence with the signs that `theirs()` sets. Out: what Preact draws; a sentence without a sign as it is.
import { gatewayText } from '../language';

export const marked = (sentence: string) =>
  sentence.split(/\u2068([^\u2069]*)\u2069/).map((text, i) => (i % 2 === 1 ? <span {...gatewayText}>{text}</span> : text));
