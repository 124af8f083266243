// The page: one network, its controls, and the hand that drags it.
//
//   #check             compare hashes, and write them into the page, instead of running
//   #scene=ship&frames=300&solver=1&substeps=2&cut=...    for pictures and measurements: run so many frames, then stop
//   #scene=ship&breaking=1&cut=x,y,x,y    cut it after a second, once; blast=x,y,radius,speed likewise
//   #embed=1    in a frame of another page: panels are folded, and it rests while it is out of sight; still=1: none
'use strict';

const DT = 1 / 64;
const MOST_STEPS = 2; // in a frame: what is slower than time goes on in slow motion
const HOLD_RADIUS = 14; // pixels
const CLICK_REACH = 4; // pixels that a click may move
const ACT_AFTER = 60; // steps, after which a cut or a blast of the address happens
const WATCHED = 2000, SLOWEST = 0.012; // ms after the start; frames in a ms
const REST_TIME = 150; // ms that the pointer rests before it asks for a spring
const SETTINGS = ['scene', 'solver', 'substeps', 'stiffness', 'gravity', 'damping', 'limit'];
const SWITCHES = ['breaking', 'floor', 'collide', 'yielding'];
const byId = (id) => document.getElementById(id);
const settings = new URLSearchParams(location.hash.slice(1));

let core, drawing, marks, materials, current, ownImage;
const view = { x: 0, y: 0, scale: 1, strainLimit: 0.01 };
const state = { running: true, seen: true, tool: 'drag', broken: '', debt: 0, last: 0, frames: 0, seconds: 0, floorAt: 0,
  steps: 0, drawn: 0 };
const cost = { sum: 0, count: 0, drawing: 0, shown: 0 }; // ms

/* ----------------------------------------------------------------------------------------------- resources */

async function resource(name) {
  const text = typeof RESOURCES === 'undefined' ? null : RESOURCES[name];
  if (!text) return (await fetch(name)).arrayBuffer();
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
}

/* -------------------------------------------------------------------------------------------------- scenes */

async function sceneOf(name) {
  switch (name) {
    case 'bar':
      return bar(80, 5);
    case 'large':
      return bar(544, 68);
    case 'bridge':
      return bridge();
    case 'weights':
      return weights();
    case 'rubble':
      return rubble();
    case 'girder':
      return girder();
    case 'own':
      return fromImage(ownImage, materials);
    default:
      return fromImage(new Blob([await resource('ship.png')], { type: 'image/png' }), materials);
  }
}

async function load(name) {
  try {
    current = await sceneOf(name);
    if (current.yields) toggle(byId('yielding'), true);
    if (current.collide) {
      toggle(byId('collide'), true);
      Object.assign(byId('solver'), { value: 0 });
      Object.assign(byId('substeps'), { value: 40 });
    }
    start();
  } catch (problem) {
    tell(problem.message);
  }
}

function start() {
  makeScene(core, current);
  drawing.start(core.slots());
  marks.forget();
  applyAll();
  fit();
  state.debt = state.steps = 0;
  tell('');
  byId('particles').textContent = core.particles().toLocaleString('en');
  byId('springs').textContent = core.spring_count().toLocaleString('en');
  byId('level').textContent = textAt(core, core.level()) === 'wasm' ? 'WebAssembly' : 'none';
}

function floats(pointer, count) {
  return new Float32Array(core.memory.buffer, pointer, count);
}

function bounds() {
  const slots = core.slots(), x = floats(core.x(), slots), y = floats(core.y(), slots);
  const inUse = new Uint32Array(core.memory.buffer, core.springs(), 3 * core.spring_count());
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (let i = 0; i < inUse.length; i += 3) {
    for (const slot of [inUse[i], inUse[i + 1]]) {
      box.left = Math.min(box.left, x[slot]);
      box.right = Math.max(box.right, x[slot]);
      box.bottom = Math.min(box.bottom, y[slot]);
      box.top = Math.max(box.top, y[slot]);
    }
  }
  return box;
}

