// Said: whether the words of a page are those of its reader: none of the API's own, and nothing English on a page of another language unless it is marked as
// English for a screen reader. In: a page as it stands. Out: what is wrong, in words. Names, values and code are nobody's language.

/** Words with an underscore, in text, label, title or choice. What is the drive's or the API's own name stands in a fixed-width face, and is no text. */
export const underscored = (page) =>
  page.evaluate(() => {
    const found = [];
    const look = (text, where) => {
      for (const m of (text ?? '').match(/\b[a-z0-9]+(?:_[a-z0-9]+)+\b/g) ?? []) found.push(`${m} in ${where}`);
    };
    for (const e of document.querySelectorAll('body *')) {
      if (e.closest('code, pre, kbd, textarea, script, style, .mono')) continue;
      const where = `${e.tagName.toLowerCase()}.${e.className.baseVal ?? e.className}`;
      for (const n of e.childNodes) if (n.nodeType === Node.TEXT_NODE) look(n.data, `${where}: ${n.data.trim().slice(0, 80)}`);
      for (const a of ['aria-label', 'title', 'placeholder', 'alt', 'aria-description']) look(e.getAttribute(a), `${a} of ${where}`);
    }
    return [...new Set(found)];
  });

/** Texts with words that only English has, outside of all that says `lang="en"`: the page's own sentence that was forgotten, or the gateway's without its mark. */
export const english = (page, typedWords = []) =>
  page.evaluate((own) => {
    // A person's own words, such as the comment of a mapping, are hers in every language.
    const typed = new Set(own);
    const found = new Set();
    const walk = document.createTreeWalker(document.querySelector('#app') ?? document.body, NodeFilter.SHOW_TEXT);
    for (let n = walk.nextNode(); n; n = walk.nextNode()) {
      const e = n.parentElement;
      if (!e || e.closest('[lang=en], code, pre, kbd, textarea, script, style, .mono')) continue;
      if (typed.has(n.data.trim())) continue;
      const words = n.data.match(/(?<![\p{L}\d_./-])(?:the|is|are|of|with|not|and|to|from|there|been|has|does|which|by|this|that|for|it|be|no|at)(?![\p{L}\d_./-])/gu) ?? [];
      if (words.length > 0) found.add(`“${n.data.trim().replace(/\s+/g, ' ').slice(0, 90)}” is not said to be English (${e.localName}.${e.className.baseVal ?? e.className} in ${e.closest('[data-field], [class]')?.dataset.field ?? e.parentElement?.className})`);
    }
    return [...found];
  }, typedWords);
