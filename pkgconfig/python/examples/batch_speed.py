"""How many steps of an environment a second, with many robots in one batch.

    python3 batch_speed.py [ROBOTS [SECONDS]]

A robot has 5 x 5 voxels of 0.1 m: 6 x 6 particles, 110 springs, of which 40 get a new signal in each step. It stands on a
floor. A step of the environment takes 1/50 s in 20 substeps, observes all robots, and puts one in 500 back. Prints
processor time by part, without contact of a robot with itself and with it, and what a robot takes in memory.

SPDX-License-Identifier: MIT
"""
import sys
import time

import numpy as np

import massspring

DT, SUBSTEPS, ACTUATED = 1 / 50, 20, 40
OBSERVED = dict.fromkeys(("relative_x", "relative_y", "vx", "vy"), [0, 5, 30, 35])  # of the corners
EVOGYM = 792  # steps a second of one robot of EvoGym's engine, on the machine of bench/RESULTS.md


def robot():
    builder = massspring.Builder()
    builder.add_lattice(np.zeros((6, 6), int), {"mass": 0.05, "stiffness": 400, "damping": 0.5}, spacing=0.1, y=0.01)
    return builder


def batch_of(count, has_contact):
    batch = massspring.Batch(robot(), count, actuators=range(0, 2 * ACTUATED, 2), observations=OBSERVED,
                             substeps=SUBSTEPS, gravity=(0, -9.8), max_speed=100)
    batch.network.set_floor(planes=[[0, 0, 0, 1]], friction=0.8)
    if has_contact:
        batch.network.set_contact(friction=0.5, thickness=0.04)
    return batch


def run(batch, seconds):
    """Processor seconds a step of: all, signals, the physics, observing, resetting."""
    random = np.random.default_rng(1)
    phase = random.uniform(0, 6.28, (batch.count, ACTUATED)).astype(np.float32)
    times, end, steps = np.zeros(4), time.perf_counter() + seconds, 0
    while time.perf_counter() < end:
        marks = [time.process_time()]
        batch.signals[...] = 1 + 0.1 * np.sin(phase + np.float32(0.2 * steps))
        marks.append(time.process_time())
        batch.step(DT)
        marks.append(time.process_time())
        batch.observe()
        marks.append(time.process_time())
        if (done := np.flatnonzero(random.random(batch.count) < 1 / 500)).size:
            batch.reset(done)
        marks.append(time.process_time())
        times += np.diff(marks)
        steps += 1
    return times / steps


def calls(batch, repeats=200):
    """Nanoseconds: of a signal, and of putting a robot back."""
    take, signal = massspring.lib.mspring_network_set, massspring.Property.SIGNAL
    network, data = batch.network.pointer, massspring.ffi.from_buffer("float[]", batch.signals)
    groups = np.arange(batch.count, dtype=np.uint32)
    spans = []
    for _ in range(repeats):
        begin = time.perf_counter()
        take(network, signal, massspring.ffi.NULL, 0, batch.signals.size, data, 1)
        middle = time.perf_counter()
        batch.reset(groups)
        spans.append((middle - begin, time.perf_counter() - middle))
    signals, resets = np.median(spans, axis=0)
    return 1e9 * signals / batch.signals.size, 1e9 * resets / batch.count


def main():
    count, seconds = [int(text) for text in sys.argv[1:]] + [256, 5][len(sys.argv) - 1:]
    print(f"{count} robots, {SUBSTEPS} substeps, {batch_of(count, False).network.info.simd_level.name.lower()}")
    for has_contact in (False, True):
        batch = batch_of(count, has_contact)
        batch.step(DT, count=50)
        times = run(batch, seconds)
        rate = count / times.sum()
        print(f"self-contact {'yes' if has_contact else 'no '}: {rate:9,.0f} steps a second, {rate / EVOGYM:.0f} times "
              f"{EVOGYM}. us a robot: numpy's signals {1e6 * times[0] / count:.2f}, step {1e6 * times[1] / count:.2f}, "
              f"observe {1e6 * times[2] / count:.2f}, reset {1e6 * times[3] / count:.3f}. "
              f"{batch.network.info.memory_used / count / 1024:.1f} kB a robot, held {int(batch.held.sum())}")
        signal, reset = calls(batch)
        print(f"  a signal is handed over in {signal:.2f} ns, a robot put back in {reset:.0f} ns")


main()
