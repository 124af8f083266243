// The package as a user has it: the golden hashes, with and without SIMD, and every call, used well and badly.
//
//   node check.mjs hash                writes the hashes of the golden bars
//   node --expose-gc check.mjs calls  handles networks
import assert from 'node:assert';
import * as massspring from 'massspring';
import { goldenBars } from './golden.mjs';

const { load, MassSpringError, CELL_EMPTY, ELEMENT_REMOVED, ENUMS, FIND_BROKEN, NONE, PARTICLE_PINNED, PARTICLE_REMOVED,
  SPRING_PULL_ONLY } = massspring;

const refused = (body, result, words) => assert.throws(body, (error) => {
  assert(error instanceof MassSpringError, `${error.stack}`);
  assert.strictEqual(error.result, result, error.message);
  assert.match(error.message, words);
  return true;
});

function bar(ms, width = 20, height = 4, settings = {}, options) {
  const builder = new ms.Builder(), cells = new Uint16Array(width * height);
  for (let i = 0; i < height; i++) cells[i * width] = 1;
  const iron = { mass: 73.4, stiffness: 6.76e7 };
  const ids = builder.addLattice({ width, height, cells, materials: [iron, { ...iron, particleFlags: PARTICLE_PINNED }] });
  assert.strictEqual(ids.length, width * height);
  const network = new ms.Network(builder, { substeps: 30, ...settings }, options);
  builder.free();
  return network;
}

function shapes(ms) {
  const builder = new ms.Builder();
  assert.strictEqual(builder.addParticles({ x: 0, y: 0, flags: PARTICLE_PINNED }), 0);
  assert.strictEqual(builder.addParticles({ x: [1, 2, 3], y: new Float64Array([0, 0, 0]), mass: 2 }), 1);
  assert.strictEqual(builder.addSprings({ a: 0, b: 1, stiffness: 100, restLength: 'auto' }), 0);
  assert.strictEqual(builder.addSprings({ a: [1, 2], b: [2, 3], stiffness: [100, 200], damping: 1 }), 1);
  const { particles, firstSpring } = builder.addRope({ from: 0, to: 3, segmentCount: 5, material: { stiffness: 50, mass: 0.5 },
    lengthRatio: 1.2 });
  assert.deepStrictEqual([...particles], [0, 4, 5, 6, 7, 3]);
  assert.strictEqual(firstSpring, 3);
  const disc = builder.addDisc({ x: 20, y: 5, radius: 2, ringCount: 3, material: { stiffness: 1e3 } });
  assert.deepStrictEqual(disc, { firstParticle: 8, firstSpring: 8 });
  const mesh = builder.addMesh({ x: [30, 31, 30], y: [0, 0, 1], triangles: [0, 1, 2], material: { stiffness: 10 } });
  assert.deepStrictEqual(mesh, { firstParticle: builder.particleCount - 3, firstSpring: builder.springCount - 3 });
  assert.strictEqual(builder.addStrainLimits(0.1, 9, { count: 2 }), builder.springCount - 2);
  refused(() => builder.addStrainLimits(0, 2, 0), 'argument', /strain limit is 0/);
  const network = new ms.Network(builder, { solver: 'implicit', gravityY: -1, maxSpeed: undefined }, { spareSprings: 1 });
  network.step(1 / 60, 10);
  assert.strictEqual(network.settings.solver, 'implicit');
  assert.deepStrictEqual([...network.get(['endA', 'endB'], { first: 0, count: 2 })], [0, 1, 1, 2]);
  assert.deepStrictEqual([...network.get('stiffness', [2, 1])], [200, 100]);
  assert.deepStrictEqual([...network.get('mass', particles)], [1, 0.5, 0.5, 0.5, 0.5, 2]);

  const [read] = builder.springs([2]);
  assert.deepStrictEqual([read.a, read.b, read.stiffness, read.restLength, read.relaxStrain], [2, 3, 200, 1, 'auto']);
  assert.deepStrictEqual(builder.particles({ first: 1, count: 3 }).map(({ x, mass }) => [x, mass]), [[1, 2], [2, 2], [3, 2]]);

  const copies = new ms.Builder();
  assert.deepStrictEqual(copies.addCopies(builder, [0, 0, 0, 50]), { firstParticle: 0, firstSpring: 0 });
  const ids = copies.addNetwork(network, [0, 1]);
  assert.strictEqual(copies.particleCount, 2 * builder.particleCount + 2);
  assert.deepStrictEqual([...ids.particles.subarray(0, 3)], [copies.particleCount - 2, copies.particleCount - 1, NONE]);
  assert.deepStrictEqual([ids.springs[1], ids.springs[0] < NONE], [NONE, true]);
  const [, , , y] = new ms.Network(copies).positions([1, builder.particleCount + 1]);
  assert.strictEqual(y, 50);
  network.free();
  builder.free();
}

