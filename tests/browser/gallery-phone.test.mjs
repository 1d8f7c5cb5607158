// Every part of the page on a phone: pictures, accessibility, nothing cut off.
import { visits } from './lib/browser.mjs';
import { gallery } from './lib/gallery.mjs';

gallery(visits[1]);
