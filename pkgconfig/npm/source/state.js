// A network's state: particles, springs, and what they are made of.
import { array, choice, fail, Handle, number, whole } from './core.js';
import { STRUCTS } from './tables.js';

function known(where, names) {
  for (const name of Object.keys(where))
    if (!names.includes(name) && where[name] !== undefined)
      fail(`${name} has no meaning here; there are: ${names.join(', ')}`);
  return where;
}

const isTyped = (value, ...types) => types.some((type) => value instanceof type);

export class State extends Handle {
  get kind() {
    return 'network';
  }

  get particleCount() {
    return this.core.exports.mspring_network_particle_count(this.pointer);
  }

  get springCount() {
    return this.core.exports.mspring_network_spring_count(this.pointer);
  }

  /* --------------------------------------------------------------------------------------------------- helpers */

  check(result) {
    this.core.check(result, result < 0 ? this.core.exports.mspring_network_error(this.pointer) : 0);
  }

  // A call with memory for its time: body returns a result of the library.
  run(body) {
    const { core, pointer } = this;
    core.call(() => this.check(body(core, core.exports, pointer)));
  }

  // A struct that the library fills.
  report(name, body) {
    return this.core.call(() => {
      const found = this.core.blank(name);
      this.check(body(this.core.exports, this.pointer, found));
      return this.core.read(name, found);
    });
  }

  // Numbers that the library writes one after the other.
  numbers(kind, count, body) {
    return this.core.call(() => {
      const wide = kind === 'f64' ? 8 : 4, found = this.core.take(count * wide);
      this.check(body(this.core.exports, this.pointer, ...Array.from({ length: count }, (_, i) => found + i * wide)));
      return [...this.core.view(kind, found, count)];
    });
  }

  // Which elements a call is about: { ids, count } or { first, count }. Inside of a call, which gives ids back.
  range(where, total) {
    if (where?.ids === undefined) return this.span(where, total);
    known(where, ['ids']);
    const list = array('u32', typeof where.ids === 'number' ? [where.ids] : where.ids, 'ids');
    return { ids: this.core.copyIn('u32', list), count: list.length };
  }

  span(where, total) {
    const { first = 0, count } = known(where ?? {}, ['first', 'count']);
    whole(first, 'first');
    return { first, count: whole(count ?? Math.max(0, total - first), 'count') };
  }

  // Call one of two functions of the library: for a list, or for a range.
  pick(range, at, plain, before, after) {
    return range.ids !== undefined ? at(this.pointer, ...before, range.ids, range.count, ...after)
      : plain(this.pointer, ...before, range.first, range.count, ...after);
  }

  // Where results go: into an array of the caller's, or a new one.
  read(kind, length, into, types, body) {
    if (into !== undefined && !isTyped(into, ...types)) fail(`into must be a ${types.map((type) => type.name).join(' or ')}`);
    if (into !== undefined && into.length !== length) fail(`into has ${into.length} numbers, it must have ${length}`);
    return this.core.call(() => {
      const found = this.core.take(Math.max(1, length) * (kind === 'f64' ? 8 : 4));
      this.check(body(found));
      return this.core.copyOut(kind, found, length, into);
    });
  }

  // Pairs of numbers for particles: a pair for each, or one for all.
  pairs(kind, values, where, at, plain) {
    this.core.call(() => {
      const list = array(kind, values, 'values');
      if (list.length % 2) fail(`values has ${list.length} numbers: it must have two for each particle`);
      const given = where?.ids === undefined && where?.count === undefined ? { ...where, count: list.length / 2 } : where;
      const range = this.range(given, this.particleCount);
      if (list.length !== 2 * range.count && list.length !== 2)
        fail(`values has ${list.length} numbers: it must have ${2 * range.count}, or 2 for all`);
      const x = this.core.copyIn(kind, list), y = x + (kind === 'f64' ? 8 : 4);
      this.check(this.pick(range, at, plain, [], [x, y, list.length === 2 ? 0 : 2]));
    });
  }

  /* ------------------------------------------------------------------------------------- positions, velocities */

  view() {
    return this.core.call(() => {
      const found = this.core.blank('view'), { fields } = STRUCTS.view;
      this.check(this.core.exports.mspring_network_view(this.pointer, found));
      const view = this.core.read('view', found);
      for (const [key, [kind, offset]] of Object.entries(fields))
        if (kind.endsWith('*'))
          view[key] = this.core.view(kind.slice(0, -1), this.core.data.getUint32(found + offset, true),
            key === 'slotOfParticle' ? view.particleCount : view.slotCount);
      return view;
    });
  }

