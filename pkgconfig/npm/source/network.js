// A network: made, stepped, edited, measured and saved.
import { choice, fail, MassSpringError, number, whole } from './core.js';
import { Builder } from './builder.js';
import { Laws } from './laws.js';
import { FIND_WHOLE, STRUCTS } from './tables.js';

/** A network that exists already. */
export class Made {
  constructor(pointer) {
    this.pointer = pointer;
  }
}

function create(core, builder, settings, options) {
  if (!(builder instanceof Builder) || builder.core !== core) fail('a network needs a Builder of the same module');
  return core.call(() => {
    const def = core.begin('network_def');
    builder.define(def);
    core.overlay('network_def', def, options);
    core.overlay('settings', def + STRUCTS.network_def.settings, settings);
    builder.check(core.exports.massspring_network(builder.pointer, def, core.word));
    return core.data.getUint32(core.word, true);
  });
}

export class Network extends Laws {
  constructor(core, from, settings, options) {
    super(core, from instanceof Made ? from.pointer : create(core, from, settings, options));
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

  get stepInfo() {
    return this.report('get_step_info', 'step_info');
  }

  get info() {
    return this.report('get_info', 'network_info');
  }

  get settings() {
    return this.report('get_settings', 'settings');
  }

  setSettings(settings) {
    const { core } = this;
    core.call(() => {
      const found = core.begin('settings');
      this.call('get_settings', found);
      core.overlay('settings', found, settings);
      this.call('set_settings', found);
    });
  }

  wake() {
    this.call('wake');
  }

  /* ----------------------------------------------------------------------------------------------------- edits */

  breakSprings(where) {
    this.change('break_springs', where, 'springs');
  }

  restoreSprings(where, rampSeconds = 0) {
    this.change('restore_springs', where, 'springs', number(rampSeconds, 'rampSeconds'));
  }

  detachParticles(where) {
    this.change('detach_particles', where, 'particles');
  }

  removeParticles(where) {
    this.change('remove_particles', where, 'particles');
  }

  removeSprings(where) {
    this.change('remove_springs', where, 'springs');
  }

  #add(struct, columns, body) {
    return this.core.call(() => {
      const { pointer, count } = this.core.columns(struct, columns);
      return this.copy('u32', count, undefined, (found) => body(pointer, count, found));
    });
  }

  addParticles(columns) {
    return this.#add('particle_def', columns, (...given) => this.call('add_particles', ...given));
  }

  addSprings(columns) {
    return this.#add('spring_def', columns, (...given) => this.call('add_springs', ...given));
  }

  reuseIds() {
    this.call('reuse_ids');
  }

  compact() {
    this.call('compact');
  }

  /* ------------------------------------------------------------------------------------- events and components */

  reserveEvents(capacity) {
    this.call('reserve_events', whole(capacity, 'capacity'));
  }

  readEvents(most = 1024) {
    return this.events('event', most, (...given) => this.call('read_events', ...given));
  }

  updateComponents() {
    const [count, changed] = this.words('update_components');
    return { count, changed: changed === 1 };
  }

  components(first, count) {
    const { core } = this;
    return core.call(() => {
      const found = core.begin('body', whole(count, 'count'));
      this.call('get_components', whole(first, 'first'), count, found);
      return core.readAll('body', found, count);
    });
  }

  /* ------------------------------------------------------------------------------------------------- measuring */

  get energy() {
    return this.report('get_energy', 'energy');
  }

  body(where) {
    return this.core.call(() => this.report('get_body', 'body', ...this.which(where, 'particles')));
  }

  get stableDt() {
    return this.numbers('get_stable_dt', 'f64', ['now', 'anyShape']);
  }

  suggestSubsteps(dt, safety = 0.95) {
    return this.words('suggest_substeps', number(dt, 'dt'), number(safety, 'safety'))[0];
  }

  settle(options) {
    return this.core.call(() => this.report('settle', 'settle_result', this.core.write('settle_def', options)));
  }

  describe() {
    const { core } = this;
    return core.call(() => {
      const [size] = this.words('describe', 0, 0), text = core.take(size);
      this.call('describe', text, size, 0);
      return core.text(text);
    });
  }

  /* --------------------------------------------------------------------------------------------------- queries */

  // Ids of what a query finds: body(ids, capacity, count).
  #found(total, body) {
    const { core } = this;
    return core.call(() => {
      const found = core.room('u32', total);
      body(found, total, core.word);
      return core.copyOut('u32', found, core.data.getUint32(core.word, true));
    });
  }

  nearestParticle(x, y, within = Infinity) {
    const { core } = this;
    this.call('nearest_particle', number(x, 'x'), number(y, 'y'), number(within, 'within'), core.word, core.word + 8);
    const distance = core.data.getFloat64(core.word + 8, true);
    return distance === Infinity ? null : { particle: core.data.getUint32(core.word, true), distance };
  }

  nearestSpring(x, y, within = Infinity, flags = FIND_WHOLE) {
    const { core } = this;
    this.call('nearest_spring', number(x, 'x'), number(y, 'y'), number(within, 'within'), whole(flags, 'flags'), core.word,
      core.word + 8, core.word + 16);
    const distance = core.data.getFloat64(core.word + 16, true);
    return distance === Infinity ? null
      : { spring: core.data.getUint32(core.word, true), fraction: core.data.getFloat64(core.word + 8, true), distance };
  }

  particlesInCircle(x, y, radius) {
    return this.#found(this.particleCount, (...found) =>
      this.call('particles_in_circle', number(x, 'x'), number(y, 'y'), number(radius, 'radius'), ...found));
  }

  particlesInBox(minX, minY, maxX, maxY) {
    return this.#found(this.particleCount, (...found) => this.call('particles_in_box', number(minX, 'minX'),
      number(minY, 'minY'), number(maxX, 'maxX'), number(maxY, 'maxY'), ...found));
  }

  springsInCircle(x, y, radius, flags = FIND_WHOLE) {
    return this.#found(this.springCount, (...found) => this.call('springs_in_circle', number(x, 'x'), number(y, 'y'),
      number(radius, 'radius'), whole(flags, 'flags'), ...found));
  }

  springsAcross(fromX, fromY, toX, toY, flags = FIND_WHOLE) {
    return this.#found(this.springCount, (ids, capacity, count) => this.call('springs_across', number(fromX, 'fromX'),
      number(fromY, 'fromY'), number(toX, 'toX'), number(toY, 'toY'), whole(flags, 'flags'), ids, 0, capacity, count));
  }

  /* ------------------------------------------------------------------------------------------ snapshots, clones */

  save(contents = 'all') {
    const { core } = this, index = choice('snapshot_contents', contents);
    return core.call(() => {
      const [size] = this.words('get_snapshot_size', index), found = core.take(size);
      this.call('save', index, found, size, core.word);
      return core.bytesOut(found, core.data.getUint32(core.word, true));
    });
  }

  load(snapshot) {
    this.core.call(() => this.call('load', this.core.bytesIn(snapshot, 'a snapshot'), snapshot.length));
  }

  write() {
    const { core } = this;
    return core.call(() => {
      this.check(core.exports.massspring_archive(this.pointer, 0, core.word));
      const size = core.data.getUint32(core.word, true), found = core.take(size);
      this.check(core.exports.massspring_archive(this.pointer, found, core.word));
      return core.bytesOut(found, size);
    });
  }

  clone() {
    const [pointer] = this.words('clone', 0);
    return new this.constructor(new Made(pointer));
  }
}
