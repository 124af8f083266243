"""Laws beyond the linear spring: areas and angle springs.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Tuple, Union

import numpy as np

from . import _header
from ._calls import NetworkCalls
from ._core import bad_argument, ffi, filled, id_array, lib, pointer, with_keywords

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import AngleDef, AngleInfo, AngleKeywords, AreaDef, AreaInfo, AreaKeywords


class LawCalls(NetworkCalls):
    """Areas and angle springs of a Network."""

    # ---------------------------------------------------------------------------------------------------- areas

    @with_keywords("mspring_area_def")
    def add_area(self, particles: Any, **fields: Unpack[AreaKeywords]) -> int:
        """Add an area around a polygon of particles: a balloon, a tyre. Returns its id. kind: "elastic", "gas"."""
        corners = id_array("particles", particles)
        made = ffi.new("mspring_id *")
        self._change(lib.mspring_network_add_area, filled("mspring_area_def", dict(fields)),
                     pointer("mspring_id", corners), len(corners), made)
        return made[0]

    @with_keywords("mspring_area_def")
    def add_cell_areas(self, **fields: Unpack[AreaKeywords]) -> range:
        """Add an area to each lattice cell, so that jelly turns back. Returns their ids."""
        made, count = ffi.new("mspring_id *"), ffi.new("uint32_t *")
        self._change(lib.mspring_network_add_cell_areas, filled("mspring_area_def", dict(fields)), made, count)
        return range(made[0], made[0] + count[0])

    def set_area(self, area: int, **fields: Unpack[AreaKeywords]) -> None:
        """Change some fields of an area: fill inflates it."""
        self._modify_one("mspring_area_def", lib.mspring_network_get_area, lib.mspring_network_set_area, area, fields)

    def remove_area(self, area: int) -> None:
        """Remove an area."""
        self._change(lib.mspring_network_remove_area, area)

    def get_area(self, area: int) -> AreaDef:
        """Read what an area is like."""
        return self._report(_header.AreaDef, "mspring_area_def", lib.mspring_network_get_area, area)

    def get_area_info(self, area: int) -> AreaInfo:
        """Measure an area: size (m^2), pressure (N/m), energy (J)."""
        return self._report(_header.AreaInfo, "mspring_area_info", lib.mspring_network_get_area_info, area)

    def get_area_particles(self, area: int) -> np.ndarray:
        """Read the corners of an area, in the order in which it is positive."""
        count = ffi.new("uint32_t *")
        self._read(lib.mspring_network_get_area_particles, area, ffi.NULL, 0, count)
        out = np.empty(count[0], np.uint32)
        self._read(lib.mspring_network_get_area_particles, area, pointer("mspring_id", out), len(out), count)
        return out.astype(np.int64)

    def _measured(self, function: Any) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        count = ffi.new("uint32_t *")
        with self._lock:
            self._read(function, ffi.NULL, ffi.NULL, ffi.NULL, 0, count)
            ids, one, other = np.empty(count[0], np.uint32), np.empty(count[0]), np.empty(count[0])
            self._read(function, pointer("mspring_id", ids), pointer("double", one), pointer("double", other),
                       len(ids), count)
        return ids.astype(np.int64), one, other

    def get_areas(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Measure all areas: ids, sizes (m^2) and pressures (N/m)."""
        return self._measured(lib.mspring_network_get_areas)

    # --------------------------------------------------------------------------------------------------- angles

    @with_keywords("mspring_angle_def")
    def add_angles(self, particles: Any, **fields: Unpack[AngleKeywords]) -> range:
        """Add angle springs between three particles each, (n, 3): of beams and spines. Returns their ids.

        With rest_angle the angles rest there, else at what they are now.
        """
        three = id_array("particles", particles, (None, 3))
        values = dict(fields)
        if "rest_angle" in values:
            values.setdefault("flags", _header.ANGLE_REST_GIVEN)
        made = ffi.new("mspring_id *")
        self._change(lib.mspring_network_add_angles, filled("mspring_angle_def", values),
                     pointer("mspring_id", three), len(three), made)
        return range(made[0], made[0] + len(three))

    def set_angle(self, angle: int, **fields: Unpack[AngleKeywords]) -> None:
        """Change some fields of an angle spring."""
        self._modify_one("mspring_angle_def", lib.mspring_network_get_angle, lib.mspring_network_set_angle, angle,
                         fields)

    def set_rest_angles(self, rest_angles: Any, angles: Union[int, range]) -> None:
        """Set the rest angles of one angle or of a range of ids, rad: muscles, servos. A number is for all of them."""
        ids = range(angles, angles + 1) if isinstance(angles, int) else angles
        values = np.ascontiguousarray(rest_angles, np.float64)
        if ids.step != 1 or values.shape not in ((), (len(ids),)):
            raise bad_argument(f"rest_angles has the shape {values.shape}: it must be a number or one for each id")
        self._change(lib.mspring_network_set_rest_angles, ids.start, len(ids), pointer("double", values.reshape(-1)),
                     values.ndim)

    def remove_angle(self, angle: int) -> None:
        """Remove an angle spring."""
        self._change(lib.mspring_network_remove_angle, angle)

    def get_angle(self, angle: int) -> AngleDef:
        """Read what an angle spring is like."""
        return self._report(_header.AngleDef, "mspring_angle_def", lib.mspring_network_get_angle, angle)

    def get_angle_info(self, angle: int) -> AngleInfo:
        """Measure an angle spring: angle (rad), torque (N m), energy (J)."""
        return self._report(_header.AngleInfo, "mspring_angle_info", lib.mspring_network_get_angle_info, angle)

    def get_angles(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Measure all angle springs: ids, angles (rad) and torques (N m)."""
        return self._measured(lib.mspring_network_get_angles)
