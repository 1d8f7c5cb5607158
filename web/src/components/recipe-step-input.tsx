// Recipe step input: one field of a step: a choice or a text, with what can be meant by it offered while typing. In: the field, its value, its place in the recipe.
// Out: a changed copy of the document.
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { HandItem } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { capital } from '../state/commander';
import { plainWord } from '../text/plain';
import { at, changed, commands, pointerOf, typedOf, valueOf, withCommand, type Json, type Path, type StepField } from '../text/recipe';
import { AxisMark, useEditing, useMeant } from './recipe-editing';
import { Typed } from './typed';

export function StepInput({ field, path, value, title, unit }: { field: StepField; path: Path; value: unknown; title: string; unit: string }) {
  const { document, change } = useEditing();
  const put = (v: Json | undefined) => change(changed(document, path, () => (v === undefined && !field.optional ? '' : v)));
  const label = `${title}: ${field.label}`;
  if (field.kind === 'command' || field.kind === 'register_type') {
    const choices = field.kind === 'command' ? commands : ['', 'u16', 'i16', 'u32', 'i32', 'f32', 'u64', 'i64', 'f64', 'bool'];
    return (
      <label class="step-field">
        <span>{field.label}</span>
        <select aria-label={label} value={typedOf(value)} onChange={(e) => {
            const to = e.currentTarget.value;
            if (field.kind === 'command') change(changed(document, path.slice(0, -1), (body: { [k: string]: Json }) => withCommand(body, to)));
            else put(to === '' ? undefined : to);
          }}
        >
          {choices.map((c) => (
            <option key={c} value={c}>
              {c === '' ? t('as mapped') : field.kind === 'command' ? capital(plainWord(c)) : plainWord(c)}
            </option>
          ))}
        </select>
      </label>
    );
  }
  return (
    <label class={`step-field${field.kind === 'text' ? ' is-wide' : ''}`}>
      <span>
        {field.label}
        {unit && <span class="unit">, {unit}</span>}
      </span>
      {field.kind === 'axis' && <AxisMark named={value} />}
      {field.kind === 'input' && <InputOffers id={`offers-${pointerOf(path)}`} named={at(document, [...path.slice(0, -1), 'axis'])} />}
      <Typed
        spellcheck={false}
        list={field.kind === 'axis' ? 'recipe-axes' : field.kind === 'input' ? `offers-${pointerOf(path)}` : undefined}
        aria-label={label}
        placeholder={field.optional ? t('none') : undefined}
        value={typedOf(value)}
        onDone={(typed) => {
          if (field.kind === 'text' || field.kind === 'axis' || field.kind === 'input') put(typed === '' && field.optional ? undefined : typed);
          else put(valueOf(typed));
        }}
      />
    </label>
  );
}

/** What can be simulated on this axis' drive, offered while typing. */
function InputOffers({ id, named }: { id: string; named: unknown }) {
  const { client, store } = useGateway();
  const offers = useSignal<HandItem[]>([]);
  const axis = useMeant(named);
  const simulated = store.simulation('axis', axis).value;
  useEffect(() => {
    const drive = store.axis(axis)?.peek()?.data.drive;
    if (!simulated || !drive) return void (offers.value = []);
    const end = new AbortController();
    client.hand(drive, end.signal).then((items) => (offers.value = items.filter((i) => i.writable)), () => undefined);
    return () => end.abort();
  }, [axis, simulated]);
  return (
    <datalist id={id}>
      {offers.value.map((i) => (
        <option key={i.name} value={i.name}>
          {i.description}
        </option>
      ))}
    </datalist>
  );
}

/** Said where a step would tell a real drive what is not so. */
export function SimulateText({ axis: named }: { axis: unknown }) {
  const { store } = useGateway();
  const axis = useMeant(named);
  if (axis === '' || store.axis(axis) === undefined || store.simulation('axis', axis).value) return null;
  return (
    <p class="step-fault" data-field="not-simulated">
      {t('{axis} is not simulated now: a run would be refused. A real drive is never told what is not so.', { axis })}
    </p>
  );
}
