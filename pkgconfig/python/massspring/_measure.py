"""Measurements and tools of a network: energy, queries, stability, equilibrium and tuning.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Iterable, Optional, Tuple

import numpy as np

from . import _header
from ._calls import NetworkCalls
from ._core import Ids, array_for, defaults, ffi, filled, lib, pair, pointer, record_of, text_of, with_keywords
from .tuning import TuneTable

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import Body, Energy, NetworkInfo, SettleKeywords, SettleResult, TuneKeywords


class MeasureCalls(NetworkCalls):
    """Measurements and tools of a Network."""

    @property
    def energy(self) -> Energy:
        """Energies (J) and extremes: the fastest particle, the most strained spring."""
        return self._report("mspring_energy", lib.mspring_network_get_energy)

    def get_body(self, ids: Ids = None) -> Body:
        """Particles as one body: mass, centre, angle, motion and box.

        ids  None for all, an id, a range, a slice, a list of ids or a mask
        The angle is 0 unless the network was created with poses=True.
        """
        return self._report("mspring_body", lib.mspring_network_get_body, *self._particles(ids).arguments)

    @property
    def body(self) -> Body:
        """All particles as one body: momentum, box and so on."""
        return self.get_body()

    # -------------------------------------------------------------------------------------------------- queries

    def _nearest(self, function: Any, doubles: int, *arguments: Any) -> Tuple[Any, ...]:
        found, made = ffi.new("mspring_id *"), ffi.new("double[]", doubles)
        self._read(function, *arguments, found, *(made + index for index in range(doubles)))
        return (None if found[0] == _header.NONE else found[0], *made)

    def nearest_particle(self, x: float, y: float, within: float = float("inf")) -> Tuple[Optional[int], float]:
        """The particle nearest to a point (m), or None, and its distance (m)."""
        particle, distance = self._nearest(lib.mspring_network_nearest_particle, 1, x, y, within)
        return particle, distance

    def nearest_spring(self, x: float, y: float, within: float = float("inf"),
                       flags: int = _header.FIND_WHOLE) -> Tuple[Optional[int], float, float]:
        """The spring nearest to a point (m), or None; where on it the nearest place is, from 0 to 1; its distance (m).

        flags  massspring.FIND_WHOLE, massspring.FIND_BROKEN or both
        """
        spring, fraction, distance = self._nearest(lib.mspring_network_nearest_spring, 2, x, y, within, flags)
        return spring, fraction, distance

    def _found(self, function: Any, total: int, *arguments: float) -> np.ndarray:
        ids, count = np.empty(total, np.uint32), ffi.new("uint32_t *")
        self._read(function, *arguments, pointer("mspring_id", ids), total, count)
        return ids[:count[0]].astype(np.int64)

    def particles_in_circle(self, x: float, y: float, radius: float) -> np.ndarray:
        """Ids of the particles in a circle, its edge included, m."""
        return self._found(lib.mspring_network_particles_in_circle, self.particle_count, x, y, radius)

    def particles_in_box(self, min_x: float, min_y: float, max_x: float, max_y: float) -> np.ndarray:
        """Ids of the particles in a box, its edges included, m."""
        return self._found(lib.mspring_network_particles_in_box, self.particle_count, min_x, min_y, max_x, max_y)

    def springs_in_circle(self, x: float, y: float, radius: float, flags: int = _header.FIND_WHOLE) -> np.ndarray:
        """Ids of the springs that come into a circle, its edge included, m. flags: as of nearest_spring()"""
        return self._found(lib.mspring_network_springs_in_circle, self.spring_count, x, y, radius, flags)

    def springs_across(self, from_: Tuple[float, float], to: Tuple[float, float],
                       flags: int = _header.FIND_WHOLE) -> Tuple[np.ndarray, np.ndarray]:
        """Ids of the springs that a straight line meets, and where: from 0 at its start to 1 at its end.

        flags  as of nearest_spring()
        """
        total, count = self.spring_count, ffi.new("uint32_t *")
        ids, fractions = np.empty(total, np.uint32), np.empty(total, np.float64)
        self._read(lib.mspring_network_springs_across, *pair("from_", from_), *pair("to", to), flags, pointer("mspring_id", ids),
                   pointer("double", fractions), total, count)
        return ids[:count[0]].astype(np.int64), fractions[:count[0]].copy()

    # ---------------------------------------------------------------------------------- stability and equilibrium

    @property
    def stable_dt(self) -> Tuple[float, ...]:
        """The longest stable explicit substep, s: in the present shape, and in any shape that it can reach."""
        return self._doubles(lib.mspring_network_get_stable_dt, 2)

    def suggest_substeps(self, dt: float, safety: float = 0.95) -> int:
        """The smallest stable number of substeps in a step of dt (s)."""
        made = ffi.new("uint32_t *")
        self._read(lib.mspring_network_suggest_substeps, dt, safety, made)
        return made[0]

    @with_keywords("mspring_settle_def")
    def settle(self, **fields: Unpack[SettleKeywords]) -> SettleResult:
        """Move the particles to static equilibrium."""
        result = defaults("mspring_settle_result")
        self._change(lib.mspring_network_settle, filled("mspring_settle_def", dict(fields)), result)
        return record_of("mspring_settle_result", result)

    # --------------------------------------------------------------------------------------------------- tuning

    @with_keywords("mspring_tune_def", "mspring_tune_scene")
    def tune(self, settings: Optional[Iterable[Dict[str, Any]]] = None, scene: Optional[Dict[str, Any]] = None,
             **fields: Unpack[TuneKeywords]) -> TuneTable:
        """Measure cost and accuracy of settings of the solver, on clones of this network and this machine.

        settings  dicts of the arguments of set_settings(); None: those that the library suggests
        scene     dict of the fields of mspring_tune_scene, for networks that break; None: no scene
        The result is a list of dicts with the names of mspring_tune_row, and its frame() is a pandas.DataFrame.
        """
        def_ = filled("mspring_tune_def", {"settings": settings, "scene": scene, **fields})
        count = ffi.new("uint32_t *", def_.setting_count)
        with self._lock:
            if settings is None:
                self._read(lib.mspring_tune_settings, def_.dt, ffi.NULL, 0, count)
            rows = array_for("mspring_tune_row", count[0])
            self._change(lib.mspring_network_tune, def_, rows, len(rows), count)
        return TuneTable(record_of("mspring_tune_row", rows[index]) for index in range(count[0]))

    # ------------------------------------------------------------------------------------------ plan and machine

    @property
    def info(self) -> NetworkInfo:
        """How the network is laid out and run: instruction set, workers, room, memory."""
        return self._report("mspring_network_info", lib.mspring_network_get_info)

    @property
    def description(self) -> str:
        """How the network is laid out and solved: lines of a name and a number each, which may change."""
        size = ffi.new("size_t *")
        with self._lock:
            self._read(lib.mspring_network_describe, ffi.NULL, 0, size)
            text = ffi.new("char[]", size[0])
            self._read(lib.mspring_network_describe, text, size[0], size)
        return text_of(text)
