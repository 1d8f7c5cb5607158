// Fleet: every gateway of the domain and its axes, as they tell them, and commands to each. In: GET /fleet, once a second while the page is seen.
// Out: a card for each gateway; commands by DDS, each with its one result. Never commands by itself; old words are greyed and say how old they are.
import { useSignal } from '@preact/signals';
import { marked } from '../components/marked';
import { useMemo } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { Command, FleetAxis, FleetGateway } from '../api/types';
import { ResultLine, resultId } from '../components/axis-controls';
import { Field } from '../components/field';
import { useBarred, Why } from '../components/gate';
import { Icon } from '../components/icon';
import { Empty } from '../components/lines';
import { awayText, waiting } from '../components/loaded';
import { Mark, Pill } from '../components/pill';
import { Section } from '../components/section';
import { StopButton } from '../components/stop';
import { useGateway } from '../gateway';
import { rich, t } from '../language';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { useRepeated } from '../state/repeated';
import { markOf, motionWord, positionText, stateWord, unitOf } from '../text/axis';
import { aboutAxis, asAxis, clockText, gatewayWord, receivedText, trustOf } from '../text/fleet';
import { formatExact, parseQuantity } from '../text/number';
import { duration } from '../text/time';

const period_ms = 1_000;
/** More axes than this stay folded until their gateway is opened. */
const unfolded = 40;

export function FleetPage() {
  const { client, store } = useGateway();
  const connection = store.connection.value;
  const live = connection.phase === 'live';
  const fleet = useSignal<Awaited<ReturnType<typeof client.fleet>> | null>(null);
  const fault = useSignal('');
  const ask = async () => {
    try {
      fleet.value = await client.fleet();
      fault.value = '';
    } catch (error) {
      fault.value = capital(asProblem(error).text);
    }
  };
  useRepeated(ask, period_ms, live, [connection.epoch]);
  const known = fleet.value;
  const fresh = live && fault.value === '';
  const many = (known?.gateways.reduce((n, g) => n + g.axes.length, 0) ?? 0) > unfolded;
  return (
    <main class="page fleet">
      <h1 tabIndex={-1}>{t('Fleet')}</h1>
      {!known?.enabled && fault.value && <p class="card form" role="status" data-field="fleet-fault">{marked(fault.value)}</p>}
      {!known && !fault.value && <Empty text={awayText(connection) || waiting} />}
      {known && !known.enabled && <Empty text={t('This gateway is in no domain with others. The configuration switches it on: [dds] enabled = true.')} />}
      {known?.enabled && (
        <>
          {/* One place for both, always as high: no stop moves. */}
          <div class="fleet-told" tabIndex={0} role="group" aria-label={t('Messages of {name}', { name: t('Fleet') })}>
            {fault.value && <p role="status" data-field="fleet-fault">{marked(fault.value)}</p>}
            <p class="where">{t('A stop here goes to its one axis. The STOP in the head and the Escape key stop the axes of this gateway alone.')}</p>
          </div>
          <Why need="operator" what={t('Every command but a stop')} />
          {known.gateways.map((g) => (
            <GatewayCard key={g.instance} gateway={g} title={known.gateways.some((o) => o !== g && o.gateway === g.gateway) ? `${g.gateway} · ${g.instance}` : g.gateway} connected={fresh} many={many} />
          ))}
        </>
      )}
    </main>
  );
}

/** `title`: its name, and what tells it from another one of the same name. */
function GatewayCard({ gateway: g, title, connected, many }: { gateway: FleetGateway; title: string; connected: boolean; many: boolean }) {
  const open = useSignal(!many);
  const clock = clockText(g.clock_ahead_ms);
  return (
    <Section title={title} class="fleet-gateway" beside={<Pill label={t('Gateway')} word={gatewayWord(g, connected)} id="gateway-state" />}>
      <div class="card" data-gateway={g.gateway} data-instance={g.instance} data-alive={g.alive}>
        <div class="fleet-card-told" tabIndex={0} role="group" aria-label={t('Messages of {name}', { name: title })}>
          {g.namesake && (
            <p class="notice tone-warning" data-field="namesake">
              <Icon name="triangle" size={14} />
              <span>{t('Another gateway of the domain is called {name} as well: commands to either are refused, stops are not. Give one of them another name: [dds] name.', { name: g.gateway })}</span>
            </p>
          )}
          <p class="where">
            <span data-field="heard">{receivedText(g)}</span> · {rich('version {version}', { version: <span class="mono">{g.version}</span> })} · {g.alive ? t('running for {time}', { time: duration(g.uptime_s * 1000) }) : t('had run for {time}', { time: duration(g.uptime_s * 1000) })}
            {clock && ` · ${clock}`}
            {g.page && !g.here && (
              <>
                {' · '}
                <a href={g.page} target="_blank" rel="noopener">
                  {t('its page')}
                </a>
              </>
            )}
          </p>
        </div>
        {g.axes.length === 0 ? (
          <p class="where fleet-about">{t('No axis has been told.')}</p>
        ) : open.value ? (
          <ul class="fleet-axes" aria-label={t('Axes of {gateway}', { gateway: g.gateway })}>
            {g.axes.map((a) => (
              <AxisLine key={a.axis} gateway={g} axis={a} connected={connected} />
            ))}
          </ul>
        ) : (
          <p class="fleet-about">
            <button type="button" class="button" onClick={() => (open.value = true)}>
              {t('Show the {n} axes of {gateway}', { n: g.axes.length, gateway: g.gateway })}
            </button>
          </p>
        )}
      </div>
    </Section>
  );
}

