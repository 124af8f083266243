// What the types allow, and what they refuse. Compiled, not run.
import { load, MassSpringError, NONE, PARTICLE_PINNED, type Property, type Settings } from 'massspring';

const settings: Settings = { solver: 'implicit', substeps: 'auto', guard: 'clampBounds', gravityY: -1.6 };
const ms = await load({ simd: false });
const builder = new ms.Builder();
const cells: Uint32Array = builder.addLattice({ width: 2, height: 1, materials: [ms.material('steel', 1, 1e-3)] });
builder.addParticles({ x: [1, 2], y: new Float64Array(2), mass: 3, flags: PARTICLE_PINNED });
builder.addSprings({ a: 0, b: [2, 3], stiffness: 1, restLength: 'auto', breakStrain: Infinity });
builder.addRope({ from: 0, to: 1, material: { stiffness: 5, relaxStrain: 'auto' }, lengthRatio: 1.1 });
const network = new ms.Network(builder, settings, { spareSprings: 8 });
network.step(1 / 60, 3);
const wide: Float64Array = network.positions();
const narrow: Float32Array = network.get(['x', 'y'], cells, new Float32Array(4));
const hash: bigint = network.stateHash;
const layers: Uint32Array = network.get('layers', 3);
const index: Uint32Array = network.get(['slotA', 'slotB']);
const { length, springFlags } = network.columns(['length', 'springFlags'], { first: 1 });
const [one, flags]: [Float32Array, Uint32Array] = [length, springFlags];
const property: Property = 'restLength';
network.set(property, 2, { first: 0, count: 1 });
network.set('friction', 'auto', 0);
for (const { kind, id } of network.readEvents().events) if (kind === 'broken') network.restoreSprings(id, 0.5);
const time: number = network.stepInfo.time + network.settings.sleepTime + network.info.latticeSprings + network.energy.kinetic;
const asleep: boolean = network.stepInfo.isAsleep;
const fastest: number | null = network.energy.fastest;
network.setSettings({ ...network.settings, substeps: 'even' });
network.setFloor({ ...network.floor, heights: [0], friction: 0.5 });
network.addCollider({ kind: 'circle', radius: 2 });
const tyre: number = network.addArea(cells, { kind: 'gas', pressure: 1 });
network.set('fill', 1.2, tyre);
const { first, count } = network.addAngles([0, 1, 2, 3], { stiffness: 5, restAngle: 'auto' }, 1);
network.set('restAngle', network.get('area', tyre), { first, count });
const grip = network.addGrip({ particle: network.body(cells).head ?? 0 });
network.setGrip(grip, network.grip(grip));
try {
  network.load(network.clone().save('frame'));
} catch (error) {
  if (error instanceof MassSpringError && error.result === 'snapshot') console.log(error.particles, NONE);
}
console.log(wide, narrow, hash, time, layers, index, one, flags, asleep, fastest);

// @ts-expect-error there is no such solver
network.setSettings({ solver: 'magic' });
// @ts-expect-error there is no such setting
network.setSettings({ gravity: 9.8 });
// @ts-expect-error there is no such word
network.setSettings({ substeps: 'few' });
// @ts-expect-error spare room is no setting
new ms.Network(builder, { spareSprings: 8 });
// @ts-expect-error settings are read as a property
network.settings();
// @ts-expect-error a report cannot be written
network.energy.kinetic = network.energy = 0;
// @ts-expect-error there is no such kind of area
network.addArea(cells, { kind: 'oil' });
// @ts-expect-error there is no such property
network.get('colour');
// @ts-expect-error integers do not come as floats
network.get('layers', undefined, new Float32Array(4));
// @ts-expect-error nor floats as integers
const whole: Uint32Array = network.get('mass');
// @ts-expect-error particles and springs are no columns of one table
network.columns(['mass', 'strain']);
// @ts-expect-error integers and floats do not fit into one array
network.get(['length', 'springFlags']);
// @ts-expect-error what is not asked for is not there
network.columns(['length']).strain;
// @ts-expect-error that can only be read
network.set('strain', 1);
// @ts-expect-error a mass has no such word
network.set('mass', 'auto');
// @ts-expect-error all of them only if you say so
network.breakSprings();
// @ts-expect-error such a choice has no ids
network.removeParticles({ ids: [1] });
// @ts-expect-error a rope is of a material
builder.addRope({ from: 0, to: 1, stiffness: 5 });
// @ts-expect-error a spring has two ends
builder.addSprings({ a: [0, 1], stiffness: 1 });
// @ts-expect-error the length of an array says it
network.setFloor({ planes: [0, 0, 0, 1], planeCount: 1 });
// @ts-expect-error an event may have no other
const other: number = network.readEvents().events[0].other;
