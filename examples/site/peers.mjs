// The bar of the board with other engines, all in one JavaScript runtime: time of a frame and error after a second.
//
//   npm install @dimforge/rapier2d-compat box2d3-wasm      # in FOLDER
//   node examples/site/peers.mjs PACKAGE FOLDER
//
// PACKAGE is the npm package of this library. 80 x 5 particles of iron, clamped at the left end, are let go undamped. The
// reference is velocity Verlet in double precision; the error is the RMS position error over the
// RMS displacement. A frame is 1/64 s. Times are of the processor, the least of three seconds.
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [library, folder] = process.argv.slice(2);
const { load, PARTICLE_PINNED } = await import(pathToFileURL(join(resolve(library), 'node.js')));
const ms = await load();
const WIDTH = 80, HEIGHT = 5, DT = 1 / 64, FRAMES = 64, MASS = 73.3975, IRON = 6.7643e7, GRAVITY = -9.8;

function lattice() {
  const x = [], y = [], a = [], b = [], rest = [];
  for (let i = 0; i < WIDTH * HEIGHT; i++) {
    x.push(i % WIDTH);
    y.push(HEIGHT - 1 - Math.floor(i / WIDTH));
  }
  const join = (i, j) => (a.push(i), b.push(j), rest.push(Math.hypot(x[j] - x[i], y[j] - y[i])));
  for (let i = 0; i < x.length; i++) {
    const column = i % WIDTH, isLast = i >= WIDTH * (HEIGHT - 1);
    if (column + 1 < WIDTH) join(i, i + 1);
    if (isLast) continue;
    join(i, i + WIDTH);
    if (column + 1 < WIDTH) join(i, i + WIDTH + 1);
    if (column > 0) join(i, i + WIDTH - 1);
  }
  return { x: Float64Array.from(x), y: Float64Array.from(y), vx: new Float64Array(x.length), vy: new Float64Array(x.length), a, b, rest };
}

const held = (i) => i % WIDTH === 0;

function forces({ x, y, a, b, rest }, fx, fy) {
  fx.fill(0);
  fy.fill(0);
  for (let s = 0; s < a.length; s++) {
    const i = a[s], j = b[s], dx = x[j] - x[i], dy = y[j] - y[i], length = Math.sqrt(dx * dx + dy * dy);
    const pull = (IRON * (length - rest[s])) / length;
    fx[i] += pull * dx;
    fy[i] += pull * dy;
    fx[j] -= pull * dx;
    fy[j] -= pull * dy;
  }
}

function reference() {
  const body = lattice(), n = body.x.length, fx = new Float64Array(n), fy = new Float64Array(n), substeps = 2000, h = DT / substeps;
  forces(body, fx, fy);
  for (let step = 0; step < FRAMES * substeps; step++) {
    const kick = () => {
      for (let i = 0; i < n; i++) {
        if (held(i)) continue;
        body.vx[i] += (fx[i] / MASS) * (h / 2);
        body.vy[i] += (fy[i] / MASS + GRAVITY) * (h / 2);
      }
    };
    kick();
    for (let i = 0; i < n; i++) {
      body.x[i] += body.vx[i] * h;
      body.y[i] += body.vy[i] * h;
    }
    forces(body, fx, fy);
    kick();
  }
  return body;
}

function ours() {
  const materials = [{ mass: MASS, stiffness: IRON }, { mass: MASS, stiffness: IRON, particleFlags: PARTICLE_PINNED }];
  const builder = new ms.Builder(), cells = Uint16Array.from({ length: WIDTH * HEIGHT }, (_, i) => (held(i) ? 1 : 0));
  builder.addLattice({ width: WIDTH, height: HEIGHT, cells, materials });
  const network = new ms.Network(builder, { gravityY: GRAVITY });
  network.setSettings({ substeps: Math.ceil(DT / network.stableDt.now) });
  return { name: `libmassspring, explicit, ${network.settings.substeps} substeps`, step: () => network.step(DT),
    at: (i) => network.positions(i) };
}

function plainLoop(substeps) {
  const body = lattice(), n = body.x.length, fx = new Float64Array(n), fy = new Float64Array(n), h = DT / substeps;
  const step = () => {
    for (let substep = 0; substep < substeps; substep++) {
      forces(body, fx, fy);
      for (let i = 0; i < n; i++) {
        if (held(i)) continue;
        body.vx[i] += (fx[i] / MASS) * h;
        body.vy[i] += (fy[i] / MASS + GRAVITY) * h;
        body.x[i] += body.vx[i] * h;
        body.y[i] += body.vy[i] * h;
      }
    }
  };
  return { name: `plain loop, ${substeps} substeps`, step, at: (i) => [body.x[i], body.y[i]] };
}