function reading(ms) {
  const network = bar(ms);
  network.step(1 / 64, 64);
  const { particleCount: count, view } = network, positions = network.positions();
  assert.strictEqual(positions.length, 2 * count);
  for (let i = 0; i < count; i++) {
    const slot = view.slotOfParticle[i];
    // Views show the first of a position's two words, and a float's last place at 4 m is 5e-7 m.
    assert(Math.abs(positions[2 * i + 1] - view.originY - view.y[slot]) < 5e-7);
    assert.strictEqual(view.particleOfSlot[slot], i);
  }
  const into = new Float32Array(4);
  assert.strictEqual(network.get(['x', 'y'], [3, 19], into), into);
  assert.strictEqual(into[0], Math.fround(positions[6]));
  assert.strictEqual(network.velocities({ first: 1, count: 1 }).length, 2);
  assert.deepStrictEqual(network.velocities([5]), network.get(['vx', 'vy'], 5));
  const { kinetic, elastic, strained, largestStrain } = network.energy;
  assert(kinetic > 0 && elastic > 0);
  assert.strictEqual(Math.abs(network.get('strain', strained)[0]), Math.fround(Math.abs(largestStrain)));
  assert.strictEqual(network.stepInfo.stepCount, 64);
  assert.deepStrictEqual([network.stepInfo.isAsleep, network.stepInfo.particle], [false, null]);
  assert(network.body().mass > network.body([0, 1]).mass && network.body({ first: 0, count: 2 }).particleCount === 2);
  assert.strictEqual(network.body([7, 5]).head, 5);
  assert(network.body().maxX < 20 && network.body().py !== 0 && network.stableDt.now > network.stableDt.anyShape);
  assert(network.suggestSubsteps(1 / 64) > 1 && network.info.memoryUsed > 1000);
  assert.strictEqual(network.info.latticeSprings + network.info.irregularSprings, network.springCount);
  assert.match(network.describe(), /^\w+ \S+$/m);
  const [x, y] = positions.subarray(20, 22);
  assert.deepStrictEqual(network.nearestParticle(x, y), { particle: 10, distance: 0 });
  assert.strictEqual(network.nearestParticle(x, y + 1e6, 1), null);
  assert.deepStrictEqual([...network.particlesInCircle(x, y, 0.1)], [10]);
  assert.strictEqual(network.nearestSpring(x, y).distance, 0);
  assert.strictEqual(network.nearestSpring(x, y, 1, FIND_BROKEN), null);
  assert(network.springsInCircle(x, y, 0.1).length > 2 && network.springsInCircle(x, y, 0.1, FIND_BROKEN).length === 0);
  assert.strictEqual(network.particlesInBox(-Infinity, -Infinity, Infinity, Infinity).length, count);
  assert.strictEqual(network.settle().isStable, true);
  network.free();
}

