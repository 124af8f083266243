// How many springs a lattice has.
import { SPRING_RELATIVE } from 'massspring';
import { bar, DT, MASS } from './scenes.js';

const springsOf = (width, height) => 4 * width * height - 3 * (width + height) + 2;

export default {
  name: 'size',
  controls: [
    { name: 'width', label: 'Columns', min: 2, max: 60, step: 1, value: 16 },
    { name: 'height', label: 'Rows', min: 1, max: 24, step: 1, value: 6 },
  ],

  start(ms, values) {
    const { width, height } = values;
    const network = bar(ms, { width, height, held: false, globalDamping: 0.3, substeps: 8,
      material: { mass: MASS, stiffness: 0.3, springFlags: SPRING_RELATIVE } });
    network.set('inverseMassScale', 0, 0);
    const reach = Math.hypot(width, height);
    return {
      step: () => network.step(DT),
      draw(pen) {
        pen.world(pen.all, { minX: -reach, maxX: reach, minY: height - 1 - reach, maxY: 2 * height });
        pen.network(network, 0.05);
      },
      say: () => `${width} × ${height} = ${width * height} particles, ${network.springCount} springs, ` +
        `${(network.springCount / (width * height)).toFixed(1)} a particle`,
      free: () => network.free(),
    };
  },

  async check(ms, breathe) {
    let sizes = 0, right = 0;
    for (let width = 1; width <= 24; width++)
      for (let height = 1; height <= 24; height++) {
        const builder = new ms.Builder();
        builder.addLattice({ width, height, materials: [{ stiffness: 1 }] });
        sizes++;
        right += builder.springCount === springsOf(width, height);
        builder.free();
        await breathe();
      }
    return [{ what: `{} of ${sizes} sizes follow the formula`, found: right, wanted: sizes, within: 0, digits: 0 }];
  },
};