function fit() {
  const box = bounds(), { width, height } = drawing.canvas;
  const ratio = devicePixelRatio, panels = width > 900 * ratio ? 270 * ratio : 0;
  view.scale = 0.92 * Math.min((width - 1.7 * panels) / (box.right - box.left + 4), (height * 0.8) / (box.top - box.bottom + 4));
  view.x = core.origin_x() + (box.left + box.right) / 2 - (0.1 * panels) / view.scale;
  view.y = core.origin_y() + (box.bottom + box.top) / 2 - (0.06 * height) / view.scale;
  state.floorAt = core.origin_y() + box.bottom - 0.25 * (box.right - box.left);
  if (isOn('floor')) core.floor(state.floorAt);
}

/* ------------------------------------------------------------------------------------------------ settings */

function tell(text) {
  if (text === state.broken) return;
  state.broken = text;
  byId('what').textContent = text;
  const needed = text.startsWith('unstable') && value('solver') === 0 ? core.needed(DT) : 0;
  byId('cure').hidden = needed === 0;
  Object.assign(byId('cure'), { value: needed, textContent: `More substeps: ${needed}` });
  byId('message').style.display = text ? 'block' : 'none';
}

function check(result) {
  if (result) tell(textAt(core, core.error()));
  return result === 0;
}

const value = (id) => Number(byId(id).value);

// The slider may have to become longer.
function setSubsteps(count) {
  const slider = byId('substeps');
  slider.max = Math.max(slider.max, count);
  slider.value = count;
}

const isOn = (id) => byId(id).getAttribute('aria-pressed') === 'true';

const settingsOf = {
  solver() {
    const substeps = value('substeps');
    byId('substeps-text').textContent = substeps || 'by itself';
    if (check(core.solver(value('solver'), substeps, 0))) tell('');
  },
  stiffness() {
    const factor = 10 ** value('stiffness');
    byId('stiffness-text').textContent = '\u00d7 ' + factor.toPrecision(2);
    if (check(core.stiffness(factor))) tell('');
  },
  gravity() {
    byId('gravity-text').textContent = value('gravity').toFixed(1) + ' m/s\u00b2';
    check(core.gravity(value('gravity')));
  },
  damping() {
    byId('damping-text').textContent = value('damping').toFixed(2) + ' /s';
    check(core.damping(value('damping')));
  },
  limit() {
    view.strainLimit = 10 ** value('limit');
    const percent = (100 * view.strainLimit).toPrecision(2) + ' %';
    byId('limit-text').textContent = percent;
    byId('ends').textContent = `\u00b1${percent}`;
  },
  breaking() {
    check(core.breaking(isOn('breaking') ? 1 : 0));
  },
  yielding() {
    check(core.yielding(isOn('yielding') ? 1 : 0));
  },
  collide() {
    if (check(core.collide(isOn('collide') ? 1 : 0))) tell('');
    else toggle(byId('collide'), false);
  },
};

function applyAll() {
  for (const apply of Object.values(settingsOf)) apply();
}

function toggle(button, on) {
  button.setAttribute('aria-pressed', on);
  return on;
}

