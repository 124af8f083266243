"""Measurements and tools of a network: energy, queries, stability, equilibrium, tuning and the plan.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Optional, Tuple

import numpy as np

from . import _header
from ._calls import NetworkCalls, Span
from ._core import Ids, bad_argument, empty, ffi, filled, lib, pointer, text_of, with_keywords
from .tuning import TuneTable

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import Body, Plan, SettleKeywords, SettleResult, SpringInfo, TuneKeywords


class Energy(NamedTuple):
    """Energies, J."""

    kinetic: float
    elastic: float
    potential: float

    @property
    def total(self) -> float:
        return self.kinetic + self.elastic + self.potential


class Momentum(NamedTuple):
    """Momentum, kg m/s, and angular momentum about the world's origin, kg m^2/s."""

    x: float
    y: float
    angular: float


class Bounds(NamedTuple):
    """The smallest box around all particles, m."""

    min_x: float
    min_y: float
    max_x: float
    max_y: float


class MeasureCalls(NetworkCalls):
    """Measurements and tools of a Network."""

    def _doubles(self, function: Any, count: int) -> Tuple[float, ...]:
        made = ffi.new("double[]", count)
        self._read(function, *(made + index for index in range(count)))
        return tuple(made)

    def energy(self) -> Energy:
        """Kinetic, elastic and potential energy, J, in double precision."""
        return Energy(*self._doubles(lib.mspring_network_energy, 3))

    def momentum(self) -> Momentum:
        """Momentum and angular momentum of what is not pinned."""
        return Momentum(*self._doubles(lib.mspring_network_momentum, 3))

    def bounds(self) -> Bounds:
        """The smallest box around all particles, m."""
        return Bounds(*self._doubles(lib.mspring_network_bounds, 4))

    def get_body(self, ids: Ids = None) -> Body:
        """Particles as one body: mass, centre, angle, motion and box.

        ids  None for all, an id, a range, a slice, a list of ids or a mask
        The angle is 0 unless the network was created with flags=massspring.NETWORK_POSES.
        """
        span = Span(ids, self.particle_count)
        listed = ffi.NULL if span.ids is None else pointer("mspring_id", span.ids)
        return self._report(_header.Body, "mspring_body", lib.mspring_network_get_body, listed, span.first, span.count)

    def max_strain(self) -> Tuple[float, Optional[int]]:
        """The largest absolute value of a strain, and the spring that has it."""
        strain, spring = ffi.new("float *"), ffi.new("mspring_id *")
        self._read(lib.mspring_network_max_strain, strain, spring)
        return strain[0], None if spring[0] == _header.NONE else spring[0]

    def get_spring(self, spring: int) -> SpringInfo:
        """Read the report of one spring."""
        return self._report(_header.SpringInfo, "mspring_spring_info", lib.mspring_network_get_spring, spring)

    # -------------------------------------------------------------------------------------------------- queries

    def nearest_particle(self, x: float, y: float, within: float = float("inf")) -> Tuple[Optional[int], float]:
        """The particle nearest to a point (m), or None, and its distance (m)."""
        particle, distance = ffi.new("mspring_id *"), ffi.new("double *")
        self._read(lib.mspring_network_nearest_particle, x, y, within, particle, distance)
        return None if particle[0] == _header.NONE else particle[0], distance[0]

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

    def nearest_spring(self, x: float, y: float, within: float = float("inf"),
                       flags: int = _header.FIND_WHOLE) -> Tuple[Optional[int], float, float]:
        """The spring nearest to a point (m), or None; where on it the nearest place is, from 0 to 1; its distance (m).

        flags  massspring.FIND_WHOLE, massspring.FIND_BROKEN or both
        """
        spring, made = ffi.new("mspring_id *"), ffi.new("double[2]")
        self._read(lib.mspring_network_nearest_spring, x, y, within, flags, spring, made, made + 1)
        return None if spring[0] == _header.NONE else spring[0], made[0], made[1]

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
        self._read(lib.mspring_network_springs_across, *from_, *to, flags, pointer("mspring_id", ids),
                   pointer("double", fractions), total, count)
        return ids[:count[0]].astype(np.int64), fractions[:count[0]].copy()

    # ---------------------------------------------------------------------------------- stability and equilibrium

    def stable_dt(self) -> Tuple[float, float]:
        """The longest stable explicit substep, s: in the present shape, and in any shape that it can reach."""
        made = ffi.new("double[2]")
        self._change(lib.mspring_network_stable_dt, made, made + 1)
        return made[0], made[1]

    def suggest_substeps(self, dt: float, safety: float = 0.95) -> int:
        """The smallest stable number of substeps in a step of dt (s)."""
        made = ffi.new("uint32_t *")
        self._change(lib.mspring_network_suggest_substeps, dt, safety, made)
        return made[0]

    @with_keywords("mspring_settle_def")
    def settle(self, **fields: Unpack[SettleKeywords]) -> SettleResult:
        """Move the particles to static equilibrium."""
        result = empty("mspring_settle_result")
        self._change(lib.mspring_network_settle, filled("mspring_settle_def", dict(fields)), result)
        return _header.SettleResult(result)

    def renew_relative_springs(self) -> None:
        """Compute relative springs from the present masses."""
        self._change(lib.mspring_network_renew_relative_springs)

    # --------------------------------------------------------------------------------------------------- tuning

    @with_keywords("mspring_tune_def", "mspring_tune_scene")
    def tune(self, settings: Optional[Iterable[dict]] = None, scene: Optional[dict] = None,
             **fields: Unpack[TuneKeywords]) -> TuneTable:
        """Measure cost and accuracy of settings of the solver, on clones of this network and this machine.

        settings  dicts of the arguments of set_solver(); None: those that the library suggests
        scene     dict of the fields of mspring_tune_scene, for networks that break; None: no scene
        The result is a list of dicts with the names of mspring_tune_row, and its frame() is a pandas.DataFrame.
        """
        def_ = filled("mspring_tune_def", dict(fields), ("setting_count",))
        if scene is not None:
            of_scene = filled("mspring_tune_scene", scene)
            def_.scene = of_scene
        with self._lock:
            tried = self._settings_to_tune(def_.dt, settings)
            def_.settings, def_.setting_count = tried, len(tried)
            rows, count = ffi.new("mspring_tune_row[]", len(tried)), ffi.new("uint32_t *")
            for row in rows:
                row.struct_size = ffi.sizeof(row)
            self._change(lib.mspring_network_tune, def_, rows, len(tried), count)
        return TuneTable(_header.TuneRow(rows[index]) for index in range(count[0]))

    def _settings_to_tune(self, dt: float, settings: Optional[Iterable[dict]]) -> Any:
        if settings is not None:
            listed = [filled("mspring_solver_def", dict(fields)) for fields in settings]
            if not listed:
                raise bad_argument("settings is empty")
            array = ffi.new("mspring_solver_def[]", len(listed))
            for index, struct in enumerate(listed):
                array[index] = struct[0]
            return array
        count = ffi.new("uint32_t *")
        self._change(lib.mspring_tune_settings, dt, ffi.NULL, 0, count)
        array = ffi.new("mspring_solver_def[]", count[0])
        for struct in array:
            struct.struct_size = ffi.sizeof(struct)
        self._change(lib.mspring_tune_settings, dt, array, count[0], count)
        return array

    # ------------------------------------------------------------------------------------------ plan and machine

    @property
    def plan(self) -> Plan:
        """How the network is laid out in memory."""
        return self._report(_header.Plan, "mspring_plan", lib.mspring_network_get_plan)

    @property
    def memory_used(self) -> int:
        """Bytes that the network has allocated."""
        return self._value(lib.mspring_network_memory_used)

    @property
    def worker_count(self) -> int:
        """Threads that step the network."""
        return self._value(lib.mspring_network_worker_count)

    @property
    def simd_level(self) -> str:
        """Name of the instruction set that steps use, such as "avx2"."""
        return text_of(lib.mspring_simd_name(self._value(lib.mspring_network_simd_level)))

