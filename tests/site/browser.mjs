// The site in headless Chromium, wide and light from the disk, narrow and dark from a server: figures move and check
// their numbers, and every page of the menu fits the screen.
//
//   node browser.mjs SITE PICTURES
import { strict as assert } from 'node:assert';
import { createReadStream, existsSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, resolve } from 'node:path';
import { CONTENTS } from '../../examples/site/contents.mjs';
import { Browser } from '../web/browser.js';

const [site, pictures] = process.argv.slice(2);
const PAGES = CONTENTS.flatMap(({ links }) => links.map(([, page]) => page))
  .filter((page) => !page.includes('#') && existsSync(join(site, page)));
const SEEN = /index|choose|troubleshooting|solvers|core_8h|rollback|comparison|download/; // of these a picture is kept
// Layout shift after the page appeared, as browsers measure it: up to 0.1 is good.
const WATCH = `window.shifted = 0; new PerformanceObserver((list) => { for (const entry of list.getEntries())
  if (!entry.hadRecentInput) { window.shifted += entry.value; window.shifters = [...(window.shifters ?? []),
    ...entry.sources.map(({ node }) => node?.parentElement?.outerHTML.slice(0, 120))]; } })
  .observe({ type: 'layout-shift', buffered: true });`;

// How many points of a canvas are not empty.
const DRAWN = (name) => `(() => { const canvas = document.querySelector('[data-figure=${name}] canvas');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return data.filter((value, i) => i % 4 === 3 && value > 0).length; })()`;

async function each(browser, width) {
  const names = await browser.value(`[...document.querySelectorAll('[data-figure]')].map(({ dataset }) => dataset.figure)`);
  for (const name of names) {
    await browser.value(`document.querySelector('[data-figure=${name}]').scrollIntoView({ block: 'center' })`);
    await browser.until(`window.figureStages?.${name}?.steps > 20`, `figure ${name} moves`);
    const results = await browser.value(`window.figureStages.${name}.check()`);
    for (const { ok, timed, text } of results) {
      console.log(`${name}: ${text}`);
      assert(ok || timed, `${name}: ${text}`);
    }
    assert(await browser.value(DRAWN(name)) > 200, `${name} has drawn something`);
    await picture(browser, `[data-figure=${name}]`, `${name}_${width}`);
  }
  return names;
}

// With the keyboard alone: the slider of a figure starts it anew, and the button stops it.
async function byKey(browser) {
  await browser.value(`document.querySelector('[data-figure=size] input').focus()`);
  const before = await browser.value('window.figureStages.size.values.width');
  await browser.send('Input.dispatchKeyEvent', { type: 'keyDown', key: 'ArrowRight', code: 'ArrowRight', windowsVirtualKeyCode: 39 });
  await browser.send('Input.dispatchKeyEvent', { type: 'keyUp', key: 'ArrowRight', code: 'ArrowRight' });
  assert.equal(await browser.value('window.figureStages.size.values.width'), before + 1, 'an arrow moves the slider');
  await browser.value(`document.querySelector('[data-figure=size] [data-play]').focus()`);
  await browser.key(' ', ' ');
  assert.equal(await browser.value('window.figureStages.size.playing'), false, 'space stops it');
}

