// Gateway: the program itself: version, doors and their addresses, users, the Modbus door's rules, families, keys. In: /about, /modbus. Out: a page.
import { LanguageChoice } from '../components/language';
import { Empty } from '../components/lines';
import { ModbusDoor } from '../components/modbus-door';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { rich, t } from '../language';
import { setTheme, theme, type Theme } from '../state/theme';
import { duration } from '../text/time';

export function GatewayPage() {
  const { store } = useGateway();
  const about = store.about.value;
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>{t('Gateway')}</h1>
      {about ? (
        <>
          <Section title={t('Program')}>
            <dl class="card facts">
              <div><dt>{t('Version')}</dt><dd class="mono">{about.version}</dd></div>
              <div><dt>{t('Running for')}</dt><dd>{t('{time} when this page connected', { time: duration(about.uptime_s * 1000) })}</dd></div>
              <div><dt>{t('Site revision')}</dt><dd class="mono">{store.siteRevision.value ?? t('not told yet')}</dd></div>
              <div><dt>{t('Families')}</dt><dd class="mono">{about.families.join(', ') || t('none')}</dd></div>
            </dl>
          </Section>
          <Section title={t('Doors')}>
            <dl class="card facts">
              {about.doors.map((d) => (
                <div key={d.name}><dt>{d.name}</dt><dd class="mono">{d.address}</dd></div>
              ))}
            </dl>
          </Section>
          <Section title={t('Commissioning report')}>
            <p class="card form">
              <span>
                {t('Site, wiring, parameters, registers, curves and the rehearsal of loss of command in one document to print and sign:')} <a href="/report">{t('Commissioning report')}</a>
              </span>
            </p>
          </Section>
          <Section title={t('Users and tokens')}>
            <p class="card form">
              <span>
                {t('Who may sign in, with which role, and access for programs:')} <a href="/users">{t('Users and tokens')}</a>
              </span>
            </p>
          </Section>
          <ModbusDoor />
        </>
      ) : (
        <Empty text={t('Waiting for the gateway.')} />
      )}
      <Section title={t('This page')}>
        <dl class="card facts">
          <div>
            <dt>{t('Theme')}</dt>
            <dd>
              <label class="select">
                <span class="visually-hidden">{t('Theme')}</span>
                <select value={theme.value} onChange={(e) => setTheme(e.currentTarget.value as Theme)}>
                  <option value="system">{t('as the system')}</option>
                  <option value="light">{t('light')}</option>
                  <option value="dark">{t('dark')}</option>
                </select>
              </label>
            </dd>
          </div>
          <div><dt>{t('Language')}</dt><dd><LanguageChoice /></dd></div>
          <div class="with-keys"><dt>{t('Keys')}</dt><dd>{rich('{esc} stops all axes, wherever the keyboard is; while you type, it empties the field first and stops when pressed again. {space} or {enter} held on a jog button moves. {enter} in a field does what the button beside it does.', { esc: <kbd>Esc</kbd>, space: <kbd>{t('Space')}</kbd>, enter: <kbd>{t('Enter')}</kbd> })}</dd></div>
          <div><dt>{t('Handbook')}</dt><dd><a href="/help/" target="axisgate-help">{t('All chapters')}</a></dd></div>
          <div><dt>API</dt><dd><a href="/api/v1/openapi.yaml" target="_blank" rel="noopener">openapi.yaml</a></dd></div>
        </dl>
      </Section>
    </main>
  );
}
