// What a network is made of.
import { array, fail, Handle, number, whole } from './core.js';

function create(core) {
  core.check(core.exports.massspring_builder(core.word));
  return core.data.getUint32(core.word, true);
}

export class Builder extends Handle {
  constructor(core) {
    super(core, create(core));
  }

  get kind() {
    return 'builder';
  }

  // What fails is thrown at once, and so forgotten.
  check(result) {
    try {
      super.check(result);
    } catch (error) {
      this.core.exports.mspring_builder_forget_error(this.pointer);
      throw error;
    }
  }

  #make(name, struct, options) {
    const [firstParticle, firstSpring] = this.core.call(() => this.words(name, this.core.write(struct, options)));
    return { firstParticle, firstSpring };
  }

  // A call that fills ids.
  #list(count, body) {
    return this.core.call(() => {
      const found = this.core.room('u32', count);
      body(found);
      return this.core.copyOut('u32', found, count);
    });
  }

  // Definitions, as they would be added again.
  #definitions(struct, kind, where, body) {
    return this.core.call(() => {
      const which = this.which(where, kind), found = this.core.begin(struct, which[2]);
      body(...which, found);
      return this.core.readAll(struct, found, which[2]);
    });
  }

  particles(where) {
    return this.#definitions('particle_def', 'particles', where, (...given) => this.call('get_particles', ...given));
  }

  springs(where) {
    return this.#definitions('spring_def', 'springs', where, (...given) => this.call('get_springs', ...given));
  }

  addParticles(columns) {
    return this.core.call(() => {
      const { pointer, count } = this.core.columns('particle_def', columns);
      return this.words('add_particles', pointer, count)[0];
    });
  }

  addSprings(columns) {
    return this.core.call(() => {
      const { pointer, count } = this.core.columns('spring_def', columns);
      return this.words('add_springs', pointer, count)[0];
    });
  }

  addLattice(options) {
    return this.core.call(() => {
      const count = whole(options?.width, 'width') * whole(options.height, 'height');
      const def = this.core.write('lattice_def', options); // before room for as many ids
      return this.#list(count, (found) => this.call('add_lattice', def, found));
    });
  }

  addRope(options) {
    let firstSpring;
    const particles = this.#list(whole(options?.segmentCount ?? 1, 'segmentCount') + 1, (found) => {
      [firstSpring] = this.words('add_rope', this.core.write('rope_def', options), found);
    });
    return { particles, firstSpring };
  }

  addMesh(options) {
    if (!options?.x || !options.y || !options.triangles) fail('a mesh needs x, y and triangles');
    return this.#make('add_mesh', 'mesh_def', options);
  }

  addDisc(options) {
    return this.#make('add_disc', 'disc_def', options);
  }

  addCopies(from, places) {
    if (!(from instanceof Builder) || from.core !== this.core) fail('copies need a Builder of the same module');
    const list = array('f64', places, 'places');
    if (list.length % 2) fail(`places has ${list.length} numbers: it must have x, y of each copy`);
    const [firstParticle, firstSpring] = this.core.call(() => {
      const x = this.core.copyIn('f64', list);
      return this.words('add_copies', from.pointer, list.length / 2, x, x + 8, 2);
    });
    return { firstParticle, firstSpring };
  }

  addNetwork(network, where) {
    if (network?.kind !== 'network' || network.core !== this.core) fail('this needs a Network of the same module');
    let springs;
    const particles = this.#list(network.particleCount, (found) => {
      springs = this.#list(network.springCount, (others) =>
        this.call('add_network', network.pointer, ...network.which(where, 'particles'), found, others));
    });
    return { particles, springs };
  }

  addStrainLimits(strain, stiffening, where) {
    return this.core.call(() => this.words('add_strain_limits', ...this.which(where, 'springs'), number(strain, 'strain'),
      number(stiffening, 'stiffening'))[0]);
  }

  read(archive) {
    return this.core.call(() => this.words('read', this.core.bytesIn(archive, 'an archive'), archive.length)[0]);
  }

  // Fill a network's definition.
  define(def) {
    this.call('get_network_def', def);
  }
}
