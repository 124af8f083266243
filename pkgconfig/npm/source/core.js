// One instance of the library: its memory, its structs and its errors.
import { ENUMS, STRUCTS } from './tables.js';

/** A call that failed. It has changed nothing. */
export class MassSpringError extends Error {
  constructor(result, message) {
    super(message);
    this.name = 'MassSpringError';
    this.result = result;
    this.code = ENUMS.result[result];
    this.particles = culprits(message, /\bparticles? (\d+)(?: and (\d+))?/g);
    this.springs = culprits(message, /\bsprings? (\d+)(?: and (\d+))?/g);
    this.steps = 0;
  }
}

function culprits(message, pattern) {
  const found = [...message.matchAll(pattern)].flatMap((match) => match.slice(1).filter(Boolean).map(Number));
  return [...new Set(found)];
}

export function fail(message) {
  throw new MassSpringError('argument', message);
}

const RESULTS = Object.fromEntries(Object.entries(ENUMS.result).map(([name, value]) => [value, name]));
const ARRAY_OF = { u16: Uint16Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array };
const isArray = (value) => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));

/** A whole number that C takes for uint32_t. Anything else would silently become another one. */
export function whole(value, name) {
  if (typeof value !== 'number' || !(value >= 0 && value <= 0xffffffff) || !Number.isInteger(value))
    fail(`${name} is ${String(value)}, it must be a whole number from 0 to 4294967295`);
  return value;
}

export function number(value, name) {
  if (typeof value !== 'number') fail(`${name} is ${String(value)}, it must be a number`);
  return value;
}

export function choice(name, value) {
  if (typeof value !== 'string' || !Object.hasOwn(ENUMS[name], value))
    fail(`${name} is ${String(value)}, it must be one of: ${Object.keys(ENUMS[name]).join(', ')}`);
  return ENUMS[name][value];
}

/** An array as the library reads it: of numbers alone, whole ones where it wants ids. */
export function array(kind, value, name) {
  if (!isArray(value)) fail(`${name} must be an array or a typed array`);
  if (value instanceof ARRAY_OF[kind]) return value;
  const most = kind === 'u16' ? 0xffff : 0xffffffff;
  const fits = kind[0] === 'u' ? (one) => Number.isInteger(one) && one >= 0 && one <= most : (one) => typeof one === 'number';
  for (let i = 0; i < value.length; i++)
    if (!fits(value[i]))
      fail(`${name}[${i}] is ${String(value[i])}, it must be a ${kind[0] === 'u' ? `whole number up to ${most}` : 'number'}`);
  return value;
}

// Which count an array gives, and how many numbers there are to one.
const COUNTED = {
  floor_def: { planes: ['planeCount', 4], planeFrictions: ['planeCount', 1], planeRestitutions: ['planeCount', 1],
    heights: ['heightCount', 1] },
  collider_def: { points: ['pointCount', 2] },
  mesh_def: { x: ['vertexCount', 1], y: ['vertexCount', 1], triangles: ['triangleCount', 3] },
  lattice_def: { materials: ['materialCount', 1] },
};

// Where no count is: what else an array must be as long as.
const LENGTHS = {
  floor_def: { heightFrictions: (options) => options.heights.length - 1,
    heightRestitutions: (options) => options.heights.length - 1 },
  lattice_def: { cells: (options) => options.width * options.height },
};

export class Core {
  constructor(instance) {
    this.exports = instance.exports;
    this.memory = instance.exports.memory;
    this.taken = [];
    this.word = this.take(64);
    this.taken.pop(); // for good
    this.lost = new FinalizationRegistry(({ destroy, pointer }) => destroy(pointer));
  }

  /* ---------------------------------------------------------------------------------------------------- memory */

  // Views are made anew: memory that grows leaves old ones empty.
  view(kind, pointer, length) {
    return new ARRAY_OF[kind](this.memory.buffer, pointer, length);
  }

  get data() {
    if (this.seen?.buffer !== this.memory.buffer) this.seen = new DataView(this.memory.buffer);
    return this.seen;
  }

