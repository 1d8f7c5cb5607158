// German: the page's sentences, by their English ones, put together of its parts.
// In: the parts. Out: the table, which is loaded only when the language is chosen.
import { assembly } from './de/assembly';
import { axis } from './de/axis';
import { description } from './de/description';
import { events } from './de/events';
import { frame } from './de/frame';
import { mapping } from './de/mapping';
import { parameter } from './de/parameter';
import { recipe } from './de/recipe';
import { recorder } from './de/recorder';
import { report } from './de/report';
import { site } from './de/site';
import { text } from './de/text';
import type { Table } from './index';

export const table: Table = { ...assembly, ...axis, ...description, ...events, ...frame, ...mapping, ...parameter, ...recipe, ...recorder, ...report, ...site, ...text };