function connectControls() {
  for (const id of ['stiffness', 'gravity', 'damping', 'limit']) byId(id).addEventListener('input', settingsOf[id]);
  byId('substeps').addEventListener('input', settingsOf.solver);
  byId('solver').addEventListener('change', () => {
    byId('substeps').value = value('solver') ? 2 : 40;
    settingsOf.solver();
  });
  byId('scene').addEventListener('change', () => load(byId('scene').value));
  for (const button of byId('tools').children)
    button.addEventListener('click', () => chooseTool(button.dataset.tool));
  byId('play').addEventListener('click', () => (state.running = toggle(byId('play'), !state.running)));
  byId('one').addEventListener('click', () => {
    state.running = toggle(byId('play'), false);
    step();
  });
  byId('again').addEventListener('click', start);
  byId('repair').addEventListener('click', () => check(core.repair()));
  byId('straighten').addEventListener('click', () => check(core.straighten()));
  byId('link').addEventListener('click', copyLink);
  // Too stiff for so few substeps: as many as it needs, and on it goes.
  byId('cure').addEventListener('click', () => {
    setSubsteps(byId('cure').value);
    settingsOf.solver();
    noteAddress();
    state.running = toggle(byId('play'), true);
  });
  byId('controls').addEventListener('change', noteAddress);
  for (const id of SWITCHES)
    byId(id).addEventListener('click', () => {
      const on = toggle(byId(id), !isOn(id));
      if (id === 'floor') check(core.floor(on ? state.floorAt : -1e12));
      else settingsOf[id]();
      noteAddress();
    });
  byId('open').addEventListener('click', () => byId('file').click());
  byId('file').addEventListener('change', () => byId('file').files.length && open(byId('file').files[0]));
  addEventListener('dragover', (event) => event.preventDefault());
  addEventListener('drop', (event) => {
    event.preventDefault();
    if (event.dataTransfer.files.length) open(event.dataTransfer.files[0]);
  });
  addEventListener('keydown', (event) => {
    const tools = { 1: 'drag', 2: 'cut', 3: 'pin', 4: 'blast' };
    if (event.target.matches('input, select')) return;
    if (tools[event.key]) chooseTool(tools[event.key]);
    else if (event.key === ' ') byId('play').click();
    else if (event.key === '.') byId('one').click();
    else if (event.key === 'r') start();
    else return;
    event.preventDefault();
  });
}

// The address has the settings, so that it can be sent to somebody. An image of one's own is in no address.
function noteAddress() {
  const address = new URLSearchParams();
  for (const id of SETTINGS) if (id !== 'scene' || byId(id).value !== 'own') address.set(id, byId(id).value);
  for (const id of SWITCHES) if (isOn(id)) address.set(id, 1);
  history.replaceState(null, '', '#' + address);
}

async function copyLink() {
  noteAddress();
  try {
    await navigator.clipboard.writeText(location.href);
    byId('link').textContent = 'Copied';
  } catch {
    byId('link').textContent = 'Above';
  }
  setTimeout(() => (byId('link').textContent = 'Link'), 2000);
}

function open(file) {
  ownImage = file;
  byId('scene').querySelector('[value=own]').hidden = false;
  byId('scene').value = 'own';
  load('own');
}

function chooseTool(tool) {
  state.tool = tool;
  for (const button of byId('tools').children) toggle(button, button.dataset.tool === tool);
  drawing.canvas.style.cursor = tool === 'drag' ? 'grab' : 'crosshair';
}

/* ---------------------------------------------------------------------------------------------------- hand */

function worldOf(event) {
  const { width, height } = drawing.canvas, ratio = devicePixelRatio;
  return {
    x: view.x + (event.clientX * ratio - width / 2) / view.scale,
    y: view.y - (event.clientY * ratio - height / 2) / view.scale,
  };
}

function zoom(event, factor) {
  const before = worldOf(event);
  view.scale = Math.min(200, Math.max(0.05, view.scale * factor));
  const after = worldOf(event);
  view.x += before.x - after.x;
  view.y += before.y - after.y;
}

