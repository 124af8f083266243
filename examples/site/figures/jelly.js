// A square whose corner is pulled out, without and with dampers.
import { bar, DT } from './scenes.js';

const SIDE = 4, CORNER = SIDE - 1, PULL = 0.6, DAMPING = 55.05;

function square(ms, damping) {
  const network = bar(ms, { width: SIDE, height: SIDE, held: false, gravityY: 0, substeps: 1,
    material: { stiffness: 36700, damping } });
  network.setPositions([SIDE - 1 + PULL, SIDE - 1 + PULL], CORNER);
  return network;
}

const total = (network) => {
  const { kinetic, elastic } = network.energy;
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

// The mean of the last 64 values, and that of the first 64 since the beginning.
class RunningMean {
  constructor() {
    this.begin();
  }

  begin() {
    Object.assign(this, { values: [], sum: 0, first: 0 });
  }

  add(value) {
    this.values.push(value);
    this.sum += value;
    if (this.values.length > 64) this.sum -= this.values.shift();
    if (this.values.length === 64) this.first ||= this.now;
  }

  get now() {
    return this.sum / this.values.length;
  }
}

export default {
  name: 'jelly',
  controls: [
    { name: 'damping', label: 'Dampers, N s/m', min: 0, max: 300, step: 5, value: 55 },
    { name: 'pull', label: 'Pull the corner', press: true },
  ],

  start(ms, values) {
    const squares = [square(ms, 0), square(ms, values.damping)], means = squares.map(() => new RunningMean());
    return {
      grips: squares,
      press() {
        for (const network of squares) {
          const [x, y] = network.positions(CORNER);
          network.setPositions([x + PULL, y + PULL], CORNER);
        }
        means.forEach((mean) => mean.begin());
      },
      step: () => squares.forEach((network, i) => {
        network.step(DT);
        means[i].add(total(network));
      }),
      draw(pen) {
        pen.columns(2).forEach((place, i) => {
          pen.world(place, { minX: -1, maxX: SIDE, minY: -1, maxY: SIDE });
          pen.network(squares[i], 0.2);
          pen.label(place, i ? `${values.damping} N s/m` : 'no dampers');
        });
      },
      say() {
        // Both began with the energy of the pull, which the undamped one keeps: its first second is the measure.
        const first = means[0].first, parts = means.map((mean) => `${((100 * mean.now) / first).toFixed(0)} %`);
        return first ? `energy, averaged over a second: ${parts[0]} of the start (left), ${parts[1]} (right)`
          : 'energy, averaged over a second: measuring';
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
      { what: 'mean energy after a minute: {} of the first second', found: (100 * late) / early, wanted: 100, within: 2, digits: 0,
        unit: ' %' },
      { what: 'energy left after four seconds with dampers: {}', found: 100 * left, most: 3, digits: 0, unit: ' %' },
    ];
  },
};
