// Every part of the page at the widths of a desk and of a tablet: pictures, accessibility, nothing cut off.
import { visits } from './lib/browser.mjs';
import { gallery } from './lib/gallery.mjs';

gallery(visits[0]);
