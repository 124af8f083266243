// A bar under its own weight, and where its springs are in equilibrium.
import { bar, dropAtRest, DT, heightOf, IRON, probe } from './scenes.js';

const WIDTH = 80, HEIGHT = 5, TOP = HEIGHT - 1;
const make = (ms, stiffness, settings) => bar(ms, { width: WIDTH, height: HEIGHT, globalDamping: 1.5,
  material: { stiffness }, ...settings });

export default {
  name: 'bending',
  still: 150,
  controls: [{ name: 'stiffer', label: 'Times as stiff', min: 1, max: 32, step: 1, value: 1 }],

  start(ms, values) {
    const network = make(ms, IRON * values.stiffer), rest = dropAtRest(network, probe(WIDTH));
    const drop = () => TOP - heightOf(network, probe(WIDTH));
    return {
      grips: [network],
      step: () => network.step(DT),
      draw(pen) {
        pen.world(pen.all, { minX: -2, maxX: WIDTH + 2, minY: -28, maxY: 8 });
        pen.line([[40, TOP - rest], [WIDTH + 2, TOP - rest]], { colour: 'accent', dash: true });
        pen.network(network, 0.02);
        pen.word([40, TOP - rest], `at rest: ${rest.toFixed(4)} m`, { under: true });
      },
      say: () => `sag ${drop().toFixed(2)} m, should end at ${rest.toFixed(2)} m · ${network.stepInfo.substeps} substeps a frame`,
      free: () => network.free(),
    };
  },

  async check(ms, breathe) {
    const network = make(ms, IRON, { substeps: 30 }), rest = dropAtRest(network, probe(WIDTH));
    for (let frame = 0; frame < 30 * 64; frame++) {
      network.step(DT);
      await breathe();
    }
    const drop = TOP - heightOf(network, probe(WIDTH));
    network.free();
    return [
      { what: "sag by Newton's method: {}", unit: ' m', found: rest, wanted: 20.0586, within: 0.0005, digits: 4 },
      { what: 'after thirty seconds of explicit substeps: {}', unit: ' m', found: drop, wanted: rest, within: 0.002 * rest, digits: 4 },
    ];
  },
};
