// The second half of the parts of the page at the widths of a desk and of a tablet: pictures, accessibility, nothing cut off.
import { visits } from './lib/browser.mjs';
import { gallery, halves } from './lib/gallery.mjs';

gallery(visits[0], halves.second);
