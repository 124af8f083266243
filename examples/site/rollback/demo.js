// Shows both peers of a session side by side. Visitors play, and make the line worse.
import { open } from 'massspring';
import { Pen } from '../figures/pen.js';
import { Session } from './session.js';
import { DT, JUMP, LEFT, PIT, RIGHT, World, makePlayer } from './world.js';

const KEYS = [{ KeyA: LEFT, KeyD: RIGHT, KeyW: JUMP }, { ArrowLeft: LEFT, ArrowRight: RIGHT, ArrowUp: JUMP }];
const IDLE = 4000; // ms without a key until the computer plays
const TEN_MINUTES = 36000;
const FILLS = { one: '#3fae6a', two: '#ef7d32', ball: '#f2c94c', crate: '#a9805b' };
const LOOK = { minX: PIT.left + 0.2, maxX: PIT.right - 0.2, minY: -0.8, maxY: 6.2 };

function bytesOf(text) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

// One peer without SIMD, to show that it makes no difference.
async function libraries() {
  await new Promise((done, failed) => {
    const script = document.createElement('script');
    script.src = new URL('massspring_scalar.wasm.js', document.querySelector('script[src$="rollback.js"]').src);
    script.onload = done;
    script.onerror = failed;
    document.head.append(script);
  });
  const scalar = await open({ wasm: bytesOf(globalThis.massspringScalar) });
  try {
    return [await open({ wasm: bytesOf(globalThis.massspringSimd) }), scalar];
  } catch {
    return [scalar, scalar];
  }
}

/* ------------------------------------------------------------------------------------------------------- drawing */

function outline(pen, points, fill) {
  const { context } = pen, middle = ([ax, ay], [bx, by]) => [(ax + bx) / 2, (ay + by) / 2];
  context.beginPath();
  context.moveTo(...pen.at(...middle(points.at(-1), points[0])));
  points.forEach((point, i) => context.quadraticCurveTo(...pen.at(...point), ...pen.at(...middle(point, points[(i + 1) % points.length]))));
  context.fillStyle = fill;
  context.fill();
}

function eyes(pen, [x, y], toward) {
  for (const side of [-0.28, 0.28]) {
    pen.context.fillStyle = '#fff';
    pen.context.beginPath();
    pen.context.arc(...pen.at(x + side, y + 0.25), 0.2 * pen.scale, 0, 7);
    pen.context.fill();
    pen.dot([x + side + 0.07 * toward, y + 0.24], 'ink', 0.09 * pen.scale);
  }
}

function drawWorld(pen, place, world, title) {
  pen.world(place, LOOK);
  const all = world.network.positions(), at = (id) => [all[2 * id], all[2 * id + 1]];
  const { heights, left, right } = PIT, step = (right - left) / (heights.length - 1);
  const { context } = pen;
  context.beginPath();
  context.moveTo(...pen.at(left, -9));
  heights.forEach((height, i) => context.lineTo(...pen.at(left + i * step, height)));
  context.lineTo(...pen.at(right, -9));
  context.fillStyle = pen.colours.line;
  context.fill();
  for (const { ids, side } of world.crates)
    for (let i = 0; i < side * (side - 1); i++) {
      if (i % side === side - 1) continue;
      const corners = [ids[i], ids[i + 1], ids[i + side + 1], ids[i + side]].map(at);
      if (corners.some(([x, y], j) => Math.hypot(x - corners[(j + 1) % 4][0], y - corners[(j + 1) % 4][1]) > 0.65)) continue;
      context.beginPath();
      corners.forEach((corner, j) => (j ? context.lineTo(...pen.at(...corner)) : context.moveTo(...pen.at(...corner))));
      context.fillStyle = FILLS.crate;
      context.fill();
    }
  for (const { kind, rim } of [world.ball, ...world.players]) outline(pen, rim.map(at), FILLS[kind]);
  pen.network(world.network, 0.15, { thick: 0.8 });
  const ball = at(world.ball.centre)[0];
  for (const { centre } of world.players) eyes(pen, at(centre), Math.sign(ball - at(centre)[0]));
  pen.label(place, title);
}

/* --------------------------------------------------------------------------------------------------------- demo */

class Demo {
  constructor(element, ms) {
    Object.assign(this, { element, ms, pressed: [0, 0], lastKey: [-IDLE, -IDLE], debt: 0 });
    this.pen = new Pen(element.querySelector('canvas'));
    this.quality = {};
    for (const slider of element.querySelectorAll('[data-line]')) {
      const read = () => {
        slider.closest('label').querySelector('output').textContent = slider.value;
        this.quality[slider.dataset.line] = Number(slider.value) * (slider.dataset.line === 'loss' ? 0.01 : 1);
      };
      slider.addEventListener('input', read);
      read();
    }
    this.tenButton = element.querySelector('[data-ten]');
    this.tenButton.onclick = () => this.tenMinutes();
    this.bindKeys();
    this.bindPointer();
    this.start();
  }

