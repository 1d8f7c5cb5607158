// Chinese (simplified): the page's sentences, by their English ones.
import type { Table } from './index';

export const table: Table = {};
