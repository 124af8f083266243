/**
 * libmassspring: two-dimensional networks of masses, springs and dampers.
 *
 * Units are SI, the y axis points up. Particles and springs have ids 0, 1, 2 ... in the order in which they were added.
 * A call that fails throws a MassSpringError and changes nothing. The headers of the library are its manual: a function
 * mspring_network_get_positions is network.positions here, and a field rest_length is restLength.
 */
import type {
  AngleInfo, AngleOptions, AreaInfo, AreaOptions, Body, ColliderOptions, Component, ContactEvent, ContactInfo,
  ContactOptions, DiscOptions, FloorOptions, GripOptions, LatticeOptions, Material, MeshOptions, NetworkEvent,
  NetworkOptions, Numbering, ParticleOptions, Plan, Plasticity, Preset, Property, Result, RopeOptions, Settings,
  SettleOptions, SettleResult, SnapshotContents, SolverOptions, SpringOptions, StepInfo,
} from './tables.js';

export * from './tables.js';

/** Numbers, as an array or as a typed array. */
export type Numbers = ArrayLike<number>;

/** Of each field a number for all, or an array with one for each. At least one must be an array. */
export type Columns<T> = { [Field in keyof T]?: NonNullable<T[Field]> | Numbers };

/** The particles or springs from first on. Without count: all of them, or as many as there are values. */
export interface IdRange {
  first?: number;
  count?: number;
}

/** A range, or those listed. */
export type Selection = IdRange & { ids?: Numbers | number };

/** Options that were read: all fields have values. */
export type Full<T> = { [Field in keyof T]-?: NonNullable<T[Field]> };

/** A call that failed. */
export class MassSpringError extends Error {
  /** The library's result without its prefix: 'argument', 'id', 'unstable' ... */
  readonly result: Result;
  /** The same as a number, below 0. */
  readonly code: number;
  /** Ids that the message names. */
  readonly particles: number[];
  readonly springs: number[];
  /** Steps that a call of step() has made before the one that failed. */
  readonly steps: number;
}

/** Collects particles and springs. It can make any number of networks, and is not needed after that. */
export interface Builder {
  readonly particleCount: number;
  readonly springCount: number;
  /** Returns the id. */
  addParticle(options: ParticleOptions): number;
  /** Returns the id of the first. */
  addParticles(columns: Columns<ParticleOptions>): number;
  addSpring(options: SpringOptions): number;
  addSprings(columns: Columns<SpringOptions>): number;
  /** Returns the particle of each cell, or NONE. */
  addLattice(options: LatticeOptions): Uint32Array;
  /** Returns the particles along the rope, both ends included. */
  addRope(options: RopeOptions): { particles: Uint32Array; firstSpring: number };
  /** Have springs stiffen beyond a strain: above 0 of stretching, below 0 of pressing. Returns the first limit's id. */
  addStrainLimits(firstSpring: number, count: number, strain: number, stiffening: number): number;
  addMesh(options: MeshOptions): { firstParticle: number; firstSpring: number };
  addDisc(options: DiscOptions): { firstParticle: number; firstSpring: number };
  /**
   * Read an archive of Network.write() into an empty builder. A network made of it continues where the written one was;
   * its options override the archived ones. Returns the number of chunks that were skipped as unknown.
   */
  read(archive: Uint8Array): number;
  /** Frees it now. Otherwise the garbage collector does so some time. */
  free(): void;
}

/**
 * The state as it lies in memory, by slot. Read it at once: the arrays follow the steps, but any call of this module that
 * takes memory may leave them empty. To keep values, use positions() and velocities().
 */
export interface View {
  readonly slotCount: number;
  readonly particleCount: number;
  readonly layoutGeneration: number;
  readonly originGeneration: number;
  /** World position = origin + (x, y), m. */
  readonly originX: number;
  readonly originY: number;
  readonly x: Float32Array;
  readonly y: Float32Array;
  readonly vx: Float32Array;
  readonly vy: Float32Array;
  readonly inverseMass: Float32Array;
  readonly particleOfSlot: Uint32Array;
  readonly slotOfParticle: Uint32Array;
}

/** Particles and springs that move. */
export interface Network {
  readonly particleCount: number;
  readonly springCount: number;
  readonly isAsleep: boolean;
  /** Bytes that the network uses. */
  readonly memoryUsed: number;
  /** Frees it now. Otherwise the garbage collector does so some time. */
  free(): void;

