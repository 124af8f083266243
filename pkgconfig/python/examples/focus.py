"""Design a lattice that focuses a wave: the stiffness of its cells is found by gradients.

    python3 focus.py [PICTURE [ITERATIONS]]

A plane wave comes from the left. Cells of a lens may be softer than the rest. The loss is the energy that reaches one
particle behind it; its derivatives by thousands of stiffnesses take one reverse. Needs numpy and, for the picture,
matplotlib.

SPDX-License-Identifier: MIT
"""
import sys
import time

import numpy as np

import massspring

ROWS, COLUMNS, STEPS, DT = 41, 64, 110, 0.05
STIFF, SOFTEST = 100.0, 0.35  # N/m, and a fraction of it
LENS = slice(12, 28)          # columns
TARGET = (ROWS // 2, 48)      # row, column


def lattice():
    builder = massspring.Builder()
    ids = builder.add_lattice(np.zeros((ROWS, COLUMNS), int), {"mass": 1.0, "stiffness": STIFF})
    network = massspring.Network(builder, substeps=3, gravity=(0, 0), precise=True, global_damping=0.05)
    return network, ids


def pulse():
    """Force on each particle of the left column in each step, N: four periods of a wave, which begin and end softly."""
    t = np.arange(STEPS) * DT
    push = 0.5 * np.sin(2 * np.pi * 2.4 * t) * np.sin(np.pi * np.clip(t / 1.7, 0, 1)) ** 2
    return np.repeat(np.stack([push, 0 * push], 1)[:, None], ROWS, axis=1).astype("f4")


def run(design, wants_gradient=True):
    """Energy at the target over time, its derivatives by the softness of cells, and the energy of all cells."""
    network, ids = lattice()
    with network:
        ends = network.ends
        cells = 1 - (1 - SOFTEST) * design  # stiffness as a fraction; ids of particles are those of cells
        network.set("stiffness", (STIFF * cells.ravel()[ends].mean(1)).astype("f4"))
        target = int(ids[TARGET])
        with massspring.Gradient(network, STEPS, forced=ids[:, 0]) as record:
            velocities, energy = [], np.zeros(ROWS * COLUMNS)
            for forces in pulse():
                record.step(DT, forces=forces)
                v = network.velocities.astype("f8")
                velocities.append(v[target])
                energy += (v ** 2).sum(1) * DT / 2
            value = energy[target]
            if not wants_gradient:
                return value, None, energy
            for v in reversed(velocities):
                record.add_seeds(velocities=v[None] * DT, ids=[target])
                record.reverse(1)
            by_spring = record.get("stiffness") * STIFF / 2
        by_cell = np.zeros(ROWS * COLUMNS)
        np.add.at(by_cell, ends.ravel(), np.repeat(by_spring, 2))
        return value, -(1 - SOFTEST) * by_cell.reshape(design.shape), energy


def design_lens(iterations):
    """Gradient ascent by Adam. The design is symmetric, and 0 outside the lens."""
    raw, mean, square = np.full((ROWS, COLUMNS), -1.0), 0.0, 0.0
    mask = np.zeros((ROWS, COLUMNS))
    mask[:, LENS] = 1
    for iteration in range(1, iterations + 1):
        design = mask / (1 + np.exp(-raw))
        value, gradient, _ = run(design)
        gradient = (gradient + gradient[::-1]) / 2 * design * (1 - design)
        gradient /= value
        mean, square = 0.9 * mean + 0.1 * gradient, 0.99 * square + 0.01 * gradient ** 2
        raw += 0.15 * (mean / (1 - 0.9 ** iteration)) / (np.sqrt(square / (1 - 0.99 ** iteration)) + 1e-6)
        if iteration % 10 == 1:
            print(f"iteration {iteration:3}: {value * 1e3:.3f} mJ s at the target")
    return mask / (1 + np.exp(-raw))


def draw(design, before, after, picture):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(3, 1, figsize=(7, 12), constrained_layout=True)
    shown = [(1 - (1 - SOFTEST) * design, "stiffness, of that outside", "gray", None),
             (before.reshape(ROWS, COLUMNS) * 1e3, "energy, mJ s: without lens", "inferno", after.max() * 1e3),
             (after.reshape(ROWS, COLUMNS) * 1e3, "energy, mJ s: with it", "inferno", after.max() * 1e3)]
    for axis, (values, title, colours, most) in zip(axes, shown):
        image = axis.imshow(values, cmap=colours, vmin=0, vmax=most)
        axis.plot(TARGET[1], TARGET[0], "o", mfc="none", mec="tab:cyan", ms=10)
        axis.set_title(title)
        figure.colorbar(image, ax=axis, shrink=0.8)
    figure.savefig(picture, dpi=90)


def main():
    picture = sys.argv[1] if len(sys.argv) > 1 else "focus.png"
    iterations = int(sys.argv[2]) if len(sys.argv) > 2 else 80
    begin = time.process_time()
    design = design_lens(iterations)
    seconds = time.process_time() - begin
    before, _, energy_before = run(np.zeros((ROWS, COLUMNS)), False)
    after, _, energy_after = run(design, False)
    print(f"{iterations} gradients by {ROWS * (LENS.stop - LENS.start)} cells in {seconds:.1f} s of processor time")
    print(f"the lens brings {after / before:.1f} times the energy to the target")
    try:
        draw(design, energy_before, energy_after, picture)
    except ImportError:
        print("no picture: matplotlib is missing")


main()
