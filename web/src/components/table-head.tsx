// Table head: the titles of a table's columns. In: words, which columns have figures. Out: a head.
interface HeadProps {
  of: readonly string[];
  /** Columns of figures, by their place. */
  figures?: readonly number[];
}

export function TableHead({ of, figures = [] }: HeadProps) {
  return (
    <thead>
      <tr>
        {of.map((title, i) => (
          <th key={i} scope="col" class={figures.includes(i) ? 'num' : undefined}>
            {title}
          </th>
        ))}
      </tr>
    </thead>
  );
}