// Every property: of its kind, in its type, alone and in columns, over ranges and lists.
function properties(ms) {
  const network = bar(ms, 20, 4, { substeps: 'auto' });
  network.setContact({});
  network.addCellAreas({ stiffness: 1e6 });
  network.step(1 / 64, 8);
  const kinds = ['particles', 'springs', 'elements'], counts = [network.particleCount, network.springCount, network.elementCount];
  assert.strictEqual(counts[2], 57);
  for (const [kind, name] of kinds.entries()) {
    const all = Object.keys(ENUMS.property).filter((property) => ENUMS.property[property] >> 8 === kind);
    const table = network.columns(all);
    assert(all.length > 10, name);
    for (const property of all) {
      const array = ENUMS.property[property] & 128 ? Uint32Array : Float32Array, values = network.get(property);
      assert(values instanceof array && values.length === counts[kind], property);
      assert.deepStrictEqual(table[property], values);
      assert.deepStrictEqual(network.get(property, [9, 4]), array.of(values[9], values[4]));
      const last = values.at(-1);
      assert.deepStrictEqual(network.get([property, property], { first: counts[kind] - 1 }), array.of(last, last));
    }
  }
  network.set('layers', 0x80000001, [3, 4]);
  network.set('masks', [1, 0xffffffff], { first: 0, count: 2 });
  assert.deepStrictEqual([...network.get('layers', { first: 2, count: 3 })], [1, 0x80000001, 0x80000001]);
  assert.deepStrictEqual([...network.get('masks', [0, 1])], [1, 0xffffffff]);
  network.set('friction', 0.5, 7);
  network.set('friction', 'auto', [7]);
  assert.deepStrictEqual([...network.get('friction', 7)], [-1]);
  assert.strictEqual(network.settings.substeps, 'auto');
  network.setSettings({ substeps: 'even' });
  assert.strictEqual(network.settings.substeps, 'even');
  network.setSettings({ ...network.settings, substeps: 7 });
  assert.strictEqual(network.settings.substeps, 7);
  refused(() => network.setSettings({ substeps: 'few' }), 'argument', /auto, even/);
  refused(() => network.set('mass', 'auto'), 'argument', /mass\[0\] is auto/);
  refused(() => network.set('friction', 'toString'), 'argument', /one of: auto/);
  refused(() => network.set('layers', 0.5), 'argument', /layers\[0\] is 0.5/);
  refused(() => network.columns(['mass', 'strain']), 'argument', /column 1/);
  refused(() => network.columns(['mass', 'colour']), 'argument', /colour/);
  refused(() => network.columns([]), 'argument', /./);
  refused(() => network.columns('mass'), 'argument', /array/);
  refused(() => network.get(['length', 'springFlags']), 'argument', /columns/);
  refused(() => network.get('layers', 0, new Float32Array(1)), 'argument', /Uint32Array/);
}

function editing(ms) {
  const network = bar(ms, 20, 4, { gravityY: 0 }, { spareParticles: 4, spareSprings: 4 });
  network.reserveEvents(64);
  network.breakSprings([3, 5]);
  const { events, lost } = network.readEvents();
  assert.deepStrictEqual([events.map(({ kind, id, other }) => [kind, id, other]), lost],
    [[['broken', 3, null], ['broken', 5, null]], 0]);
  assert.strictEqual(network.get('springFlags')[3] & massspring.SPRING_BROKEN, massspring.SPRING_BROKEN);
  network.restoreSprings(new Uint32Array([3, 5]), 0.1);
  network.set('inverseMassScale', 0, [19, 39]);
  assert.strictEqual(network.get('particleFlags', 19)[0] & PARTICLE_PINNED, PARTICLE_PINNED);
  network.applyForces([0, 1e5], [18, 19]);
  network.step(1 / 64);
  const v = network.velocities();
  assert(v[37] > 0 && v[39] === 0, 'a pinned particle feels no force');
  network.set('inverseMassScale', 1, 19);
  network.applyForce(19, 0, 1e5);
  network.applyForces([1, 2], { first: 0 }, 'impulse');
  network.applyForces([1, 2], { first: 0 }, 'substep');
  network.applyTorque(5, [18, 19, 38]);
  network.step(1 / 64);
  network.detachParticles([30]);
  assert.deepStrictEqual(network.updateComponents(), { count: 2, changed: true });
  assert.deepStrictEqual([network.components(1, 1)[0].particleCount, network.components(0, 2)[1].head], [1, 30]);
  assert.strictEqual(network.get('component')[30], 1);
  const added = network.addParticles({ x: [50, 51], y: 0 });
  assert.deepStrictEqual([...added], [80, 81]);
  const [spring] = network.addSprings({ a: 80, b: 81, stiffness: 10 });
  network.removeSprings(spring);
  network.removeParticles([80, 81]);
  const gone = ({ 0: flags }) => (flags & PARTICLE_REMOVED) > 0;
  assert(gone(network.get('particleFlags', { first: 80, count: 1 })) && gone(network.get('springFlags', { first: spring })));
  assert(!gone(network.get('particleFlags', 79)));
  network.reuseIds();
  assert.deepStrictEqual([...network.addParticles({ x: 50 })], [80]);
  network.compact();
  network.setPositions([0, 100], 30);
  network.setVelocities([1, 1]);
  assert.deepStrictEqual([...network.velocities([0, 79])], [1, 1, 1, 1]);
  network.set('restLength', 1.01, { first: 0, count: 3 });
  network.setSettings({ globalDamping: 3 });
  assert.strictEqual(network.settings.globalDamping, 3);
  network.breakSprings({ first: 0 });
  assert.strictEqual(network.energy.elastic, 0);
  network.free();
}

