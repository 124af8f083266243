// What a network is made of.
import { fail, Handle, whole } from './core.js';
import { NONE } from './tables.js';

function create(core) {
  core.check(core.exports.massspring_builder(core.word));
  return core.data.getUint32(core.word, true);
}

export class Builder extends Handle {
  constructor(core) {
    super(core, create(core), core.exports.mspring_builder_destroy);
  }

  get kind() {
    return 'builder';
  }

  get particleCount() {
    return this.core.exports.mspring_builder_particle_count(this.pointer);
  }

  get springCount() {
    return this.core.exports.mspring_builder_spring_count(this.pointer);
  }

  // Call the library with this builder, and return the two ids that it may leave.
  #add(body) {
    const { core, pointer } = this;
    return core.call(() => {
      core.data.setUint32(core.word, NONE, true);
      core.data.setUint32(core.word + 4, NONE, true);
      core.check(body(core, core.exports, pointer, core.word), core.exports.mspring_builder_error(pointer));
      return [core.data.getUint32(core.word, true), core.data.getUint32(core.word + 4, true)];
    });
  }

  addParticle(options) {
    return this.#add((core, exports, pointer, id) =>
      exports.mspring_builder_add_particle(pointer, core.write('particle_def', options), id))[0];
  }

  addParticles(columns) {
    return this.#add((core, exports, pointer, id) => {
      const defs = core.columns('particle_def', columns);
      return exports.mspring_builder_add_particles(pointer, defs.pointer, defs.count, id);
    })[0];
  }

  addSpring(options) {
    return this.#add((core, exports, pointer, id) =>
      exports.mspring_builder_add_spring(pointer, core.write('spring_def', options), id))[0];
  }

  addSprings(columns) {
    return this.#add((core, exports, pointer, id) => {
      const defs = core.columns('spring_def', columns);
      return exports.mspring_builder_add_springs(pointer, defs.pointer, defs.count, id);
    })[0];
  }

  addLattice(options) {
    let ids;
    this.#add((core, exports, pointer) => {
      const count = whole(options?.width, 'width') * whole(options?.height, 'height');
      if (!options.cells || !options.materials) fail('a lattice needs cells and materials');
      const def = core.write('lattice_def', options), found = core.take(4 * Math.max(1, count));
      const result = exports.mspring_builder_add_lattice(pointer, def, found);
      if (result >= 0) ids = core.copyOut('u32', found, count);
      return result;
    });
    return ids;
  }

  addRope(options) {
    let particles;
    const [firstSpring] = this.#add((core, exports, pointer, spring) => {
      const count = whole(options?.segmentCount ?? 1, 'segmentCount') + 1;
      const def = core.write('rope_def', options), found = core.take(4 * count);
      const result = exports.mspring_builder_add_rope(pointer, def, found, count, spring);
      if (result >= 0) particles = core.copyOut('u32', found, count);
      return result;
    });
    return { particles, firstSpring };
  }

  read(archive) {
    if (!(archive instanceof Uint8Array)) fail('an archive must be a Uint8Array');
    let skipped;
    this.#add((core, exports, pointer, found) => {
      const copy = core.take(Math.max(1, archive.length));
      new Uint8Array(core.memory.buffer).set(archive, copy);
      const result = exports.mspring_builder_read(pointer, copy, archive.length, found);
      skipped = core.data.getUint32(found, true);
      return result;
    });
    return skipped;
  }

  addStrainLimits(firstSpring, count, strain, stiffening) {
    return this.#add((core, exports, pointer, id) =>
      exports.mspring_builder_add_strain_limits(pointer, firstSpring, count, strain, stiffening, id))[0];
  }

  addMesh(options) {
    const [firstParticle, firstSpring] = this.#add((core, exports, pointer, ids) => {
      if (!options?.x || !options.y || !options.triangles) fail('a mesh needs x, y and triangles');
      return exports.mspring_builder_add_mesh(pointer, core.write('mesh_def', options), ids, ids + 4);
    });
    return { firstParticle, firstSpring };
  }

  addDisc(options) {
    const [firstParticle, firstSpring] = this.#add((core, exports, pointer, ids) =>
      exports.mspring_builder_add_disc(pointer, core.write('disc_def', options), ids, ids + 4));
    return { firstParticle, firstSpring };
  }
}
