"""A crawler learns its gait by gradients, and by evolution: how many simulated steps does either take?

    python3 crawl.py [SEEDS]

An inchworm of springs has bristles below, that drag less forwards than backwards. Its muscles follow two sines each,
whose amplitudes are learned. Bristles are forces that depend on velocities, so the chain rule goes through them: a step
back gives the derivatives by forces, and these, times those of the forces by velocities, are seeds of the state before.
Needs numpy alone.

SPDX-License-Identifier: MIT
"""
import sys
import time

import numpy as np

import massspring

COLUMNS, STEPS, DT, REACH = 9, 100, 1 / 50, 0.25
FORWARD, BACKWARD, SLOW = 0.1, 2.0, 0.05  # N s/m, N s/m, m/s: between which the drag changes
STEPS_OF_A_GRADIENT = 10                  # what it costs, in steps: see the guide


def body():
    builder = massspring.Builder()
    ids = builder.add_lattice(np.zeros((2, COLUMNS), int), {"mass": 0.05, "stiffness": 150, "damping": 0.5}, spacing=0.1)
    with builder.network() as network:
        ends = network.ends.tolist()
    muscles = [ends.index([int(row[i]), int(row[i + 1])]) for row in ids for i in range(COLUMNS - 1)]
    return builder, muscles, np.asarray(ids[1], np.uint32)


BUILDER, MUSCLES, FEET = body()
TIME = (np.arange(STEPS) + 1) * DT
WAVES = np.stack([f(2 * np.pi * h * TIME) for h in (1, 2) for f in (np.sin, np.cos)], 1)  # (steps, 4)
SHAPE = (WAVES.shape[1], len(MUSCLES))


def signals_of(gait):
    return 1 + REACH * np.tanh(WAVES @ gait)


def drag(v):
    """Forces on feet along x, and their derivatives."""
    share = 1 / (1 + np.exp(np.clip(v / SLOW, -50, 50)))
    rate = FORWARD + (BACKWARD - FORWARD) * share
    return -rate * v, -rate + (BACKWARD - FORWARD) * share * (1 - share) * v / SLOW


def way_and_gradient(gait):
    """How far the crawler comes, m, and the derivatives."""
    signals = signals_of(gait)
    with BUILDER.network(substeps=10, gravity=(0, 0)) as network:
        network.set_actuators(MUSCLES, changes=5)
        start = network.positions[:, 0].mean()
        with massspring.Gradient(network, STEPS, forced=FEET) as run:
            slopes = []
            for step in range(STEPS):
                force, slope = drag(network.velocities[FEET, 0].astype("f8"))
                slopes.append(slope)
                run.step(DT, signals[step], np.stack([force, 0 * force], 1))
            way = network.positions[:, 0].mean() - start
            seeds = np.zeros((network.particle_count, 2))
            seeds[:, 0] = 1 / network.particle_count
            run.add_seeds(seeds)
            for step in reversed(range(STEPS)):
                run.reverse(1)
                by_force = run.forces_of(step)[:, 0]
                run.add_seeds(velocities=np.stack([by_force * slopes[step], 0 * by_force], 1), ids=FEET)
            by_signal = run.signals
    return way, REACH * WAVES.T @ (by_signal * (1 - ((signals - 1) / REACH) ** 2))


class Crowd:
    """Crawlers in one batch."""

    def __init__(self, count):
        self.batch = massspring.Batch(BUILDER, count, actuators=MUSCLES, changes=5, substeps=10, gravity=(0, 0))
        self.feet = (self.batch.first_particles[:-1, None] + FEET).ravel()

    def ways(self, gaits):
        self.batch.reset()
        network, signals = self.batch.network, np.stack([signals_of(gait) for gait in gaits], 1)
        self.batch.observe()
        start = self.batch.centres[:, 0].copy()
        for step in range(STEPS):
            force = drag(network.velocities[self.feet, 0].astype("f8"))[0]
            network.apply_forces(np.stack([force, 0 * force], 1).astype("f4"), self.feet)
            self.batch.step(DT, signals[step])
        self.batch.observe()
        return self.batch.centres[:, 0] - start


def by_gradients(seed, iterations=60, rate=0.1):
    """Adam. Returns steps and the best way so far."""
    random = np.random.default_rng(seed)
    gait, mean, square, curve, best = 0.1 * random.standard_normal(SHAPE), 0.0, 0.0, [], -np.inf
    for i in range(1, iterations + 1):
        way, gradient = way_and_gradient(gait)
        best = max(best, way)
        curve.append((i * STEPS, best))
        mean, square = 0.9 * mean + 0.1 * gradient, 0.99 * square + 0.01 * gradient ** 2
        gait = gait + rate * (mean / (1 - 0.9 ** i)) / (np.sqrt(square / (1 - 0.99 ** i)) + 1e-8)
    return np.array(curve)


def by_evolution(seed, generations, pairs, noise, rate):
    """An evolution strategy (Salimans 2017): mirrored noise, ranks instead of rewards; its mean by Adam, too."""
    random = np.random.default_rng(seed)
    crowd, gait, curve, best = Crowd(2 * pairs), 0.1 * random.standard_normal(SHAPE), [], -np.inf
    mean, square = 0.0, 0.0
    for i in range(1, generations + 1):
        half = random.standard_normal((pairs, *SHAPE))
        ways = crowd.ways(gait + noise * np.concatenate([half, -half]))
        best = max(best, ways.max())  # of all that were tried: to its advantage
        curve.append((i * 2 * pairs * STEPS, best))
        ranks = ways.argsort().argsort() / (len(ways) - 1) - 0.5
        gradient = np.einsum("p,pij->ij", ranks[:pairs] - ranks[pairs:], half) / (pairs * noise)
        mean, square = 0.9 * mean + 0.1 * gradient, 0.99 * square + 0.01 * gradient ** 2
        gait = gait + rate * (mean / (1 - 0.9 ** i)) / (np.sqrt(square / (1 - 0.99 ** i)) + 1e-8)
    return np.array(curve)


def steps_to(curve, way):
    reached = np.flatnonzero(curve[:, 1] >= way)
    return curve[reached[0], 0] if reached.size else np.inf


def main():
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    begin = time.process_time()
    gradients = [by_gradients(seed) for seed in range(seeds)]
    print(f"gradients: {time.process_time() - begin:.1f} s of processor time, ways "
          + ", ".join(f"{curve[-1, 1]:.3f}" for curve in gradients) + " m")
    goal = 0.9 * np.median([curve[-1, 1] for curve in gradients])
    ours = np.median([steps_to(curve, goal) for curve in gradients])
    print(f"to {goal:.3f} m: {ours:,.0f} steps forward, as dear as {ours * STEPS_OF_A_GRADIENT:,.0f} steps")
    for pairs, noise, rate in ((8, 0.1, 0.1), (8, 0.3, 0.1), (32, 0.1, 0.1), (32, 0.3, 0.1)):
        begin = time.process_time()
        curves = [by_evolution(seed, 3200 // (2 * pairs) if pairs == 8 else 100, pairs, noise, rate)
                  for seed in range(seeds)]
        theirs = np.median([steps_to(curve, goal) for curve in curves])
        print(f"evolution, {2 * pairs} a generation, noise {noise}: {theirs:,.0f} steps, {theirs / ours:.0f} times as many, "
              f"{theirs / ours / STEPS_OF_A_GRADIENT:.1f} times the cost; at last "
              + ", ".join(f"{curve[-1, 1]:.3f}" for curve in curves)
              + f" m; {time.process_time() - begin:.1f} s")


main()
