"""Robots of springs learn to walk: an environment in the shape of gymnasium's, and a small evolution strategy.

    python3 walker.py [PICTURE [GENERATIONS]]

All robots of a generation walk in one batch. Takes less than a minute of one processor. Draws the best robot as a moving
picture, an animated PNG. Needs numpy alone.

SPDX-License-Identifier: MIT
"""
import sys
import time

import numpy as np
from moving_picture import MovingPicture

import massspring

SHAPE = np.array([[1, 1, 1, 1, 1, 1, 1, 1],
                  [1, 1, 1, 1, 1, 1, 1, 1],
                  [1, 1, 1, 1, 1, 1, 1, 1],
                  [1, 1, 1, 0, 0, 1, 1, 1],
                  [1, 1, 1, 0, 0, 1, 1, 1],
                  [1, 1, 1, 0, 0, 1, 1, 1]], bool)
SPACING = 0.1  # m
SEEN = ("relative_x", "relative_y", "vx", "vy")  # of some particles: what a robot feels
# Rows of particles whose springs get one signal together, as (first row, column) and (last row, column).
MUSCLES = [((2, 0), (5, 0)), ((2, 2), (5, 2)), ((2, 5), (5, 5)), ((2, 7), (5, 7)), ((0, 0), (0, 7)), ((2, 2), (2, 5))]


def robot():
    """A builder, the springs of all muscles, and the muscle of each."""
    builder = massspring.Builder()
    ids = builder.add_lattice(SHAPE, {"mass": 0.05, "stiffness": 1200, "damping": 1}, spacing=SPACING, y=0.005)
    with builder.network() as network:
        spring_of = {frozenset(pair): spring for spring, pair in enumerate(network.ends.tolist())}
    springs, muscles = [], []
    for muscle, ((row, column), (last_row, last_column)) in enumerate(MUSCLES):
        while (row, column) != (last_row, last_column):
            next_row, next_column = row + (row < last_row), column + (column < last_column)
            springs.append(spring_of[frozenset((int(ids[row, column]), int(ids[next_row, next_column])))])
            muscles.append(muscle)
            row, column = next_row, next_column
    return builder, springs, np.array(muscles)


class Walkers:
    """count robots on a floor. An action is one number of -1 to 1 for each muscle: how much longer it is to be."""

    dt, reach, limit = 1 / 50, 0.2, 250  # s; share of the length; steps of an episode

    def __init__(self, count):
        builder, springs, self.muscles = robot()
        feet = [int(np.argmin(abs(x - np.arange(8)))) for x in (0, 7)]
        count_of_row = SHAPE.sum(1).cumsum()
        probes = [feet[0], feet[1], int(count_of_row[-1]) - 6, int(count_of_row[-1]) - 1]  # corners of the body, feet
        self.batch = massspring.Batch(builder, count, actuators=springs, observations=dict.fromkeys(SEEN, probes),
                                      substeps=20, gravity=(0, -9.8), max_speed=50)
        self.batch.network.set_floor(planes=[[0, 0, 0, 1]], friction=1.0)
        self.action_shape, self.observation_shape = (count, len(MUSCLES)), self.reset()[0].shape

    def _observation(self):
        self.batch.observe()
        probes = np.stack([self.batch[name] for name in SEEN], 2)
        return np.concatenate([self.batch.velocities, probes.reshape(self.batch.count, -1), self.batch.centres[:, 1:]], 1)

    def reset(self):
        self.batch.reset()
        self.steps = 0
        return self._observation(), {}

    def step(self, actions):
        """Observations, rewards (metres walked), which robots broke down, whether the episode is over, and more."""
        before = self.batch.centres[:, 0].copy()
        self.batch.step(self.dt, 1 + self.reach * np.clip(actions, -1, 1)[:, self.muscles])
        observation = self._observation()
        self.steps += 1
        return observation, self.batch.centres[:, 0] - before, self.batch.held, self.steps >= self.limit, {}


def act(weights, observation, seconds):
    """Actions of linear policies (count, muscles, inputs), with a clock of 2 Hz among the inputs."""
    angle = 2 * np.pi * 2 * seconds
    clock = np.broadcast_to([np.sin(angle), np.cos(angle), 1.0], (len(observation), 3))
    return np.tanh(np.einsum("rmi,ri->rm", weights, np.concatenate([clock, observation], 1)))


def walk(walkers, weights, watch=None):
    """How far each robot comes, m."""
    observation, _ = walkers.reset()
    way, done = np.zeros(len(weights)), False
    while not done:
        observation, reward, broken, done, _ = walkers.step(act(weights, observation, walkers.steps * walkers.dt))
        way += np.where(broken, -0.1, reward)
        if watch:
            watch(walkers)
    return way


def train(generations, pairs=64, noise=0.1, rate=0.075, seed=1):
    """An evolution strategy (Salimans 2017): mirrored noise, ranks instead of rewards."""
    random, walkers = np.random.default_rng(seed), Walkers(2 * pairs)
    mean = 0.05 * random.standard_normal((len(MUSCLES), 3 + walkers.observation_shape[1]))
    for generation in range(generations):
        half = random.standard_normal((pairs, *mean.shape))
        way = walk(walkers, mean + noise * np.concatenate([half, -half]))
        ranks = way.argsort().argsort() / (len(way) - 1) - 0.5
        mean += rate * np.einsum("p,pmi->mi", ranks[:pairs] - ranks[pairs:], half) / (pairs * noise)
        if generation % 10 == 0 or generation == generations - 1:
            print(f"generation {generation:3}: the best walks {way.max():.2f} m, the median {np.median(way):.2f} m")
    return mean


def draw(mean, picture):
    walkers = Walkers(1)
    network = walkers.batch.network
    frames = MovingPicture(width=480, height=140, metres=2.8, dt=2 * walkers.dt)

    def watch(at):
        if at.steps % 2 == 0:
            frames.add(network.positions, network.ends, network.get("strain"), at.batch.centres[0, 0])

    way = walk(walkers, mean[None], watch)
    frames.save(picture)
    return way[0]


def main():
    picture = sys.argv[1] if len(sys.argv) > 1 else "walker.png"
    generations = int(sys.argv[2]) if len(sys.argv) > 2 else 60
    begin = time.process_time()
    mean = train(generations)
    seconds = time.process_time() - begin
    way = draw(mean, picture)
    print(f"{generations * 128 * Walkers.limit:,} steps of robots in {seconds:.0f} s of processor time")
    print(f"the mean robot walks {way:.2f} m in {Walkers.limit * Walkers.dt:.0f} s, see {picture}")


main()
