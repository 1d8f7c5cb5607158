// Gateway: the program itself: version, doors and their addresses, users, the Modbus door's rules, families, keys. In: /about, /modbus. Out: a page.
import { Empty } from '../components/lines';
import { ModbusDoor } from '../components/modbus-door';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { setTheme, theme, type Theme } from '../state/theme';
import { duration } from '../text/time';

export function GatewayPage() {
  const { store } = useGateway();
  const about = store.about.value;
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>Gateway</h1>
      {about ? (
        <>
          <Section title="Program">
            <dl class="card facts">
              <div><dt>Version</dt><dd class="mono">{about.version}</dd></div>
              <div><dt>Running for</dt><dd>{duration(about.uptime_s * 1000)} when this page connected</dd></div>
              <div><dt>Site revision</dt><dd class="mono">{store.siteRevision.value ?? 'not told yet'}</dd></div>
              <div><dt>Families</dt><dd class="mono">{about.families.join(', ') || 'none'}</dd></div>
            </dl>
          </Section>
          <Section title="Doors">
            <dl class="card facts">
              {about.doors.map((d) => (
                <div key={d.name}><dt>{d.name}</dt><dd class="mono">{d.address}</dd></div>
              ))}
            </dl>
          </Section>
          <Section title="Commissioning report">
            <p class="card form">
              <span>
                Site, wiring, parameters, registers, curves and the rehearsal of loss of command in one document to print and sign: <a href="/report">Commissioning report</a>
              </span>
            </p>
          </Section>
          <Section title="Users and tokens">
            <p class="card form">
              <span>
                Who may sign in, with which role, and access for programs: <a href="/users">Users and tokens</a>
              </span>
            </p>
          </Section>
          <ModbusDoor />
        </>
      ) : (
        <Empty text="Waiting for the gateway." />
      )}
      <Section title="This page">
        <dl class="card facts">
          <div>
            <dt>Theme</dt>
            <dd>
              <label class="select">
                <span class="visually-hidden">Theme</span>
                <select value={theme.value} onChange={(e) => setTheme(e.currentTarget.value as Theme)}>
                  <option value="system">as the system</option>
                  <option value="light">light</option>
                  <option value="dark">dark</option>
                </select>
              </label>
            </dd>
          </div>
          <div class="with-keys"><dt>Keys</dt><dd><kbd>Esc</kbd> stops all axes, wherever the keyboard is; while you type, it empties the field first and stops when pressed again. <kbd>Space</kbd> or <kbd>Enter</kbd> held on a jog button moves. <kbd>Enter</kbd> in a field does what the button beside it does.</dd></div>
          <div><dt>Handbook</dt><dd><a href="/help/" target="axisgate-help">All chapters</a></dd></div>
          <div><dt>API</dt><dd><a href="/api/v1/openapi.yaml" target="_blank" rel="noopener">openapi.yaml</a></dd></div>
        </dl>
      </Section>
    </main>
  );
}
