"""Edits of a network, events and components.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Tuple

import numpy as np

from . import _header
from ._calls import NetworkCalls
from ._core import Ids, array_for, dtype_of, ffi, lib, pointer, record_of, with_keywords
from .builder import particle_rows, spring_rows

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import Body, ParticleColumns, SpringColumns

AT_ONCE = 4096  # events that are read in a call


class EditCalls(NetworkCalls):
    """Edits, events and components of a Network."""

    events_lost = 0  # events that a full queue has lost since reserve_events(), as of the last read_events()
    contact_events_lost = 0  # contact events that had no room, as of the last read_contact_events()

    def break_springs(self, springs: Ids) -> None:
        """Break springs: an id, a list of ids, a range or a mask. They exert nothing until they are restored."""
        self._change(lib.mspring_network_break_springs, *self._springs(springs).arguments)

    def restore_springs(self, springs: Ids, ramp_seconds: float = 0.0) -> None:
        """Restore broken springs. With a ramp (s of simulated time), the rest length goes evenly to its own."""
        call = self._relayout if self._was_compacted else self._change
        call(lib.mspring_network_restore_springs, *self._springs(springs).arguments, ramp_seconds)

    def detach_particles(self, particles: Ids) -> None:
        """Break all springs of particles, which become loose."""
        self._change(lib.mspring_network_detach_particles, *self._particles(particles).arguments)

    def _added(self, function: Any, ctype: str, rows: np.ndarray) -> np.ndarray:
        ids = np.empty(len(rows), np.uint32)
        self._change(function, pointer(ctype, rows), len(rows), pointer("mspring_id", ids))
        return ids.astype(np.int64)

    @with_keywords("mspring_particle_def")
    def add_particles(self, positions: Any, velocities: Any = None,
                      **columns: Unpack[ParticleColumns]) -> np.ndarray:
        """Add particles, as many as spare_particles has room for: all or, on error, none. Returns their ids.

        As Builder.add_particles().
        """
        return self._added(lib.mspring_network_add_particles, "mspring_particle_def",
                           particle_rows(positions, velocities, dict(columns)))

    @with_keywords("mspring_spring_def")
    def add_springs(self, pairs: Any, **columns: Unpack[SpringColumns]) -> np.ndarray:
        """Add springs, as many as spare_springs has room for: all or, on error, none. Returns their ids.

        As Builder.add_springs().
        """
        return self._added(lib.mspring_network_add_springs, "mspring_spring_def", spring_rows(pairs, dict(columns)))

    def remove_particles(self, particles: Ids) -> None:
        """Remove particles with all their springs, for good."""
        self._change(lib.mspring_network_remove_particles, *self._particles(particles).arguments)

    def remove_springs(self, springs: Ids) -> None:
        """Remove springs, for good."""
        self._change(lib.mspring_network_remove_springs, *self._springs(springs).arguments)

    def reuse_ids(self) -> None:
        """Allow that added particles and springs get ids of added ones that were removed."""
        self._change(lib.mspring_network_reuse_ids)

    def compact(self) -> None:
        """Leave broken springs out of the plan, and take added ones in. Arrays of views must be gone: BufferError."""
        self._relayout(lib.mspring_network_compact)
        self._was_compacted = True

    # --------------------------------------------------------------------------------------------------- events

    def reserve_events(self, capacity: int) -> None:
        """Reserve room for events, which are recorded from then on. Events that were not read are dropped."""
        self._change(lib.mspring_network_reserve_events, capacity)

    def _events(self, function: Any, kind: str) -> Tuple[np.ndarray, int]:
        """All events that wait, and how many were lost."""
        pieces, count, lost = [], ffi.new("uint32_t *", AT_ONCE), ffi.new("uint64_t *")
        while count[0] == AT_ONCE:
            events = np.zeros(AT_ONCE, dtype_of(kind))
            if kind in _header.STRUCTS:
                events["struct_size"] = events.itemsize
            self._change(function, pointer(kind, events), AT_ONCE, count, lost)
            pieces.append(events[:count[0]])
        return np.concatenate(pieces), lost[0]

    def read_events(self) -> np.ndarray:
        """Read and remove all events that wait, oldest first: an array with kind (EventKind), id, other and strain."""
        events, self.events_lost = self._events(lib.mspring_network_read_events, "mspring_event")
        return events

    def read_contact_events(self) -> np.ndarray:
        """Read and remove all contact events that wait, oldest first, with the fields of ContactEvent.

        set_contact(event_capacity=...) reserves room for them.
        """
        events, self.contact_events_lost = self._events(lib.mspring_network_read_contact_events,
                                                        "mspring_contact_event")
        return events

    # ----------------------------------------------------------------------------------------------- components

    def update_components(self) -> Tuple[int, bool]:
        """Update the components. Returns their number, and whether a particle's component has another number now.

        get("component") has the number of each particle's component.
        """
        count, has_changed = ffi.new("uint32_t *"), ffi.new("uint32_t *")
        self._change(lib.mspring_network_update_components, count, has_changed)
        return count[0], bool(has_changed[0])

    @property
    def components(self) -> List[Body]:
        """The components of the last update_components() as bodies: head, mass (kg), centre (m), momentum and so on."""
        numbers = np.empty(self.particle_count, np.uint32)
        with self._lock:
            self._read(lib.mspring_network_get_integers, _header.COMPONENT, ffi.NULL, 0, len(numbers),
                       pointer("uint32_t", numbers), 1)
            count = int((numbers + np.uint32(1)).max())  # NONE, of removed particles, becomes 0
            bodies = array_for("mspring_body", count)
            self._read(lib.mspring_network_get_components, 0, count, bodies)
        return [record_of("mspring_body", body) for body in bodies]