  /**
   * Takes count steps of dt seconds. If one fails, the error says how many were made before it. Pass equal dt: if it
   * differs from step to step and little damps, explicit steps add energy.
   */
  step(dt: number, count?: number): void;
  stepInfo(): StepInfo;
  getSettings(): Full<Settings>;
  /** Sets those that are given; the others stay. */
  setSettings(options: Settings): void;
  getSolver(): Full<SolverOptions>;
  /** Sets those that are given; the others stay. */
  setSolver(options: SolverOptions): void;
  wake(): void;

  view(): View;
  /** A copy of world positions, m: x, y of one particle after the other. */
  positions<T extends Float64Array | Float32Array = Float64Array>(options?: Selection & { into?: T }): T;
  /** A copy of velocities, m/s. Explicit steps leave those of half a substep ago. */
  velocities(options?: Selection & { into?: Float32Array }): Float32Array;
  /** x, y for each particle, or one pair for all. */
  setPositions(values: Numbers, where?: Selection): void;
  setVelocities(values: Numbers, where?: Selection): void;
  /** Adds a force, N, during the whole next step. */
  applyForce(particle: number, x: number, y: number): void;
  applyForces(values: Numbers, where?: Selection): void;
  /** Changes velocities at once, by impulse / mass. */
  applyImpulses(values: Numbers, where?: Selection): void;
  /** Forces around the centre of mass during the next step, N m. */
  applyTorque(torque: number, where?: Selection): void;
  /** Equal states have equal hashes on every machine, in every language. */
  stateHash(): bigint;

  get(property: Property, options?: Selection & { into?: Float32Array }): Float32Array;
  /** A value for each, or one for all. */
  set(property: Property, values: Numbers | number, where?: Selection): void;
  /** get('strain') */
  strains(options?: Selection & { into?: Float32Array }): Float32Array;
  maxStrain(): { strain: number; spring: number };
  /** Both ends of one spring after the other, as for an index buffer. With 'slots' they fit a view. */
  ends(options?: IdRange & { numbering?: Numbering; into?: Uint32Array }): Uint32Array;
  springFlags(options?: IdRange & { into?: Uint32Array }): Uint32Array;

  breakSprings(ids: Numbers | number): void;
  /** With a ramp, the rest length goes evenly from the present length to its own. */
  restoreSprings(ids: Numbers | number, rampSeconds?: number): void;
  detachParticles(ids: Numbers | number): void;
  pin(ids: Numbers | number): void;
  unpin(ids: Numbers | number): void;
  /** Needs room: spareParticles and spareSprings of NetworkOptions. Returns the ids. */
  addParticles(columns: Columns<ParticleOptions>): Uint32Array;
  addSprings(columns: Columns<SpringOptions>): Uint32Array;
  removeParticles(ids: Numbers | number): void;
  removeSprings(ids: Numbers | number): void;
  recycle(): void;
  hasParticle(id: number): boolean;
  hasSpring(id: number): boolean;
  compact(): void;
  expand(): void;

  /** Events are recorded from then on, so many at most. */
  reserveEvents(capacity: number): void;
  /** Reads and removes the oldest events. lost: how many the queue had no room for. */
  readEvents(most?: number): { events: NetworkEvent[]; lost: number };
  updateComponents(): { count: number; changed: boolean };
  componentNumbers(options?: IdRange & { into?: Uint32Array }): Uint32Array;
  components(first: number, count: number): Component[];

  energy(): { kinetic: number; elastic: number; potential: number };
  momentum(): { x: number; y: number; angular: number };
  /** Particles as one body. The angle is 0 without NETWORK_POSES. */
  body(where?: Selection): Body;
  bounds(): { minX: number; minY: number; maxX: number; maxY: number };
  /** The longest stable explicit substep, s, in the present shape and in any shape. */
  stableDt(): { now: number; anyShape: number };
  suggestSubsteps(dt: number, safety?: number): number;
  /** Moves the network to its static equilibrium. */
  settle(options?: SettleOptions): SettleResult;
  plan(): Plan;

  nearestParticle(x: number, y: number, within?: number): { particle: number; distance: number } | null;
  particlesInCircle(x: number, y: number, radius: number): Uint32Array;
  particlesInBox(minX: number, minY: number, maxX: number, maxY: number): Uint32Array;
  /** flags: FIND_WHOLE, the default, FIND_BROKEN or both. */
  nearestSpring(x: number, y: number, within?: number, flags?: number): { spring: number; fraction: number; distance: number } | null;
  springsInCircle(x: number, y: number, radius: number, flags?: number): Uint32Array;
  springsAcross(fromX: number, fromY: number, toX: number, toY: number, flags?: number): Uint32Array;

