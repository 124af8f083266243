"""Gradients of a loss through explicit steps, by reverse mode.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Dict, Optional, Tuple, Union

import numpy as np

from . import _header
from ._calls import count_of
from ._core import Handle, Ids, Span, array_of, as_number, enum_value, ffi, id_array, lib, optional, pointer

if TYPE_CHECKING:
    from ._header import GradientOf, GradientOfName

_SPRINGS: Tuple[GradientOfName, ...] = ("stiffness", "damping", "rest_length")


class Gradient(Handle):
    """A record of steps of a network, and derivatives of a loss by what they started from.

    steps   most steps
    forced  ids of particles that step() gives forces

    step() as often as you like, then add_seeds() with the derivatives of the loss by the final state, and reverse().
    For terms of earlier states, reverse to them and add their seeds there. massspring_gradient.h says what has a
    gradient; the network keeps its state. Do nothing to it between the steps but read it.
    """

    _kind = "gradient"

    def __init__(self, network: Any, steps: int, forced: Any = ()):
        self.network, self.forced = network, id_array("forced", forced)
        self.capacity, self.count, self.left = count_of("steps", steps), 0, 0
        self.actuators = network.actuator_count
        made = ffi.new("mspring_gradient **")
        network._change(lib.mspring_gradient_create, self.capacity, pointer("mspring_id", self.forced),
                        len(self.forced), made)
        self._owner = network._live()  # destroyed after the gradient
        self._pointer = ffi.gc(made[0], lib.mspring_gradient_destroy)

    def close(self) -> None:
        """Free the gradient. The network stays."""
        if self._pointer is not None:
            with self.network._lock:
                ffi.release(self._pointer)
                self._pointer = self._owner = None

    def __enter__(self) -> Gradient:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _call(self, function: Any, *arguments: Any, error: Any = lib.mspring_gradient_error) -> None:
        with self.network._lock:
            self.network._live()
            self._checked(function, error, arguments)

    def step(self, dt: float, signals: Any = None, forces: Any = None) -> None:
        """Step the network by dt, s. signals: (actuators,) or None; forces: (forced, 2) in N, or None."""
        s = None if signals is None else array_of("signals", signals, "f4", (self.actuators,))
        f = None if forces is None else array_of("forces", forces, "f4", (len(self.forced), 2))
        with self.network._lock:
            self.network._changes += 1
            self._call(lib.mspring_gradient_step, as_number(dt), optional("float", s), optional("float", f))
        self.count = self.left = self.count + 1

    def add_seeds(self, positions: Any = None, velocities: Any = None, ids: Ids = None) -> None:
        """Add derivatives of the loss by positions and velocities, (n, 2), where the reverse stands."""
        span = self.network._particles(ids)
        p = None if positions is None else array_of("positions", positions, "f8", (span.count, 2))
        v = None if velocities is None else array_of("velocities", velocities, "f8", (span.count, 2))
        self._call(lib.mspring_gradient_add_seeds, *span.arguments, optional("double", p), optional("double", v))

    def reverse(self, count: Optional[int] = None) -> None:
        """Go back by count steps, or by all that are left. The GIL is released."""
        count = self.left if count is None else count_of("count", count)
        self._call(lib.mspring_gradient_reverse, count)
        self.left -= count

    def get(self, of: Union[GradientOf, GradientOfName], ids: Ids = None) -> Any:
        """Derivatives by stiffness, damping or rest_length of springs, or by x, y, vx or vy of particles."""
        number = enum_value("mspring_gradient_of", "of", of)
        kind = _header.Property[_header.GradientOf(number).name] >> 8  # of the property of that name
        span = Span(ids, self.network._count(kind))
        out = np.empty(span.count)
        self._call(lib.mspring_gradient_get, number, *span.arguments, pointer("double", out), 1,
                   error=lambda _: ffi.new("char[]", b"ids has one that is removed or too large"))
        return out[0] if span.is_one else out

    @property
    def positions(self) -> np.ndarray:
        """Derivatives by positions where the reverse stands, (n, 2)."""
        return np.stack([self.get("x"), self.get("y")], axis=1)

    @property
    def velocities(self) -> np.ndarray:
        """Derivatives by velocities where the reverse stands, (n, 2)."""
        return np.stack([self.get("vx"), self.get("vy")], axis=1)

    @property
    def signals(self) -> np.ndarray:
        """Derivatives by the signals of each step, (steps, actuators)."""
        return self._inputs(lib.mspring_gradient_get_signals, (self.count, self.actuators))

    @property
    def forces(self) -> np.ndarray:
        """Derivatives by the forces of each step, (steps, forced, 2)."""
        return self._inputs(lib.mspring_gradient_get_forces, (self.count, len(self.forced), 2))

    def signals_of(self, step: int) -> np.ndarray:
        """Derivatives by the signals of one step, (actuators,)."""
        return self._input(lib.mspring_gradient_get_signals, step, np.zeros(self.actuators))

    def forces_of(self, step: int) -> np.ndarray:
        """Derivatives by the forces of one step, (forced, 2)."""
        return self._input(lib.mspring_gradient_get_forces, step, np.zeros((len(self.forced), 2)))

    def _input(self, function: Any, step: int, out: np.ndarray) -> np.ndarray:
        if not 0 <= step < self.count:
            raise _header.IdError(f"there is no step {step}, but {self.count} were taken", _header.ERROR_ID)
        self._call(function, step, pointer("double", out))
        return out

    def _inputs(self, function: Any, shape: Tuple[int, ...]) -> np.ndarray:
        out = np.zeros(shape)
        for step in range(self.count):
            self._input(function, step, out[step])
        return out


class Gradients:
    """What Network.gradient() returns: loss, and derivatives of it.

    stiffness, damping, rest_length   (springs,)
    positions, velocities             (particles, 2), of the state at the start
    signals, forces                   (steps, actuators) and (steps, forced, 2)
    """

    def __init__(self, loss: float, values: Dict[str, np.ndarray]):
        self.loss = loss
        self.__dict__.update(values)

    def __repr__(self) -> str:
        return f"Gradients(loss={self.loss!r})"


def gradient_of(network: Any, loss: Callable[..., Any], steps: int, dt: float, signals: Any, forces: Any,
                forced: Any) -> Gradients:
    with Gradient(network, steps, forced) as run:
        for step in range(run.capacity):
            run.step(dt, None if signals is None else signals[step], None if forces is None else forces[step])
        value, *seeds = loss(network.positions, network.velocities)
        run.add_seeds(*seeds)
        run.reverse()
        values: Dict[str, np.ndarray] = {name: run.get(name) for name in _SPRINGS}
        values.update((name, getattr(run, name)) for name in ("positions", "velocities", "signals", "forces"))
    return Gradients(float(value), values)
