// Every part of the page in light colours, at the widths of a desk, a tablet and a phone: pictures, accessibility, nothing cut off.
import { gallery } from './lib/gallery.mjs';

gallery('light');
