// An operator presses everything on every part of the page, and Enter in every field: nothing is sent that the gateway refuses for the role.
// In: the program. Out: counts.
import { presses } from './lib/roles.mjs';

presses('operator');
