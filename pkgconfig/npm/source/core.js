// One instance of the library: its memory, its structs and its errors.
import { ENUMS, NONE, STRUCTS } from './tables.js';

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
export const ARRAY_OF = { u16: Uint16Array, u32: Uint32Array, id: Uint32Array, f32: Float32Array, f64: Float64Array };
const SET = { u32: 'setUint32', id: 'setUint32', f32: 'setFloat32', f64: 'setFloat64' };
export const isArray = (value) => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));

// A value in a message. What lists and objects say of themselves may be long, or fail.
const shown = (value) => (value !== null && typeof value === 'object' ? 'an object' : String(value));

/** A whole number that C takes for uint32_t. Anything else would silently become another one. */
export function whole(value, name) {
  if (typeof value !== 'number' || !(value >= 0 && value <= 0xffffffff) || !Number.isInteger(value))
    fail(`${name} is ${shown(value)}, it must be a whole number from 0 to 4294967295`);
  return value;
}

export function number(value, name) {
  if (typeof value !== 'number') fail(`${name} is ${shown(value)}, it must be a number`);
  return value;
}

export function choice(name, value) {
  if (typeof value !== 'string' || !Object.hasOwn(ENUMS[name], value))
    fail(`${name} is ${shown(value)}, it must be one of: ${Object.keys(ENUMS[name]).join(', ')}`);
  return ENUMS[name][value];
}

/** What a word such as 'auto' stands for where numbers are expected. Anything else stays. */
export function spoken(value, words, name) {
  if (typeof value !== 'string' || !words) return value;
  return Object.hasOwn(words, value) ? words[value]
    : fail(`${name} is ${value}, it must be a number or one of: ${Object.keys(words).join(', ')}`);
}

/** An array as the library reads it: of numbers alone, whole ones where it wants ids. */
export function array(kind, value, name) {
  if (!isArray(value)) fail(`${name} must be an array or a typed array`);
  if (value instanceof ARRAY_OF[kind]) return value;
  const most = kind === 'u16' ? 0xffff : 0xffffffff, integer = kind[0] !== 'f';
  const fits = integer ? (one) => Number.isInteger(one) && one >= 0 && one <= most : (one) => typeof one === 'number';
  for (let i = 0; i < value.length; i++)
    if (!fits(value[i]))
      fail(`${name}[${i}] is ${shown(value[i])}, it must be a ${integer ? `whole number up to ${most}` : 'number'}`);
  return value;
}

