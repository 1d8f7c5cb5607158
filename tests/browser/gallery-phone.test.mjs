// The first half of the parts of the page on a phone: pictures, accessibility, nothing cut off.
import { visits } from './lib/browser.mjs';
import { gallery, halves } from './lib/gallery.mjs';

gallery(visits[1], halves.first);
