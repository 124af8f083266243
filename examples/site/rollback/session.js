// Rollback for two peers, as in fighting games: each steps its own copy of the world immediately, with its own input and
// a guess of the other's. When the real input arrives and differs, it goes back to that frame and steps again.
//
// It knows nothing of the world but step(inputs), save(), load(snapshot) and hash(), and nothing of the line but that
// packets may be late, out of order, or lost.

export const WINDOW = 8; // frames that a peer may be ahead of the other's input; then it waits
export const DELAY = 2; // frames from a key to its effect: packets that arrive in that time need no guess

/** The same numbers from the same seed, 0 to 1. */
export function makeRandom(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** One direction of a bad line. Times are in ms. */
export class Line {
  constructor(random, quality) {
    Object.assign(this, { random, quality, waiting: [], sent: 0, lost: 0, bytes: 0 });
  }

  send(packet, now) {
    const { latency, jitter, loss } = this.quality, bytes = JSON.stringify(packet);
    this.sent++;
    this.bytes += bytes.length;
    if (this.random() < loss) this.lost++;
    else this.waiting.push({ at: now + latency + jitter * this.random(), bytes });
  }

  receive(now) {
    const arrived = this.waiting.filter(({ at }) => at <= now);
    this.waiting = this.waiting.filter(({ at }) => at > now);
    return arrived.map(({ bytes }) => JSON.parse(bytes));
  }
}

export class Peer {
  constructor(world, me) {
    Object.assign(this, { world, me, frame: 0, received: DELAY - 1, acknowledged: DELAY - 1, wrong: Infinity, final: -1,
      hashesSeen: -1, hashesTaken: -1, comparedTo: -1, dropped: 0 });
    // By frame: inputs of both players, guesses of the other's input, snapshots before it and hashes after it.
    this.inputs = [[0, 0], [0, 0]];
    this.guessed = [];
    this.snapshots = new Map();
    this.hashes = new Map();
    this.theirs = new Map();
    this.count = { rollbacks: 0, again: 0, deepest: 0, waits: 0, compared: 0, differing: 0 };
  }

  /** The packet to send now: all that the other may lack. */
  packet() {
    const own = this.inputs[this.me], from = this.acknowledged + 1;
    const hashes = [];
    for (let frame = this.hashesTaken + 1; frame <= this.final; frame++) hashes.push(this.hashes.get(frame));
    return { from, inputs: own.slice(from), ack: this.received, hashesFrom: this.hashesTaken + 1, hashes, hashesAck: this.hashesSeen };
  }

  take({ from, inputs, ack, hashesFrom, hashes, hashesAck }) {
    const other = this.inputs[1 - this.me];
    inputs.forEach((input, i) => {
      const frame = from + i;
      if (frame !== this.received + 1) return; // known, or out of order
      other[frame] = input;
      this.received = frame;
      if (frame < this.frame && this.guessed[frame] !== input) this.wrong = Math.min(this.wrong, frame);
    });
    this.acknowledged = Math.max(this.acknowledged, ack);
    hashes.forEach((hash, i) => {
      if (hashesFrom + i !== this.hashesSeen + 1) return;
      this.theirs.set(hashesFrom + i, hash);
      this.hashesSeen = hashesFrom + i;
    });
    this.hashesTaken = Math.max(this.hashesTaken, hashesAck);
  }

  // Step a frame with the other's input. If that is unknown, guess that it has not changed.
  simulate(frame) {
    const other = this.inputs[1 - this.me], guess = other[Math.min(frame, this.received)];
    this.guessed[frame] = guess;
    this.snapshots.set(frame, this.world.save());
    this.snapshots.delete(frame - WINDOW - 2);
    const inputs = [];
    inputs[this.me] = this.inputs[this.me][frame];
    inputs[1 - this.me] = guess;
    this.world.step(inputs);
    this.hashes.set(frame, this.world.hash());
  }

  /** Steps a frame with this input of its own player; false: it waited for the other. */
  tick(input) {
    if (this.wrong < this.frame) {
      this.world.load(this.snapshots.get(this.wrong));
      this.count.rollbacks++;
      this.count.again += this.frame - this.wrong;
      this.count.deepest = Math.max(this.count.deepest, this.frame - this.wrong);
      for (let frame = this.wrong; frame < this.frame; frame++) this.simulate(frame);
    }
    this.wrong = Infinity;
    this.finish();
    if (this.frame - this.received > WINDOW) {
      this.count.waits++;
      return false;
    }
    this.inputs[this.me][this.frame + DELAY] = input;
    this.simulate(this.frame++);
    this.finish();
    return true;
  }

  // Frames whose inputs are all known are final: their hashes are compared.
  finish() {
    this.final = Math.min(this.received, this.frame - 1);
    for (const [frame, hash] of this.theirs) {
      if (frame > this.final) break;
      this.count.compared++;
      if (hash !== this.hashes.get(frame)) this.count.differing++;
      this.theirs.delete(frame);
      this.comparedTo = frame;
    }
    for (; this.dropped <= Math.min(this.comparedTo, this.hashesTaken); this.dropped++) this.hashes.delete(this.dropped);
  }
}

/** Two peers and the line between them, in simulated time: both step every 1/60 s. */
export class Session {
  constructor(makeWorld, quality, seed = 1) {
    const random = makeRandom(seed);
    this.peers = [0, 1].map((me) => new Peer(makeWorld(), me));
    this.lines = [0, 1].map(() => new Line(random, quality)); // from each peer
    this.now = 0;
  }

  /** inputOf(me, world): what that player presses. */
  tick(inputOf) {
    this.now += 1000 / 60;
    this.peers.forEach((peer, me) => {
      for (const packet of this.lines[1 - me].receive(this.now)) peer.take(packet);
      peer.tick(inputOf(me, peer.world));
      this.lines[me].send(peer.packet(), this.now);
    });
  }
}