function meeting(ms) {
  const builder = new ms.Builder();
  for (const y of [1, 4])
    builder.addLattice({ width: 6, height: 2, x: 0.3 * y, y, materials: [{ stiffness: 5000, damping: 5 }] });
  const network = new ms.Network(builder, { substeps: 30, globalDamping: 1, sleepSpeed: 0.01 });
  const floor = { planes: [0, 0, 0, 1], heights: [-1, -1], friction: 0.5, planeFrictions: [0.25], heightFrictions: [0.75] };
  network.setFloor(floor);
  assert.deepStrictEqual(Array.from(network.floor.planes), floor.planes);
  const { planeFrictions, heightFrictions, restitution } = network.floor;
  assert.deepStrictEqual([...planeFrictions, ...heightFrictions, restitution], [0.25, 0.75, 0]);
  network.setFloor({ ...network.floor, siltDepths: [0, 1.5], siltRate: 2 });
  assert.deepStrictEqual([...network.floor.siltDepths], [0, 1.5]);
  assert.throws(() => network.setFloor({ ...network.floor, siltDepth: 1 }), /silt_depths/);
  network.setFloor(floor);
  network.setFloor({ ...network.floor, siltDepth: 0 });
  network.setContact({ friction: 0.3, pushSpeed: 'auto', eventCapacity: 64 });
  network.set('friction', 0.5);
  const box = network.addCollider({ kind: 'box', x: 12, y: 1, width: 2, height: 2 });
  const wall = network.addCollider({ points: [-4, 0, -4, 9] });
  assert.deepStrictEqual([...network.collider(wall).points], [-4, 0, -4, 9]);
  network.moveCollider(box, 10, 1);
  network.step(1 / 60, 240);
  assert(network.contactInfo.touching > 0 && network.body().minY > -0.01, 'two bodies lie on each other and the floor');
  const { events } = network.readContactEvents();
  assert(events.length > 0 && events[0].kind === 'began' && events[0].impulse > 0 && events[0].collider === null);
  assert.deepStrictEqual([network.collider(box).x, network.collider(box).kind], [10, 'box']);
  assert.strictEqual(network.colliderImpulse(wall).x, 0);
  network.placeCollider(box, 20, 1, 0.5);
  network.removeCollider(wall);
  assert(network.get('floorImpulseY').some((value) => value > 0));
  const grip = network.addGrip({ particle: 0, x: 0, y: 9, stiffness: 500, damping: 50 });
  network.setGrip(grip, { maxForce: 1e4 });
  assert.deepStrictEqual([network.grip(grip).stiffness, network.grip(grip).maxForce], [500, 1e4]);
  network.moveGrip(grip, 0, 10);
  network.step(1 / 60, 60);
  const [, held] = network.positions(0);
  assert(network.gripImpulse(grip).y !== 0 && held > 3, `the grip lifts its particle from 2 m: ${held}`);
  network.removeGrip(grip);
  assert(network.contact.thickness > 0 && network.contact.eventCapacity === 64);
  network.setSettings({ solver: 'implicit', substeps: 4 });
  network.step(1 / 60, 4);
  network.setContact(null);
  network.setFloor(null);
  assert.deepStrictEqual([network.contact, network.floor], [null, null]);
  network.wake();
  assert.strictEqual(network.stepInfo.isAsleep, false);
}

