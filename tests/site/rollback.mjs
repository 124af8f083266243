// Two peers of examples/site/rollback play ten minutes of simulated time (two with MASSSPRING_TEST_QUICK) over a line that
// is late and loses packets, one with SIMD instructions and one without. The hashes of all frames must be equal.
//
//   node rollback.mjs SOURCE PACKAGE WORK
import { strict as assert } from 'node:assert';
import { cpSync, mkdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

const [source, library, work] = process.argv.slice(2);
const MINUTE = 3600, MINUTES = process.env.MASSSPRING_TEST_QUICK ? 2 : 10;

// node finds the package beside the modules.
const folder = resolve(work, 'rollback');
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'node_modules'), { recursive: true });
cpSync(join(source, 'examples/site/rollback'), folder, { recursive: true });
symlinkSync(resolve(library), join(folder, 'node_modules/massspring'));
writeFileSync(join(folder, 'package.json'), '{ "type": "module" }');
const { Session, WINDOW } = await import(join(folder, 'session.js'));
const { World, makePlayer } = await import(join(folder, 'world.js'));
const { load } = await import(join(resolve(library), 'node.js'));

const kinds = [await load(), await load({ simd: false })];
const quality = { latency: 60, jitter: 50, loss: 0.2 };
function session(seed, change = (world) => world) {
  let made = 0;
  return new Session(() => change(new World(kinds[made]), made++), quality, seed);
}

function play(run, frames) {
  const players = [makePlayer(1), makePlayer(2)];
  for (let frame = 0; frame < frames; frame++) run.tick((me, world) => players[me](me, world));
  return run.peers;
}

// A peer whose world differs by a millimetre is found out: the comparison is worth something.
const spoiled = session(3, (world, i) => {
  if (i) world.network.setPositions([0.001, 5], world.ball.centre);
  return world;
});
assert(play(spoiled, 240).some(({ count }) => count.differing > 0), 'a difference is found');

const run = session(7), peers = play(run, MINUTES * MINUTE);
for (const { frame, count, snapshots, hashes } of peers) {
  console.log(`${frame} frames: ${JSON.stringify(count)}`);
  assert(frame > 0.95 * MINUTES * MINUTE, 'the line stops them seldom');
  assert(count.compared > 0.99 * frame, 'nearly all frames are compared');
  assert.equal(count.differing, 0);
  assert(count.rollbacks > 50 * MINUTES && count.deepest <= WINDOW, 'they go back often, and never further than the window');
  assert(snapshots.size <= WINDOW + 3 && hashes.size < 100, 'they keep only what they need');
}
console.log(`${run.lines.map(({ sent, lost }) => `${lost} of ${sent}`).join(' and ')} packets were lost`);
