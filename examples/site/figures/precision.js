// Nine kilometres from the local origin a float is a millimetre: what trembles there, and what does not.
import { NETWORK_PRECISE, PARTICLE_PINNED } from 'massspring';
import { bar, DT, IRON, MASS, plainBar } from './scenes.js';

const WIDTH = 40, HEIGHT = 4, FAR = 9000, SUBSTEPS = 64, DAMPING = 5, TIMES = 200;

// The other particle holds the origin at the middle between it and the bar.
function distant(ms, flags) {
  const network = bar(ms, { width: WIDTH, height: HEIGHT, x: FAR, substeps: SUBSTEPS, globalDamping: DAMPING, flags,
    more: (builder) => builder.addParticles({ x: -FAR - WIDTH, flags: PARTICLE_PINNED }) });
  network.settle();
  return network;
}

/** The same as a plain program has it, in single precision. */
function stepPlain(body) {
  const { x, y, vx, vy, a, b, rest, width, count } = body, h = Math.fround(DT / SUBSTEPS);
  const keep = Math.fround(Math.exp(-DAMPING * h)), fx = new Float32Array(count), fy = new Float32Array(count);
  for (let substep = 0; substep < SUBSTEPS; substep++) {
    fx.fill(0);
    fy.fill(0);
    for (let s = 0; s < a.length; s++) {
      const i = a[s], j = b[s], dx = Math.fround(x[j] - x[i]), dy = Math.fround(y[j] - y[i]);
      const length = Math.fround(Math.sqrt(dx * dx + dy * dy)), pull = Math.fround((IRON * (length - rest[s])) / length);
      fx[i] += pull * dx;
      fy[i] += pull * dy;
      fx[j] -= pull * dx;
      fy[j] -= pull * dy;
    }
    for (let i = 0; i < count; i++) {
      if (i % width === 0) continue;
      vx[i] = keep * (vx[i] + (fx[i] / MASS) * h);
      vy[i] = keep * (vy[i] + (fy[i] / MASS - 9.8) * h);
      x[i] += vx[i] * h;
      y[i] += vy[i] * h;
    }
  }
}

function plain(settled) {
  const body = plainBar(WIDTH, HEIGHT, Float32Array, FAR), places = settled.positions();
  for (let i = 0; i < body.count; i++) [body.x[i], body.y[i]] = [places[2 * i], places[2 * i + 1]];
  return body;
}

const fastest = (vx, vy) => vx.reduce((most, v, i) => Math.max(most, Math.hypot(v, vy[i])), 0);

// Positions whose way from rest is drawn so many times as long.
function enlarged(body, rest, places) {
  for (let i = 0; i < body.count; i++) {
    body.x[i] = rest[2 * i] - FAR + TIMES * (places(i)[0] - rest[2 * i]);
    body.y[i] = rest[2 * i + 1] + TIMES * (places(i)[1] - rest[2 * i + 1]);
  }
  return body;
}

export default {
  name: 'precision',
  controls: [],

  start(ms) {
    const networks = [distant(ms, NETWORK_PRECISE), distant(ms, 0)], rest = networks[0].positions(), body = plain(networks[0]);
    const shown = plainBar(WIDTH, HEIGHT), names = ['precise', 'default', 'plain floats'];
    const speeds = () => [...networks.map((network) => network.energy.largestSpeed), fastest(body.vx, body.vy)];
    return {
      step() {
        networks.forEach((network) => network.step(DT));
        stepPlain(body);
      },
      draw(pen) {
        const places = pen.columns(3), now = networks.map((network) => network.positions());
        const wheres = [...now.map((found) => (i) => [found[2 * i], found[2 * i + 1]]), (i) => [body.x[i], body.y[i]]];
        wheres.forEach((where, i) => {
          pen.world(places[i], { minX: -2, maxX: WIDTH + 2, minY: -8, maxY: 12 });
          pen.plain(enlarged(shown, rest, where));
          pen.label(places[i], names[i]);
        });
      },
      say() {
        const [precise, usual, floats] = speeds().map((speed) => `${Number(speed.toPrecision(2))} m/s`);
        return `fastest particle: precise ${precise} · default ${usual} · plain floats ${floats} (motion shown ${TIMES}×)`;
      },
      free: () => networks.forEach((network) => network.free()),
    };
  },

  async check(ms, breathe) {
    const networks = [distant(ms, NETWORK_PRECISE), distant(ms, 0)], body = plain(networks[0]), most = [0, 0, 0];
    for (let frame = 0; frame < 128; frame++) {
      networks.forEach((network) => network.step(DT));
      stepPlain(body);
      await breathe();
      if (frame < 64) continue;
      [...networks.map((network) => network.energy.largestSpeed), fastest(body.vx, body.vy)]
        .forEach((speed, i) => (most[i] = Math.max(most[i], speed)));
    }
    networks.forEach((network) => network.free());
    return [
      { what: 'fastest particle with the flag: {}', unit: ' m/s', found: most[0], most: 0.02, digits: 4 },
      { what: 'without it: {}', unit: ' m/s', found: most[1], least: 1 },
      { what: 'in a plain program in single precision: {}', unit: ' m/s', found: most[2], least: 1 },
    ];
  },
};