// How long arrays are: a count of the struct, numbers to one, numbers more.
const LENGTHS = {
  floor_def: { planes: ['planeCount', 4], planeFrictions: ['planeCount', 1], planeRestitutions: ['planeCount', 1],
    heights: ['heightCount', 1], heightFrictions: ['heightCount', 1, -1], heightRestitutions: ['heightCount', 1, -1],
    siltDepths: ['heightCount', 1] },
  collider_def: { points: ['pointCount', 2] },
  mesh_def: { x: ['vertexCount', 1], y: ['vertexCount', 1], triangles: ['triangleCount', 3] },
  lattice_def: { materials: ['materialCount', 1] },
};
const isCount = (name, key) => Object.values(LENGTHS[name] ?? {}).some(([count]) => count === key);

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
    const pointer = size > 0x7fffffff ? 0 : this.exports.massspring_take(size) >>> 0;
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

  // Room for numbers; also for none.
  room(kind, length) {
    return this.take(Math.max(1, length) * ARRAY_OF[kind].BYTES_PER_ELEMENT);
  }

  copyIn(kind, values) {
    const pointer = this.room(kind, values.length);
    this.view(kind, pointer, values.length).set(values);
    return pointer;
  }

  copyOut(kind, pointer, length, into) {
    const values = this.view(kind, pointer, length);
    if (!into) return values.slice();
    into.set(values);
    return into;
  }

  bytesIn(bytes, name) {
    if (!(bytes instanceof Uint8Array)) fail(`${name} must be a Uint8Array`);
    const pointer = this.take(Math.max(1, bytes.length));
    new Uint8Array(this.memory.buffer).set(bytes, pointer);
    return pointer;
  }

  bytesOut(pointer, size) {
    return new Uint8Array(this.memory.buffer, pointer, size).slice();
  }

  text(pointer) {
    const bytes = new Uint8Array(this.memory.buffer, pointer >>> 0);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  // message is a pointer to what the library says of its object.
  check(result, message = 0) {
    if (result >= 0) return;
    const words = message ? this.text(message) : '';
    const name = this.text(this.exports.mspring_result_string(result));
    throw new MassSpringError(RESULTS[result] ?? 'argument', words ? `${name}: ${words}` : name);
  }

  /* --------------------------------------------------------------------------------------------------- structs */

  // Structs with their defaults, one after the other.
  begin(name, count = 1) {
    const { size, kind } = STRUCTS[name], all = Math.max(1, count) * size, pointer = this.take(all);
    if (kind !== undefined) this.check(this.exports.mspring_init(kind, pointer, size));
    const bytes = new Uint8Array(this.memory.buffer, pointer, all);
    for (let done = 1; done < count; done *= 2) bytes.copyWithin(done * size, 0, Math.min(done, count - done) * size);
    return pointer;
  }

  write(name, options) {
    const pointer = this.begin(name);
    this.overlay(name, pointer, options);
    return pointer;
  }

  overlay(name, pointer, options = {}) {
    if (options === null || typeof options !== 'object') fail(`${name}: options must be an object`);
    const { fields } = STRUCTS[name], counts = {};
    for (const [key, value] of Object.entries(options)) {
      if (value === undefined) continue;
      if (!Object.hasOwn(fields, key) || isCount(name, key))
        fail(`there is no option ${key}; there are: ${Object.keys(fields).filter((known) => !isCount(name, known)).join(', ')}`);
      const [kind, offset] = fields[key];
      if (/[*&]$/.test(kind)) {
        const list = this.list(name, key, value, options, counts); // first: it may grow memory
        this.data.setUint32(pointer + offset, list, true);
      } else this.put(pointer, fields[key], value, key);
    }
    for (const [key, value] of Object.entries(counts)) this.put(pointer, fields[key], value, key);
  }

  list(name, key, value, options, counts) {
    const kind = STRUCTS[name].fields[key][0].slice(0, -1);
    if (key === 'material') return this.write('material', value);
    const values = kind === 'material' && isArray(value) ? value : array(kind, value, key);
    const [count, each, more = 0] = LENGTHS[name][key] ?? [];
    if (count && (values.length - more) % each) fail(`${key} has ${values.length} numbers, which is no multiple of ${each}`);
    const length = count ? (counts[count] ??= (values.length - more) / each) * each + more : options.width * options.height;
    if (values.length !== length) fail(`${key} has ${values.length} numbers, it must have ${length}`);
    if (kind !== 'material') return this.copyIn(kind, values);
    const pointer = this.begin('material', values.length);
    values.forEach((one, i) => this.overlay('material', pointer + i * STRUCTS.material.size, one));
    return pointer;
  }

  put(pointer, [kind, offset, words], given, name) {
    const value = spoken(given, words, name);
    if (!SET[kind]) this.data.setInt32(pointer + offset, choice(kind, value), true);
    else this.data[SET[kind]](pointer + offset, kind[0] === 'f' ? number(value, name) : whole(value, name), true);
  }

  // Fill many structs from columns: of each field a number for all, or an array with one for each.
  columns(name, columns) {
    if (columns === null || typeof columns !== 'object' || isArray(columns)) fail('columns must be an object of arrays');
    const { size, fields } = STRUCTS[name], given = Object.entries(columns).filter(([, value]) => value !== undefined);
    let count;
    for (const [key, value] of given) {
      if (!Object.hasOwn(fields, key))
        fail(`there is no column ${key}; there are: ${Object.keys(fields).join(', ')}`);
      if (isArray(value) && (count ??= value.length) !== value.length)
        fail(`column ${key} has ${value.length} values, others have ${count}`);
    }
    count ??= 1;
    const pointer = this.begin(name, count);
    for (const [key, value] of given) {
      const [kind, offset] = fields[key], wide = ARRAY_OF[kind].BYTES_PER_ELEMENT;
      const values = isArray(value) && array(kind, value, key);
      if (!values) this.put(pointer, fields[key], value, key);
      const target = this.view(kind, pointer + offset, count ? ((count - 1) * size) / wide + 1 : 0);
      for (let i = 0; i < count; i++) target[(i * size) / wide] = values ? values[i] : target[0];
    }
    return { pointer, count };
  }

  readAll(name, pointer, count) {
    return Array.from({ length: count }, (_, i) => this.read(name, pointer + i * STRUCTS[name].size));
  }

  read(name, pointer) {
    const values = {}, { data } = this, { fields } = STRUCTS[name];
    for (const [key, [kind, offset, words]] of Object.entries(fields)) {
      if (isCount(name, key)) continue;
      const at = pointer + offset;
      if (kind.endsWith('*')) {
        const [count, each, more = 0] = LENGTHS[name]?.[key] ?? [], found = data.getUint32(at, true);
        if (count && found) // an array of the library's own
          values[key] = this.copyOut(kind.slice(0, -1), found, data.getUint32(pointer + fields[count][1], true) * each + more);
      } else values[key] = valueAt(data, kind, at);
      if (words) values[key] = Object.keys(words).find((word) => words[word] === values[key]) ?? values[key];
    }
    return values;
  }
}

