// German: sentences about axis, by their English ones, in the order of the alphabet.
// In: nothing. Out: a part of the table; a sentence stands in one part only.
import type { Table } from '../index';

export const axis: Table = {
  'A text is needed.': 'Ein Text ist nötig.',
  'A value is needed.': 'Ein Wert ist nötig.',
  'A whole number.': 'Eine ganze Zahl.',
  'Jog: ended, halt accepted': 'Tippen: beendet, Halt angenommen',
  'Jog: ended, {why}. The gateway halts the axis by itself {n} s after it last heard of the jog.': 'Tippen: beendet, {why}. Das Gateway hält die Achse von selbst an, {n} s nachdem es zuletzt vom Tippen gehört hat.',
  'Jog: ended. {why}': 'Tippen: beendet. {why}',
  'Jog: halt refused. {why}': 'Tippen: Halt abgelehnt. {why}',
  'Jog: the halt is NOT confirmed: {why}': 'Tippen: Der Halt ist NICHT bestätigt: {why}',
  'the connection to the gateway is lost': 'die Verbindung zum Gateway ist verloren',
  'true or false.': 'true oder false.',
  '{action} on {axis}: {question} Run it?': '{action} an {axis}: {question} Ausführen?',
  '{from} to {to} {unit}.': '{from} bis {to} {unit}.',
  '{from} to {to}.': '{from} bis {to}.',
};