  // A block until the call ends.
  take(size) {
    if (size > 0x7fffffff) throw new MassSpringError('memory', `out of memory: ${size} bytes in one block`);
    const pointer = this.exports.massspring_take(size) >>> 0;
    if (!pointer) throw new MassSpringError('memory', `out of memory: ${size} bytes in one block`);
    this.taken.push([pointer, size]);
    return pointer;
  }

  // Everything that a call takes is given back after it.
  call(body) {
    const before = this.taken.length;
    try {
      return body();
    } finally {
      while (this.taken.length > before) this.exports.massspring_leave(...this.taken.pop());
    }
  }

  copyIn(kind, values) {
    const pointer = this.take(Math.max(1, values.length) * ARRAY_OF[kind].BYTES_PER_ELEMENT);
    this.view(kind, pointer, values.length).set(values);
    return pointer;
  }

  copyOut(kind, pointer, length, into) {
    const values = this.view(kind, pointer, length);
    if (!into) return values.slice();
    into.set(values);
    return into;
  }

  text(pointer) {
    const bytes = new Uint8Array(this.memory.buffer, pointer >>> 0);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /* ---------------------------------------------------------------------------------------------------- errors */

  // message is a pointer to what the library says of its object.
  check(result, message = 0) {
    if (result >= 0) return;
    const words = message ? this.text(message) : '';
    const name = this.text(this.exports.mspring_result_string(result));
    throw new MassSpringError(RESULTS[result] ?? 'argument', words ? `${name}: ${words}` : name);
  }

  /* --------------------------------------------------------------------------------------------------- structs */

  // Fill a struct of the library with its defaults, and those fields that options have.
  write(name, options, extra = {}) {
    const pointer = this.begin(name, 1);
    this.overlay(name, pointer, options, extra);
    return pointer;
  }

  begin(name, count) {
    const { size } = STRUCTS[name], pointer = this.take(Math.max(1, count) * size);
    this.check(this.exports[INIT[name]](pointer, size));
    const bytes = new Uint8Array(this.memory.buffer, pointer, Math.max(1, count) * size);
    for (let done = 1; done < count; done *= 2) bytes.copyWithin(done * size, 0, Math.min(done, count - done) * size);
    return pointer;
  }

  overlay(name, pointer, options, extra = {}) {
    if (options === undefined) options = {};
    if (options === null || typeof options !== 'object') fail(`${name}: options must be an object`);
    const { fields } = STRUCTS[name], counts = { ...extra };
    for (const [key, value] of Object.entries(options)) {
      if (value === undefined) continue;
      if (!Object.hasOwn(fields, key) || /^(plane|height|point|vertex|triangle|material)Count$/.test(key))
        fail(`there is no option ${key}; there are: ${Object.keys(fields).join(', ')}`);
      const [kind, offset] = fields[key];
      if (kind.endsWith('*')) {
        const list = this.list(name, key, value, options, counts); // first: it may grow memory
        this.data.setUint32(pointer + offset, list, true);
      } else this.put(pointer + offset, kind, value, key);
    }
    for (const [key, value] of Object.entries(counts)) this.put(pointer + fields[key][1], fields[key][0], value, key);
  }

  list(name, key, value, options, counts) {
    const kind = STRUCTS[name].fields[key][0].slice(0, -1);
    const values = kind === 'material' ? value : array(kind, value, key);
    if (!isArray(values)) fail(`${key} must be an array`);
    const [count, each] = COUNTED[name][key] ?? [];
    if (count) {
      if (values.length % each) fail(`${key} has ${values.length} numbers, which is no multiple of ${each}`);
      if ((counts[count] ??= values.length / each) !== values.length / each)
        fail(`${key} has ${values.length} numbers, it must have ${counts[count] * each}`);
    } else {
      if (name === 'floor_def' && !options.heights) fail(`${key} needs heights`);
      const length = LENGTHS[name][key](options);
      if (values.length !== length) fail(`${key} has ${values.length} numbers, it must have ${length}`);
    }
    return kind === 'material' ? this.materials(values) : this.copyIn(kind, values);
  }

  materials(values) {
    const pointer = this.begin('material', values.length);
    values.forEach((value, i) => this.overlay('material', pointer + i * STRUCTS.material.size, value));
    return pointer;
  }

  put(pointer, kind, value, name) {
    if (kind === 'u32') this.data.setUint32(pointer, whole(value, name), true);
    else if (kind === 'f32') this.data.setFloat32(pointer, number(value, name), true);
    else if (kind === 'f64') this.data.setFloat64(pointer, number(value, name), true);
    else this.data.setInt32(pointer, choice(kind, value), true);
  }

  // Fill many structs from columns: of each field a number for all, or an array with one for each.
  columns(name, columns) {
    if (columns === null || typeof columns !== 'object') fail('columns must be an object of arrays');
    const { size, fields } = STRUCTS[name];
    let count;
    for (const [key, value] of Object.entries(columns)) {
      if (!Object.hasOwn(fields, key))
        fail(`there is no column ${key}; there are: ${Object.keys(fields).join(', ')}`);
      if (!isArray(value)) continue;
      if ((count ??= value.length) !== value.length)
        fail(`column ${key} has ${value.length} values, others have ${count}`);
    }
    if (count === undefined) fail('one column at least must be an array');
    const pointer = this.begin(name, count);
    for (const [key, value] of Object.entries(columns)) {
      if (value === undefined) continue;
      const [kind, offset] = fields[key], wide = kind === 'f64' ? 8 : 4;
      const values = isArray(value) ? array(kind, value, key) : (this.put(pointer + offset, kind, value, key), undefined);
      const target = this.view(kind, pointer + offset, count ? ((count - 1) * size) / wide + 1 : 0);
      for (let i = 0; i < count; i++) target[(i * size) / wide] = values ? values[i] : value;
    }
    return { pointer, count };
  }

  // A struct for the library to fill.
  blank(name, count = 1) {
    const { size } = STRUCTS[name], pointer = this.take(size * Math.max(1, count));
    for (let i = 0; i < count; i++) this.data.setUint32(pointer + i * size, size, true);
    return pointer;
  }

  read(name, pointer) {
    const values = {}, { data } = this;
    for (const [key, [kind, offset]] of Object.entries(STRUCTS[name].fields)) {
      const at = pointer + offset;
      if (kind === 'u32') values[key] = data.getUint32(at, true);
      else if (kind === 'f32') values[key] = data.getFloat32(at, true);
      else if (kind === 'f64') values[key] = data.getFloat64(at, true);
      else if (kind === 'u64') values[key] = Number(data.getBigUint64(at, true));
      else if (!kind.endsWith('*')) values[key] = nameOf(kind, data.getInt32(at, true));
    }
    return values;
  }
}

function nameOf(kind, value) {
  for (const [name, number] of Object.entries(ENUMS[kind])) if (number === value) return name;
  return String(value); // of a later version
}

const INIT = {
  particle_def: 'mspring_particle_def_init', spring_def: 'mspring_spring_def_init', material: 'mspring_material_init',
  lattice_def: 'mspring_lattice_def_init', network_def: 'mspring_network_def_init', floor_def: 'mspring_floor_def_init',
  rope_def: 'mspring_rope_def_init', mesh_def: 'mspring_mesh_def_init', disc_def: 'mspring_disc_def_init',
  contact_def: 'mspring_contact_def_init', collider_def: 'mspring_collider_def_init', grip_def: 'mspring_grip_def_init',
  settle_def: 'mspring_settle_def_init', area_def: 'mspring_area_def_init', angle_def: 'mspring_angle_def_init',
};

/** A builder or a network: a pointer that is freed once. */
export class Handle {
  #core;
  #pointer;
  #destroy;

  constructor(core, pointer, destroy) {
    this.#core = core;
    this.#pointer = pointer;
    this.#destroy = destroy;
    core.lost.register(this, { destroy, pointer }, this);
  }

  get core() {
    return this.#core;
  }

  get pointer() {
    if (!this.#pointer) fail(`this ${this.kind} has been freed`);
    return this.#pointer;
  }

  free() {
    if (!this.#pointer) return;
    this.#core.lost.unregister(this);
    this.#destroy(this.#pointer);
    this.#pointer = 0;
  }
}
if (Symbol.dispose)
  Object.defineProperty(Handle.prototype, Symbol.dispose, { value: Handle.prototype.free });