function valueAt(data, kind, at) {
  const integer = data.getUint32(at, true);
  switch (kind) {
    case 'u32': return integer;
    case 'bool': return integer !== 0;
    case 'id': return integer === NONE ? null : integer;
    case 'f32': return data.getFloat32(at, true);
    case 'f64': return data.getFloat64(at, true);
    case 'u64': return Number(data.getBigUint64(at, true));
    // Of a later version, it may have no name.
    default: return Object.keys(ENUMS[kind]).find((name) => ENUMS[kind][name] === (integer | 0)) ?? String(integer | 0);
  }
}

/** A builder or a network: a pointer that is freed once. Its functions are those that begin with mspring_ and its kind. */
export class Handle {
  #core;
  #pointer;

  constructor(core, pointer) {
    this.#core = core;
    this.#pointer = pointer;
    core.lost.register(this, { destroy: this.#function('destroy'), pointer }, this);
  }

  #function(name) {
    return this.#core.exports[`mspring_${this.kind}_${name}`];
  }

  get core() {
    return this.#core;
  }

  get pointer() {
    if (!this.#pointer) fail(`this ${this.kind} has been freed`);
    return this.#pointer;
  }

  get particleCount() {
    return this.count('particles');
  }

  get springCount() {
    return this.count('springs');
  }

  get elementCount() {
    return this.count('elements');
  }

  count(kind) {
    return this.#function('count')(this.pointer, choice('kind', kind)) >>> 0;
  }

  check(result) {
    if (result < 0) this.core.check(result, this.#function('error')(this.pointer));
  }

  // build finds the functions that the modules must have by their names here.
  call(name, ...given) {
    this.check(this.#function(name)(this.pointer, ...given));
  }

  // Which things of a kind: a list, its first, how many. One id, a list of ids, or { first, count }; nothing means all.
  // Inside of a call, which gives the list back.
  which(where = {}, kind) {
    if (typeof where === 'number' || isArray(where)) {
      const list = array('u32', isArray(where) ? where : [where], 'ids');
      return [this.core.copyIn('u32', list), 0, list.length];
    }
    if (where === null || typeof where !== 'object') fail(`${shown(where)} is no id, list of ids or { first, count }`);
    const { first = 0, count, ...others } = where;
    for (const name in others) fail(`${name} has no meaning here; there are: first, count`);
    return [0, whole(first, 'first'), whole(count ?? Math.max(0, this.count(kind) - first), 'count')];
  }

  // A call that leaves a word, such as an id, or two.
  words(name, ...given) {
    const { core } = this;
    this.call(name, ...given, core.word, core.word + 4);
    return [core.data.getUint32(core.word, true), core.data.getUint32(core.word + 4, true)];
  }

  free() {
    if (!this.#pointer) return;
    this.#core.lost.unregister(this);
    this.#function('destroy')(this.#pointer);
    this.#pointer = 0;
  }
}
if (Symbol.dispose)
  Object.defineProperty(Handle.prototype, Symbol.dispose, { value: Handle.prototype.free });
