// Permanent bending: a bar whose springs yield, next to an elastic one.
import { bar, DT, heightOf, probe } from './scenes.js';

const WIDTH = 40, HEIGHT = 5, TOP = HEIGHT - 1, YIELD = 0.01, HARDENING = 0.1, LOAD = 60000;

const make = (ms, yielding) => bar(ms, { width: WIDTH, height: HEIGHT, substeps: 30, globalDamping: 2, gravityY: 0,
  material: yielding ? { yieldStrain: YIELD, hardening: HARDENING } : {} });

// The load at the free end grows for two seconds and is taken away in the next two.
const loadAt = (time) => LOAD * Math.max(0, 1 - Math.abs(time - 2) / 2);

export default {
  name: 'plasticity',
  still: 230,
  controls: [
    { name: 'load', label: 'Load, %', min: 10, max: 100, step: 5, value: 100 },
    { name: 'again', label: 'Load it again', press: true },
  ],

  start(ms, values) {
    const bars = [make(ms, false), make(ms, true)];
    let time = 0;
    return {
      press: () => (time = 0),
      grips: bars,
      step() {
        time += DT;
        bars.forEach((network) => {
          for (let row = 0; row < HEIGHT; row++)
            network.applyForce(row * WIDTH + WIDTH - 1, 0, -(loadAt(time) * values.load) / 100);
          network.step(DT);
        });
      },
      draw(pen) {
        pen.columns(2).forEach((place, i) => {
          pen.world(place, { minX: -2, maxX: WIDTH + 2, minY: -24, maxY: 10 });
          pen.network(bars[i], 0.02);
          pen.label(place, i ? 'yields at 1 %' : 'elastic');
        });
      },
      say() {
        const load = (HEIGHT * loadAt(time) * values.load) / 1e5;
        const [elastic, yielding] = bars.map((network) => `${Math.abs(TOP - heightOf(network, probe(WIDTH))).toFixed(2)} m`);
        return load > 0 ? `load ${load.toFixed(0)} kN · elastic: sag ${elastic} · yielding: sag ${yielding}`
          : `load gone · elastic ${elastic} · yielding keeps ${yielding}`;
      },
      free: () => bars.forEach((network) => network.free()),
    };
  },

  // One spring that is pulled by a tenth: what stays follows from the law.
  async check(ms) {
    const pull = 0.1, builder = new ms.Builder();
    builder.addParticles({ x: [0, 1], mass: 1 });
    builder.addSprings({ a: 0, b: 1, stiffness: 1000, yieldStrain: YIELD, hardening: HARDENING });
    const network = new ms.Network(builder, { gravityY: 0, substeps: 4 });
    builder.free();
    network.set('inverseMassScale', 0);
    network.setPositions([1 + pull, 0], 1);
    network.step(DT, 4);
    const [strain] = network.get('plasticStrain');
    network.free();
    return [{ what: 'a spring pulled by 10 % keeps {}', found: 100 * strain, wanted: (100 * (pull - YIELD)) / (1 + HARDENING),
      within: 1e-3, digits: 3, unit: ' %' }];
  },
};
