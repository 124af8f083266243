// World that both peers step: two jellies in a pit with a ball and crates that break. Inputs are bits.
import { SPRING_DAMPING_RATIO } from 'massspring';
import { makeRandom } from './session.js';

export const LEFT = 1, RIGHT = 2, JUMP = 4;
export const DT = 1 / 60;
export const PIT = { left: -9, right: 9, heights: [5, 1.2, 0.3, 0, 0, 0, 0, 0, 0.3, 1.2, 5] };
const PUSH = 26, FASTEST = 6, LEAP = 6.5; // m/s^2, m/s, m/s
const RINGS = 2, RADIUS = 1;

export class World {
  constructor(ms) {
    const builder = new ms.Builder(), material = { springFlags: SPRING_DAMPING_RATIO, damping: 0.3 };
    const disc = (kind, x, y, radius, density, youngModulus) => {
      const { firstParticle } = builder.addDisc({ x, y, radius, ringCount: RINGS, areaDensity: density, youngModulus, material });
      const count = 1 + 3 * RINGS * (RINGS + 1), rim = 6 * RINGS;
      return { kind, centre: firstParticle, count, rim: Array.from({ length: rim }, (_, i) => firstParticle + count - rim + i) };
    };
    this.players = [disc('one', -5, 1.5, RADIUS, 12, 6000), disc('two', 5, 1.5, RADIUS, 12, 6000)];
    this.ball = disc('ball', 0, 5, 0.7, 5, 5000);
    this.crates = [[-1.1, 0.35], [0.4, 0.35], [-0.35, 1.75]].map(([x, y]) => {
      const ids = builder.addLattice({ width: 4, height: 4, x, y, spacing: 0.36,
        materials: [{ mass: 0.8, stiffness: 9000, breakStrain: 0.3, ...material }] });
      return { kind: 'crate', ids, side: 4 };
    });
    this.network = new ms.Network(builder, { substeps: 8, gravityY: -9.8, globalDamping: 0.1 });
    builder.free();
    const { left, right, heights } = PIT;
    this.network.setFloor({ heightsX: left, spacing: (right - left) / (heights.length - 1), heights, friction: 0.7, restitution: 0.2,
      planes: [left + 0.3, 0, 1, 0, right - 0.3, 0, -1, 0] });
    this.network.setContact({ flags: 0, thickness: 0.14, friction: 0.5 });
  }

  step(inputs) {
    inputs.forEach((input, i) => this.move(this.players[i], input));
    this.network.step(DT);
  }

  // All that a player does follows from its input and from what a snapshot has.
  move({ centre, count }, input) {
    const { network } = this, where = { first: centre, count };
    const [vx, vy] = network.velocities(centre);
    const direction = (input & RIGHT ? 1 : 0) - (input & LEFT ? 1 : 0);
    if (direction && vx * direction < FASTEST) {
      const mass = network.get('mass', where), forces = new Float32Array(2 * count);
      mass.forEach((m, i) => (forces[2 * i] = direction * PUSH * m));
      network.applyForces(forces, where);
    }
    if (input & JUMP && Math.abs(vy) < 0.4 && network.positions(centre)[1] < 2.6) {
      const mass = network.get('mass', where), impulses = new Float32Array(2 * count);
      mass.forEach((m, i) => (impulses[2 * i + 1] = LEAP * m));
      network.applyForces(impulses, where, 'impulse');
    }
  }

  save() {
    return this.network.save('frame');
  }

  load(snapshot) {
    this.network.load(snapshot);
  }

  hash() {
    return this.network.stateHash.toString(16);
  }
}

/** A player who runs to the ball, and sometimes changes his mind. */
export function makePlayer(seed) {
  const random = makeRandom(seed);
  let left = 0, input = 0;
  return (me, world) => {
    if (left-- > 0) return input;
    left = 6 + Math.floor(24 * random());
    const [mine] = world.network.positions(world.players[me].centre);
    const [ball] = world.network.positions(world.ball.centre);
    const chase = (ball > mine) === (random() < 0.8) ? RIGHT : LEFT;
    input = (random() < 0.85 ? chase : 0) | (random() < 0.3 ? JUMP : 0);
    return input;
  };
}

