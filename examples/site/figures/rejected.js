// Methods that do not serve, beside the library: position based dynamics, and Euler's method as it is first written.
import { bar, dropAtRest, DT, heightOf, IRON, MASS, plainBar, probe } from './scenes.js';

const WIDTH = 80, HEIGHT = 5, TOP = HEIGHT - 1, SUBSTEPS = 30, GRAVITY = -9.8, DAMPING = 1.5;

/** Position based dynamics (Müller 2007): move freely, then correct one spring after the other. It knows no N/m. */
export function stepPbd(body, iterations) {
  const { x, y, vx, vy, a, b, rest, width, count } = body, keep = Math.exp(-DAMPING * DT);
  const oldX = x.slice(), oldY = y.slice();
  for (let i = 0; i < count; i++) {
    if (i % width === 0) continue;
    vy[i] += GRAVITY * DT;
    x[i] += vx[i] * DT;
    y[i] += vy[i] * DT;
  }
  for (let round = 0; round < iterations; round++)
    for (let s = 0; s < a.length; s++) {
      const i = a[s], j = b[s], dx = x[j] - x[i], dy = y[j] - y[i], length = Math.sqrt(dx * dx + dy * dy);
      const wi = i % width ? 1 : 0, wj = j % width ? 1 : 0;
      if (wi + wj === 0) continue;
      const part = (length - rest[s]) / length / (wi + wj);
      x[i] += wi * part * dx;
      y[i] += wi * part * dy;
      x[j] -= wj * part * dx;
      y[j] -= wj * part * dy;
    }
  for (let i = 0; i < count; i++) {
    vx[i] = (keep * (x[i] - oldX[i])) / DT;
    vy[i] = (keep * (y[i] - oldY[i])) / DT;
  }
}

/** Explicit Euler: forces at the old place, and the place moves with the old velocity. */
export function stepEuler(body, substeps) {
  const { x, y, vx, vy, a, b, rest, width, count } = body, h = DT / substeps, keep = Math.exp(-DAMPING * h);
  const fx = new Float64Array(count), fy = new Float64Array(count);
  for (let substep = 0; substep < substeps; substep++) {
    fx.fill(0);
    fy.fill(0);
    for (let s = 0; s < a.length; s++) {
      const i = a[s], j = b[s], dx = x[j] - x[i], dy = y[j] - y[i], length = Math.sqrt(dx * dx + dy * dy);
      const pull = (IRON * (length - rest[s])) / length;
      fx[i] += pull * dx;
      fy[i] += pull * dy;
      fx[j] -= pull * dx;
      fy[j] -= pull * dy;
    }
    for (let i = 0; i < count; i++) {
      if (i % width === 0) continue;
      x[i] += vx[i] * h;
      y[i] += vy[i] * h;
      vx[i] = keep * (vx[i] + (fx[i] / MASS) * h);
      vy[i] = keep * (vy[i] + (fy[i] / MASS + GRAVITY) * h);
    }
  }
}

const iron = (ms) => bar(ms, { width: WIDTH, height: HEIGHT, substeps: SUBSTEPS, globalDamping: DAMPING });
const dropOf = (body) => TOP - body.y[WIDTH - 1];
const hasBurst = (body) => !(Math.abs(dropOf(body)) < 1000);

export default {
  name: 'rejected',
  still: 110,
  controls: [{ name: 'iterations', label: 'Iterations of PBD', min: 4, max: 240, step: 4, value: 12 }],

  start(ms, values) {
    const ours = iron(ms), pbd = plainBar(WIDTH, HEIGHT), rest = dropAtRest(ours, probe(WIDTH));
    let euler = plainBar(WIDTH, HEIGHT), burst = 0;
    const box = { minX: -2, maxX: WIDTH + 2, minY: -44, maxY: 8 };
    return {
      step() {
        ours.step(DT);
        stepPbd(pbd, values.iterations);
        if (!burst) stepEuler(euler, SUBSTEPS);
        if (burst || hasBurst(euler)) burst++;
        if (burst > 32) {
          euler = plainBar(WIDTH, HEIGHT);
          burst = 0;
        }
      },
      draw(pen) {
        const places = pen.columns(3);
        [ours, pbd, euler].forEach((body, i) => {
          pen.world(places[i], box);
          pen.line([[30, TOP - rest], [WIDTH, TOP - rest]], { colour: 'accent', dash: true });
          if (i === 0) pen.network(ours, 0.02);
          else pen.plain(body);
          pen.label(places[i], ['this library', 'PBD', 'plain Euler'][i]);
        });
      },
      say() {
        const sag = (drop) => `${Math.max(0, drop).toFixed(2)} m`, last = dropOf(euler);
        const ends = burst || !(Math.abs(last) < 100) ? 'exploded' : sag(last);
        return `sag so far: this library ${sag(TOP - heightOf(ours, probe(WIDTH)))} · PBD ${sag(dropOf(pbd))} · Euler ${ends} · ` +
          `all should end at ${rest.toFixed(2)} m`;
      },
      free: () => ours.free(),
    };
  },

  async check(ms, breathe) {
    const ours = iron(ms), pbd = plainBar(WIDTH, HEIGHT), euler = plainBar(WIDTH, HEIGHT), rest = dropAtRest(ours, probe(WIDTH));
    let burst = 0;
    for (let frame = 0; frame < 25 * 64; frame++) {
      ours.step(DT);
      stepPbd(pbd, 12);
      if (!burst) {
        stepEuler(euler, SUBSTEPS);
        if (hasBurst(euler)) burst = (frame + 1) / 64;
      }
      await breathe();
    }
    const drop = TOP - heightOf(ours, probe(WIDTH));
    ours.free();
    return [
      { what: 'this library sags {} times as far as it should', found: drop / rest, wanted: 1, within: 0.003, digits: 4 },
      { what: 'PBD with 12 iterations sags {} times as far as it should', found: dropOf(pbd) / rest, least: 2 },
      { what: 'plain Euler exploded after {}', found: burst || 25, most: 1, unit: ' s' },
    ];
  },
};