function AxisLine({ gateway: g, axis: a, connected }: { gateway: FleetGateway; axis: FleetAxis; connected: boolean }) {
  const { fleet } = useGateway();
  const open = useSignal(false);
  const at = `${g.gateway}/${a.axis}`;
  const trust = trustOf(g, a, connected);
  const shown = asAxis(a);
  // Two gateways of one name have axes of the same names.
  const result = `${resultId(at)}-${g.instance}`;
  return (
    <li class="fleet-axis" data-axis={at} data-condition={a.fault && trust === 'live' ? 'fault' : trust} data-presence={shown.presence}>
      <h3>{a.axis}</h3>
      <Mark mark={markOf(shown)} />
      <p class={`row-position${trust === 'live' ? '' : ' is-old'}`} data-field="position" data-value={shown.position ?? ''} data-live={trust === 'live'}>
        <span class="visually-hidden">{trust === 'live' ? t('Position') : t('Last known position, not live')}: </span>
        <span class="figure">{positionText(shown)}</span> <span class="unit">{unitOf(shown)}</span>
      </p>
      <p class="pills">
        <Pill label={t('State')} word={stateWord(shown, trust)} id="state" />
        <Pill label={t('Motion')} word={motionWord(shown, trust)} id="motion" />
      </p>
      <div class="fleet-said" tabIndex={0} role="group" aria-label={t('Messages of {name}', { name: at })}>
        <ResultLine axis={at} id={result} by={fleet} />
        <p class="where" data-field="about">{aboutAxis(g, a)}</p>
      </div>
      <button type="button" class="button fleet-command" aria-expanded={open.value} aria-label={t('Command {at}', { at })} onClick={() => (open.value = !open.value)}>
        {t('Command')}
      </button>
      <StopButton axis={at} urgent={a.moving && trust === 'live'} by={fleet} />
      {open.value && <Controls at={at} unit={unitOf(shown)} result={result} />}
    </li>
  );
}

/** What an operator needs to bring an axis somewhere; all else is on its own gateway's page. */
function Controls({ at, unit, result }: { at: string; unit: string; result: string }) {
  const { fleet } = useGateway();
  const no = useBarred('operator');
  const typed = useMemo(() => ({ target: persisted(`fleet.${at}.target`), speed: persisted(`fleet.${at}.speed`) }), [at]);
  const error = useSignal<'target' | 'speed' | ''>('');
  const send = (command: Command, text: string) => void fleet.send(at, command, text);
  const move = () => {
    const target = parseQuantity(typed.target.value);
    const speed = typed.speed.value.trim() === '' ? null : parseQuantity(typed.speed.value);
    error.value = !target.good ? 'target' : speed && !(speed.good && speed.value > 0) ? 'speed' : '';
    if (!target.good) return fleet.tell(at, 'refused', t('Target: {why}', { why: target.why }));
    if (speed && !speed.good) return fleet.tell(at, 'refused', t('Speed: {why}', { why: speed.why }));
    if (speed?.good && speed.value <= 0) return fleet.tell(at, 'refused', t('Speed: It must be greater than 0.'));
    send({ command: 'move_absolute', position: target.value, ...(speed?.good ? { velocity: speed.value } : {}) }, t('Move to {target} {unit}', { target: formatExact(target.value), unit }));
  };
  return (
    <div class="fleet-controls">
      <span class="group">
        <button type="button" class="button" aria-label={t('Enable {at}', { at })} {...no} onClick={() => send({ command: 'enable' }, t('Enable'))}>{t('Enable')}</button>
        <button type="button" class="button" aria-label={t('Disable {at}', { at })} title={t('Takes the power off at once; the shaft is free')} {...no} onClick={() => send({ command: 'disable' }, t('Disable'))}>{t('Disable')}</button>
      </span>
      <button type="button" class="button" aria-label={t('Reset fault of {at}', { at })} {...no} onClick={() => send({ command: 'reset_fault' }, t('Reset fault'))}>{t('Reset')}</button>
      <button type="button" class="button" aria-label={t('Halt {at}', { at })} title={t('Stop on the profile ramp, stay enabled')} onClick={() => send({ command: 'halt' }, t('Halt'))}>{t('Halt')}</button>
      <Field label={t('Target')} longLabel={t('Target of {at}', { at })} unit={unit} text={typed.target} invalid={error.value === 'target'} describedBy={result} onEnter={move} />
      <Field label={t('Speed')} longLabel={t('Speed of {at}', { at })} unit={`${unit}/s`} text={typed.speed} invalid={error.value === 'speed'} describedBy={result} placeholder={t('as is')} onEnter={move} />
      <button type="button" class="button tinted" aria-label={t('Move to target of {at}', { at })} {...no} onClick={move}>{t('Move to')}</button>
    </div>
  );
}
