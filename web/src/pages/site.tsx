// Site: what is connected, as one document. In: nothing. Out: a page.
import { Section } from '../components/section';

export function SitePage() {
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>Site</h1>
      <Section title="Document">
        <p>
          <a class="button" href="/api/v1/site" download="site.json">
            Export
          </a>
        </p>
      </Section>
    </main>
  );
}
