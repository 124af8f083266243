// The page as somebody uses it: real events of mouse and keyboard in headless Chromium.
//
//   node hand.js PAGE.html PICTURE.png
'use strict';
const assert = require('node:assert');
const { writeFileSync } = require('node:fs');
const { resolve } = require('node:path');
const { Browser } = require('./browser.js');

const [page, picture] = process.argv.slice(2);
const browser = new Browser();

// In the page: where a place in the world is on the screen, how many springs are broken, and so on.
const HELPERS = `
  const screenOf = (x, y) => ({ x: (x - view.x) * view.scale + drawing.canvas.width / 2,
    y: drawing.canvas.height / 2 - (y - view.y) * view.scale });
  const springsNow = () => new Float32Array(core.memory.buffer, core.springs(), 3 * core.spring_count());
  const brokenNow = () => springsNow().filter((value, i) => i % 3 === 2 && value === 0).length;
  const pinnedNow = () => floats(core.inverse_mass(), core.slots()).filter((value) => value === 0).length;
  // The free particle that is farthest to the right, or up.
  const farthest = (key) => {
    const [x, y, m, by] = ['x', 'y', 'inverse_mass', key].map((name) => floats(core[name](), core.slots()));
    let best = -1;
    for (let i = 0; i < by.length; i++) if (m[i] > 0 && (best < 0 || by[i] > by[best])) best = i;
    return { x: core.origin_x() + x[best], y: core.origin_y() + y[best] };
  };`;

const middleOf = (selector) =>
  browser.value(`(() => { const box = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect();
    return { x: box.left + box.width / 2, y: box.top + box.height / 2 }; })()`);
const press = async (selector) => browser.click(await middleOf(selector));
const screenOf = (x, y) => browser.value(`screenOf(${x}, ${y})`);
// Steps by key, one by one: what happens does not depend on how fast the machine is.
const steps = async (count) => {
  for (let i = 0; i < count; i++) await browser.key('.', '.');
};