function laws(ms) {
  const builder = new ms.Builder();
  builder.addLattice({ width: 6, height: 6, materials: [{ stiffness: 200, mass: 0.1 }] });
  builder.addParticles({ x: [20, 21, 22, 23], y: 0 });
  builder.addSprings({ a: [36, 37, 38], b: [37, 38, 39], stiffness: 100, breakStrain: 0.75,
    flags: SPRING_PULL_ONLY | massspring.SPRING_METRES });
  const network = new ms.Network(builder, { gravityY: 0, substeps: 30 });
  assert.deepStrictEqual(network.addCellAreas({ stiffness: 100 }), { first: 0, count: 25 });
  network.set('fill', 1.5, 0);
  network.removeElements(3);
  const tyre = network.addArea([0, 5, 35, 30], { kind: 'gas', pressure: 1 });
  assert.deepStrictEqual(Array.from(network.elementParticles(tyre)).sort((a, b) => a - b), [0, 5, 30, 35]);
  network.step(1 / 60, 30);
  const { area, activePressure, elementFlags } = network.columns(['area', 'activePressure', 'elementFlags']);
  assert.deepStrictEqual([area.length, tyre, elementFlags[3] & ELEMENT_REMOVED], [26, 25, ELEMENT_REMOVED]);
  assert(area[0] > 1.05 && activePressure[0] > 0, `a cell that is filled grows: ${area[0]}`);
  const { first, count } = network.addAngles([36, 37, 38, 39], { stiffness: 5, damping: 0.1 }, 1);
  assert.deepStrictEqual([count, ...network.elementParticles(first + 1)], [2, 37, 38, 39]);
  network.set('restAngle', [0.5, -0.5], { first });
  network.step(1 / 60, 60);
  const bent = network.get('angle', { first, count });
  assert(bent[0] > 0.2 && bent[1] < -0.2, `angles follow: ${bent}`);
  network.set('elementStiffness', 1, first);
  assert.deepStrictEqual([...network.get(['restAngle', 'elementStiffness'], first)], [0.5, 1]);
  network.removeElements(first + 1);
  const again = network.addAngles([36, 37, 38, 37, 38, 39], { restAngle: 'auto' });
  assert.deepStrictEqual([again.count, network.elementCount], [2, again.first + 2]);
  network.set('yieldStrain', 0.01, { first: 0, count: 1 });
  const [a] = network.get('endA', 0), [x, y] = network.positions(a);
  network.setPositions([x - 0.3, y - 0.3], a);
  network.step(1 / 60);
  assert(network.energy.yieldCount > 0 && network.energy.bentSprings === 1, 'a spring has yielded');
  refused(() => network.addArea([0, 1]), 'argument', /2 particles/);
  refused(() => network.addAngles([0, 1]), 'argument', /multiple of 3/);
  refused(() => network.addAngles([0, 1, 2], {}, 0), 'argument', /./);
  refused(() => network.get('area', [3]), 'id', /./);
  refused(() => network.set('restAngle', NaN, first), 'argument', /./);
  refused(() => network.removeElements(999), 'id', /./);
}

function goingBack(ms) {
  const network = bar(ms);
  network.step(1 / 64, 10);
  const snapshot = network.save('frame'), clone = network.clone();
  assert(snapshot instanceof Uint8Array && clone instanceof ms.Network);
  network.step(1 / 64, 10);
  const hash = network.stateHash;
  network.load(snapshot);
  assert.notStrictEqual(network.stateHash, hash);
  network.step(1 / 64, 10);
  clone.step(1 / 64, 10);
  assert.deepStrictEqual([network.stateHash, clone.stateHash], [hash, hash]);
  refused(() => network.load(snapshot.subarray(0, 100)), 'snapshot', /./);
  snapshot[200] ^= 1;
  refused(() => network.load(snapshot), 'snapshot', /./);
  refused(() => network.load('snapshot'), 'argument', /Uint8Array/);
  assert.strictEqual(network.stateHash, hash, 'calls that fail change nothing');
  const archive = network.write(), builder = new ms.Builder();
  assert(archive instanceof Uint8Array);
  assert.strictEqual(builder.read(archive), 0);
  const again = new ms.Network(builder), light = new ms.Network(builder, { gravityY: -1 });
  assert.deepStrictEqual(again.write(), archive);
  assert.strictEqual(light.settings.gravityY, -1);
  network.step(1 / 64, 10);
  again.step(1 / 64, 10);
  assert.strictEqual(again.stateHash, network.stateHash);
  refused(() => new ms.Builder().read(archive.subarray(0, 3000)), 'snapshot', /cut off/);
  refused(() => builder.read(archive), 'argument', /empty/);
  refused(() => builder.read([1]), 'argument', /Uint8Array/);
}

// Reading calls that fail in turn have messages of their own.
function messages(ms) {
  const network = bar(ms);
  refused(() => network.nearestParticle(NaN, 0), 'argument', /point/);
  refused(() => network.get('mass', 999), 'id', /particle 999/);
  refused(() => network.nearestSpring(0, 0, 1, 0), 'argument', /flags/);
}

