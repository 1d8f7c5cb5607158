// Main: start here. The reader's language first, then everything else, whose constants may hold sentences.
import { startLanguage } from './language';

await startLanguage();
await import('./start');
