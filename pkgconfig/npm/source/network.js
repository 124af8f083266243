// A network: made, stepped, edited, measured and saved.
import { array, choice, fail, MassSpringError, number, whole } from './core.js';
import { Builder } from './builder.js';
import { Laws } from './laws.js';
import { FIND_WHOLE, NONE, STRUCTS } from './tables.js';

/** A network that exists already. */
export class Made {
  constructor(pointer) {
    this.pointer = pointer;
  }
}

function create(core, builder, options) {
  if (!(builder instanceof Builder) || builder.core !== core) fail('a network needs a Builder of the same module');
  return core.call(() => {
    const { exports } = core, { pointer } = builder, def = core.blank('network_def');
    core.check(exports.mspring_builder_get_network_def(pointer, def), exports.mspring_builder_error(pointer));
    core.overlay('network_def', def, options);
    core.check(exports.massspring_network(pointer, def, core.word), exports.mspring_builder_error(pointer));
    return core.data.getUint32(core.word, true);
  });
}

export class Network extends Laws {
  constructor(core, from, options) {
    super(core, from instanceof Made ? from.pointer : create(core, from, options), core.exports.mspring_network_destroy);
  }

  // A list of ids for a call.
  #list(ids, body) {
    this.run((core, exports, pointer) => {
      const list = array('u32', typeof ids === 'number' ? [ids] : ids, 'ids');
      return body(exports, pointer, core.copyIn('u32', list), list.length);
    });
  }

  /* ------------------------------------------------------------------------------------------ step and settings */

  step(dt, count = 1) {
    const { core } = this;
    const result = core.exports.massspring_steps(this.pointer, number(dt, 'dt'), whole(count, 'count'), core.word);
    if (result >= 0) return;
    const steps = core.data.getUint32(core.word, true);
    try {
      this.check(result);
    } catch (error) {
      if (error instanceof MassSpringError) error.steps = steps;
      throw error;
    }
  }

  stepInfo() {
    return this.report('step_info', (exports, pointer, found) => exports.mspring_network_get_step_info(pointer, found));
  }

  getSettings() {
    return this.report('settings', (exports, pointer, found) => exports.mspring_network_get_settings(pointer, found));
  }

  setSettings(options) {
    this.run((core, exports, pointer) => {
      const found = core.blank('settings');
      this.check(exports.mspring_network_get_settings(pointer, found));
      core.overlay('settings', found, options);
      return exports.mspring_network_set_settings(pointer, found);
    });
  }

  getSolver() {
    return this.report('solver_def', (exports, pointer, found) => exports.mspring_network_get_solver(pointer, found));
  }

  setSolver(options) {
    this.run((core, exports, pointer) => {
      const found = core.blank('solver_def');
      this.check(exports.mspring_network_get_solver(pointer, found));
      core.overlay('solver_def', found, options);
      return exports.mspring_network_set_solver(pointer, found);
    });
  }

  get isAsleep() {
    return this.core.exports.mspring_network_is_asleep(this.pointer) === 1;
  }

  wake() {
    this.check(this.core.exports.mspring_network_wake(this.pointer));
  }

  /* ----------------------------------------------------------------------------------------------------- edits */

  breakSprings(ids) {
    this.#list(ids, (exports, pointer, list, count) => exports.mspring_network_break_springs(pointer, list, count));
  }

  restoreSprings(ids, rampSeconds = 0) {
    number(rampSeconds, 'rampSeconds');
    this.#list(ids, (exports, pointer, list, count) =>
      exports.mspring_network_restore_springs(pointer, list, count, rampSeconds));
  }

  detachParticles(ids) {
    this.#list(ids, (exports, pointer, list, count) => exports.mspring_network_detach_particles(pointer, list, count));
  }

  pin(ids) {
    this.set('inverseMassScale', 0, { ids });
  }

  unpin(ids) {
    this.set('inverseMassScale', 1, { ids });
  }

  #added(name, columns, body) {
    return this.core.call(() => {
      const { pointer, count } = this.core.columns(name, columns), ids = this.core.take(Math.max(1, 4 * count));
      this.check(body(this.core.exports, this.pointer, pointer, count, ids));
      return this.core.copyOut('u32', ids, count);
    });
  }

  addParticles(columns) {
    return this.#added('particle_def', columns, (exports, pointer, defs, count, ids) =>
      exports.mspring_network_add_particles(pointer, defs, count, ids));
  }

  addSprings(columns) {
    return this.#added('spring_def', columns, (exports, pointer, defs, count, ids) =>
      exports.mspring_network_add_springs(pointer, defs, count, ids));
  }

  removeParticles(ids) {
    this.#list(ids, (exports, pointer, list, count) => exports.mspring_network_remove_particles(pointer, list, count));
  }

  removeSprings(ids) {
    this.#list(ids, (exports, pointer, list, count) => exports.mspring_network_remove_springs(pointer, list, count));
  }

  recycle() {
    this.check(this.core.exports.mspring_network_recycle(this.pointer));
  }

  hasParticle(id) {
    return this.core.exports.mspring_network_has_particle(this.pointer, whole(id, 'id')) === 1;
  }

  hasSpring(id) {
    return this.core.exports.mspring_network_has_spring(this.pointer, whole(id, 'id')) === 1;
  }

  compact() {
    this.check(this.core.exports.mspring_network_compact(this.pointer));
  }

  expand() {
    this.check(this.core.exports.mspring_network_expand(this.pointer));
  }

  /* ------------------------------------------------------------------------------------- events and components */

  reserveEvents(capacity) {
    this.check(this.core.exports.mspring_network_reserve_events(this.pointer, whole(capacity, 'capacity')));
  }

  readEvents(most = 1024) {
    const { core } = this;
    return core.call(() => {
      const { size } = STRUCTS.event, found = core.take(Math.max(1, whole(most, 'most')) * size);
      this.check(core.exports.mspring_network_read_events(this.pointer, found, most, core.word, core.word + 8));
      const count = core.data.getUint32(core.word, true), lost = Number(core.data.getBigUint64(core.word + 8, true));
      return { events: Array.from({ length: count }, (_, i) => core.read('event', found + i * size)), lost };
    });
  }

  updateComponents() {
    const [count, changed] = this.numbers('u32', 2, (exports, pointer, ...found) =>
      exports.mspring_network_update_components(pointer, ...found));
    return { count, changed: changed === 1 };
  }

  componentNumbers({ into, ...where } = {}) {
    const { first, count } = this.span(where, this.particleCount);
    return this.read('u32', count, into, [Uint32Array], (found) =>
      this.core.exports.mspring_network_get_component_numbers(this.pointer, first, count, found, 1));
  }

  components(first, count) {
    const { core } = this;
    return core.call(() => {
      const found = core.blank('component', whole(count, 'count'));
      this.check(core.exports.mspring_network_get_components(this.pointer, whole(first, 'first'), count, found));
      return Array.from({ length: count }, (_, i) => core.read('component', found + i * STRUCTS.component.size));
    });
  }

  /* ------------------------------------------------------------------------------------------------- measuring */

  energy() {
    const [kinetic, elastic, potential] = this.numbers('f64', 3, (exports, pointer, ...found) =>
      exports.mspring_network_energy(pointer, ...found));
    return { kinetic, elastic, potential };
  }

  momentum() {
    const [x, y, angular] = this.numbers('f64', 3, (exports, pointer, ...found) =>
      exports.mspring_network_momentum(pointer, ...found));
    return { x, y, angular };
  }

  bounds() {
    const [minX, minY, maxX, maxY] = this.numbers('f64', 4, (exports, pointer, ...found) =>
      exports.mspring_network_bounds(pointer, ...found));
    return { minX, minY, maxX, maxY };
  }

  body(where) {
    return this.report('body', (exports, pointer, found) => {
      const { ids = 0, first = 0, count } = this.range(where, this.particleCount);
      return exports.mspring_network_get_body(pointer, ids, first, count, found);
    });
  }

  stableDt() {
    const [now, anyShape] = this.numbers('f64', 2, (exports, pointer, ...found) =>
      exports.mspring_network_stable_dt(pointer, ...found));
    return { now, anyShape };
  }

  suggestSubsteps(dt, safety = 0.95) {
    return this.numbers('u32', 1, (exports, pointer, found) =>
      exports.mspring_network_suggest_substeps(pointer, number(dt, 'dt'), number(safety, 'safety'), found))[0];
  }

  settle(options) {
    return this.report('settle_result', (exports, pointer, found) =>
      exports.mspring_network_settle(pointer, this.core.write('settle_def', options), found));
  }

  plan() {
    return this.report('plan', (exports, pointer, found) => exports.mspring_network_get_plan(pointer, found));
  }

  get memoryUsed() {
    return this.core.exports.mspring_network_memory_used(this.pointer);
  }

  /* --------------------------------------------------------------------------------------------------- queries */

  nearestParticle(x, y, within = Infinity) {
    const { core } = this;
    this.check(core.exports.mspring_network_nearest_particle(this.pointer, number(x, 'x'), number(y, 'y'),
      number(within, 'within'), core.word, core.word + 8));
    const particle = core.data.getUint32(core.word, true);
    return particle === NONE ? null : { particle, distance: core.data.getFloat64(core.word + 8, true) };
  }

  // Ids of what a query finds: body(ids, capacity, count).
  #found(total, body) {
    const { core } = this;
    return core.call(() => {
      const found = core.take(Math.max(1, total) * 4);
      this.check(body(found, total, core.word));
      return core.copyOut('u32', found, core.data.getUint32(core.word, true));
    });
  }

  particlesInCircle(x, y, radius) {
    return this.#found(this.particleCount, (...found) => this.core.exports.mspring_network_particles_in_circle(
      this.pointer, number(x, 'x'), number(y, 'y'), number(radius, 'radius'), ...found));
  }

  particlesInBox(minX, minY, maxX, maxY) {
    return this.#found(this.particleCount, (...found) => this.core.exports.mspring_network_particles_in_box(
      this.pointer, number(minX, 'minX'), number(minY, 'minY'), number(maxX, 'maxX'), number(maxY, 'maxY'), ...found));
  }

  nearestSpring(x, y, within = Infinity, flags = FIND_WHOLE) {
    const { core } = this;
    return core.call(() => {
      const found = core.take(24);
      this.check(core.exports.mspring_network_nearest_spring(this.pointer, number(x, 'x'), number(y, 'y'),
        number(within, 'within'), whole(flags, 'flags'), found, found + 8, found + 16));
      const spring = core.data.getUint32(found, true);
      return spring === NONE ? null
        : { spring, fraction: core.data.getFloat64(found + 8, true), distance: core.data.getFloat64(found + 16, true) };
    });
  }

  springsInCircle(x, y, radius, flags = FIND_WHOLE) {
    return this.#found(this.springCount, (...found) => this.core.exports.mspring_network_springs_in_circle(
      this.pointer, number(x, 'x'), number(y, 'y'), number(radius, 'radius'), whole(flags, 'flags'), ...found));
  }

  springsAcross(fromX, fromY, toX, toY, flags = FIND_WHOLE) {
    return this.#found(this.springCount, (ids, capacity, count) => this.core.exports.mspring_network_springs_across(
      this.pointer, number(fromX, 'fromX'), number(fromY, 'fromY'), number(toX, 'toX'), number(toY, 'toY'),
      whole(flags, 'flags'), ids, 0, capacity, count));
  }

  /* ------------------------------------------------------------------------------------------ snapshots, clones */

  save(contents = 'all') {
    const { core } = this, index = choice('snapshot_contents', contents);
    return core.call(() => {
      this.check(core.exports.mspring_network_snapshot_size(this.pointer, index, core.word));
      const size = core.data.getUint32(core.word, true), found = core.take(size);
      this.check(core.exports.mspring_network_save(this.pointer, index, found, size, core.word));
      return new Uint8Array(core.memory.buffer, found, core.data.getUint32(core.word, true)).slice();
    });
  }

  load(snapshot) {
    if (!(snapshot instanceof Uint8Array)) fail('a snapshot must be a Uint8Array');
    this.run((core, exports, pointer) => {
      const copy = core.take(Math.max(1, snapshot.length));
      new Uint8Array(core.memory.buffer).set(snapshot, copy);
      return exports.mspring_network_load(pointer, copy, snapshot.length);
    });
  }

  write() {
    const { core } = this;
    return core.call(() => {
      this.check(core.exports.massspring_archive(this.pointer, 0, core.word));
      const size = core.data.getUint32(core.word, true), found = core.take(size);
      this.check(core.exports.massspring_archive(this.pointer, found, core.word));
      return new Uint8Array(core.memory.buffer, found, size).slice();
    });
  }

  clone() {
    const { core } = this;
    this.check(core.exports.mspring_network_clone(this.pointer, 0, core.word));
    return new this.constructor(new Made(core.data.getUint32(core.word, true)));
  }
}