function hostile(ms) {
  messages(ms);
  const builder = new ms.Builder();
  refused(() => new ms.Network(builder), 'argument', /particle/);
  builder.addParticles({ x: [0, 1], y: 0 });
  refused(() => builder.addParticles({ x: NaN }), 'argument', /position/);
  refused(() => builder.addParticles({ x: '1' }), 'argument', /x is 1, it must be a number/);
  refused(() => builder.addParticles({ z: 1 }), 'argument', /no column z/);
  refused(() => builder.addParticles(null), 'argument', /object/);
  refused(() => builder.addParticles([]), 'argument', /object/);
  refused(() => builder.addParticles({ x: [0, 1], y: [0] }), 'argument', /column y has 1/);
  refused(() => builder.addParticles({ x: [0, 1, NaN], y: 0 }), 'argument', /definition 2/);
  refused(() => builder.addSprings({ a: 0, b: 9 }), 'id', /9/);
  refused(() => builder.addSprings({ a: 0, b: NaN }), 'argument', /b is NaN/);
  refused(() => builder.addSprings({ a: 0, b: 1, restLength: 'short' }), 'argument', /one of: auto/);
  refused(() => builder.addSprings({ a: [0], b: [-1] }), 'argument', /b\[0\] is -1/);
  refused(() => builder.addLattice({ width: 3, height: 1, cells: [0, 0], materials: [{}] }), 'argument', /cells has 2/);
  refused(() => builder.addLattice({ width: 1e5, height: 1e5, cells: [0], materials: [{}] }), 'argument', /cells/);
  refused(() => builder.addLattice({ width: 1, height: 1, cells: [7], materials: [{}] }), 'argument', /cell/);
  refused(() => builder.addLattice({}), 'argument', /width/);
  refused(() => builder.addLattice({ width: 1, height: 1, materials: 5 }), 'argument', /materials must be an array/);
  refused(() => builder.addRope({ from: 0, to: 1, segmentCount: 4e9, material: {} }), 'memory', /memory/);
  refused(() => builder.addRope({ from: 0, to: 1 }), 'argument', /material/);
  refused(() => builder.addRope({ from: 0, to: 1, material: { mas: 1 } }), 'argument', /no option mas/);
  refused(() => builder.addMesh({ x: [0], y: [0, 1], triangles: [0, 0, 0], material: {} }), 'argument', /y has 2/);
  refused(() => builder.addDisc({ radius: Infinity, material: {} }), 'argument', /./);
  refused(() => builder.addCopies({}, [0, 0]), 'argument', /Builder/);
  refused(() => builder.addCopies(new ms.Builder(), [0]), 'argument', /places has 1/);
  refused(() => builder.addNetwork(builder), 'argument', /Network/);
  refused(() => new ms.Network(builder, { solver: 'magic' }), 'argument', /explicit, implicit, direct/);
  refused(() => new ms.Network(builder, { solver: 'constructor' }), 'argument', /explicit, implicit, direct/);
  refused(() => new ms.Network(builder, { substeps: -1 }), 'argument', /substeps is -1/);
  refused(() => new ms.Network(builder, { gravityY: Infinity }), 'argument', /gravity_y/);
  refused(() => new ms.Network(builder, { spareSprings: 1 }), 'argument', /no option spareSprings/);
  refused(() => new ms.Network({}), 'argument', /Builder/);
  assert(new ms.Network(builder).particleCount === 2, 'calls that fail leave a builder as it was');
  builder.addSprings({ a: [0, 1], b: [1, 0], stiffness: 1 });
  assert.throws(() => new ms.Network(builder), (error) => {
    assert.deepStrictEqual([error.name, error.result, error.code, error.particles], ['MassSpringError', 'duplicate', -6, [0, 1]]);
    return error.springs.length > 0;
  });

  const network = bar(ms), hash = network.stateHash;
  for (const dt of [NaN, -1, 0, Infinity, '1', undefined]) refused(() => network.step(dt), 'argument', /dt/);
  refused(() => network.step(1, 0.5), 'argument', /count/);
  refused(() => network.breakSprings([1, 1e6]), 'id', /index 1/);
  refused(() => network.breakSprings([0.5]), 'argument', /ids\[0\]/);
  refused(() => network.setPositions([1, 2, 3]), 'argument', /3 numbers/);
  refused(() => network.breakSprings(), 'argument', /first: 0/);
  refused(() => network.breakSprings(null), 'argument', /null/);
  refused(() => network.breakSprings('1'), 'argument', /1 is no id/);
  refused(() => network.setPositions([1, 2, 3, 4], [1]), 'argument', /4 numbers/);
  refused(() => network.setPositions([NaN, 0], [4]), 'argument', /./);
  refused(() => network.setPositions('ab'), 'argument', /array/);
  refused(() => network.positions({ first: 79, count: 2 }), 'id', /./);
  refused(() => network.positions({ particle: 1 }), 'argument', /no meaning/);
  refused(() => network.positions([0], new Float64Array(3)), 'argument', /into has 3/);
  refused(() => network.positions([0], []), 'argument', /Float64Array/);
  refused(() => network.applyForces([0, 0], [0], 'shove'), 'argument', /step, substep, impulse/);
  refused(() => network.set('strain', 1), 'argument', /read/);
  refused(() => network.set('mass', [1, NaN], [0, 1]), 'argument', /mass/);
  refused(() => network.get('colour'), 'argument', /one of/);
  refused(() => network.setFloor({ planes: [0, 0, 0] }), 'argument', /multiple of 4/);
  refused(() => network.setFloor({ planes: [0, 0, 0, 1], planeCount: 1 }), 'argument', /no option planeCount/);
  refused(() => network.setFloor({ heights: [1, 2], heightFrictions: [1, 1] }), 'argument', /must have 1/);
  refused(() => network.setFloor({ planes: [0, 0, 0, 0] }), 'argument', /plane 0/);
  refused(() => network.addCollider({ kind: 'circle', radius: 1 }), 'argument', /contact/);
  refused(() => network.moveGrip(3, 0, 0), 'id', /./);
  refused(() => network.addParticles({ x: [1] }), 'limit', /./);
  refused(() => network.components(0, 1), 'argument', /./);
  assert.strictEqual(network.stateHash, hash, 'calls that fail change nothing');

  network.setSettings({ substeps: 1, guard: 'growth' });
  assert.throws(() => network.step(1, 5), (error) => {
    assert(error.result === 'unstable' && error.particles.length + error.springs.length > 0, error.message);
    return error.steps < 5;
  });
  network.free();
  network.free();
  refused(() => network.step(1 / 64), 'argument', /freed/);
  refused(() => network.positions(), 'argument', /freed/);
  builder.free();
  refused(() => builder.addParticles({}), 'argument', /freed/);
  refused(() => new ms.Network(builder), 'argument', /freed/);
}

