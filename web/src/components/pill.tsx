// Pill: a state in words with an icon and a tone. Its width is kept while the words change, so that nothing beside it moves.
import type { Word } from '../text/axis';
import { Icon } from './icon';

export function Pill({ word, label, id }: { word: Word; label: string; id?: string }) {
  return (
    <span class={`pill tone-${word.tone}`} title={word.long} data-field={id}>
      <Icon name={word.icon} size={14} />
      <span class="visually-hidden">{label}: </span>
      <span class="pill-text">{word.text}</span>
    </span>
  );
}

export function Mark({ mark }: { mark: { text: string; kind: string; long: string } }) {
  return (
    <span class={`mark mark-${mark.kind}`} title={mark.long} data-field="mark">
      {mark.text}
    </span>
  );
}
