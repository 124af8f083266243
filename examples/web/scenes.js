// Scenes as cells, materials and ropes; images become cells as everywhere in the examples.
'use strict';

const EMPTY = 65535;
const IRON = { mass: 73.3975, stiffness: 6.7643e7, damping: 1400, breakStrain: 0.05, pinned: 0 };
const PINNED = { ...IRON, breakStrain: 0, pinned: 1 };

function empty(width, height, materials) {
  return { width, height, cells: new Uint16Array(width * height).fill(EMPTY), materials, ropes: [] };
}

function bar(width, height) {
  const scene = empty(width, height, [IRON, PINNED]);
  for (let i = 0; i < width * height; i++) scene.cells[i] = i % width === 0 ? 1 : 0;
  return scene;
}

// A deck that hangs by ropes from two towers.
function bridge() {
  const light = { mass: 30, stiffness: 3e7, damping: 900, breakStrain: 0.04, pinned: 0 };
  const scene = empty(180, 60, [light, PINNED, IRON]);
  const { cells, width, ropes } = scene;
  const at = (x, y) => y * width + x;
  for (let x = 0; x < width; x++) for (let y = 44; y < 48; y++) cells[at(x, y)] = x < 2 || x >= width - 2 ? 1 : 0;
  for (const tower of [40, 136])
    for (let y = 2; y < 60; y++) for (let x = tower; x < tower + 4; x++) cells[at(x, y)] = y > 56 ? 1 : 2;
  const rope = { mass: 8, stiffness: 2e7, damping: 600, lengthRatio: 1 };
  for (const [tower, direction] of [[40, -1], [43, 1], [136, -1], [139, 1]])
    for (let i = 1; i <= 6; i++)
      ropes.push({ from: at(tower, 2 + 2 * i), to: at(tower + direction * (6 * i), 44), segments: 10 + 2 * i, ...rope });
  return scene;
}

// A curtain of ropes: chains alone, with a weight at the end of each.
function weights() {
  const heavy = { mass: 400, stiffness: 3e7, damping: 2000, breakStrain: 0, pinned: 0 };
  const scene = empty(96, 60, [PINNED, heavy]);
  const { cells, width, ropes } = scene;
  for (let i = 0; i < 12; i++) {
    const x = 4 + 8 * i, y = 24 + ((i * 5) % 12) * 2;
    cells[x] = 0;
    for (let dy = 0; dy < 3; dy++) for (let dx = -1; dx < 2; dx++) cells[(y + dy) * width + x + dx] = 1;
    ropes.push({ from: x, to: y * width + x, segments: y, mass: 6, stiffness: 2e7, damping: 300, lengthRatio: 1 });
  }
  return scene;
}

// Blocks of many sizes above a deck that is pinned at its ends. Bodies meet.
function rubble() {
  const stone = { mass: 60, stiffness: 4e7, damping: 2500, breakStrain: 0.05, pinned: 0 };
  const deck = { mass: 40, stiffness: 3e7, damping: 1500, breakStrain: 0.03, pinned: 0 };
  const scene = { ...empty(150, 90, [deck, PINNED, stone]), collide: true };
  const { cells, width, height } = scene;
  for (let x = 0; x < width; x++)
    for (let y = height - 6; y < height; y++) cells[y * width + x] = x < 2 || x >= width - 2 ? 1 : 0;
  let seed = 7;
  const below = (most) => {
    seed = (seed * 48271) % 2147483647;
    return seed % most;
  };
  for (let y = 2; y < height - 22; y += 11)
    for (let x = 24; x < width - 34; x += 11) {
      const across = 2 + below(7), up = 2 + below(7);
      for (let i = 0; i < across * up; i++) cells[(y + Math.floor(i / across)) * width + x + (i % across)] = 2;
    }
  return scene;
}

// A block falls on a girder of steel that yields: its dent stays.
function girder() {
  const steel = { mass: 40, stiffness: 3e7, damping: 1500, breakStrain: 0, pinned: 0, yieldStrain: 0.01 };
  const block = { ...steel, mass: 400, stiffness: 6e7, damping: 4000 };
  const scene = { ...empty(120, 60, [steel, PINNED, block]), collide: true, yields: true };
  const { cells, width, height } = scene;
  for (let x = 0; x < width; x++)
    for (let y = height - 8; y < height; y++) cells[y * width + x] = x < 2 || x >= width - 2 ? 1 : 0;
  for (let x = 52; x < 68; x++) for (let y = 2; y < 14; y++) cells[y * width + x] = 2;
  return scene;
}

// colour,name,mass,stiffness,damping,break_strain,pinned,probe
function readMaterials(text) {
  const table = new Map(), materials = [];
  for (const line of text.split('\n').slice(1)) {
    const [colour, , mass, stiffness, damping, breakStrain, pinned] = line.split(',');
    if (!colour) continue;
    table.set(parseInt(colour.slice(1), 16), materials.length);
    materials.push({ mass: +mass, stiffness: +stiffness, damping: +damping, breakStrain: +breakStrain, pinned: +pinned });
  }
  return { table, materials };
}

// White and transparent pixels are nothing; a colour without a material is iron.
function fromPixels(pixels, width, height, { table, materials }) {
  const scene = empty(width, height, [...materials, IRON]);
  for (let i = 0; i < width * height; i++) {
    const colour = (pixels[4 * i] << 16) | (pixels[4 * i + 1] << 8) | pixels[4 * i + 2];
    if (pixels[4 * i + 3] === 0 || colour === 0xffffff) continue;
    scene.cells[i] = table.has(colour) ? table.get(colour) : materials.length;
  }
  return scene;
}

async function fromImage(source, materials) {
  const image = await createImageBitmap(source, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  const canvas = document.createElement('canvas');
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext('2d', { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return fromPixels(context.getImageData(0, 0, image.width, image.height).data, image.width, image.height, materials);
}

// Write a scene into the module and make its network. Throws with the library's words.
function makeScene(module, scene) {
  const cellBytes = Math.ceil((2 * scene.cells.length) / 16) * 16;
  const ropeBytes = 28, materialBytes = 24;
  const size = cellBytes + scene.materials.length * materialBytes + scene.ropes.length * ropeBytes;
  const at = module.prepare(size);
  if (!at) throw new Error('out of memory');
  const memory = module.memory.buffer;
  new Uint16Array(memory, at, scene.cells.length).set(scene.cells);
  const values = new DataView(memory);
  let place = at + cellBytes;
  const put = (...floats) => {
    for (const value of floats) {
      values.setFloat32(place, value, true);
      place += 4;
    }
  };
  for (const m of scene.materials) put(m.mass, m.stiffness, m.damping, m.breakStrain, m.pinned, m.yieldStrain ?? 0);
  for (const rope of scene.ropes) {
    for (const id of [rope.from, rope.to, rope.segments]) {
      values.setUint32(place, id, true);
      place += 4;
    }
    put(rope.mass, rope.stiffness, rope.damping, rope.lengthRatio);
  }
  if (module.make(scene.width, scene.height, scene.materials.length, scene.ropes.length)) throw new Error(textAt(module, module.error()));
}

function textAt(module, pointer) {
  const bytes = new Uint8Array(module.memory.buffer, pointer);
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
}

function hashText(part) {
  return [1, 0].map((upper) => (part(upper) >>> 0).toString(16).padStart(8, '0')).join('');
}

if (typeof module !== 'undefined')
  module.exports = { bar, bridge, weights, rubble, girder, readMaterials, fromPixels, makeScene, textAt, hashText };