// Words in the search field lead to their page, also words of its text; where there are none, it says so.
async function bySearch(browser) {
  const field = '[...document.querySelectorAll("[data-search]")].at(-1)';
  const finds = async (words, value, expected) => {
    await browser.value(`{ const field = ${field}; field.value = '${words}'; field.dispatchEvent(new Event('input')); }`);
    await browser.until(`${expected}.test(${field}.nextSibling.${value})`, `${words} leads to ${expected}`);
  };
  const leads = (words, page) => finds(words, "querySelector('a')?.href", page);
  await leads('yield strain', /guides|reference/);
  await leads('One per cent from', /figures\.html#one-per-cent-from-exploding$/);
  await leads('a nudge of a millionth', /figures\.html#one-per-cent-from-exploding$/);
  await finds('a nudge of a millionth', "querySelector('mark')?.textContent", /^a nudge of a millionth$/);
  if (PAGES.some((page) => page.startsWith('reference/'))) await leads('network_step', /reference\/core_8h\.html#/);
  await finds('zyzzyva', 'textContent', /^Nothing for zyzzyva\. Try Troubleshooting or the Glossary\.$/);
  await leads('zyzzyva', /troubleshooting\.html$/);
}

// Previews of shared links, and stills in place of figures that have not started.
async function byLink(browser) {
  const meta = (name) => browser.value(`document.querySelector('meta[property="og:${name}"], meta[name="${name}"]')?.content ?? ''`);
  assert((await meta('description')).length > 40, 'a description');
  assert((await meta('title')).length > 3 && /\.png$/.test(await meta('image')), 'a title and a picture');
}

// The playground of the first page: something is drawn in its frame, and each button brings its scene.
async function byPlay(browser, width) {
  const runs = `document.querySelector('.playground').classList.contains('runs')`;
  await browser.until(runs, 'the playground runs');
  const scene = `document.querySelector('.playground iframe').src`;
  if (width < 700) assert.match(await browser.value(scene), /scene=bridge/, 'a phone gets the bridge');
  await browser.value(`document.querySelector('[data-scene*=girder]').click()`);
  await browser.until(`${runs} && ${scene}.includes('girder')`, 'another scene runs');
  assert.equal(await browser.value(`document.querySelector('[data-scene*=girder]').getAttribute('aria-pressed')`), 'true');
  await browser.value(`document.querySelector('#tab-Python').click()`);
  assert.match(await browser.value(`[...document.querySelectorAll('.tab')].find((tab) => tab.offsetHeight > 0).textContent`), /import massspring/);
}

// Two peers of the page play for a while, and all hashes are equal; then over a line that is far worse.
async function byRollback(browser, width) {
  await browser.until('globalThis.rollbackDemo?.session.peers[0].count.compared > 60', 'peers compare hashes');
  await browser.value(`for (const [name, value] of [['latency', 150], ['loss', 50]]) { const slider =
    document.querySelector('[data-line=' + name + ']'); slider.value = value; slider.dispatchEvent(new Event('input')); }`);
  const before = await browser.value('rollbackDemo.session.peers[0].count.compared');
  await browser.until(`rollbackDemo.session.peers[0].count.compared > ${before + 60}`, 'they go on over a worse line');
  const peers = await browser.value('rollbackDemo.session.peers.map(({ count }) => count)');
  console.log(`${width} px, rollback:`, JSON.stringify(peers));
  for (const { differing, deepest, rollbacks } of peers) assert(!differing && rollbacks > 0 && deepest <= 8, 'all hashes are equal');
  assert.match(await browser.value(`document.querySelector('[data-verdict]').textContent`), /hashes compared, all equal$/);
}

// A particle of the jelly, stopped so that it stays where it is read, is held by the pointer, and let go.
async function byHand(browser) {
  await browser.value(`document.querySelector('[data-figure=jelly]').scrollIntoView({ block: 'center' })`);
  await browser.until('window.figureStages.jelly.playing', 'the jelly plays');
  await browser.value(`document.querySelector('[data-figure=jelly] [data-play]').click()`);
  await browser.until('!window.figureStages.jelly.playing', 'the jelly stops');
  const corner = await browser.value(`(() => { const { pen, canvas, running } = window.figureStages.jelly;
    const [x, y] = running.grips[1].positions(12), { scale, left, base } = pen.places[1];
    const box = canvas.getBoundingClientRect();
    return { x: box.left + left + scale * x, y: box.top + base - scale * y }; })()`);
  const held = 'window.figureStages.jelly.held';
  await browser.drag([corner, { x: corner.x - 20, y: corner.y + 20 }], 'left', false);
  assert.equal(await browser.value(`${held}?.index`), 1, 'the pointer holds the right square');
  await browser.mouse('mouseReleased', { x: corner.x - 20, y: corner.y + 20 }, { button: 'left', clickCount: 1 });
  assert.equal(await browser.value(`${held} === undefined`), true, 'it lets go');
}

// Without WebAssembly: still pictures in place of what cannot run, and words that say why.
async function withoutWasm() {
  const browser = new Browser();
  const shown = (selector) => browser.value(`document.querySelector('${selector}').offsetHeight > 100`);
  try {
    await browser.open('about:blank', 1280, 800);
    await browser.send('Page.addScriptToEvaluateOnNewDocument', { source: 'delete globalThis.WebAssembly;' });
    await browser.send('Page.navigate', { url: `${DISK}/index.html` });
    await browser.until(`document.querySelector('[data-now]')?.textContent.startsWith('This browser cannot run it')`, 'it says so');
    await browser.value(`document.querySelector('.still').scrollIntoView()`);
    await browser.until(`document.querySelector('.still').naturalWidth > 0`, 'a still picture is there');
    assert(await shown('.still') && !await shown('.live canvas') && await shown('.playground img'), 'stills are shown');
    assert.equal(await browser.value(`document.querySelector('.without').offsetHeight > 10`), true);
    assert.equal(await browser.value(`document.querySelector('.playground iframe')`), null);
  } finally {
    await browser.close();
  }
}

async function look(browser, width, scheme) {
  await browser.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }] });
  await browser.value(WATCH);
  const overflow = await browser.value('document.documentElement.scrollWidth - innerWidth');
  assert(overflow <= 0, `at ${width} px ${await browser.value('location.href')} is ${overflow} px wider than the screen`);
}

