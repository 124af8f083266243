"""The bending of a bar of iron, 80 x 5 particles, pinned at its left end, after a minute.

SPDX-License-Identifier: MIT
"""
import numpy as np

import massspring

cells = np.zeros((5, 80), int)  # the material of each cell: 0 is free
cells[:, 0] = 1                 # 1 is pinned
iron = {"mass": 73.4, "stiffness": 6.76e7}
builder = massspring.Builder()
ids = builder.add_lattice(cells, [iron, {**iron, "pinned": True}])
with builder.network(substeps=30, global_damping=1.0) as network:
    network.step(1 / 64, 60 * 64)
    print(f"the free end has dropped by {4 - network.get_positions(ids[0, -1])[1]:.2f} m")
