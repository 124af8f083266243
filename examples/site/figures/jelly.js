// A square whose corner is pulled out, without and with dampers.
import { bar, DT } from './scenes.js';

const SIDE = 4, CORNER = SIDE - 1, PULL = 0.6, DAMPING = 55.05;

function square(ms, damping) {
  const network = bar(ms, { width: SIDE, height: SIDE, held: false, gravityY: 0, substeps: 1,
    material: { stiffness: 36700, damping } });
  network.setPositions([SIDE - 1 + PULL, SIDE - 1 + PULL], { ids: [CORNER] });
  return network;
}

const total = (network) => {
  const { kinetic, elastic } = network.energy();
  return kinetic + elastic;
};

// Energy of the scheme swings within each period, so it is the mean over a second.
async function meanEnergy(network, breathe) {
  let sum = 0;
  for (let i = 0; i < 64; i++) {
    network.step(DT);
    sum += total(network);
  }
  await breathe();
  return sum / 64;
}

export default {
  name: 'jelly',
  controls: [
    { name: 'damping', label: 'Dampers, N s/m', min: 0, max: 300, step: 5, value: 55 },
    { name: 'pull', label: 'Pull the corner', press: true },
  ],

  start(ms, values) {
    const squares = [square(ms, 0), square(ms, values.damping)], first = total(squares[0]);
    return {
      grips: squares,
      press() {
        for (const network of squares) {
          const [x, y] = network.positions({ ids: [CORNER] });
          network.setPositions([x + PULL, y + PULL], { ids: [CORNER] });
        }
      },
      step: () => squares.forEach((network) => network.step(DT)),
      draw(pen) {
        pen.columns(2).forEach((place, i) => {
          pen.world(place, { minX: -1, maxX: SIDE, minY: -1, maxY: SIDE });
          pen.network(squares[i], 0.2);
          pen.label(place, i ? `${values.damping} N s/m` : 'no dampers');
        });
      },
      say() {
        const parts = squares.map((network) => `${((100 * total(network)) / first).toFixed(0)} %`);
        return `energy now, of that at first: ${parts.join(' and ')}`;
      },
      free: () => squares.forEach((network) => network.free()),
    };
  },

  async check(ms, breathe) {
    const free = square(ms, 0), damped = square(ms, DAMPING), whole = total(damped);
    const early = await meanEnergy(free, breathe);
    for (let second = 1; second < 59; second++) await meanEnergy(free, breathe);
    const late = await meanEnergy(free, breathe);
    for (let second = 0; second < 4; second++) await meanEnergy(damped, breathe);
    const left = total(damped) / whole;
    free.free();
    damped.free();
    return [
      { what: 'energy of the undamped square after a minute, of that in the first second', found: late / early,
        wanted: 1, within: 0.02 },
      { what: 'energy of the damped one after four seconds, of that at first', found: left, most: 0.03 },
    ];
  },
};
