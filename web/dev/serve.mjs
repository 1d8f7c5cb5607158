// Develop: Vite with the page as it is written, and behind it a gateway: the mock one, or the one named by AXISGATE_URL
// (such as http://127.0.0.1:8080). In: the environment. Out: an address to open. For the author's machine alone.
import { spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { createServer } from 'vite';

let target = process.env.AXISGATE_URL;
if (!target) {
  const mock = spawn(process.execPath, [fileURLToPath(new URL('mock-server.mjs', import.meta.url)), '--port', '8090'], { stdio: 'inherit' });
  process.on('exit', () => mock.kill());
  target = 'http://127.0.0.1:8090';
}
const server = await createServer({
  root: fileURLToPath(new URL('..', import.meta.url)),
  server: { host: '127.0.0.1', proxy: { '/api': { target, ws: true, changeOrigin: true, rewriteWsOrigin: true } } },
});
await server.listen();
server.printUrls();
