// What is wrong: a compact list at the top of the overview, each entry a link to where it can be mended. In: the store. Out: a list, or nothing.
// Old values are no news: without a connection the strip says what there is to say.
import { useGateway } from '../gateway';
import { whatIsWrong } from '../words/alarm';
import { Icon } from './icon';
import { Section } from './section';

const most = 12;

export function WrongList() {
  const { store } = useGateway();
  if (!store.connected.value || !store.listed.value) return null;
  const all = whatIsWrong(
    store.axisNames.value.flatMap((n) => store.axis(n)?.value.data ?? []),
    store.lineNames.value.flatMap((n) => store.line(n)?.value.data ?? []),
    store.driveNames.value.flatMap((n) => store.drive(n)?.value.data ?? []),
    store.alarms.value?.unacknowledged ?? 0,
  );
  if (all.length === 0) return null;
  return (
    <Section title="What is wrong" class="wrong">
      <ul class="card" aria-label="What is wrong" data-field="wrong">
        {all.slice(0, most).map((w) => (
          <li key={w.key}>
            <a class={`wrong-item tone-${w.word.tone}`} href={w.path} data-wrong={w.key}>
              <span class="wrong-word">
                <Icon name={w.word.icon} size={14} /> {w.word.text}
              </span>
              {w.about && <b>{w.about}</b>}
              <span class="wrong-text">{w.text}</span>
            </a>
          </li>
        ))}
        {all.length > most && <li class="wrong-item">and {all.length - most} more</li>}
      </ul>
    </Section>
  );
}
