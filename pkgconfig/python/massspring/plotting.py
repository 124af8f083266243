"""Pictures of networks and of tuning tables, with matplotlib.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Any

import numpy as np

from . import _header
from .network import Network
from .tuning import TuneTable


def draw(network: Network, ax: Any = None, color: Any = "strain", cmap: str = "coolwarm", linewidth: float = 1.0,
         **options: Any) -> Any:
    """Draw the springs that are not broken, and loose particles. Returns the LineCollection.

    ax       axes of matplotlib; None: the current ones
    color    a property of springs, such as "strain" or "tension"; an array (n,) by spring id; or a colour
    options  those of matplotlib.collections.LineCollection
    """
    from matplotlib import pyplot
    from matplotlib.collections import LineCollection

    ax = ax if ax is not None else pyplot.gca()
    whole = (network.get("spring_flags") & (_header.SPRING_BROKEN | _header.SPRING_REMOVED)) == 0
    ends, positions = network.ends[whole], network.positions
    lines = LineCollection(positions[ends], linewidths=linewidth, **options)
    if isinstance(color, str) and color.upper() in _header.Property.__members__:
        color = network.get(_header.Property[color.upper()])
    if isinstance(color, np.ndarray) and color.shape == (len(whole),):
        values = color[whole]
        limit = float(np.abs(values).max()) if values.size else 0.0
        lines.set_array(values)
        lines.set_cmap(cmap)
        lines.set_clim(-limit, limit)
    else:
        lines.set_color(color)
    ax.add_collection(lines)
    loose = np.setdiff1d(np.flatnonzero(network.get("particle_flags") & _header.PARTICLE_REMOVED == 0), ends)
    if len(loose):
        ax.plot(*positions[loose].T, ".", markersize=2, color="black")
    ax.autoscale_view()
    ax.set_aspect("equal")
    ax.set_xlabel("m")
    return lines


def draw_tuning(table: TuneTable, ax: Any = None, error: str = "trajectory_share") -> Any:
    """Plot a tuning: cost of a step against an error, the Pareto front joined, the recommended row ringed."""
    from matplotlib import pyplot

    ax = ax if ax is not None else pyplot.gca()
    rows = [row for row in table if row["median_cost"] and row[error]]
    for solver in sorted({row["solver"] for row in rows}):
        of_solver = [row for row in rows if row["solver"] == solver]
        ax.loglog([row["median_cost"] for row in of_solver], [row[error] for row in of_solver], "o", label=solver)
    front = sorted((row["median_cost"], row[error]) for row in rows if row["is_pareto"])
    if front:
        ax.loglog(*zip(*front), "-", color="grey", zorder=0)
    best = table.recommended
    if best and best["median_cost"] and best[error]:
        ax.loglog(best["median_cost"], best[error], "o", markersize=14, fillstyle="none", color="black")
    ax.set_xlabel("cost of a step, s")
    ax.set_ylabel(error.replace("_", " "))
    ax.legend()
    return ax
