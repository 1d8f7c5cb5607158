// Chinese (simplified): the page's sentences, by their English ones, put together of its parts.
// In: the parts. Out: the table, which is loaded only when the language is chosen.
import { axis } from './zh/axis';
import { frame } from './zh/frame';
import { words } from './zh/words';
import type { Table } from './index';

export const table: Table = { ...axis, ...frame, ...words };
