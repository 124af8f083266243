"""The state of a network: positions, velocities, forces, properties, and views without a copy.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Tuple, Union

import numpy as np

from . import _header
from ._calls import Export, NetworkCalls, Span, output
from ._core import Ids, bad_argument, empty, enum_value, ffi, lib, numbers, pointer
from ._types import StaleViewError

if TYPE_CHECKING:
    from ._header import Property, PropertyName


class StateView:
    """The state as it lies in memory, without a copy: read-only arrays by slot. Network.view() makes it.

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
            self._struct = empty("mspring_view")
            network._read(lib.mspring_network_view, self._struct)
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


class StateCalls(NetworkCalls):
    """State and properties of a Network."""

    def view(self) -> StateView:
        """The state as it lies in memory, without a copy."""
        return StateView(self)

    # ---------------------------------------------------------------------------------- positions and velocities

    def get_positions(self, ids: Ids = None, out: Optional[np.ndarray] = None) -> np.ndarray:
        """World positions, m: float64 (n, 2), or (2,) for one id.

        ids  None for all, an id, a range, a slice, a list of ids or a mask
        out  (n, 2), contiguous, float64 or float32, to fill instead of a new array
        """
        span = Span(ids, self.particle_count)
        if out is not None and getattr(out, "dtype", None) == np.float32:
            out = output(out, (span.count, 2), "f4")
            return self._pairs(lib.mspring_network_get_positions_float, lib.mspring_network_get_positions_float_at,
                               span, "float", out)
        out = output(out, (span.count, 2), "f8")
        return self._pairs(lib.mspring_network_get_positions, lib.mspring_network_get_positions_at, span, "double", out)

    def set_positions(self, values: Any, ids: Ids = None) -> None:
        """Set world positions, m: (n, 2), or (2,) for all of them."""
        self._set_pairs(lib.mspring_network_set_positions, lib.mspring_network_set_positions_at,
                        Span(ids, self.particle_count), "double", "positions", values)

    def get_velocities(self, ids: Ids = None, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Velocities, m/s: float32 (n, 2), or (2,) for one id. Explicit steps leave those of half a substep ago."""
        span = Span(ids, self.particle_count)
        return self._pairs(lib.mspring_network_get_velocities, lib.mspring_network_get_velocities_at, span, "float",
                           output(out, (span.count, 2), "f4"))

    def set_velocities(self, values: Any, ids: Ids = None) -> None:
        """Set velocities, m/s: (n, 2), or (2,) for all of them. A pinned particle moves by its velocity."""
        self._set_pairs(lib.mspring_network_set_velocities, lib.mspring_network_set_velocities_at,
                        Span(ids, self.particle_count), "float", "velocities", values)

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

    def state_hash(self) -> int:
        """Hash of positions, velocities, their lag and origin. Equal states have equal hashes on every machine."""
        made = ffi.new("uint64_t *")
        self._read(lib.mspring_network_state_hash, made)
        return made[0]

    # ------------------------------------------------------------------------------------------------- forces

    def apply_forces(self, forces: Any, ids: Ids = None) -> None:
        """Add forces during the whole next step, N: (n, 2), or (2,) for each. Forces on an id that repeats add up."""
        self._set_pairs(lib.mspring_network_apply_forces, lib.mspring_network_apply_forces_at,
                        Span(ids, self.particle_count), "float", "forces", forces)

    def apply_impulses(self, impulses: Any, ids: Ids = None) -> None:
        """Change velocities by impulses at once, N s: (n, 2), or (2,) for each."""
        self._set_pairs(lib.mspring_network_apply_impulses, lib.mspring_network_apply_impulses_at,
                        Span(ids, self.particle_count), "float", "impulses", impulses)

    def apply_torque(self, torque: float, ids: Ids = None) -> None:
        """Add a torque during the next step, N m: forces around the centre of mass, whose sum is 0."""
        span = Span(ids, self.particle_count)
        listed = ffi.NULL if span.ids is None else pointer("mspring_id", span.ids)
        self._change(lib.mspring_network_apply_torque, listed, span.first, span.count, torque)

    # --------------------------------------------------------------------------------------------- properties

    def _property(self, name: Union[Property, str, int], ids: Ids) -> Tuple[int, Span]:
        number = enum_value("mspring_property", "property", name)
        of_particles = number in _header.PARTICLE_PROPERTIES
        return number, Span(ids, self.particle_count if of_particles else self.spring_count)

    def get(self, property: Union[Property, PropertyName], ids: Ids = None, out: Optional[np.ndarray] = None) -> Any:
        """Read a property of particles or springs: float32 (n,), or one number for one id.

        property  such as "mass" (kg), "stiffness" (N/m), "rest_length" (m), "strain" or "force" (N): see Property
        ids       None for all, an id, a range, a slice, a list of ids or a mask
        """
        number, span = self._property(property, ids)
        out = output(out, (span.count,), "f4")
        values = pointer("float", out)
        if span.ids is None:
            self._read(lib.mspring_network_get, number, span.first, span.count, values, 1)
        else:
            self._read(lib.mspring_network_get_at, number, pointer("mspring_id", span.ids), span.count, values, 1)
        return float(out[0]) if span.is_one else out

    def set(self, property: Union[Property, PropertyName], values: Any, ids: Ids = None) -> None:
        """Set a property of particles or springs: all values or, on error, none. values is (n,), or one for all."""
        number, span = self._property(property, ids)
        array = np.atleast_1d(numbers("values", values, "f4", (None,) * np.ndim(values)))
        if np.ndim(values) > 1 or (np.ndim(values) and len(array) != span.count):
            raise bad_argument(f"values has the shape {np.shape(values)}: it must be a number or ({span.count},)")
        stride = 1 if np.ndim(values) else 0
        if span.ids is None:
            self._change(lib.mspring_network_set, number, span.first, span.count, pointer("float", array), stride)
        else:
            self._change(lib.mspring_network_set_at, number, pointer("mspring_id", span.ids), span.count,
                         pointer("float", array), stride)

    @property
    def strains(self) -> np.ndarray:
        """Strains of all springs by id: float32. 0 if a spring is broken."""
        return self.get("strain")

    @property
    def ends(self) -> np.ndarray:
        """Particles at the ends of all springs by id: uint32 (n, 2). NONE for removed ones."""
        out = np.empty((self.spring_count, 2), np.uint32)
        self._read(lib.mspring_network_get_ends, 0, len(out), _header.ENDS_IDS, pointer("uint32_t", out),
                   pointer("uint32_t", out, 1), 2)
        return out

    @property
    def spring_flags(self) -> np.ndarray:
        """Flags of all springs by id: uint32, such as SPRING_BROKEN."""
        out = np.empty(self.spring_count, np.uint32)
        self._read(lib.mspring_network_get_spring_flags, 0, len(out), pointer("uint32_t", out), 1)
        return out

    @property
    def sleepers(self) -> np.ndarray:
        """Which particles sleep, by id: booleans."""
        out = np.empty(self.particle_count, np.uint8)
        self._read(lib.mspring_network_get_sleepers, 0, len(out), pointer("uint8_t", out), 1)
        return out.astype(bool)