// An element of the page, for people to look at.
async function picture(browser, selector, name) {
  const clip = await browser.value(`(() => { const box = document.querySelector('${selector}').getBoundingClientRect();
    return { x: box.left + scrollX, y: box.top + scrollY, width: box.width, height: Math.min(box.height, 4000), scale: 1 }; })()`);
  const { data } = await browser.send('Page.captureScreenshot', { format: 'png', clip, captureBeyondViewport: selector === 'body' });
  writeFileSync(join(pictures, `${name}.png`), Buffer.from(data, 'base64'));
}

// A plain server of files: what it answers is gone with the process.
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.png': 'image/png' };
const server = createServer((request, response) => {
  const path = join(site, normalize(new URL(request.url, 'http://localhost').pathname));
  if (!existsSync(path)) return response.writeHead(404).end();
  response.writeHead(200, { 'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream' });
  createReadStream(path).pipe(response);
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
const DISK = `file://${resolve(site)}`, SERVER = `http://127.0.0.1:${server.address().port}`;

let where = 'without WebAssembly'; // the page that is looked at, for messages

async function at(place, width, height, scheme) {
  const browser = new Browser();
  try {
    where = `figures at ${width} px`;
    await browser.open(`${place}/examples/guides/figures.html`, width, height);
    await browser.until('document.readyState === "complete" && window.firstMotion !== undefined', 'something moves');
    await look(browser, width, scheme);
    const first = await browser.value('window.firstMotion');
    console.log(`${width} px: first motion after ${first.toFixed(0)} ms`);
    const names = await each(browser, width);
    assert.equal(names.length, 10);
    await byKey(browser);
    await byHand(browser);
    await bySearch(browser);
    const shifted = await browser.value('window.shifted');
    assert(shifted < 0.01, `at ${width} px the page jumps by ${shifted}: ${await browser.value('window.shifters')}`);
    for (const page of PAGES) {
      where = `${page} at ${width} px`;
      await browser.send('Page.navigate', { url: `${place}/${page}` });
      await browser.until(`location.href.endsWith(${JSON.stringify(page)}) && document.readyState === 'complete'`, 'the page is there');
      await look(browser, width, scheme);
      if (!page.startsWith('reference/')) await byLink(browser);
      if (page === 'index.html') await byPlay(browser, width);
      if (page === 'rollback.html') await byRollback(browser, width);
      if (SEEN.test(page)) await picture(browser, 'body', `${page.replace(/.*\/|\.html/g, '')}_${width}`);
    }
    assert.deepEqual(browser.complaints, [], 'nothing complains');
  } finally {
    await browser.close();
  }
}

try {
  await withoutWasm();
  await at(DISK, 1280, 800, 'light');
  await at(SERVER, 390, 844, 'dark');
} catch (problem) {
  console.error(`${where}:`, problem);
  process.exit(1);
}
server.close();