  positions({ into, ...where } = {}) {
    const { exports } = this.core, single = into instanceof Float32Array, wide = single ? 4 : 8;
    return this.core.call(() => {
      const range = this.range(where, this.particleCount);
      return this.read(single ? 'f32' : 'f64', 2 * range.count, into, [Float64Array, Float32Array], (found) => single
        ? this.pick(range, exports.mspring_network_get_positions_float_at, exports.mspring_network_get_positions_float, [],
          [found, found + wide, 2])
        : this.pick(range, exports.mspring_network_get_positions_at, exports.mspring_network_get_positions, [],
          [found, found + wide, 2]));
    });
  }

  velocities({ into, ...where } = {}) {
    const { exports } = this.core;
    return this.core.call(() => {
      const range = this.range(where, this.particleCount);
      return this.read('f32', 2 * range.count, into, [Float32Array], (found) => this.pick(range,
        exports.mspring_network_get_velocities_at, exports.mspring_network_get_velocities, [], [found, found + 4, 2]));
    });
  }

  setPositions(values, where) {
    const { exports } = this.core;
    this.pairs('f64', values, where, exports.mspring_network_set_positions_at, exports.mspring_network_set_positions);
  }

  setVelocities(values, where) {
    const { exports } = this.core;
    this.pairs('f32', values, where, exports.mspring_network_set_velocities_at, exports.mspring_network_set_velocities);
  }

  applyForce(particle, x, y) {
    this.check(this.core.exports.mspring_network_apply_force(this.pointer, whole(particle, 'particle'), number(x, 'x'),
      number(y, 'y')));
  }

  applyForces(values, where) {
    const { exports } = this.core;
    this.pairs('f32', values, where, exports.mspring_network_apply_forces_at, exports.mspring_network_apply_forces);
  }

  applyImpulses(values, where) {
    const { exports } = this.core;
    this.pairs('f32', values, where, exports.mspring_network_apply_impulses_at, exports.mspring_network_apply_impulses);
  }

  applyTorque(torque, where) {
    this.core.call(() => {
      const { ids = 0, first = 0, count } = this.range(where, this.particleCount);
      this.check(this.core.exports.mspring_network_apply_torque(this.pointer, ids, first, count, number(torque, 'torque')));
    });
  }

  stateHash() {
    const { core } = this;
    this.check(core.exports.mspring_network_state_hash(this.pointer, core.word));
    return core.data.getBigUint64(core.word, true);
  }

  /* ------------------------------------------------------------------------------------------------ properties */

  #total(property) {
    return property === 'mass' || property === 'inverseMassScale' ? this.particleCount : this.springCount;
  }

  get(property, { into, ...where } = {}) {
    const index = choice('property', property), { exports } = this.core;
    return this.core.call(() => {
      const range = this.range(where, this.#total(property));
      return this.read('f32', range.count, into, [Float32Array], (found) =>
        this.pick(range, exports.mspring_network_get_at, exports.mspring_network_get, [index], [found, 1]));
    });
  }

  set(property, values, where) {
    const index = choice('property', property), single = typeof values === 'number', { exports } = this.core;
    this.core.call(() => {
      const list = single ? [values] : array('f32', values, 'values');
      const all = single || where?.ids !== undefined || where?.count !== undefined ? where : { ...where, count: list.length };
      const range = this.range(all, this.#total(property));
      if (!single && list.length !== range.count) fail(`values has ${list.length} numbers, it must have ${range.count}`);
      this.check(this.pick(range, exports.mspring_network_set_at, exports.mspring_network_set, [index],
        [this.core.copyIn('f32', list), single ? 0 : 1]));
    });
  }

  strains(where) {
    return this.get('strain', where);
  }

  maxStrain() {
    const { core } = this;
    this.check(core.exports.mspring_network_max_strain(this.pointer, core.word, core.word + 4));
    return { strain: core.data.getFloat32(core.word, true), spring: core.data.getUint32(core.word + 4, true) };
  }

  ends({ numbering = 'ids', into, ...where } = {}) {
    const index = choice('numbering', numbering), { first, count } = this.span(where, this.springCount);
    return this.read('u32', 2 * count, into, [Uint32Array], (found) =>
      this.core.exports.mspring_network_get_ends(this.pointer, first, count, index, found, found + 4, 2));
  }

  springFlags({ into, ...where } = {}) {
    const { first, count } = this.span(where, this.springCount);
    return this.read('u32', count, into, [Uint32Array], (found) =>
      this.core.exports.mspring_network_get_spring_flags(this.pointer, first, count, found, 1));
  }
}
