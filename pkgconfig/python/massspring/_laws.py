"""Elements: areas and angle springs.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._calls import NetworkCalls
from ._core import Ids, Span, ffi, filled, id_array, lib, pointer, with_keywords

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import AngleKeywords, AreaKeywords


class LawCalls(NetworkCalls):
    """Areas and angle springs of a Network. They are read and changed by properties: get("pressure", area)."""

    @with_keywords("mspring_area_def")
    def add_area(self, particles: Any, **fields: Unpack[AreaKeywords]) -> int:
        """Add an area around a polygon of particles: a balloon, a tyre. Returns its id. kind: "elastic", "gas"."""
        corners = id_array("particles", particles)
        return self._made(lib.mspring_network_add_area, filled("mspring_area_def", dict(fields)),
                          pointer("mspring_id", corners), len(corners))

    @with_keywords("mspring_area_def")
    def add_cell_areas(self, **fields: Unpack[AreaKeywords]) -> range:
        """Add an area to each lattice cell, so that jelly turns back. Returns their ids."""
        made, count = ffi.new("mspring_id *"), ffi.new("uint32_t *")
        self._change(lib.mspring_network_add_cell_areas, filled("mspring_area_def", dict(fields)), made, count)
        return range(made[0], made[0] + count[0])

    @with_keywords("mspring_angle_def")
    def add_angles(self, particles: Any, **fields: Unpack[AngleKeywords]) -> range:
        """Add angle springs: of beams and spines. Returns their ids.

        particles  (n, 3): three of each; or (n + 2,): a chain, with an angle at each of its inner particles
        """
        is_chain = np.ndim(particles) == 1
        ids = id_array("particles", particles, (None,) if is_chain else (None, 3))
        count = max(len(ids) - 2 * is_chain, 0)
        first = self._made(lib.mspring_network_add_angles, filled("mspring_angle_def", dict(fields)),
                           pointer("mspring_id", ids), count, 1 if is_chain else 3)
        return range(first, first + count)

    def remove_elements(self, elements: Ids) -> None:
        """Remove areas and angle springs, for good."""
        self._change(lib.mspring_network_remove_elements, *Span(elements, self.element_count).arguments)

    def get_element_particles(self, element: int) -> np.ndarray:
        """Read the particles of an element: of an area in the order in which it is positive, of an angle all three."""
        count = ffi.new("uint32_t *")
        with self._lock:
            self._read(lib.mspring_network_get_element_particles, element, ffi.NULL, 0, count)
            out = np.empty(count[0], np.uint32)
            self._read(lib.mspring_network_get_element_particles, element, pointer("mspring_id", out), len(out), count)
        return out.astype(np.int64)