function connectHand() {
  const canvas = drawing.canvas, fingers = new Map();
  let held = false, last = null, spread = 0, pressed = null;
  const radius = () => (HOLD_RADIUS * devicePixelRatio) / view.scale;
  const middle = () => {
    const [a, b] = [...fingers.values()];
    return { clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2,
      spread: Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) };
  };
  canvas.addEventListener('pointerdown', (event) => {
    try {
      canvas.setPointerCapture(event.pointerId);
    } catch { /* events that scripts make have no pointer */ }
    fingers.set(event.pointerId, event);
    document.body.classList.add('used'); // where there is little room, the help makes way
    last = event;
    pressed = event.button === 0 && fingers.size === 1 && state.tool === 'drag' ? event : null;
    if (fingers.size === 2) {
      core.let_go();
      held = false;
      spread = middle().spread;
      last = middle();
      return;
    }
    const at = worldOf(event);
    if (event.button !== 0) held = false;
    else if (state.tool === 'drag') held = core.hold(at.x, at.y, radius()) > 0;
    else if (state.tool === 'pin') {
      check(core.pin(at.x, at.y, radius() / 2));
      marks.forget();
    }
    else if (state.tool === 'blast') check(core.blast(at.x, at.y, 5 * radius(), 60));
  });
  canvas.addEventListener('pointermove', (event) => {
    if (!fingers.has(event.pointerId)) return;
    const before = fingers.get(event.pointerId);
    fingers.set(event.pointerId, event);
    if (fingers.size === 2) {
      const now = middle();
      zoom(now, now.spread / Math.max(spread, 1));
      spread = now.spread;
      move(last, now);
      last = now;
      return;
    }
    const at = worldOf(event), was = worldOf(before);
    if (event.buttons & 6) move(before, event);
    else if (held) core.hold_to(at.x, at.y);
    else if (state.tool === 'cut') check(core.cut(was.x, was.y, at.x, at.y));
  });
  // A mouse that rests asks for the spring under it. A click keeps asking, until one beside all springs.
  let resting = 0;
  const ask = (event) => {
    const at = worldOf(event);
    marks.rest(core, { x: at.x - core.origin_x(), y: at.y - core.origin_y() }, event, view.scale);
  };
  const leave = () => {
    clearTimeout(resting);
    if (!marks.kept) marks.leave();
  };
  canvas.addEventListener('pointermove', (event) => {
    leave();
    if (event.buttons || event.pointerType === 'touch' || marks.kept) return;
    resting = setTimeout(() => ask(event), REST_TIME);
  });
  canvas.addEventListener('pointerleave', leave);
  const end = (event) => {
    if (pressed && Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) < CLICK_REACH) {
      ask(event);
      marks.kept = marks.spring >= 0;
    }
    pressed = null;
    fingers.delete(event.pointerId);
    core.let_go();
    held = false;
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    zoom(event, Math.exp(-0.0015 * event.deltaY));
  }, { passive: false });
}

function move(from, to) {
  const a = worldOf(from), b = worldOf(to);
  view.x += a.x - b.x;
  view.y += a.y - b.y;
}

/* -------------------------------------------------------------------------------------------------- frames */

function step() {
  if (++state.steps === ACT_AFTER && !settings.has('frames')) act();
  const began = performance.now();
  const good = check(core.step(DT));
  const spent = performance.now() - began;
  cost.sum += spent;
  cost.count++;
  if (!good) state.running = toggle(byId('play'), false);
  return spent;
}

function resize() {
  const canvas = drawing.canvas, ratio = devicePixelRatio;
  const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
}

function draw() {
  const slots = core.slots(), springs = core.spring_count();
  const relative = { ...view, x: view.x - core.origin_x(), y: view.y - core.origin_y() };
  const bytes = new Uint8Array(core.memory.buffer, core.springs(), 12 * springs);
  drawing.draw(floats(core.x(), slots), floats(core.y(), slots), bytes, floats(core.plastic(), springs), core.changes(), relative);
  marks.draw(core, relative);
}

function withPrefix(value, unit) {
  const [size, prefix] = value < 1e3 ? [1, ''] : value < 1e6 ? [1e3, 'k'] : value < 1e9 ? [1e6, 'M'] : [1e9, 'G'];
  return `${Number((value / size).toPrecision(3))} ${prefix}${unit}`;
}

function showFigures(now) {
  if (now - cost.shown < 250) return;
  if (cost.count) {
    const each = cost.sum / cost.count;
    byId('milliseconds').textContent = each.toFixed(2) + ' ms';
    const bar = byId('cost').firstElementChild;
    bar.style.width = Math.min(100, (100 * each) / (1000 * DT)) + '%';
    bar.style.background = each < 700 * DT ? '#4cc38a' : each < 1000 * DT ? '#ffb224' : '#e5484d';
  }
  byId('drawing').textContent = state.seconds ? (cost.drawing / state.seconds).toFixed(2) + ' ms' : '\u2013';
  byId('taken').textContent = core.substeps();
  byId('strain').textContent = (100 * core.max_strain()).toPrecision(3) + ' %';
  byId('bent').hidden = core.bent_count() === 0;
  byId('bent-count').textContent = core.bent_count().toLocaleString('en');
  byId('kinetic').textContent = withPrefix(core.kinetic_energy(), 'J');
  byId('frames').textContent = Math.round((1000 * state.seconds) / (now - cost.shown)) + ' /s';
  Object.assign(cost, { sum: 0, count: 0, drawing: 0, shown: now });
  state.seconds = 0;
}

