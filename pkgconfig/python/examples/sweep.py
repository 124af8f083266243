"""A sweep over two parameters: how high soft squares bounce, by stiffness and damping.

    python3 sweep.py FOLDER                          # processes, as many as there are processors
    python3 sweep.py FOLDER --shard 3/8              # a job of an array: every eighth case from 3 on
    python3 sweep.py FOLDER --scheduler HOST:8786    # a cluster of Dask (Debian: python3-distributed)

FOLDER keeps each result, so a sweep that was killed goes on. When all are there, prints their hash, the same whoever did
which, and draws FOLDER/sweep.png if matplotlib is there. sweep_array, beside this file, makes an array of jobs of it, for
Slurm, GNU parallel or xargs.
SPDX-License-Identifier: MIT
"""
import argparse

import numpy as np

import massspring

GRID = {"stiffness": [float(f"{k:.4g}") for k in np.geomspace(500, 50000, 24)],
        "damping": [float(f"{c:.4g}") for c in np.geomspace(0.3, 30, 24)]}
FALL = 2.0  # m


def bounce(stiffness, damping):
    """How high the square comes again, as a share of its fall, and how much of its height it is pressed, at most."""
    builder = massspring.Builder()
    builder.add_lattice(np.zeros((8, 8), int), {"mass": 1, "stiffness": stiffness, "damping": damping}, y=FALL)
    with builder.network(substeps=40, gravity=(0, -9.8)) as network:
        network.set_floor(planes=[[0, 0, 0, 1]], restitution=0)
        heights, sizes = [], []
        for _ in range(130):
            network.step(1 / 64)
            box = network.body
            heights.append(box.min_y)
            sizes.append(box.max_y - box.min_y)
    first = int(np.argmax(np.array(heights) < 0.01 * FALL))
    return {"share": max(heights[first:]) / FALL, "pressed": 1 - min(sizes) / 7}


def draw(result, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 2, figsize=(11, 4.5))
    for ax, name, title in zip(axes, ("share", "pressed"), ("height of the bounce / fall", "most it is pressed")):
        shown = ax.contourf(GRID["damping"], GRID["stiffness"], result.array(name), 20)
        ax.set(xscale="log", yscale="log", xlabel="damping, N s/m", ylabel="stiffness, N/m", title=title)
        figure.colorbar(shown, ax=ax)
    figure.tight_layout()
    figure.savefig(picture, dpi=90)
    print(f"drawn to {picture}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--shard", default="0/1")
    parser.add_argument("--processes", type=int)
    parser.add_argument("--scheduler")
    options = parser.parse_args()
    engine = None
    if options.scheduler:
        from distributed import Client
        engine = Client(options.scheduler)
        engine.upload_file(__file__)
    shard = tuple(int(number) for number in options.shard.split("/"))
    result = massspring.sweep(bounce, GRID, options.processes, options.folder, shard, engine=engine)
    if result is None:
        print("the shard is done, others are not")
        return
    print(f"{len(result)} cases, hash {result.hash[:16]}")
    try:
        draw(result, f"{options.folder}/sweep.png")
    except ImportError:
        print("no picture, as there is no matplotlib")


if __name__ == "__main__":
    main()
