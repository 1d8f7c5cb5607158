// Cut: text that a reader cannot see whole, found by the boxes that the browser has drawn. In: a page as it stands. Out: what is wrong, in words.
// Never judges what can be scrolled to, what stands under a bar that stays while the page scrolls, or what a tooltip says whole.
import { drawn } from './browser.mjs';

/** Opens every fold and every help of the page. In the page itself, so that nothing is hit that lies in between. */
export async function unfold(page) {
  await page.evaluate(() => {
    for (const d of document.querySelectorAll('main details:not([open])')) d.open = true;
    for (const b of document.querySelectorAll('main :is(.help-button, .fold)[aria-expanded=false]')) if (b.checkVisibility()) b.click();
  });
  await drawn(page);
}

/** Text that is cut off, that leaves its button or lies upon another, a choice that its list does not show whole, a page that scrolls sideways. */
export const cut = (page) =>
  page.evaluate(() => {
    const found = new Set();
    const say = (e, text, why) => found.add(`“${text.trim().replace(/\s+/g, ' ').slice(0, 60)}” ${why} (${path(e)})`);
    const path = (e) => {
      const names = [];
      for (let at = e; at && at !== document.body && names.length < 4; at = at.parentElement) names.unshift(at.localName + (at.getAttribute('class') ? `.${at.getAttribute('class').trim().split(/\s+/).join('.')}` : ''));
      return names.join(' > ');
    };
    const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
    if (wide > 0) found.add(`the page is ${wide} px too wide`);

    const styles = new Map();
    const styleOf = (e) => styles.get(e) ?? styles.set(e, getComputedStyle(e)).get(e);
    // A finger sees no tooltip.
    const told = (e) => matchMedia('(hover: hover)').matches && Boolean(e.closest('[title]:not([title=""])') ?? e.closest('[aria-hidden=true]')?.parentElement?.closest('[title]:not([title=""])'));
    const stays = (e) => {
      for (let at = e; at && at !== document.body; at = at.parentElement) if (['fixed', 'sticky'].includes(styleOf(at).position)) return at;
      return null;
    };
    const unseen = '.visually-hidden, .print-only, [hidden], option, select, datalist, script, style';

    const nameOf = (e) => e.getAttribute('aria-label') ?? e.labels?.[0]?.textContent ?? e.textContent;
    const scrolled = (e) => {
      for (let at = e.parentElement; at && !at.matches('.card'); at = at.parentElement) if (['auto', 'scroll'].includes(styleOf(at).overflowX)) return true;
      return false;
    };

    // What is drawn: one box for each line of each text, as far as its surroundings let it be seen.
    const boxes = [];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const range = document.createRange();
    for (let n = walk.nextNode(); n; n = walk.nextNode()) {
      const e = n.parentElement;
      if (!n.data.trim() || !e || e.closest(unseen) || !e.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
      const s = styleOf(e);
      range.selectNodeContents(n);
      const control = e.closest('button, .button, .stop, .pill, .mark, .link-button');
      const frame = control?.getBoundingClientRect();
      for (const r of range.getClientRects()) {
        if (r.width < 1 || r.height < 1) continue;
        if (frame && (r.left < frame.left - 1 || r.right > frame.right + 1 || r.top < frame.top - 3 || r.bottom > frame.bottom + 3)) say(control, control.textContent, 'leaves its button');
        let [left, top, right, bottom] = [r.left, r.top, r.right, r.bottom];
        let hidden = false;
        for (let at = e; at && at !== document.documentElement; at = at.parentElement) {
          const a = styleOf(at);
          if (a.overflowX === 'visible' && a.overflowY === 'visible') {
            if (a.position === 'fixed') break;
            continue;
          }
          const b = at.getBoundingClientRect();
          if (b.width < 2 && b.height < 2) { hidden = true; break; }
          const firm = (o) => o === 'hidden' || o === 'clip';
          const over = Math.max(firm(a.overflowX) ? Math.max(right - b.right, b.left - left) : 0, firm(a.overflowY) ? Math.max(bottom - b.bottom - 3, b.top - top - 3) : 0);
          if (over > 1 && !told(e)) say(e, n.data, `is cut by ${Math.ceil(over)} px`);
          [left, top, right, bottom] = [Math.max(left, b.left), Math.max(top, b.top), Math.min(right, b.right), Math.min(bottom, b.bottom)];
          if (right - left < 1 || bottom - top < 1) { hidden = true; break; }
        }
        if (!hidden && Number(s.opacity) > 0) boxes.push({ e, n, control, text: n.data, left, top, right, bottom, stays: stays(e) });
      }
      // What an ellipsis has taken away has no box.
      if (['hidden', 'clip'].includes(s.overflowX) && s.textOverflow === 'ellipsis' && e.scrollWidth > e.clientWidth + 1 && !told(e)) say(e, n.data, `is cut by ${e.scrollWidth - e.clientWidth} px`);
      if (s.webkitLineClamp !== 'none' && e.scrollHeight > e.clientHeight + 2 && !told(e)) say(e, n.data, 'has more lines than are shown');
    }

    // Fields and buttons are boxes, too: a text that is not in them must not lie on them.
    for (const e of document.querySelectorAll('button, a.button, label.button, input:not([type=file]):not([type=hidden]), select, textarea')) {
      if (e.closest(unseen.replace(', select', '')) || !e.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
      const r = e.getBoundingClientRect();
      if (r.width < 3 || r.height < 3) continue;
      let [left, top, right, bottom] = [r.left, r.top, r.right, r.bottom];
      for (let at = e.parentElement; at && at !== document.documentElement; at = at.parentElement) {
        const a = styleOf(at);
        if (a.overflowX === 'visible' && a.overflowY === 'visible') continue;
        const b = at.getBoundingClientRect();
        const over = ['hidden', 'clip'].includes(a.overflowX) ? Math.max(right - b.right, b.left - left) : 0;
        if (over > 1 && b.width > 2) say(e, nameOf(e), `has ${Math.ceil(over)} px out of sight`);
        [left, top, right, bottom] = [Math.max(left, b.left), Math.max(top, b.top), Math.min(right, b.right), Math.min(bottom, b.bottom)];
      }
      const card = e.parentElement?.closest('.card')?.getBoundingClientRect();
      if (card && !scrolled(e) && (left < card.left - 1 || right > card.right + 1)) say(e, nameOf(e), 'leaves its card');
      if (right - left > 2 && bottom - top > 2) boxes.push({ e, n: e, control: e, text: nameOf(e), left, top, right, bottom, stays: stays(e), solid: true });
    }
    boxes.sort((a, b) => a.top - b.top);
    for (let i = 0; i < boxes.length; i += 1) {
      const a = boxes[i];
      for (let k = i + 1; k < boxes.length && boxes[k].top < a.bottom; k += 1) {
        const b = boxes[k];
        if (a.n === b.n || a.stays !== b.stays || (a.solid && b.solid && (a.e.contains(b.e) || b.e.contains(a.e)))) continue;
        if ((a.solid && a.e.contains(b.e)) || (b.solid && b.e.contains(a.e))) continue;
        const x = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (x > 2 && y > 0.35 * Math.min(a.bottom - a.top, b.bottom - b.top)) say(a.e, a.text, `lies upon “${b.text.trim().replace(/\s+/g, ' ').slice(0, 40)}”, ${path(b.e)}`);
      }
    }

    // A list as wide as its longest choice needs no more; its arrow is in that width.
    for (const e of document.querySelectorAll('select')) {
      if (!e.checkVisibility() || e.closest('.visually-hidden')) continue;
      const twin = e.cloneNode(true);
      twin.removeAttribute('id');
      twin.style.cssText = 'position:absolute;visibility:hidden;width:max-content;min-width:0;max-width:none;flex:none';
      e.parentElement.append(twin);
      const needs = twin.getBoundingClientRect().width;
      twin.remove();
      const longest = [...e.options].reduce((a, o) => (o.text.length > a.length ? o.text : a), '');
      const below = e.closest('.form-field')?.querySelector('.choice-whole');
      const whole = below?.checkVisibility() && below.textContent.trim() === e.selectedOptions[0]?.text.trim();
      if (needs > e.getBoundingClientRect().width + 1 && !whole && !told(e)) say(e, longest, `is a choice that is cut by ${Math.ceil(needs - e.getBoundingClientRect().width)} px`);
    }
    const ruler = document.createElement('canvas').getContext('2d');
    for (const e of document.querySelectorAll('input[placeholder]')) {
      if (!e.checkVisibility() || e.value !== '' || e.placeholder === '' || told(e)) continue;
      const s = getComputedStyle(e);
      ruler.font = getComputedStyle(e, '::placeholder').font;
      const over = ruler.measureText(e.placeholder).width - (e.clientWidth - parseFloat(s.paddingLeft) - parseFloat(s.paddingRight));
      if (over > 1) say(e, e.placeholder, `is a hint that is cut by ${Math.ceil(over)} px`);
    }
    // Words in a drawing have a frame of their own.
    for (const e of document.querySelectorAll('.node text')) {
      const a = e.getBoundingClientRect();
      const b = e.parentElement.querySelector('rect').getBoundingClientRect();
      if (a.left < b.left - 1 || a.right > b.right + 1) say(e, e.textContent, 'leaves its frame');
    }
    return [...found];
  });
