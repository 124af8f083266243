// The cure: more substeps. Twice as many are stable with four times the stiffness.
import { bisected, computed } from './border.js';
import { bar, DT } from './scenes.js';

const WIDTH = 24, HEIGHT = 5, SOFT = 165000; // a tenth above the border of one substep

const make = (ms, stiffness, substeps) => bar(ms, { width: WIDTH, height: HEIGHT, substeps, guard: 'bounds', globalDamping: 0.2,
  material: { stiffness, damping: 55.05 } });

// A step of a network, or whether it has exploded.
function tried(network) {
  try {
    network.step(DT);
    return network.energy.largestSpeed > 1e4;
  } catch {
    return true;
  }
}

export default {
  name: 'cure',
  controls: [{ name: 'substeps', label: 'Substeps', min: 1, max: 40, step: 1, value: 6 }],

  start(ms, values) {
    const { substeps } = values, stiffness = SOFT * (substeps === 1 ? 1 : (substeps * substeps) / 4);
    const bars = [make(ms, stiffness, 1), make(ms, stiffness, substeps)], gone = [0, 0], worst = ['steady', 'steady'];
    return {
      step() {
        bars.forEach((network, i) => {
          if (!gone[i]) {
            gone[i] = tried(network) ? 1 : 0;
            if (gone[i]) worst[i] = 'exploded';
          }
          else if (++gone[i] > 64 && i === 0) { // once more from the start
            network.free();
            bars[i] = make(ms, stiffness, 1);
            gone[i] = 0;
          }
        });
      },
      draw(pen) {
        pen.columns(2).forEach((place, i) => {
          pen.world(place, { minX: -2, maxX: WIDTH + 2, minY: -24, maxY: 10 });
          pen.network(bars[i], 0.2);
          pen.label(place, i ? `${substeps} substeps` : `1 substep${gone[0] ? ': exploded' : ''}`);
        });
      },
      say: () => `both ${Math.round(stiffness).toLocaleString('en')} N/m · left: 1 substep, ${worst[0]} · right: ${substeps} ` +
        `substep${substeps > 1 ? 's' : ''}, ${worst[1]}`,
      free: () => bars.forEach((network) => network.free()),
    };
  },

  async check(ms, breathe) {
    const one = computed(ms), guess = 900 * one;
    const found = await bisected(ms, breathe, 0.97 * guess, 1.03 * guess, 30);
    return [{ what: '30 substeps allow {} times the stiffness of one', found: found / one, wanted: 900, within: 9, digits: 0 }];
  },
};
