"""The state of a network: positions, velocities, forces, properties, and views without a copy.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Optional, Tuple, Union

import numpy as np

from . import _header
from ._calls import Export, NetworkCalls, output
from ._core import Ids, Span, bad_argument, column, defaults, enum_value, ffi, lib, pointer, word
from ._types import StaleViewError

if TYPE_CHECKING:
    from ._header import Property, PropertyName, Push, PushName


class StateView:
    """The state as it lies in memory, without a copy: read-only arrays by slot. Network.view is one.

    x, y, vx, vy      float32 by slot, m relative to origin, and m/s
    inverse_mass      float32 by slot, 1/kg; 0 if the particle is pinned, or where there is none
    particle_of_slot  uint32 by slot: the particle's id, or NONE
    slot_of_particle  uint32 by id
    origin            (x, y), m: world position = origin + (x, y)

    When the network has changed, each of these is a StaleViewError: take a new view. An array that you keep follows
    the steps, whose origin may move. It stays valid memory even after close().
    """

    _ARRAYS = {"x": "f4", "y": "f4", "vx": "f4", "vy": "f4", "inverse_mass": "f4", "particle_of_slot": "u4",
               "slot_of_particle": "u4"}

    def __init__(self, network: StateCalls):
        with network._lock:
            self._struct = defaults("mspring_view")
            network._read(lib.mspring_network_get_view, self._struct)
            self._network, self._changes, self._owner = network, network._changes, network._live()

    def _now(self) -> Any:
        self._network._live()
        if self._network._changes != self._changes:
            raise StaleViewError("the network has changed since this view was taken: take a new one")
        return self._struct

    def __getattr__(self, name: str) -> np.ndarray:
        if name not in self._ARRAYS:
            raise AttributeError(name)
        with self._network._lock:  # another thread might move the memory
            struct = self._now()
            count = struct.particle_count if name == "slot_of_particle" else struct.slot_count
            export = Export(self._owner, getattr(struct, name), count, self._ARRAYS[name])
            self._network._exports.add(export)
            return np.asarray(export)

    @property
    def origin(self) -> Tuple[float, float]:
        """World position (m) to which x and y are relative."""
        struct = self._now()
        return struct.origin_x, struct.origin_y

    @property
    def slot_count(self) -> int:
        """Length of the arrays by slot."""
        return self._now().slot_count


def default_of(number: int) -> Any:
    """The value of a property for which none was given."""
    name = _header.Property(number).name.lower()
    kind = ("mspring_particle_def", "mspring_spring_def")[number >> 8] if number >> 8 < 2 else None
    if kind and name in _header.KEYWORDS[kind]:
        return getattr(defaults(kind), name)
    if number not in _header.PROPERTY_DEFAULTS:
        raise TypeError(f"{name} is None, but it has no default: give a number")
    return _header.PROPERTY_DEFAULTS[number]


class StateCalls(NetworkCalls):
    """State and properties of a Network."""

    @property
    def view(self) -> StateView:
        """The state as it lies in memory, without a copy."""
        return StateView(self)

    # ---------------------------------------------------------------------------------- positions and velocities

    def get_positions(self, ids: Ids = None, out: Optional[np.ndarray] = None) -> np.ndarray:
        """World positions, m: float64 (n, 2), or (2,) for one id.

        ids  None for all, an id, a range, a slice, a list of ids or a mask
        out  (n, 2), contiguous, float64, to fill instead of a new array
        """
        span = self._particles(ids)
        return self._pairs(lib.mspring_network_get_positions, span, "double", output(out, (span.count, 2), "f8"))

    def set_positions(self, values: Any, ids: Ids = None) -> None:
        """Set world positions, m: (n, 2), or (2,) for all of them."""
        self._set_pairs(lib.mspring_network_set_positions, (), self._particles(ids), "double", "positions", values)

    def get_velocities(self, ids: Ids = None, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Velocities, m/s: float32 (n, 2), or (2,) for one id. Explicit steps leave those of half a substep ago."""
        span = self._particles(ids)
        return self._pairs(lib.mspring_network_get_velocities, span, "float", output(out, (span.count, 2), "f4"))

    def set_velocities(self, values: Any, ids: Ids = None) -> None:
        """Set velocities, m/s: (n, 2), or (2,) for all of them. A pinned particle moves by its velocity."""
        self._set_pairs(lib.mspring_network_set_velocities, (), self._particles(ids), "float", "velocities", values)

    @property
    def positions(self) -> np.ndarray:
        """World positions of all particles by id, m: a copy, float64 (n, 2). Assign to it to set them."""
        return self.get_positions()

    @positions.setter
    def positions(self, values: Any) -> None:
        self.set_positions(values)

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of all particles by id, m/s: a copy, float32 (n, 2). Assign to it to set them."""
        return self.get_velocities()

    @velocities.setter
    def velocities(self, values: Any) -> None:
        self.set_velocities(values)

    @property
    def state_hash(self) -> int:
        """Hash of positions, velocities, their lag and origin. Equal states have equal hashes on every machine."""
        made = ffi.new("uint64_t *")
        self._read(lib.mspring_network_get_state_hash, made)
        return made[0]

    # ------------------------------------------------------------------------------------------------- forces

    def apply_forces(self, forces: Any, ids: Ids = None, push: Union[Push, PushName] = "step") -> None:
        """Add forces during the whole next step, N: (n, 2), or (2,) for each. On an id that repeats they add up.

        push  "step"; "substep": only during its first substep; or "impulse": these are impulses, N s, which change
              velocities at once
        """
        self._set_pairs(lib.mspring_network_apply_forces, (enum_value("mspring_push", "push", push),),
                        self._particles(ids), "float", "forces", forces)

    def apply_torque(self, torque: float, ids: Ids = None) -> None:
        """Add a torque during the next step, N m: forces around the centre of mass, whose sum is 0."""
        self._change(lib.mspring_network_apply_torque, *self._particles(ids).arguments, torque)

    # --------------------------------------------------------------------------------------------- properties

    def _property(self, name: Any, ids: Ids) -> Tuple[int, Span, str, str]:
        """Its number, the things, and the types of numpy and C. Bits of the number name the kind and the type."""
        number = enum_value("mspring_property", "property", name)
        is_integer = number >> 7 & 1
        return number, Span(ids, self._count(number >> 8)), ("f4", "u4")[is_integer], ("float", "uint32_t")[is_integer]

    def get(self, property: Union[Property, PropertyName], ids: Ids = None, out: Optional[np.ndarray] = None) -> Any:
        """Read a property: float32 or, of flags, layers and ids, uint32 (n,); or one number for one id.

        property  such as "mass" (kg), "strain", "tension" (N), "layers" or "pressure" (N/m): see Property
        ids       None for all, an id, a range, a slice, a list of ids or a mask
        """
        number, span, dtype, ctype = self._property(property, ids)
        out = output(out, (span.count,), dtype)
        function = lib.mspring_network_get if dtype == "f4" else lib.mspring_network_get_integers
        self._read(function, number, *span.arguments, pointer(ctype, out), 1)
        return out[0].item() if span.is_one else out

    def set(self, property: Union[Property, PropertyName], values: Any, ids: Ids = None) -> None:
        """Set a property: all values or, on error, none.

        values  (n,), or one for all; None for the default, as of break_strain or friction
        """
        number, span, dtype, ctype = self._property(property, ids)
        if values is None:
            values = default_of(number)
        elif isinstance(values, str):
            values = word(_header.Property(number).name.lower(), values)
        array = np.ascontiguousarray(column("values", values, span.count, np.dtype(dtype)), dtype)
        function = lib.mspring_network_set if dtype == "f4" else lib.mspring_network_set_integers
        self._change(function, number, *span.arguments, pointer(ctype, array), int(np.ndim(values)))

    def columns(self, *properties: Union[Property, PropertyName], ids: Ids = None) -> List[Any]:
        """Read properties of the same things in one pass: length, strain = network.columns("length", "strain").

        Each is what get() returns. Lengths, directions and strains together take little longer than one of them.
        """
        if not properties:
            raise bad_argument("columns() needs properties")
        wanted = [self._property(name, ids) for name in properties]
        columns = ffi.new("mspring_column[]", len(wanted))
        span = wanted[0][1]  # the library sees whether all are of its kind
        arrays = [np.empty(span.count, dtype) for _, _, dtype, _ in wanted]
        for column_, (number, _, _, ctype), array in zip(columns, wanted, arrays):
            column_.property, column_.stride, column_.values = number, 1, pointer(ctype, array)
        self._read(lib.mspring_network_get_columns, *span.arguments, columns, len(wanted))
        return [array[0].item() for array in arrays] if span.is_one else arrays

    @property
    def ends(self) -> np.ndarray:
        """Particles at the ends of all springs by id: uint32 (n, 2). NONE for removed ones."""
        return np.stack(self.columns("end_a", "end_b"), 1)
