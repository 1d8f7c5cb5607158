// English: every part of the page is read whole at three widths. In: the program. Out: counts, pictures under build/browser.
import { whole } from './lib/whole.mjs';

whole('en');
