// Chinese (simplified): the page's sentences, by their English ones, put together of its parts.
// In: the parts. Out: the table, which is loaded only when the language is chosen.
import { assembly } from './zh/assembly';
import { axis } from './zh/axis';
import { description } from './zh/description';
import { events } from './zh/events';
import { frame } from './zh/frame';
import { mapping } from './zh/mapping';
import { parameter } from './zh/parameter';
import { recipe } from './zh/recipe';
import { recorder } from './zh/recorder';
import { report } from './zh/report';
import { site } from './zh/site';
import { text } from './zh/text';
import type { Table } from './index';

export const table: Table = { ...assembly, ...axis, ...description, ...events, ...frame, ...mapping, ...parameter, ...recipe, ...recorder, ...report, ...site, ...text };
