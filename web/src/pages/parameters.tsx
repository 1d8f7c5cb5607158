// Parameters: the catalogue of one axis on a page of its own. In: its name. Out: a page.
import { Parameters } from '../components/parameters';
import { axisPath } from '../router';

export function ParametersPage({ name }: { name: string }) {
  return (
    <main class="page parameters-page" data-axis={name}>
      <p class="crumbs">
        <a href={axisPath(name)}>{name}</a>
      </p>
      <h1 tabIndex={-1}>Parameters of {name}</h1>
      <Parameters axis={name} />
    </main>
  );
}
