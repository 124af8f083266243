// The page's module in node: writes the lines of the page's checks, and handles networks as the page does.
//
//   node check.js MODULE SCENES
'use strict';
const assert = require('node:assert');
const { readFileSync } = require('node:fs');
const { resolve } = require('node:path');

const [file, scenes] = process.argv.slice(2);
const { bar, bridge, weights, rubble, girder, readMaterials, fromPixels, makeScene, textAt, hashText } = require(resolve(scenes));
const compiled = new WebAssembly.Module(readFileSync(file));
assert.deepStrictEqual(WebAssembly.Module.imports(compiled), [], 'the module needs nothing');
const core = new WebAssembly.Instance(compiled, {}).exports;

for (const [scene, steps] of [[0, 64], [0, 1000], [1, 1000], [2, 200], [3, 100], [4, 300], [5, 200]])
  for (const level of [1, 0]) {
    assert.strictEqual(core.check(scene, steps, level), 0);
    console.log(`check ${scene} ${steps} ${level ? 'scalar' : 'best'} ${hashText(core.check_hash)}`);
  }

const DT = 1 / 64;
const good = (result) => assert.strictEqual(result, 0, textAt(core, core.error()));
const floats = (pointer) => new Float32Array(core.memory.buffer, pointer, core.slots());
const steps = (count) => {
  for (let i = 0; i < count; i++) good(core.step(DT));
};
const springs = () => new Float32Array(core.memory.buffer, core.springs(), 3 * core.spring_count());
const broken = () => springs().filter((value, i) => i % 3 === 2 && value === 0).length;
const highest = () => core.origin_y() + Math.max(...floats(core.y()).filter((y, i) => floats(core.inverse_mass())[i] > 0));
const lowest = () => core.origin_y() + Math.min(...floats(core.y()).filter((y, i) => floats(core.inverse_mass())[i] > 0));

// Each scene with each solver.
for (const scene of [bar(80, 5), bridge(), weights()])
  for (const [solver, substeps] of [[0, 40], [0, 0], [1, 2], [2, 1]]) {
    makeScene(core, scene);
    good(core.solver(solver, substeps, 0));
    good(core.damping(0.2));
    steps(64);
    assert(core.max_strain() < 1 && core.kinetic_energy() > 0, 'it moves and is whole');
    assert.strictEqual(textAt(core, core.level()), 'wasm');
  }

// A free bar without weight is dragged up, and let go.
const free = bar(40, 4);
free.cells.fill(0);
makeScene(core, free);
good(core.solver(0, 40, 0));
good(core.gravity(0));
assert(core.hold(20, 2, 3) > 10);
core.hold_to(20, 30);
steps(192);
core.let_go();
assert(Math.abs(highest() - 31) < 3, `dragged to 30: its top is at ${highest()}`);

// Cut in two, repaired.
makeScene(core, free);
good(core.cut(19.4, -5, 19.6, 9));
steps(1);
assert.strictEqual(broken(), 10, 'four springs along and six across');
good(core.repair());
steps(1);
assert.strictEqual(broken(), 0);

// Pinned and freed; with a floor it falls no farther.
good(core.pin(0, 0, 0.1));
assert.strictEqual(floats(core.inverse_mass()).filter((value) => value > 0).length, 159);
good(core.pin(0, 0, 0.1));
assert.strictEqual(floats(core.inverse_mass()).filter((value) => value > 0).length, 160);
good(core.damping(1));
good(core.floor(-10));
steps(320);
assert(Math.abs(lowest() + 10) < 0.1, `its lowest particle is at ${lowest()}`);
good(core.floor(-1e12));
steps(64);
assert(lowest() < -12);

// Rubble lies on its deck, and falls through it without contact.
for (const [on, falls] of [[1, false], [0, true]]) {
  makeScene(core, rubble());
  good(core.solver(0, 40, 0));
  good(core.collide(on));
  good(core.damping(0.2));
  steps(256);
  assert.strictEqual(lowest() < -20, falls, `with contact ${on} its lowest particle is at ${lowest()}`);
}
good(core.collide(1));
good(core.solver(1, 2, 0));
steps(16);

// A blast moves it, and breaks what may break.
makeScene(core, free);
good(core.breaking(1));
good(core.blast(20, 2, 10, 400));
steps(8);
assert(broken() > 0);
good(core.breaking(0));

// Too stiff: the step is refused, the words are the library's, and a lower stiffness goes on.
makeScene(core, bar(80, 5));
good(core.solver(0, 4, 0));
assert.notStrictEqual(core.step(DT), 0);
assert.match(textAt(core, core.error()), /particle/);
good(core.stiffness(0.001));
steps(4);

// A block dents the girder; the dent stays when nothing yields any more, and can be taken back.
makeScene(core, girder());
good(core.solver(0, 40, 0));
good(core.collide(1));
good(core.yielding(1));
steps(32);
assert.strictEqual(core.bent_count(), 0, 'the block is still in the air');
steps(224);
const bent = core.bent_count();
assert(bent > 20, `${bent} springs are bent`);
good(core.yielding(0));
steps(16);
assert.strictEqual(core.bent_count(), bent);
const dents = new Float32Array(core.memory.buffer, core.plastic(), core.spring_count());
assert.strictEqual(dents.filter((value) => value !== 0).length, bent);
good(core.straighten());
assert.strictEqual(core.bent_count(), 0);
steps(4);
good(core.collide(0));

// What is wrong is refused.
assert.throws(() => makeScene(core, { ...bar(4, 4), ropes: [{ from: 99, to: 0, segments: 1, mass: 1, stiffness: 1, damping: 0, lengthRatio: 1 }] }));
assert.throws(() => makeScene(core, { ...bar(4, 4), materials: [{ mass: 0, stiffness: 1, damping: 0, breakStrain: 0, pinned: 0 }] }));

// Colours are looked up; white and transparent is nothing.
const table = readMaterials('colour,name,mass,stiffness,damping,break_strain,pinned,probe\n#102030,plate,5,100,1,0.1,1,0\n');
const pixels = fromPixels([16, 32, 48, 255, 255, 255, 255, 255, 1, 2, 3, 0, 9, 9, 9, 255], 4, 1, table);
assert.deepStrictEqual([...pixels.cells], [0, 65535, 65535, 1]);
assert.strictEqual(pixels.materials[0].pinned, 1);

// Memory of networks that are gone is used again.
makeScene(core, bar(544, 68));
const size = core.memory.buffer.byteLength;
for (let i = 0; i < 5; i++) makeScene(core, bar(544, 68));
assert(core.memory.buffer.byteLength <= 2 * size);