function frame(now) {
  if (!state.seen) return requestAnimationFrame(frame);
  resize();
  state.debt = Math.min(state.debt + (now - state.last) / 1000, MOST_STEPS * DT);
  state.last = now;
  for (; state.running && state.debt >= DT; state.debt -= DT) step();
  const began = performance.now();
  draw();
  state.drawn++;
  cost.drawing += performance.now() - began;
  state.seconds++;
  showFigures(now);
  requestAnimationFrame(frame);
}

/* ------------------------------------------------------------------------------------------ checks, pictures */

function writeChecks() {
  const lines = [];
  for (const [scene, steps] of [[0, 64], [0, 1000], [1, 1000], [2, 200], [3, 100], [4, 300], [5, 200]])
    for (const level of [1, 0]) {
      const result = core.check(scene, steps, level);
      lines.push(`check ${scene} ${steps} ${level ? 'scalar' : 'best'} ${result || hashText(core.check_hash)}`);
    }
  lines.push(`level ${textAt(core, core.level())}`);
  write(lines);
}

function write(lines) {
  const text = document.createElement('pre');
  text.id = 'written';
  text.textContent = lines.join('\n');
  text.style.display = 'none';
  document.body.append(text);
}

function act() {
  for (const name of ['blast', 'cut'])
    if (settings.has(name)) check(core[name](...settings.get(name).split(',').map(Number)));
}

// A run of so many frames, with what it cost; the picture is that of its end.
function runFrames(count) {
  const times = [];
  act();
  for (let i = 0; i < count; i++) times.push(step());
  times.sort((a, b) => a - b);
  resize();
  fit();
  draw();
  Object.assign(cost, { sum: times[count >> 1], count: 1, shown: -1000 });
  showFigures(performance.now());
  byId('frames').textContent = count;
  write([`frames ${count} least ${times[0].toFixed(3)} median ${times[count >> 1].toFixed(3)} ms`,
    `particles ${core.particles()} springs ${core.spring_count()} substeps ${core.substeps()}`,
    `hash ${hashText(core.hash)} level ${textAt(core, core.level())} ${state.broken}`]);
}

async function main() {
  drawing = new Drawing(byId('canvas'));
  marks = new Marks(byId('marks'), byId('tip'));
  const embedded = settings.has('embed');
  document.body.classList.toggle('embedded', embedded);
  document.body.classList.toggle('still', settings.has('still'));
  byId('controls').open = innerWidth > 640 && !embedded;
  resize();
  core = (await WebAssembly.instantiate(await resource('massspring.wasm'), {})).instance.exports;
  materials = readMaterials(new TextDecoder().decode(await resource('ship_materials.csv')));
  for (const id of SETTINGS)
    if (settings.has(id)) byId(id).value = settings.get(id);
  if (settings.has('substeps')) setSubsteps(settings.get('substeps'));
  for (const id of SWITCHES) if (settings.has(id)) toggle(byId(id), true);
  connectControls();
  connectHand();
  await load(byId('scene').value);
  if (settings.has('check')) return writeChecks();
  if (settings.has('frames')) return runFrames(Number(settings.get('frames')));
  if (embedded) new IntersectionObserver(([{ isIntersecting }]) => (state.seen = isIntersecting)).observe(drawing.canvas);
  requestAnimationFrame((now) => {
    state.last = now;
    frame(now);
    if (embedded) tellParent(now);
  });
}

// The still picture over the frame may go; and a page may choose a lighter scene for a slow computer.
function tellParent(start) {
  parent.postMessage('massspring runs', '*');
  const drawn = state.drawn;
  setTimeout(() => {
    if (state.seen && (state.drawn - drawn) / (performance.now() - start) < SLOWEST) parent.postMessage('massspring is slow', '*');
  }, WATCHED);
}

main().catch((problem) => {
  tell(problem.message);
  write([`failed ${problem.message}`]);
});
