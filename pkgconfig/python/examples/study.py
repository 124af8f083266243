"""A parameter study: how far do cantilevers bend by stiffness and height, and how long do they swing?

    python3 study.py [PICTURE]

Each case is a bar of 40 columns that falls from rest for 20 s. Two threads take the cases, as steps release the GIL.
Prints a table. If matplotlib is there, draws it, and the most bent bar, to PICTURE.

SPDX-License-Identifier: MIT
"""
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np

import massspring

STIFFNESSES = (1e7, 2e7, 4e7, 8e7)  # N/m
HEIGHTS = (3, 5, 8)  # cells of 1 m
FRAMES = 20 * 64


def bar(stiffness, height):
    """A network, and the id of its free end."""
    cells = np.zeros((height, 40), int)
    cells[:, 0] = 1
    iron = {"mass": 73.4, "stiffness": stiffness}
    builder = massspring.Builder()
    ids = builder.add_lattice(cells, [iron, {**iron, "pinned": True}])
    return builder.network(global_damping=1.0), ids[0, -1]


def run(case):
    """One row of the study: stiffness, height, drop at rest (m), deepest drop (m), seconds until it is within 5 %."""
    network, end = bar(*case)
    with network, network.clone() as at_rest:
        top = network.get_positions(end)[1]
        at_rest.settle()
        rest = top - at_rest.get_positions(end)[1]
        drops = np.empty(FRAMES)
        for frame in range(FRAMES):
            network.step(1 / 64)
            drops[frame] = top - network.get_positions(end)[1]
    outside = np.flatnonzero(np.abs(drops - rest) > 0.05 * rest)
    return (*case, rest, drops.max(), (outside[-1] + 1) / 64 if outside.size else 0.0, drops)


def draw(rows, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(15, 4.5))
    for height in HEIGHTS:
        of_height = [row for row in rows if row[1] == height]
        left.loglog([row[0] for row in of_height], [row[2] for row in of_height], "o-", label=f"{height} rows")
    left.set(xlabel="stiffness, N/m", ylabel="drop at rest, m")
    left.legend()
    for row in rows:
        if row[1] == HEIGHTS[1]:
            middle.plot(np.arange(1, FRAMES + 1) / 64, row[5], label=f"{row[0]:.0e} N/m")
    middle.set(xlabel="time, s", ylabel=f"drop, m, {HEIGHTS[1]} rows")
    middle.legend(loc="upper right")
    network, _ = bar(STIFFNESSES[0], HEIGHTS[1])
    network.settle()
    figure.colorbar(network.plot(right), ax=right, label="strain", shrink=0.7)
    figure.tight_layout()
    figure.savefig(picture, dpi=100)
    print(f"drawn to {picture}")


def main():
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(run, product(STIFFNESSES, HEIGHTS)))
    print("stiffness N/m   rows   at rest m   deepest m   within 5 % after s")
    for stiffness, height, rest, deepest, seconds, _ in rows:
        print(f"{stiffness:13.0e} {height:6} {rest:11.3f} {deepest:11.3f} {seconds:20.2f}")
    try:
        draw(rows, sys.argv[1] if len(sys.argv) > 1 else "study.png")
    except ImportError:
        print("no picture, as there is no matplotlib")


main()
