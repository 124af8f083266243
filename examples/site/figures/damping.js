// One spring between two free masses: what damping ratio 55.05 N s/m is.
import { MASS } from './scenes.js';

const STIFFNESS = 36700, REDUCED = MASS / 2, DT = 1 / 1024, PULL = 0.4;
const CRITICAL = 2 * Math.sqrt(STIFFNESS * REDUCED), OMEGA = Math.sqrt(STIFFNESS / REDUCED);

function pair(ms, ratio) {
  const builder = new ms.Builder();
  builder.addParticles({ x: [0, 1 + PULL], mass: MASS });
  builder.addSprings({ a: 0, b: 1, stiffness: STIFFNESS, damping: ratio * CRITICAL, restLength: 1 });
  const network = new ms.Network(builder, { gravityY: 0, substeps: 1 });
  builder.free();
  return network;
}

const stretchOf = (network) => {
  const [left, , right] = network.positions();
  return right - left - 1;
};

export default {
  name: 'damping',
  still: 900,
  controls: [{ name: 'ratio', label: 'Damping ratio', min: 0, max: 1.2, step: 0.004, value: 0.024 }],

  start(ms, values) {
    const { ratio } = values, network = pair(ms, ratio), trace = [];
    return {
      // An eighth of real time: the spring swings five times a second.
      step() {
        network.step(DT, 2);
        trace.push(stretchOf(network));
        if (trace.length > 1024) trace.length = 0;
      },
      draw(pen) {
        const [scene, graph] = pen.rows([1, 3]);
        pen.world(scene, { minX: -0.6, maxX: 1.6, minY: -0.35, maxY: 0.35 });
        pen.network(network, 0.5, { thick: 4, dots: 7 });
        const end = 1024 * 2 * DT, point = (stretch, i) => [2 * (i + 1) * DT, stretch];
        const envelope = (sign) => Array.from({ length: 100 }, (_, i) => (i / 99) * end)
          .map((t) => [t, sign * PULL * Math.exp(-ratio * OMEGA * t)]);
        pen.plot(graph, { x: [0, end], y: [-PULL, PULL], xName: 's', yName: 'stretch, m', curves: [
          { points: envelope(1), dash: true }, { points: envelope(-1), dash: true }, { points: trace.map(point), colour: 'accent' }] });
      },
      say: () => `damping ratio ${ratio.toFixed(3)}: ${(ratio * CRITICAL).toFixed(1)} N s/m, critical would be ` +
        `${Math.round(CRITICAL).toLocaleString('en')}`,
      free: () => network.free(),
    };
  },

  // The logarithm of two maxima ten swings apart.
  async check(ms, breathe) {
    const network = pair(ms, 55.05 / CRITICAL), peaks = [PULL];
    let before = PULL, now = PULL;
    while (peaks.length < 11) {
      network.step(1 / 8192);
      const next = stretchOf(network);
      if (now > before && now >= next) peaks.push(now);
      [before, now] = [now, next];
      await breathe();
    }
    network.free();
    const decrement = Math.log(peaks[0] / peaks[10]) / 10;
    return [{ what: 'damping ratio measured over ten swings: {}', found: decrement / Math.hypot(decrement, 2 * Math.PI),
      wanted: 55.05 / CRITICAL, within: 0.0001, digits: 4 }];
  },
};
