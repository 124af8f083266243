/**
 * libmassspring: two-dimensional networks of masses, springs and dampers.
 *
 * Units are SI, the y axis points up. Particles and springs have ids 0, 1, 2 ... in the order in which they were added.
 * A call that fails throws a MassSpringError and changes nothing. The headers of the library are its manual: a function
 * mspring_network_get_positions is network.positions here, and a field rest_length is restLength. What takes no argument
 * and changes nothing is a property, such as network.energy.
 */
import type {
  AngleOptions, AreaOptions, AutoProperty, Body, ColliderOptions, ContactEvent, ContactInfo, ContactOptions, DiscOptions,
  ElementProperty, Energy, FloorOptions, GripOptions, IntegerProperty, LatticeOptions, Material, MeshOptions, NetworkEvent,
  NetworkInfo, NetworkOptions, ParticleOptions, ParticleProperty, Preset, Property, Push, ReadOnlyProperty, Result,
  RopeOptions, Settings, SettleOptions, SettleResult, SnapshotContents, SpringOptions, SpringProperty, StepInfo,
} from './tables.js';

export * from './tables.js';

/** Numbers, as an array or as a typed array. */
export type Numbers = ArrayLike<number>;

/** Of each field a number for all, or an array with one for each. Numbers alone are one. */
export type Columns<T> = { [Field in keyof T]: T[Field] | Numbers };

/** Which particles, springs or elements: one, those listed, or a range. Without first or count: from 0, to the end. */
export type Which = number | Numbers | { first?: number; count?: number };

/** Options that were read: all fields have values. */
export type Full<T> = { [Field in keyof T]-?: NonNullable<T[Field]> };

/** What a property is read into. */
export type ArrayOf<P extends Property> = P extends IntegerProperty ? Uint32Array : Float32Array;

