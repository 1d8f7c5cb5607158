// Scope trigger: at which level of which channel the picture is held. In: the scope's view, the time. Out: the setting; each change arms it anew.
import { useSignal } from '@preact/signals';
import { midSentence, t } from '../language';
import { channels, type Channel, type TriggerSetting } from '../state/scope';
import type { ScopeView } from '../state/scope-view';
import { parseNumber } from '../text/number';
import { channelNames, channelUnit } from '../text/scope';

const stateText = { off: '', waiting: t('Waiting for the trigger'), fired: t('Triggered, recording'), shown: t('Held by the trigger') } as const;

export function TriggerBar({ view, unit, now }: { view: ScopeView; unit: string; now: () => number }) {
  const typed = useSignal('0');
  const setting = view.trigger.value;
  const change = (part: Partial<TriggerSetting>) => {
    view.trigger.value = { ...view.trigger.peek(), ...part };
    view.machine.arm(now());
  };
  const parsed = parseNumber(typed.value);
  return (
    <div class="scope-trigger">
      <label>
        <span>{t('Trigger')}</span>
        <select value={setting.mode} onChange={(e) => change({ mode: e.currentTarget.value as TriggerSetting['mode'] })}>
          <option value="off">{t('off')}</option>
          <option value="single">{t('once')}</option>
          <option value="again">{t('each time')}</option>
        </select>
      </label>
      {setting.mode !== 'off' && (
        <>
          <label>
            <span>{t('when')}</span>
            <select value={setting.channel} onChange={(e) => change({ channel: e.currentTarget.value as Channel })}>
              {channels.map((c) => (
                <option key={c} value={c}>
                  {midSentence(channelNames[c])}
                </option>
              ))}
            </select>
          </label>
          <label>
            <span class="visually-hidden">{t('Edge')}</span>
            <select value={setting.edge} onChange={(e) => change({ edge: e.currentTarget.value as TriggerSetting['edge'] })}>
              <option value="rising">{t('rises through')}</option>
              <option value="falling">{t('falls through')}</option>
            </select>
          </label>
          <label>
            <span class="visually-hidden">{t('Level, {channel}', { channel: channelUnit(setting.channel, unit) })}</span>
            <input
              type="text"
              inputMode="decimal"
              autocomplete="off"
              size={8}
              value={typed.value}
              aria-invalid={!parsed.good}
              onInput={(e) => {
                typed.value = e.currentTarget.value;
                const p = parseNumber(typed.value);
                if (p.good) change({ level: p.value });
              }}
            />
            <span class="unit">{channelUnit(setting.channel, unit)}</span>
          </label>
          <button type="button" class="button small" onClick={() => view.machine.arm(now())}>
            {t('Arm')}
          </button>
          <span class="where" role="status">
            {parsed.good ? stateText[view.triggerState.value] : parsed.why}
          </span>
        </>
      )}
    </div>
  );
}
