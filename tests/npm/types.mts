// What the types allow, and what they refuse. Compiled, not run.
import { load, MassSpringError, NONE, PARTICLE_PINNED, type NetworkOptions, type Property } from 'massspring';

const options: NetworkOptions = { solver: 'implicit', guard: 'clampBounds', gravityY: -1.6, spareSprings: 8 };
const ms = await load({ simd: false });
const builder = new ms.Builder();
const cells: Uint32Array = builder.addLattice({ width: 2, height: 1, cells: [0, 0], materials: [ms.material('steel', 1, 1e-3)] });
builder.addParticles({ x: [1, 2], y: new Float64Array(2), mass: 3, flags: PARTICLE_PINNED });
const network = new ms.Network(builder, options);
network.step(1 / 60, 3);
const wide: Float64Array = network.positions();
const narrow: Float32Array = network.positions({ ids: cells, into: new Float32Array(4) });
const hash: bigint = network.stateHash();
const property: Property = 'restLength';
network.set(property, 2, { first: 0, count: 1 });
for (const { kind, id } of network.readEvents().events) if (kind === 'broken') network.restoreSprings(id, 0.5);
const time: number = network.stepInfo().time + network.getSettings().sleepTime + network.plan().latticeCount;
network.setFloor({ planes: [0, 0, 0, 1], friction: 0.5 });
network.addCollider({ kind: 'circle', radius: 2 });
const tyre: number = network.addArea(cells, { kind: 'gas', pressure: 1 });
network.setArea(tyre, { ...network.getArea(tyre), fill: 1.2 });
network.setRestAngles(network.addAngles([0, 1, 2], { stiffness: 5 }).first, [network.areaInfo(tyre).area]);
try {
  network.load(network.clone().save('frame'));
} catch (error) {
  if (error instanceof MassSpringError && error.result === 'snapshot') console.log(error.particles, NONE);
}
console.log(wide, narrow, hash, time);

// @ts-expect-error there is no such solver
network.setSolver({ solver: 'magic' });
// @ts-expect-error there is no such option
network.setSettings({ gravity: 9.8 });
// @ts-expect-error there is no such kind of area
network.addArea(cells, { kind: 'oil' });
// @ts-expect-error there is no such property
network.get('colour');
// @ts-expect-error the length of an array says it
network.setFloor({ planes: [0, 0, 0, 1], planeCount: 1 });
