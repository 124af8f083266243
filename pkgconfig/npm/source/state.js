// A network's state: particles, springs, and what they are made of.
import { array, choice, fail, Handle, isArray, number, spoken, whole } from './core.js';
import { ENUMS, PROPERTY_WORDS, STRUCTS } from './tables.js';

const KINDS = Object.keys(ENUMS.kind);

// Bits 8 up of a property are what it is of, bit 7 says integer or float.
const kindOf = (property) => KINDS[choice('property', property) >> 8];
const typeOf = (property) => (choice('property', property) & 0x80 ? 'u32' : 'f32');

export class State extends Handle {
  get kind() {
    return 'network';
  }

  // A reading call that fails keeps its message until a call that may change: make one that does nothing.
  check(result) {
    try {
      super.check(result);
    } catch (error) {
      this.core.exports.mspring_network_read_events(this.pointer, 0, 0, this.core.word, 0);
      throw error;
    }
  }

  /* --------------------------------------------------------------------------------------------------- helpers */

  // A struct that the library fills.
  report(name, struct, ...given) {
    return this.core.call(() => {
      const found = this.core.begin(struct);
      this.call(name, ...given, found);
      return this.core.read(struct, found);
    });
  }

  // Numbers that the library writes, by name.
  numbers(name, kind, names, ...given) {
    return this.core.call(() => {
      const found = this.core.room('f64', names.length);
      this.call(name, ...given, ...names.map((_, i) => found + 8 * i));
      return Object.fromEntries(names.map((key, i) => [key, this.core.view(kind, found + 8 * i, 1)[0]]));
    });
  }

  // A call about things of a kind: about those that are named.
  change(name, where, kind, ...given) {
    if (where === undefined) fail(`name the ${kind}; all are { first: 0 }`);
    this.core.call(() => this.call(name, ...this.which(where, kind), ...given));
  }

  // Results as numbers: in an array of the caller's, or a new one.
  copy(kind, length, into, body) {
    const found = this.core.room(kind, length), made = this.core.view(kind, found, 0).constructor;
    if (into !== undefined && !(into instanceof made)) fail(`into must be a ${made.name}`);
    if (into !== undefined && into.length !== length) fail(`into has ${into.length} numbers, it must have ${length}`);
    body(found);
    return this.core.copyOut(kind, found, length, into);
  }

  // Pairs of numbers for particles: a pair for each, or one for all. body gets which they are and where the pairs lie.
  pairs(kind, values, where, body) {
    this.core.call(() => {
      const list = array(kind, values, 'values'), which = this.which(where, 'particles'), length = 2 * which[2];
      if (list.length !== length && list.length !== 2)
        fail(`values has ${list.length} numbers: it must have ${length}, or 2 for all`);
      const x = this.core.copyIn(kind, list);
      body(...which, x, x + (kind === 'f64' ? 8 : 4), list.length === length ? 2 : 0);
    });
  }

  /* ------------------------------------------------------------------------------------- positions, velocities */

  get view() {
    return this.core.call(() => {
      const found = this.core.begin('view'), { core } = this;
      this.call('get_view', found);
      const view = core.read('view', found);
      for (const [key, [kind, offset]] of Object.entries(STRUCTS.view.fields))
        if (kind.endsWith('*'))
          view[key] = core.view(kind.slice(0, -1), core.data.getUint32(found + offset, true),
            key === 'slotOfParticle' ? view.particleCount : view.slotCount);
      return view;
    });
  }

  get stateHash() {
    this.call('get_state_hash', this.core.word);
    return this.core.data.getBigUint64(this.core.word, true);
  }

  positions(where, into) {
    return this.core.call(() => {
      const which = this.which(where, 'particles');
      return this.copy('f64', 2 * which[2], into, (found) => this.call('get_positions', ...which, found, found + 8, 2));
    });
  }

  velocities(where, into) {
    return this.get(['vx', 'vy'], where, into);
  }

  setPositions(values, where) {
    this.pairs('f64', values, where, (...given) => this.call('set_positions', ...given));
  }

  setVelocities(values, where) {
    this.pairs('f32', values, where, (...given) => this.call('set_velocities', ...given));
  }

  applyForce(particle, x, y) {
    this.call('apply_force', whole(particle, 'particle'), number(x, 'x'), number(y, 'y'));
  }

  applyForces(values, where, push = 'step') {
    const how = choice('push', push);
    this.pairs('f32', values, where, (...given) => this.call('apply_forces', how, ...given));
  }

  applyTorque(torque, where) {
    this.core.call(() => this.call('apply_torque', ...this.which(where, 'particles'), number(torque, 'torque')));
  }

  /* ------------------------------------------------------------------------------------------------ properties */

  // Read properties: place(i, count) is where column i begins.
  #read(properties, which, stride, place) {
    const columns = properties.flatMap((property, i) => [ENUMS.property[property], stride, place(i)]);
    this.call('get_columns', ...which, this.core.copyIn('u32', columns), properties.length);
  }

  // One, or several by turns: x, y of one thing after the other.
  get(property, where, into) {
    const all = isArray(property) ? property : [property], type = typeOf(all[0]), stride = all.length;
    for (const one of all) if (typeOf(one) !== type) fail(`${all[0]} and ${one} do not fit into one array: use columns`);
    return this.core.call(() => {
      const which = this.which(where, kindOf(all[0]));
      return this.copy(type, stride * which[2], into, (found) => this.#read(all, which, stride, (i) => found + 4 * i));
    });
  }

  columns(properties, where) {
    if (!isArray(properties)) fail('properties must be an array');
    return this.core.call(() => {
      const which = this.which(where, kindOf(properties[0])), count = which[2];
      const places = properties.map((property) => this.core.room(typeOf(property), count));
      this.#read(properties, which, 1, (i) => places[i]);
      return Object.fromEntries(properties.map((property, i) =>
        [property, this.core.copyOut(typeOf(property), places[i], count)]));
    });
  }

  set(property, values, where) {
    const index = choice('property', property), type = typeOf(property), single = !isArray(values);
    this.core.call(() => {
      const which = this.which(where, kindOf(property));
      const list = array(type, single ? [spoken(values, PROPERTY_WORDS[property], property)] : values, property);
      if (!single && list.length !== which[2]) fail(`values has ${list.length} numbers, it must have ${which[2]}`);
      const given = [index, ...which, this.core.copyIn(type, list), single ? 0 : 1];
      if (type === 'u32') this.call('set_integers', ...given);
      else this.call('set', ...given);
    });
  }
}