  start() {
    let made = 0;
    const worlds = [];
    this.session = new Session(() => (worlds[made] = new World(this.ms[made++])), this.quality, Date.now());
    this.players = [makePlayer(11 + Date.now()), makePlayer(12 + Date.now())];
  }

  bindKeys() {
    const set = (event, on) => KEYS.forEach((keys, me) => {
      const bit = keys[event.code];
      if (!bit) return;
      this.pressed[me] = on ? this.pressed[me] | bit : this.pressed[me] & ~bit;
      this.lastKey[me] = performance.now();
      if (!event.target.matches('input')) event.preventDefault();
    });
    addEventListener('keydown', (event) => set(event, true));
    addEventListener('keyup', (event) => set(event, false));
  }

  // On a phone: a player follows the finger in his half of the canvas, and jumps if it is above him.
  bindPointer() {
    const { canvas } = this.pen;
    const lead = (event) => {
      const box = canvas.getBoundingClientRect(), point = this.pen.pick(event.clientX - box.left, event.clientY - box.top);
      if (!point) return;
      const { world } = this.session.peers[point.index], [x, y] = world.network.positions(world.players[point.index].centre);
      this.pressed[point.index] = (point.x > x + 0.4 ? RIGHT : point.x < x - 0.4 ? LEFT : 0) | (point.y > y + 1.3 ? JUMP : 0);
      this.lastKey[point.index] = performance.now();
    };
    canvas.addEventListener('pointerdown', lead);
    canvas.addEventListener('pointermove', (event) => event.buttons && lead(event));
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, () => (this.pressed = [0, 0]));
  }

  tick() {
    this.session.tick((me, world) =>
      (performance.now() - this.lastKey[me] < IDLE ? this.pressed[me] : this.players[me](me, world)));
  }

  advance(seconds) {
    this.debt = Math.min(this.debt + seconds, 4 * DT);
    for (; this.debt >= DT; this.debt -= DT) this.tick();
  }

  // In pieces, so that the page stays alive.
  async tenMinutes() {
    this.start();
    this.tenButton.disabled = this.busy = true;
    for (let done = 0; done < TEN_MINUTES;) {
      for (const end = performance.now() + 12; performance.now() < end && done < TEN_MINUTES; done++) this.tick();
      this.tenButton.textContent = `${Math.floor((100 * done) / TEN_MINUTES)} %`;
      await new Promise((next) => setTimeout(next));
    }
    this.tenButton.textContent = 'Ten minutes at once';
    this.tenButton.disabled = this.busy = false;
  }

  show() {
    const { peers, lines } = this.session, compared = Math.min(...peers.map(({ count }) => count.compared));
    const differing = peers[0].count.differing + peers[1].count.differing;
    this.pen.begin();
    const places = this.pen.columns(2);
    places.forEach((place, i) => drawWorld(this.pen, place, peers[i].world,
      `${i ? 'orange' : 'green'}'s computer${this.ms[0] === this.ms[1] ? '' : i ? ' (no SIMD)' : ' (SIMD)'}`));
    this.pen.divide(places[1]);
    const verdict = this.element.querySelector('[data-verdict]');
    verdict.textContent = `${compared.toLocaleString('en')} hashes compared, ${differing ? `${differing} differ` : 'all equal'}`;
    verdict.className = `verdict ${differing ? 'failed' : 'passed'}`;
    const sum = (name) => peers[0].count[name] + peers[1].count[name];
    const sent = lines[0].sent + lines[1].sent, lost = lines[0].lost + lines[1].lost;
    const minutes = Math.floor(peers[0].frame / 3600), seconds = Math.floor(peers[0].frame / 60) % 60;
    this.element.querySelector('[data-now]').textContent = `${minutes}:${String(seconds).padStart(2, '0')} played · ` +
      `${sum('rollbacks').toLocaleString('en')} rollbacks, the longest ${Math.max(...peers.map(({ count }) => count.deepest))} frames · ` +
      `waited ${sum('waits').toLocaleString('en')} frames · ${lost.toLocaleString('en')} of ${sent.toLocaleString('en')} packets lost`;
  }
}

async function run() {
  const demo = new Demo(document.querySelector('[data-rollback]'), await libraries());
  globalThis.rollbackDemo = demo;
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => demo.pen.readColours());
  demo.element.classList.add('running');
  let before = performance.now();
  const frame = (now) => {
    if (!demo.busy) demo.advance((now - before) / 1000);
    before = now;
    demo.show();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

run().catch((error) => {
  document.querySelector('[data-verdict]').textContent = `This browser cannot run it: ${error.message}`;
  console.error(error);
});