// Small steps of one iteration each (Macklin 2019).
function xpbd(substeps) {
  const body = lattice(), { x, y, vx, vy, a, b, rest } = body, n = x.length, h = DT / substeps, soft = 1 / IRON / (h * h), w = 1 / MASS;
  const step = () => {
    for (let substep = 0; substep < substeps; substep++) {
      const oldX = x.slice(), oldY = y.slice();
      for (let i = 0; i < n; i++) {
        if (held(i)) continue;
        vy[i] += GRAVITY * h;
        x[i] += vx[i] * h;
        y[i] += vy[i] * h;
      }
      for (let s = 0; s < a.length; s++) {
        const i = a[s], j = b[s], wi = held(i) ? 0 : w, wj = held(j) ? 0 : w;
        if (!wi && !wj) continue;
        const dx = x[j] - x[i], dy = y[j] - y[i], length = Math.sqrt(dx * dx + dy * dy);
        const part = (length - rest[s]) / (wi + wj + soft) / length;
        x[i] += wi * part * dx;
        y[i] += wi * part * dy;
        x[j] -= wj * part * dx;
        y[j] -= wj * part * dy;
      }
      for (let i = 0; i < n; i++) {
        vx[i] = (x[i] - oldX[i]) / h;
        vy[i] = (y[i] - oldY[i]) / h;
      }
    }
  };
  return { name: `XPBD, ${substeps} substeps`, step, at: (i) => [x[i], y[i]] };
}

async function rapier(substeps) {
  const { default: R } = await import(pathToFileURL(createRequire(join(resolve(folder), 'x.js')).resolve('@dimforge/rapier2d-compat')));
  await R.init({});
  const world = new R.World({ x: 0, y: GRAVITY }), body = lattice(), none = { x: 0, y: 0 };
  world.timestep = DT / substeps;
  const bodies = Array.from(body.x, (x, i) => {
    const made = world.createRigidBody((held(i) ? R.RigidBodyDesc.fixed() : R.RigidBodyDesc.dynamic()).setTranslation(x, body.y[i])
      .lockRotations().setCanSleep(false));
    if (!held(i)) made.setAdditionalMassProperties(MASS, none, 1, true);
    return made;
  });
  body.a.forEach((i, s) => held(i) && held(body.b[s]) ||
    world.createImpulseJoint(R.JointData.spring(body.rest[s], IRON, 0, none, none), bodies[i], bodies[body.b[s]], true));
  const step = () => {
    for (let i = 0; i < substeps; i++) world.step();
  };
  return { name: `Rapier ${R.version()}, ${substeps} substeps`, step, at: (i) => [bodies[i].translation().x, bodies[i].translation().y] };
}

async function box2d(substeps) {
  const file = join(resolve(folder), 'node_modules/box2d3-wasm/build/dist/es/compat/Box2D.compat.mjs');
  const B = await (await import(pathToFileURL(file))).default(), body = lattice();
  const def = B.b2DefaultWorldDef();
  def.gravity = new B.b2Vec2(0, GRAVITY);
  def.enableSleep = false;
  const world = B.b2CreateWorld(def);
  const bodies = Array.from(body.x, (x, i) => {
    const made = B.b2DefaultBodyDef();
    made.type = held(i) ? B.b2BodyType.b2_staticBody : B.b2BodyType.b2_dynamicBody;
    made.position = new B.b2Vec2(x, body.y[i]);
    if ('fixedRotation' in made) made.fixedRotation = true;
    const id = B.b2CreateBody(world, made);
    const mass = new B.b2MassData();
    Object.assign(mass, { mass: MASS, rotationalInertia: 0 });
    if (!held(i)) B.b2Body_SetMassData(id, mass);
    return id;
  });
  body.a.forEach((i, s) => {
    const j = body.b[s];
    if (held(i) && held(j)) return;
    const made = B.b2DefaultDistanceJointDef(), reduced = held(i) || held(j) ? MASS : MASS / 2;
    const base = 'base' in made ? made.base : made;
    base.bodyIdA = bodies[i];
    base.bodyIdB = bodies[j];
    Object.assign(made, { length: body.rest[s], enableSpring: true, hertz: Math.sqrt(IRON / reduced) / (2 * Math.PI), dampingRatio: 0 });
    B.b2CreateDistanceJoint(world, made);
  });
  return { name: `Box2D v3, ${substeps} substeps`, step: () => B.b2World_Step(world, DT, substeps),
    at: (i) => [B.b2Body_GetPosition(bodies[i]).x, B.b2Body_GetPosition(bodies[i]).y] };
}

const exact = reference(), start = lattice();
let moved = 0;
for (let i = 0; i < exact.x.length; i++) moved += (exact.x[i] - start.x[i]) ** 2 + (exact.y[i] - start.y[i]) ** 2;

async function measure(make) {
  let least = Infinity, error, name;
  for (let run = 0; run < 3; run++) {
    const method = await make();
    const began = process.cpuUsage();
    for (let frame = 0; frame < FRAMES; frame++) method.step();
    const { user, system } = process.cpuUsage(began);
    least = Math.min(least, (user + system) / FRAMES);
    if (run) continue;
    let wrong = 0;
    for (let i = 0; i < exact.x.length; i++) {
      const [x, y] = method.at(i);
      wrong += (x - exact.x[i]) ** 2 + (y - exact.y[i]) ** 2;
    }
    error = 100 * Math.sqrt(wrong / moved);
    name = method.name;
  }
  console.log(`${name}: ${least.toFixed(0)} µs a frame, error ${error.toPrecision(2)} %`);
}

for (const make of [ours, () => plainLoop(24), () => xpbd(16), () => xpbd(64), () => rapier(4), () => rapier(16), () => rapier(64),
  () => box2d(4), () => box2d(16), () => box2d(64)]) {
  try {
    await measure(make);
  } catch (problem) {
    console.log(`left out: ${String(problem).slice(0, 200)}`);
  }
}