// Memory grows while a view is held, and while arrays are copied in, and is used again.
function memory(ms) {
  const builder = new ms.Builder(), cells = new Uint16Array(4e6).fill(CELL_EMPTY);
  cells[0] = 0;
  builder.addLattice({ width: 2000, height: 2000, cells, materials: [{}] });
  assert.strictEqual(builder.particleCount, 1);
  builder.free();

  const first = bar(ms), before = ms.memoryUsed, { x } = first.view;
  let large = bar(ms, 1500, 300);
  assert(ms.memoryUsed > before && x.length === 0, 'an old view is empty after growth');
  assert(first.view.x.length > 0);
  large.free();
  const grown = ms.memoryUsed;
  for (let i = 0; i < 4; i++) {
    large = bar(ms, 1500, 300);
    large.step(1 / 64);
    large.free();
  }
  assert(ms.memoryUsed <= 2 * grown, 'what is freed is used again');
}

// What nobody frees, the garbage collector does: with --expose-gc.
async function forgotten(ms) {
  const before = ms.memoryUsed;
  let most = 0;
  for (let i = 0; i < 20; i++) {
    bar(ms, 544, 68);
    most = Math.max(most, (i + 1) * 8e6); // each takes more than that
    globalThis.gc();
    await new Promise((done) => setTimeout(done));
  }
  assert(ms.memoryUsed - before < most / 2, `memory has grown by ${ms.memoryUsed - before} bytes`);
}

if (process.argv[2] === 'hash')
  for (const simd of [true, false]) {
    const ms = await load({ simd });
    assert.strictEqual(ms.simd, simd);
    for (const line of goldenBars(ms, massspring)) console.log(line);
  }
else
  for (const simd of [true, false]) {
    const ms = await load({ simd });
    assert.strictEqual(CELL_EMPTY, 0xffff);
    for (const part of [shapes, reading, properties, editing, meeting, laws, goingBack, hostile, memory]) part(ms);
    await forgotten(await load({ simd }));
    const other = await load();
    refused(() => new ms.Network(new other.Builder()), 'argument', /same module/);
  }
