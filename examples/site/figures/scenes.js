// Scenes of the figures: bars of the library, and the same bars as plain arrays for other methods.
import { PARTICLE_PINNED } from 'massspring';

/** kg of a particle, and s of a frame: those of the articles and examples. */
export const MASS = 73.3975;
export const DT = 1 / 64;
/** N/m of iron, with which thirty substeps are stable. */
export const IRON = 6.7643e7;

/** A lattice of width x height particles, 1 m apart. held: whether those in the first column are pinned. */
export function bar(ms, { width, height, held = true, x = 0, y = 0, material = {}, more, flags, ...settings }) {
  const materials = [{ mass: MASS, stiffness: IRON, ...material }];
  materials.push({ ...materials[0], particleFlags: PARTICLE_PINNED });
  const cells = new Uint16Array(width * height);
  if (held) for (let row = 0; row < height; row++) cells[row * width] = 1;
  const builder = new ms.Builder();
  builder.addLattice({ width, height, x, y, cells, materials });
  more?.(builder);
  const network = new ms.Network(builder, settings, { flags });
  builder.free();
  return network;
}

/** The particle at the top right of a bar of that width, whose drop is the bending. */
export const probe = (width) => width - 1;

/** The height of a particle. */
export const heightOf = (network, particle) => network.positions(particle)[1];

/** Where the springs of a network leave its particles at rest. The network itself stays. */
export function dropAtRest(network, particle) {
  const copy = network.clone(), before = heightOf(copy, particle);
  copy.settle();
  const after = heightOf(copy, particle);
  copy.free();
  return before - after;
}

/** The same bar as arrays, in double precision, or in single precision with Array = Float32Array. */
export function plainBar(width, height, Array = Float64Array, left = 0) {
  const count = width * height, a = [], b = [];
  const join = (from, to) => (a.push(from), b.push(to));
  for (let row = 0; row < height; row++)
    for (let column = 0; column < width; column++) {
      const at = row * width + column;
      if (column + 1 < width) join(at, at + 1);
      if (row + 1 === height) continue;
      join(at, at + width);
      if (column + 1 < width) join(at, at + width + 1);
      if (column > 0) join(at, at + width - 1);
    }
  const made = { width, height, count, a: Uint32Array.from(a), b: Uint32Array.from(b), x: new Array(count),
    y: new Array(count), vx: new Array(count), vy: new Array(count), rest: new Array(a.length) };
  for (let i = 0; i < count; i++) {
    made.x[i] = left + (i % width);
    made.y[i] = height - 1 - Math.floor(i / width);
  }
  for (let s = 0; s < a.length; s++) made.rest[s] = Math.hypot(made.x[b[s]] - made.x[a[s]], made.y[b[s]] - made.y[a[s]]);
  return made;
}
