// The exact border of stability: the library computes it, and runs on both sides of it agree.
import { bar, DT, MASS } from './scenes.js';
import { NETWORK_PRECISE } from 'massspring';

const WIDTH = 24, HEIGHT = 6, LARGE = MASS / (2 * DT * DT);

function sheet(ms, stiffness) {
  const network = bar(ms, { width: WIDTH, height: HEIGHT, held: false, gravityY: 0, substeps: 1, guard: 'bounds',
    material: { stiffness }, flags: NETWORK_PRECISE });
  // A push of a millionth of a metre per second, different for each particle.
  network.setVelocities(Float32Array.from({ length: 2 * WIDTH * HEIGHT }, (_, i) => 1e-6 * Math.sin(i * i)));
  return network;
}

/** The stiffness at which one substep of 1/64 s is the longest stable one. */
export function computed(ms) {
  const network = sheet(ms, LARGE), { now } = network.stableDt;
  network.free();
  return LARGE * (now / DT) ** 2;
}

export function grows(ms, stiffness, substeps = 1, frames = 1500) {
  const network = sheet(ms, stiffness);
  network.setSettings({ substeps });
  try {
    for (let frame = 0; frame < frames; frame += 25) {
      network.step(DT, 25);
      if (network.energy.largestSpeed > 0.5) return true;
    }
    return false;
  } catch {
    return true;
  } finally {
    network.free();
  }
}

/** The same from runs: between these two stiffnesses they begin to grow. */
export async function bisected(ms, breathe, low, high, substeps = 1) {
  for (let i = 0; i < 10; i++) {
    const middle = (low + high) / 2;
    if (grows(ms, middle, substeps)) high = middle;
    else low = middle;
    await breathe();
  }
  return (low + high) / 2;
}

export default {
  name: 'border',
  still: 110,
  controls: [{ name: 'part', label: 'Stiffness, % of the limit', min: 90, max: 110, step: 0.5, value: 101 }],

  start(ms, values) {
    const limit = computed(ms), stiffness = (limit * values.part) / 100, network = sheet(ms, stiffness);
    let gone = false;
    const trace = [];
    return {
      step() {
        if (gone) return;
        try {
          network.step(DT);
        } catch {
          gone = true;
        }
        trace.push(Math.max(network.energy.largestSpeed, 1e-9));
        gone ||= trace.at(-1) > 300 || trace.length >= 1200;
      },
      draw(pen) {
        const [scene, graph] = pen.columns(2);
        pen.world(scene, { minX: -3, maxX: WIDTH + 2, minY: -4, maxY: HEIGHT + 3 });
        pen.network(network, 0.2);
        pen.plot(graph, { x: [0, Math.max(4, trace.length / 64)], y: [1e-7, 1e3], log: true, xName: 's',
          yName: 'fastest particle, m/s', curves: [{ points: trace.map((speed, i) => [i / 64, speed]), colour: 'accent' }] });
      },
      // State of the run, independent of the slider.
      say() {
        const speed = trace.at(-1) ?? 0, fastest = trace.reduce((most, value) => Math.max(most, value), 0), seconds = trace.length / 64;
        const state = speed > 300 || !Number.isFinite(speed) ? `exploded after ${seconds.toFixed(1)} s`
          : fastest > 1e-4 ? `growing, ${speed.toPrecision(2)} m/s` : `steady for ${seconds.toFixed(0)} s`;
        return `${Math.round(stiffness).toLocaleString('en')} N/m, limit ${Math.round(limit).toLocaleString('en')}: ${state}`;
      },
      free: () => network.free(),
    };
  },

  async check(ms, breathe) {
    const limit = computed(ms);
    const found = await bisected(ms, breathe, 0.95 * limit, 1.05 * limit);
    return [
      { what: 'limit found by trial: {} times the computed one', found: found / limit, wanted: 1, within: 0.005, digits: 4 },
      { what: 'computed limit: {} times that of an endless sheet', found: limit / LARGE, wanted: 1, within: 0.05 },
    ];
  },
};
