// The installed package in headless Chromium, by a plain <script type=module>: writes the hashes of the golden bars.
//
//   node browser.mjs PROJECT
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';
import { Browser } from '../web/browser.js';

const [project] = process.argv.slice(2);
const TYPES = { '': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm' };
const PAGE = `<!doctype html><title>massspring</title><script type="module">
import * as massspring from './node_modules/massspring/index.js';
import { goldenBars } from './golden.mjs';
window.written = (async () => {
  const lines = [];
  for (const simd of [true, false]) {
    const ms = await massspring.load({ simd });
    if (ms.simd !== simd) throw new Error('the wrong module');
    lines.push(...goldenBars(ms, massspring));
  }
  return lines.join('\\n');
})();
</script>`;

const server = createServer(async (request, response) => {
  const path = normalize(new URL(request.url, 'http://localhost').pathname);
  try {
    const body = path === '/' ? PAGE : await readFile(join(project, path));
    response.writeHead(200, { 'Content-Type': TYPES[extname(path)] ?? 'text/plain' }).end(body);
  } catch {
    response.writeHead(path === '/favicon.ico' ? 204 : 404).end();
  }
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
const browser = new Browser();
let status = 0;
try {
  await browser.open(`http://127.0.0.1:${server.address().port}/`, 300, 200);
  await browser.until('window.written !== undefined', 'the page has loaded its module');
  console.log(await browser.value('window.written'));
  if (browser.complaints.length) throw new Error(browser.complaints.join('\n'));
} catch (problem) {
  console.error(problem);
  status = 1;
}
await browser.close();
server.close();
process.exit(status);
