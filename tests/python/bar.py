"""The bar of the other examples, and small networks, for the tests.

SPDX-License-Identifier: MIT
"""
import numpy as np

import massspring

IRON = {"mass": 73.3975, "stiffness": 6.7643e7}  # as examples/scenes/scene.h has it


def bar_builder(columns=80, rows=5, **fields):
    """A bar of iron, pinned at its left end."""
    cells = np.zeros((rows, columns), int)
    cells[:, 0] = 1
    builder = massspring.Builder()
    builder.add_lattice(cells, [{**IRON, **fields}, {**IRON, **fields, "pinned": True}])
    return builder


def bar(columns=80, rows=5, **settings):
    settings = {"substeps": 30, "guard": "growth", **settings}
    return massspring.Network(bar_builder(columns, rows), **settings)


def pair(**settings):
    """Two particles and a spring."""
    builder = massspring.Builder()
    builder.add_particles([[0, 0], [1, 0]])
    builder.add_spring(0, 1, stiffness=10)
    return builder.network(**{"substeps": 8, "gravity": (0, 0), **settings})
