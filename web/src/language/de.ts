// German: the page's sentences, by their English ones, put together of its parts.
// In: the parts. Out: the table, which is loaded only when the language is chosen.
import { axis } from './de/axis';
import { frame } from './de/frame';
import { words } from './de/words';
import type { Table } from './index';

export const table: Table = { ...axis, ...frame, ...words };
