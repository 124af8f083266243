"""Edits of a network, events and components.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Tuple

import numpy as np

from . import _header
from ._calls import NetworkCalls, Span
from ._core import Ids, dtype_of, ffi, lib, pointer, with_keywords
from .builder import particle_rows, spring_rows

if TYPE_CHECKING:
    from ._header import Component

EVENT = dtype_of("mspring_event")


class EditCalls(NetworkCalls):
    """Edits, events and components of a Network."""

    events_lost = 0  # events that a full queue has lost since reserve_events(), as of the last read_events()

    def _list(self, function: Any, ids: Ids, total: int, *more: Any) -> None:
        listed = Span(ids, total).as_list()
        self._change(function, pointer("mspring_id", listed), len(listed), *more)

    def break_springs(self, springs: Ids) -> None:
        """Break springs: an id, a list of ids, a range or a mask. They exert nothing until they are restored."""
        self._list(lib.mspring_network_break_springs, springs, self.spring_count)

    def restore_springs(self, springs: Ids, ramp_seconds: float = 0.0) -> None:
        """Restore broken springs. With a ramp (s of simulated time), the rest length goes evenly to its own."""
        listed = Span(springs, self.spring_count).as_list()
        call = self._relayout if self._was_compacted else self._change
        call(lib.mspring_network_restore_springs, pointer("mspring_id", listed), len(listed), ramp_seconds)

    def detach_particles(self, particles: Ids) -> None:
        """Break all springs of particles, which become loose."""
        self._list(lib.mspring_network_detach_particles, particles, self.particle_count)

    @with_keywords("mspring_particle_def")
    def add_particles(self, positions: Any, velocities: Any = None, **columns: Any) -> np.ndarray:
        """Add particles, as many as spare_particles has room for: all or, on error, none. Returns their ids.

        As Builder.add_particles().
        """
        rows = particle_rows(positions, velocities, columns)
        ids = np.empty(len(rows), np.uint32)
        self._change(lib.mspring_network_add_particles, pointer("mspring_particle_def", rows), len(rows),
                     pointer("mspring_id", ids))
        return ids.astype(np.int64)

    @with_keywords("mspring_spring_def")
    def add_springs(self, pairs: Any, **columns: Any) -> np.ndarray:
        """Add springs, as many as spare_springs has room for: all or, on error, none. Returns their ids.

        As Builder.add_springs().
        """
        rows = spring_rows(pairs, columns)
        ids = np.empty(len(rows), np.uint32)
        self._change(lib.mspring_network_add_springs, pointer("mspring_spring_def", rows), len(rows),
                     pointer("mspring_id", ids))
        return ids.astype(np.int64)

    def remove_particles(self, particles: Ids) -> None:
        """Remove particles with all their springs, for good."""
        self._list(lib.mspring_network_remove_particles, particles, self.particle_count)

    def remove_springs(self, springs: Ids) -> None:
        """Remove springs, for good."""
        self._list(lib.mspring_network_remove_springs, springs, self.spring_count)

    def recycle(self) -> None:
        """Allow that added particles and springs get ids of added ones that were removed."""
        self._change(lib.mspring_network_recycle)

    def has_particle(self, particle: int) -> bool:
        """Whether there is such a particle."""
        return 0 <= particle <= _header.NONE and bool(self._value(lib.mspring_network_has_particle, particle))

    def has_spring(self, spring: int) -> bool:
        """Whether there is such a spring."""
        return 0 <= spring <= _header.NONE and bool(self._value(lib.mspring_network_has_spring, spring))

    # --------------------------------------------------------------------------------------------------- events

    def reserve_events(self, capacity: int) -> None:
        """Reserve room for events, which are recorded from then on. Events that were not read are dropped."""
        self._change(lib.mspring_network_reserve_events, capacity)
        self._event_capacity = capacity

    _event_capacity = 0

    def read_events(self) -> np.ndarray:
        """Read and remove all events that wait, oldest first: an array with kind (EventKind), id, other and strain."""
        events = np.empty(self._event_capacity, EVENT)
        count, lost = ffi.new("uint32_t *"), ffi.new("uint64_t *")
        self._change(lib.mspring_network_read_events, pointer("mspring_event", events), len(events), count, lost)
        self.events_lost = lost[0]
        if 0 < count[0] == len(events):  # there may be more, of a network from an archive
            return np.concatenate((events, self.read_events()))
        return events[:count[0]].copy()

    # ----------------------------------------------------------------------------------------------- components

    def update_components(self) -> Tuple[int, bool]:
        """Update the components. Returns their number, and whether a particle's component has another number now."""
        count, has_changed = ffi.new("uint32_t *"), ffi.new("uint32_t *")
        self._change(lib.mspring_network_update_components, count, has_changed)
        self._component_count = count[0]
        return count[0], bool(has_changed[0])

    _component_count = 0

    @property
    def component_numbers(self) -> np.ndarray:
        """Component of each particle by id, as of the last update_components(): uint32, NONE for removed ones."""
        out = np.empty(self.particle_count, np.uint32)
        self._read(lib.mspring_network_get_component_numbers, 0, len(out), pointer("uint32_t", out), 1)
        return out

    @property
    def components(self) -> List[Component]:
        """Head, size, mass (kg), centre (m) and momentum (kg m/s) of the components of the last update_components()."""
        structs = ffi.new("mspring_component[]", max(self._component_count, 1))
        for struct in structs:
            struct.struct_size = ffi.sizeof(struct)
        self._read(lib.mspring_network_get_components, 0, self._component_count, structs)
        return [_header.Component(structs[index]) for index in range(self._component_count)]

    # ----------------------------------------------------------------------------------------------- compaction

    def compact(self) -> None:
        """Leave broken springs out of the plan, and take added ones in. Arrays of views must be gone: BufferError."""
        self._relayout(lib.mspring_network_compact)
        self._was_compacted = True

    def expand(self) -> None:
        """Take all springs into the plan again. Arrays of views must be gone: BufferError."""
        self._relayout(lib.mspring_network_expand)
        self._was_compacted = False

