"""Many small bodies: put them in one network, where they are swept side by side.

    python3 many_bodies.py [BODIES [TURNS]]

Steps the same bodies in one network, and each in a network of its own, in turns. Prints processor time, and how many
times faster one network is. The loop over networks makes a call of Python for each: the last column is its share.

SPDX-License-Identifier: MIT
"""
import sys
import time

import numpy as np

import massspring

SUBSTEPS = 20
SHAPES = ((3, 3), (4, 4), (5, 5), (8, 8))


def add(builder, shape, x):
    builder.add_lattice(np.zeros(shape, int), {"mass": 1, "stiffness": 1000, "damping": 1}, x=x)


def apart(shape, count):
    """Networks of one body each."""
    builder = massspring.Builder()
    add(builder, shape, 0)
    first = builder.network(substeps=SUBSTEPS)
    return [first] + [first.clone() for _ in range(count - 1)]


def together(shape, count):
    """One network of all bodies."""
    builder = massspring.Builder()
    for index in range(count):
        add(builder, shape, 1.5 * shape[1] * index)
    return [builder.network(substeps=SUBSTEPS)]


def seconds_of(call, networks):
    begin = time.process_time()
    for network in networks:
        call(network)
    return time.process_time() - begin


def main():
    count, repeats = [int(text) for text in sys.argv[1:]] + [1000, 40][len(sys.argv) - 1:]
    level = together(SHAPES[0], 1)[0].info.simd_level.name.lower()
    print(f"{count} bodies, {SUBSTEPS} substeps, {level}, the median of {repeats} turns")
    print("cells   us a body apart   together   times faster   share of Python's calls")
    for shape in SHAPES:
        single, all_ = apart(shape, count), together(shape, count)
        step, nothing = (lambda network: network.step(1 / 64)), (lambda network: network.step(1 / 64, 0))
        turns = [(seconds_of(step, single), seconds_of(step, all_), seconds_of(nothing, single))
                 for _ in range(repeats)]
        of_single, of_all, of_calls = np.median(turns, axis=0)
        print(f"{shape[0]} x {shape[1]}{1e6 * of_single / count:18.2f}{1e6 * of_all / count:11.2f}"
              f"{of_single / of_all:15.1f}{of_calls / of_single:26.2f}")


main()