type Alike<P, All> = [P] extends [All] ? P : never;
/** Properties of one kind of thing. */
export type OneKind<P> = Alike<P, ParticleProperty> | Alike<P, SpringProperty> | Alike<P, ElementProperty>;
/** Properties of one kind that fit into one array. */
export type OneType<P> = OneKind<P> & (Alike<P, IntegerProperty> | Alike<P, Exclude<Property, IntegerProperty>>);

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
  readonly elementCount: number;
  /** Returns the id of the first. */
  addParticles(columns: Columns<ParticleOptions>): number;
  addSprings(columns: Columns<SpringOptions>): number;
  /** Reads them back, as they would be added again. */
  particles(which?: Which): Full<ParticleOptions>[];
  springs(which?: Which): Full<SpringOptions>[];
  /** Returns the particle of each cell, or NONE. */
  addLattice(options: LatticeOptions): Uint32Array;
  /** Returns the particles along the rope, both ends included. */
  addRope(options: RopeOptions): { particles: Uint32Array; firstSpring: number };
  addMesh(options: MeshOptions): { firstParticle: number; firstSpring: number };
  addDisc(options: DiscOptions): { firstParticle: number; firstSpring: number };
  /** Adds another builder's particles and springs once for each x, y that they are moved by. */
  addCopies(from: Builder, places: Numbers): { firstParticle: number; firstSpring: number };
  /** Adds what a network has now. Returns the new id of each of its particles and springs, or NONE. */
  addNetwork(network: Network, which?: Which): { particles: Uint32Array; springs: Uint32Array };
  /** Have springs stiffen beyond a strain: above 0 of stretching, below 0 of pressing. Returns the first limit's id. */
  addStrainLimits(strain: number, stiffening: number, which?: Which): number;
  /**
   * Read an archive of Network.write() into an empty builder. A network made of it continues where the written one was;
   * its settings override the archived ones. Returns the number of chunks that were skipped as unknown.
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
  readonly elementCount: number;
  /** Frees it now. Otherwise the garbage collector does so some time. */
  free(): void;

  /**
   * Takes count steps of dt seconds. If one fails, the error says how many were made before it. Pass equal dt: if it
   * differs from step to step and little damps, explicit steps add energy.
   */
  step(dt: number, count?: number): void;
  /** Report of the last step, and of all so far. */
  readonly stepInfo: StepInfo;
  /** How the network is laid out and run. */
  readonly info: NetworkInfo;
  /** The same in many more words, which may change. */
  describe(): string;
  readonly settings: Full<Settings>;
  /** Sets those that are given; the others stay. */
  setSettings(settings: Settings): void;
  wake(): void;

  readonly view: View;
  /** A copy of world positions, m: x, y of one particle after the other. For drawing, get(['x', 'y']) has floats. */
  positions(which?: Which, into?: Float64Array): Float64Array;
  /** A copy of velocities, m/s. Explicit steps leave those of half a substep ago. */
  velocities(which?: Which, into?: Float32Array): Float32Array;
  /** x, y for each particle, or one pair for all. */
  setPositions(values: Numbers, which?: Which): void;
  setVelocities(values: Numbers, which?: Which): void;
  /** Adds a force, N, during the whole next step. */
  applyForce(particle: number, x: number, y: number): void;
  /** Adds forces, N, of the whole next step or its first substep, or impulses, N s, which change velocities at once. */
  applyForces(values: Numbers, which?: Which, push?: Push): void;
  /** Forces around the centre of mass during the next step, N m. */
  applyTorque(torque: number, which?: Which): void;
  /** Equal states have equal hashes on every machine, in every language. */
  readonly stateHash: bigint;

  /** Integers are in a Uint32Array, all else in a Float32Array. Several properties come by turns, as for a buffer. */
  get<P extends Property>(property: P, which?: Which, into?: ArrayOf<P>): ArrayOf<P>;
  get<P extends Property>(properties: readonly (P & OneType<P>)[], which?: Which, into?: ArrayOf<P>): ArrayOf<P>;
  /** Several properties in one pass, each in an array of its own. */
  columns<P extends Property>(properties: readonly (P & OneKind<P>)[], which?: Which): { [Name in P]: ArrayOf<Name> };
  /** A value for each, or one for all. A scale of 0 pins: set('inverseMassScale', 0, ids). */
  set(property: Exclude<Property, ReadOnlyProperty>, values: Numbers | number, which?: Which): void;
  set(property: AutoProperty, value: 'auto', which?: Which): void;

  breakSprings(which: Which): void;
  /** With a ramp, the rest length goes evenly from the present length to its own. */
  restoreSprings(which: Which, rampSeconds?: number): void;
  detachParticles(which: Which): void;
  /** Needs room: spareParticles and spareSprings of NetworkOptions. Returns the ids. */
  addParticles(columns: Columns<ParticleOptions>): Uint32Array;
  addSprings(columns: Columns<SpringOptions>): Uint32Array;
  removeParticles(which: Which): void;
  removeSprings(which: Which): void;
  reuseIds(): void;
  compact(): void;

  /** Events are recorded from then on, so many at most. */
  reserveEvents(capacity: number): void;
  /** Reads and removes the oldest events. lost: how many the queue had no room for. */
  readEvents(most?: number): { events: NetworkEvent[]; lost: number };
  updateComponents(): { count: number; changed: boolean };
  components(first: number, count: number): Body[];

  /** Energies, the fastest particle and the most strained spring. */
  readonly energy: Energy;
  /** Particles as one body: all, if none are named. The angle is 0 without NETWORK_POSES. */
  body(which?: Which): Body;
  /** The longest stable explicit substep, s, in the present shape and in any shape. */
  readonly stableDt: { now: number; anyShape: number };
  suggestSubsteps(dt: number, safety?: number): number;
  /** Moves the network to its static equilibrium. */
  settle(options?: SettleOptions): SettleResult;

  nearestParticle(x: number, y: number, within?: number): { particle: number; distance: number } | null;
  particlesInCircle(x: number, y: number, radius: number): Uint32Array;
  particlesInBox(minX: number, minY: number, maxX: number, maxY: number): Uint32Array;
  /** flags: FIND_WHOLE, the default, FIND_BROKEN or both. */
  nearestSpring(x: number, y: number, within?: number, flags?: number): { spring: number; fraction: number; distance: number } | null;
  springsInCircle(x: number, y: number, radius: number, flags?: number): Uint32Array;
  springsAcross(fromX: number, fromY: number, toX: number, toY: number, flags?: number): Uint32Array;

  /** null: no floor. */
  readonly floor: FloorOptions | null;
  setFloor(options: FloorOptions | null): void;
  readonly contact: Full<ContactOptions> | null;
  /** Bodies collide from then on; null: no more. */
  setContact(options: ContactOptions | null): void;
  readonly contactInfo: ContactInfo;
  /** Those that began or ended, as many as eventCapacity of ContactOptions lets wait. */
  readContactEvents(most?: number): { events: ContactEvent[]; lost: number };
  /** Returns the id of the collider. */
  addCollider(options: ColliderOptions): number;
  removeCollider(collider: number): void;
  /** Sets where it is to be at the end of the next step. */
  moveCollider(collider: number, x: number, y: number, angle?: number): void;
  /** Puts it somewhere else at once. */
  placeCollider(collider: number, x: number, y: number, angle?: number): void;
  collider(collider: number): Full<Omit<ColliderOptions, 'points'>> & Pick<ColliderOptions, 'points'>;
  colliderImpulse(collider: number): { x: number; y: number; angular: number };
  /** Holds a particle softly, as a mouse does. Returns the id of the grip. */
  addGrip(options: GripOptions): number;
  removeGrip(grip: number): void;
  /** Changes some values of a grip; the others stay. */
  setGrip(grip: number, options: Partial<GripOptions>): void;
  moveGrip(grip: number, x: number, y: number): void;
  grip(grip: number): Full<GripOptions>;
  gripImpulse(grip: number): { x: number; y: number };

  /** An area around a polygon of particles: a balloon, a tyre. Returns its id. set('fill', ...) inflates it. */
  addArea(particles: Numbers, options?: AreaOptions): number;
  /** An area for each lattice cell, so that jelly turns back. */
  addCellAreas(options?: AreaOptions): { first: number; count: number };
  /** Angle springs between a, b, c of each three particles; with stride 1 along a chain: beams, spines. */
  addAngles(particles: Numbers, options?: AngleOptions, stride?: number): { first: number; count: number };
  removeElements(which: Which): void;
  elementParticles(element: number): Uint32Array;

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
  readonly Network: new (builder: Builder, settings?: Settings, options?: NetworkOptions) => Network;
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
