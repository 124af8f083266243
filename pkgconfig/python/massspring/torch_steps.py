"""Steps of a network as a function of PyTorch's autograd. Needs torch, which the package does not import otherwise.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Any, Optional

import numpy as np
import torch

from .gradient import Gradient

_SETTABLE = ("stiffness", "damping", "rest_length")


class _Steps(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, network: Any, dt: float, steps: int, forced: Any, *inputs: Optional[torch.Tensor]) -> Any:
        arrays = [None if t is None else t.detach().cpu().numpy() for t in inputs]
        for name, array in zip(_SETTABLE, arrays):
            if array is not None:
                network.set(name, array)
        if arrays[3] is not None:
            network.set_positions(arrays[3])
        if arrays[4] is not None:
            network.set_velocities(arrays[4])
        run = Gradient(network, steps, forced)
        for step in range(steps):
            run.step(dt, None if arrays[5] is None else arrays[5][step], None if arrays[6] is None else arrays[6][step])
        ctx.run, ctx.inputs = run, inputs
        return torch.from_numpy(network.positions), torch.from_numpy(network.velocities.astype(np.float64))

    @staticmethod
    def backward(ctx: Any, positions: torch.Tensor, velocities: torch.Tensor) -> Any:
        with ctx.run as run:
            run.add_seeds(positions.cpu().numpy(), velocities.cpu().numpy())
            run.reverse()
            by = [run.get(name) for name in _SETTABLE] + [run.positions, run.velocities, run.signals, run.forces]
        return (None, None, None, None) + tuple(
            None if t is None else torch.from_numpy(array).to(t) for t, array in zip(ctx.inputs, by))


def steps(network: Any, dt: float, count: int, *, stiffness: Any = None, damping: Any = None, rest_length: Any = None,
          positions: Any = None, velocities: Any = None, signals: Any = None, forces: Any = None,
          forced: Any = ()) -> Any:
    """Step a network count times: tensors of final positions and velocities, float64 (particles, 2).

    Tensors that are given are set first, and get gradients: properties of all springs, the state of all particles,
    signals (count, actuators) and forces (count, forced, 2). Each result can go backward once. Do not touch the network
    until then.
    """
    return _Steps.apply(network, dt, count, forced, stiffness, damping, rest_length, positions, velocities, signals,
                        forces)