  /** null: no floor. */
  setFloor(options: FloorOptions | null): void;
  floorImpulses(options?: IdRange & { into?: Float32Array }): Float32Array;
  /** Bodies collide from then on; null: no more. */
  setContact(options: ContactOptions | null): void;
  getContact(): Full<ContactOptions> | null;
  setContactGroups(groups: number, masks: number, where?: IdRange): void;
  setContactSurface(surface: { friction?: number; restitution?: number }, where?: IdRange): void;
  contactInfo(): ContactInfo;
  /** Contact events are recorded from then on, so many at most. */
  reserveContactEvents(capacity: number): void;
  readContactEvents(most?: number): { events: ContactEvent[]; lost: number };
  /** Returns the id of the collider. */
  addCollider(options: ColliderOptions): number;
  removeCollider(collider: number): void;
  /** Sets where it is to be at the end of the next step. */
  moveCollider(collider: number, x: number, y: number, angle?: number): void;
  /** Puts it somewhere else at once. */
  placeCollider(collider: number, x: number, y: number, angle?: number): void;
  getCollider(collider: number): Full<Omit<ColliderOptions, 'points'>>;
  colliderImpulse(collider: number): { x: number; y: number; angular: number };
  /** Holds a particle softly, as a mouse does. Returns the id of the grip. */
  addGrip(options: GripOptions): number;
  removeGrip(grip: number): void;
  setGrip(grip: number, options: GripOptions): void;
  moveGrip(grip: number, x: number, y: number): void;
  getGrip(grip: number): Full<GripOptions>;
  gripImpulse(grip: number): { x: number; y: number };

  /** How many springs have yielded, and the energy that it took. */
  plasticity(): Plasticity;
  /** An area around a polygon of particles: a balloon, a tyre. Returns its id. */
  addArea(particles: ArrayLike<number>, options?: AreaOptions): number;
  /** An area for each lattice cell, so that jelly turns back. */
  addCellAreas(options?: AreaOptions): { first: number; count: number };
  removeArea(area: number): void;
  /** All fields anew: fill inflates it. */
  setArea(area: number, options: AreaOptions): void;
  getArea(area: number): Full<AreaOptions>;
  areaInfo(area: number): AreaInfo;
  areas(): { ids: Uint32Array; areas: Float64Array; pressures: Float64Array };
  /** Angle springs between a, b, c of each three particles: beams, spines. */
  addAngles(particles: ArrayLike<number>, options?: AngleOptions): { first: number; count: number };
  removeAngle(angle: number): void;
  setAngle(angle: number, options: AngleOptions): void;
  /** Rest angles of one after the other, rad: muscles, servos. */
  setRestAngles(first: number, restAngles: ArrayLike<number>): void;
  getAngle(angle: number): Full<AngleOptions>;
  angleInfo(angle: number): AngleInfo;
  angles(): { ids: Uint32Array; angles: Float64Array; torques: Float64Array };

  /** A snapshot, for rollback and replay: the following steps repeat, bit for bit. */
  save(contents?: SnapshotContents): Uint8Array;
  load(snapshot: Uint8Array): void;
  /** Return an archive, for files: all but unread events. This and later versions read it, see Builder.read(). */
  write(): Uint8Array;
  clone(): Network;
}

/** One instance of the library, with memory of its own. */
export interface MassSpring {
  readonly version: string;
  /** Whether the module with SIMD runs. The bits are the same without. */
  readonly simd: boolean;
  /** Bytes of memory of the module. It grows and never shrinks, but what is freed is used again. */
  readonly memoryUsed: number;
  readonly Builder: new () => Builder;
  readonly Network: new (builder: Builder, options?: NetworkOptions) => Network;
  /** A material that looks like steel, wood, rubber or jelly. substep is dt / substeps, s. */
  material(preset: Preset, spacing: number, substep: number): Full<Material>;
}

export interface LoadOptions {
  /** false: the module without SIMD, even where there is SIMD. */
  simd?: boolean;
  /** The module itself, where the package cannot find it: one of massspring.wasm and massspring_scalar.wasm. */
  wasm?: BufferSource | WebAssembly.Module | Response | Promise<BufferSource | WebAssembly.Module | Response>;
}

/** Loads the module, with SIMD where there is SIMD. */
export function load(options?: LoadOptions): Promise<MassSpring>;
