// Cost of stiffness: explicit substeps along a line, implicit ones off it.
import { bar, dropAtRest, DT, heightOf, MASS, probe } from './scenes.js';

const WIDTH = 80, HEIGHT = 5, SHARE = 0.9, NUMBERS = [32, 48, 64, 96, 128, 192, 256, 384, 512, 1024, 2048];
const stiffnessFor = (substeps) => (SHARE * MASS * substeps * substeps) / (2 * DT * DT);

const make = (ms, substeps, settings) => bar(ms, { width: WIDTH, height: HEIGHT, globalDamping: 1, substeps,
  material: { stiffness: stiffnessFor(substeps) }, ...settings });

// The least time of a frame, in ms. Clocks of browsers tick each tenth of one, so it is that of several frames.
function timeOf(network) {
  const time = (count) => {
    const begin = performance.now();
    network.step(DT, count);
    return performance.now() - begin;
  };
  for (let count = 1; ; count *= 2) {
    const least = Math.min(time(count), time(count), time(count));
    if (least > 2) return least / count;
  }
}

/** A point of the plot: at rest, and the time of a frame by both solvers. */
function measure(ms, substeps) {
  const network = make(ms, substeps), drop = dropAtRest(network, probe(WIDTH)), explicit = timeOf(network);
  network.setSettings({ solver: 'implicit', substeps: 1 });
  const implicit = timeOf(network);
  network.free();
  return { substeps, drop, explicit, implicit };
}

const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

// Explicit cost is in proportion to substeps, implicit cost constant: medians of both, so that one slow moment counts little.
const crossing = (found) => Math.round(median(found.map(({ implicit }) => implicit)) /
  median(found.map(({ explicit, substeps }) => explicit / substeps)));

export default {
  name: 'cost',
  still: 180,
  controls: [{ name: 'substeps', label: 'Substeps', min: 32, max: 256, step: 8, value: 32 }],

  start(ms, values) {
    const network = make(ms, values.substeps), found = [];
    let frames = 0;
    return {
      step() {
        network.step(DT);
        if (++frames % 16 === 0 && found.length < NUMBERS.length) found.push(measure(ms, NUMBERS[found.length]));
      },
      draw(pen) {
        const [scene, graph] = pen.columns(2);
        pen.world(scene, { minX: -2, maxX: WIDTH + 2, minY: -26, maxY: 12 });
        pen.network(network, 0.02);
        const times = found.flatMap(({ explicit, implicit }) => [explicit, implicit]);
        const low = times.length ? Math.min(...times) / 2 : 0.01, high = times.length ? Math.max(...times) * 2 : 10;
        const products = found.map(({ drop, explicit }) => explicit * Math.sqrt(drop)).sort((a, b) => a - b);
        const line = found.length ? [20, 0.002].map((drop) => [drop, products[found.length >> 1] / Math.sqrt(drop)]) : [];
        pen.plot(graph, { x: [20, 0.002], y: [low, high], log: true, logX: true, xName: 'sag, m', yName: 'ms a frame', curves: [
          { points: line, dash: true },
          { points: found.map(({ drop, explicit }) => [drop, explicit]), colour: 'accent', dots: true, name: 'explicit' },
          { points: found.map(({ drop, implicit }) => [drop, implicit]), colour: 'squeezed', dots: true, name: 'implicit' }] });
      },
      say() {
        const sag = `sag ${(4 - heightOf(network, probe(WIDTH))).toFixed(2)} m with ${values.substeps} substeps · `;
        if (found.length < NUMBERS.length) return `${sag}measuring ${found.length + 1} of ${NUMBERS.length}`;
        return `${sag}on this computer implicit is cheaper above ${crossing(found)} substeps`;
      },
      free: () => network.free(),
    };
  },

  async check(ms, breathe) {
    const products = [];
    for (const substeps of [64, 128, 256, 512]) {
      const network = make(ms, substeps);
      products.push(substeps * Math.sqrt(dropAtRest(network, probe(WIDTH))));
      network.free();
      await breathe();
    }
    const wanted = Math.sqrt((1.422e9 * 2 * DT * DT) / (SHARE * MASS));
    const { explicit, implicit } = measure(ms, 2048);
    return [
      { what: 'substeps × √sag from 64 to 512 substeps: least {}', found: Math.min(...products), wanted, within: 0.015 * wanted },
      { what: 'substeps × √sag from 64 to 512 substeps: most {}', found: Math.max(...products), wanted, within: 0.015 * wanted },
      { what: 'at 2,048 substeps an explicit frame costs as much as {} implicit ones', found: explicit / implicit, least: 3, digits: 1, timed: true },
    ];
  },
};
