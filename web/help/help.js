// Handbook: the search, the theme that was chosen on the gateway's page, and chapters folded away on a narrow screen.
// In: /help/search.json, read when somebody begins to search. Out: the ten best headings. The pages are whole without this file.
(() => {
  try {
    const theme = localStorage.getItem('axisgate.theme');
    if (theme === 'light' || theme === 'dark') document.documentElement.setAttribute('data-theme', theme);
  } catch {
    // no storage: as the system has it
  }
  const book = document.querySelector('.book details');
  if (book && matchMedia('(max-width: 880px)').matches) book.open = false;

  const place = document.getElementById('search');
  if (!place) return;
  const field = document.createElement('input');
  field.type = 'search';
  field.placeholder = 'Search';
  field.setAttribute('aria-label', 'Search the handbook');
  field.maxLength = 80;
  const found = document.createElement('ul');
  found.hidden = true;
  found.setAttribute('aria-label', 'Found');
  const said = document.createElement('p');
  said.className = 'visually-hidden';
  said.setAttribute('role', 'status');
  place.append(field, found, said);

  let entries;
  const load = () => (entries ??= fetch('/help/search.json').then((r) => r.json()).catch(() => []));
  field.addEventListener('focus', load);
  field.addEventListener('input', async () => {
    const all = await load();
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    const hits = [];
    if (words.join('').length > 1) {
      for (const e of all) {
        const heading = `${e.heading} ${e.chapter}`.toLowerCase();
        const text = e.text.toLowerCase();
        if (!words.every((w) => heading.includes(w) || text.includes(w))) continue;
        hits.push([words.filter((w) => heading.includes(w)).length, e]);
      }
    }
    hits.sort((a, b) => b[0] - a[0]);
    found.replaceChildren(
      ...hits.slice(0, 10).map(([, e]) => {
        const li = document.createElement('li');
        const a = document.createElement('a');
        a.href = e.to;
        a.textContent = e.heading === e.chapter ? e.chapter : `${e.chapter}: ${e.heading}`;
        const at = Math.max(0, e.text.toLowerCase().indexOf(words[0]) - 40);
        const around = document.createElement('small');
        around.textContent = e.text.slice(at, at + 110);
        a.append(around);
        li.append(a);
        return li;
      }),
    );
    found.hidden = hits.length === 0;
    said.textContent = words.length === 0 ? '' : hits.length === 0 ? 'Nothing found' : `${hits.length} found`;
  });
  addEventListener('keydown', (e) => {
    if (e.key === 'Escape') found.hidden = true;
    if (e.key === '/' && !(e.target instanceof HTMLInputElement)) {
      e.preventDefault();
      field.focus();
    }
  });
})();