async function test() {
  await browser.open(`file://${resolve(page)}#scene=bar&damping=1`, 1200, 700);
  await browser.until('typeof core === "object" && core.spring_count() === 1347', 'the bar is there');
  await browser.value(HELPERS);

  // It runs by itself, until space stops it; R puts it back.
  await browser.until('core.kinetic_energy() > 0 && byId("frames").textContent.endsWith("/s")', 'it moves and is drawn');
  await browser.key(' ', ' ');
  assert.strictEqual(await browser.value('state.running'), false, 'space stops it');
  await browser.key('r', 'r');
  assert.strictEqual(await browser.value('core.kinetic_energy()'), 0, 'R starts anew');

  // The free end is dragged up and stays at the pointer; let go, it falls.
  const end = await browser.value('farthest("x")');
  const from = await screenOf(end.x, end.y), to = await screenOf(end.x - 4, end.y + 20);
  await browser.drag([from, to], 'left', false);
  await steps(60);
  const held = await browser.value('farthest("x")');
  assert(held.y > end.y + 14, `dragged up by 20 m it is ${held.y - end.y} m higher`);
  await browser.mouse('mouseReleased', to, { button: 'left', clickCount: 1 });
  await steps(200); // it swings on for a while
  const fallen = await browser.value('farthest("x")');
  assert(fallen.y < held.y - 5, `let go it falls: from ${held.y} to ${fallen.y}`);

  // Pinned with the tool, freed with the next click.
  await browser.key('r', 'r');
  await press('[data-tool=pin]');
  const before = await browser.value('pinnedNow()');
  await browser.click(await screenOf(end.x, end.y));
  assert((await browser.value('pinnedNow()')) > before, 'a click pins');
  await browser.click(await screenOf(end.x, end.y));
  assert.strictEqual(await browser.value('pinnedNow()'), before, 'another one frees');

  // Pins are drawn: white dots at the clamped end. The pointer rests on a spring, and is told its strain.
  const white = `(() => { draw(); const pen = byId('marks').getContext('2d');
    return pen.getImageData(0, 0, drawing.canvas.width, drawing.canvas.height).data.reduce(
      (sum, value, i, all) => sum + (i % 4 === 0 && value > 230 && all[i + 3] > 230), 0); })()`;
  assert.strictEqual(await browser.value('(draw(), marks.pins.length)'), 5, 'five particles are pinned');
  assert((await browser.value(white)) > 50, 'pins are seen');
  const middle = await screenOf(40.5, end.y);
  await browser.mouse('mouseMoved', middle);
  await browser.until('byId("tip").style.display === "block"', 'a spring under the pointer is told');
  const told = /^spring [\d,]+ of particles [\d,]+ and [\d,]+: \d\.\d{3} m, (stretched|squeezed) by \S+ %, \S+ k?N/;
  assert.match(await browser.value('(draw(), byId("tip").textContent)'), told);
  await browser.mouse('mouseMoved', { x: middle.x, y: middle.y - 200 });
  await browser.until('byId("tip").style.display === "none"', 'and no more where none is');
  // A click keeps it, until one beside all springs.
  await press('[data-tool=drag]');
  await browser.click(middle);
  await browser.mouse('mouseMoved', { x: middle.x, y: middle.y - 200 });
  await steps(1);
  assert.match(await browser.value('(draw(), byId("tip").textContent)'), told);
  assert.match(await browser.value('byId("drawing").textContent'), /^[\d.]+ ms$/, 'drawing has its own cost');
  assert(await browser.value('marks.kept && byId("tip").style.display === "block"'), 'a click keeps the spring');
  await browser.click({ x: middle.x, y: middle.y - 200 });
  assert.strictEqual(await browser.value('byId("tip").style.display'), 'none', 'a click beside lets it go');

  // A line cuts, Repair mends.
  await press('[data-tool=cut]');
  await browser.drag([await screenOf(40.4, end.y + 6), await screenOf(40.6, end.y - 12)]);
  await steps(1);
  const broken = await browser.value('brokenNow()');
  assert(broken >= 13 && broken <= 39, `a cut through five rows breaks ${broken} springs`);
  await press('#repair');
  await steps(1);
  assert.strictEqual(await browser.value('brokenNow()'), 0, 'repaired');

  // A blast gives it speed.
  await browser.key('r', 'r');
  await browser.key('4', '4');
  assert.strictEqual(await browser.value('state.tool'), 'blast');
  await browser.click(await screenOf(40, end.y - 2));
  assert((await browser.value('core.kinetic_energy()')) > 1e4, 'a blast moves it');
  await steps(4);

  // Every solver and a slider, by key and mouse.
  for (const [solver, name] of [[1, 'implicit'], [2, 'direct']]) {
    await browser.value('byId("solver").focus()');
    await browser.key('ArrowDown');
    await browser.until(`value("solver") === ${solver}`, `${name} is chosen`);
    await browser.value('document.activeElement.blur()');
    await steps(3);
    assert.strictEqual(await browser.value('core.substeps()'), 2, `${name} takes two substeps`);
  }
  const slider = await browser.value('(() => { const { left, top, width, height } = byId("gravity").getBoundingClientRect(); ' +
    'return { x: left + 0.9 * width, y: top + height / 2 }; })()');
  await browser.click(slider);
  assert((await browser.value('value("gravity")')) > 10, 'the slider follows the mouse');
  await browser.value('document.activeElement.blur()');

  // Too stiff for two explicit substeps: it says so, and a button helps.
  await browser.value('byId("gravity").value = -9.8, settingsOf.gravity(), byId("solver").value = 0, ' +
    'byId("substeps").value = 2, settingsOf.solver()');
  await steps(8);
  assert.match(await browser.value('state.broken'), /^unstable/, 'two substeps are too few');
  const needed = Number((await browser.value('byId("cure").textContent')).match(/^More substeps: (\d+)$/)[1]);
  await press('#cure');
  await browser.until(`state.broken === "" && core.substeps() === ${needed}`, 'it goes on with as many substeps as it needs');
  await browser.key(' ', ' ');

  // The address follows, so that it can be sent to somebody.
  await press('#collide');
  const address = await browser.value('location.hash');
  for (const part of ['scene=bar', 'solver=0', `substeps=${needed}`, 'collide=1', 'gravity=']) assert(address.includes(part), address);
  await press('#collide');

  // The wheel zooms about the pointer, the right button moves.
  const scale = await browser.value('view.scale'), place = await browser.value('view.x');
  await browser.mouse('mouseWheel', { x: 600, y: 350 }, { deltaX: 0, deltaY: -300 });
  await browser.until(`view.scale > ${scale}`, 'the wheel zooms in');
  await browser.drag([{ x: 600, y: 500 }, { x: 500, y: 500 }], 'right');
  assert((await browser.value('view.x')) > place, 'the right button moves the view');

  // The bridge, one of its towers pulled; the picture is for people to look at. (The ship takes software that draws
  // seconds for a frame.)
  await browser.value('byId("solver").value = 0, byId("substeps").value = 40, byId("gravity").value = -9.8, ' +
    'chooseTool("drag"), byId("scene").value = "bridge", load("bridge")');
  await browser.until('core.particles() > 1000', 'the bridge is there');
  await browser.value('byId("limit").value = -2.2, settingsOf.limit()');
  const top = await browser.value('farthest("y")');
  await browser.drag([await screenOf(top.x, top.y - 1), await screenOf(top.x - 14, top.y + 6)], 'left', false);
  await steps(60);
  await browser.until('byId("milliseconds").textContent.endsWith("ms")', 'it says what a step costs');
  writeFileSync(picture, await browser.picture());
  console.log(`bridge, 40 substeps: a step takes ${await browser.value('byId("milliseconds").textContent')}`);

  assert.strictEqual(await browser.value('state.broken'), '', 'nothing was refused');
  assert.deepStrictEqual(browser.complaints, [], 'nothing was thrown');
}

test().then(() => 0, (problem) => (console.error(problem), 1)).then(async (status) => {
  await browser.close();
  process.exit(status);
});
