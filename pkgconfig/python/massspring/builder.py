"""The builder: particles, springs, lattices, ropes, meshes and discs, of which networks are made.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Dict, Iterable, Optional, Tuple, Union

import numpy as np

from ._core import (Handle, Ids, Span, array_of, as_number, bad_argument, defaults, enum_value, fail, ffi, filled,
                    id_array, lib, optional_ids, pointer, table, with_keywords)
from ._header import CELL_EMPTY, KEYWORDS, MAX_SPRINGS, PARTICLES, SPRINGS
from ._types import Error

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import (DiscKeywords, LatticeKeywords, MaterialKeywords, MeshKeywords, NetworkKeywords,
                          ParticleColumns, ParticleKeywords, Preset, PresetName, RopeKeywords, SpringColumns,
                          SpringKeywords)
    from .network import Network

MaterialLike = Dict[str, Any]


@with_keywords("mspring_material")
def material(preset: Union[Preset, PresetName, None] = None, spacing: float = 1.0, substep: float = 1 / 64 / 30,
             **fields: Unpack[MaterialKeywords]) -> MaterialLike:
    """What lattices, ropes, meshes and discs are made of, as a dict. pinned=True pins its particles.

    preset   "steel", "wood", "rubber" or "jelly": how it looks. Its springs are relative to substep (s), the step's
             length over the substeps, for a lattice of this spacing (m).
    """
    filled("mspring_material", dict(fields))  # mistakes show here
    if preset is None:
        return dict(fields)
    made = defaults("mspring_material")
    result = lib.mspring_material_preset(made, enum_value("mspring_preset", "preset", preset), spacing, substep)
    if result:
        fail(result, f"no preset with a spacing of {spacing} m and a substep of {substep} s")
    return {**{name: getattr(made, name) for name in KEYWORDS["mspring_material"]}, **fields}


def _cells(cells: Any) -> Optional[np.ndarray]:
    if cells is None:
        return None
    array = np.asarray(cells)
    if array.ndim != 2 or array.size == 0:
        raise bad_argument(f"cells has the shape {array.shape}: it must be (rows, columns)")
    if array.dtype.kind == "b":
        return np.where(array, 0, CELL_EMPTY).astype(np.uint16)
    if array.dtype.kind not in "iu":
        raise TypeError(f"cells has the dtype {array.dtype}: it must be integers, or bool for one material")
    if array.max() > CELL_EMPTY:
        raise bad_argument(f"cells has {array.max()}: materials are numbered from 0 to {CELL_EMPTY - 1}")
    return np.where(array < 0, CELL_EMPTY, array).astype(np.uint16)


class Builder(Handle):
    """Collects particles and springs. It can make any number of networks.

    Ids are 0, 1, 2 ... in the order in which particles and springs are added. Units are SI; the y axis points up.
    Use it in a with statement, call close(), or let it be collected. Calls from several threads wait for each other.
    """

    _kind = "builder"

    def __init__(self) -> None:
        self._lock = threading.RLock()
        made = ffi.new("mspring_builder **")
        result = lib.mspring_builder_create(ffi.NULL, made)
        if result:
            fail(result, "")
        self._pointer = ffi.gc(made[0], lib.mspring_builder_destroy)

    def close(self) -> None:
        """Free the builder. Networks that were made of it stay."""
        with self._lock:
            self._pointer = None

    def __enter__(self) -> Builder:
        self._live()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _call(self, function: Any, *arguments: Any) -> None:
        arguments = tuple(map(as_number, arguments))
        with self._lock:
            try:
                self._checked(function, lib.mspring_builder_error, arguments)
            except Error:
                if self._pointer is not None:
                    lib.mspring_builder_forget_error(self._pointer)  # it is raised here, not by what follows
                raise

    @property
    def particle_count(self) -> int:
        """Particles added so far."""
        return lib.mspring_builder_count(self._live(), PARTICLES)

    @property
    def spring_count(self) -> int:
        """Springs added so far."""
        return lib.mspring_builder_count(self._live(), SPRINGS)

    def __repr__(self) -> str:
        if self.closed:
            return "Builder(closed)"
        return f"Builder({self.particle_count} particles, {self.spring_count} springs)"

    # ------------------------------------------------------------------------------------ particles and springs

    def _added(self, function: Any, ctype: str, rows: Any, count: int) -> range:
        made = ffi.new("mspring_id *")
        self._call(function, rows if isinstance(rows, ffi.CData) else pointer(ctype, rows), count, made)
        return range(made[0], made[0] + count) if count else range(0)

    @with_keywords("mspring_particle_def")
    def add_particle(self, x: float, y: float, **fields: Unpack[ParticleKeywords]) -> int:
        """Add one particle at the world position (x, y), m. Returns its id. pinned=True pins it."""
        def_ = filled("mspring_particle_def", {"x": x, "y": y, **fields})
        return self._added(lib.mspring_builder_add_particles, "", def_, 1).start

    @with_keywords("mspring_particle_def")
    def add_particles(self, positions: Any, velocities: Any = None, **columns: Unpack[ParticleColumns]) -> range:
        """Add particles: all of them or, on error, none. Returns their ids.

        positions   (n, 2), world positions, m
        velocities  (n, 2), of now, m/s
        Keyword arguments are numbers, or arrays of n numbers. pinned takes booleans.
        """
        rows = particle_rows(positions, velocities, dict(columns))
        return self._added(lib.mspring_builder_add_particles, "mspring_particle_def", rows, len(rows))

    @with_keywords("mspring_spring_def")
    def add_spring(self, a: int, b: int, **fields: Unpack[SpringKeywords]) -> int:
        """Add one spring between the particles a and b. Returns its id."""
        def_ = filled("mspring_spring_def", {"a": a, "b": b, **fields})
        return self._added(lib.mspring_builder_add_springs, "", def_, 1).start

    @with_keywords("mspring_spring_def")
    def add_springs(self, pairs: Any, **columns: Unpack[SpringColumns]) -> range:
        """Add springs: all of them or, on error, none. Returns their ids.

        pairs  (n, 2), ids of the particles that they join
        Keyword arguments are numbers, or arrays of n numbers.
        """
        rows = spring_rows(pairs, dict(columns))
        return self._added(lib.mspring_builder_add_springs, "mspring_spring_def", rows, len(rows))

    def add_strain_limits(self, springs: Ids, strain: float, stiffening: float) -> range:
        """Have springs stiffen beyond a strain. Returns the ids of their limits, which are springs beside them.

        strain      above 0: of stretching; below 0, above -1: of pressing
        stiffening  by how many times their stiffness they get stiffer, up to 30
        """
        span, made = Span(springs, self.spring_count, "springs"), ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_strain_limits, *span.arguments, strain, stiffening, made)
        return range(made[0], made[0] + span.count)

    def _rows(self, function: Any, kind: str, span: Span) -> np.ndarray:
        rows = table(kind, span.count, {})
        self._call(function, *span.arguments, pointer(kind, rows))
        return rows[0] if span.is_one else rows

    def get_particles(self, ids: Ids = None) -> np.ndarray:
        """Read particles back: an array with the fields of mspring_particle_def."""
        return self._rows(lib.mspring_builder_get_particles, "mspring_particle_def", Span(ids, self.particle_count))

    def get_springs(self, ids: Ids = None) -> np.ndarray:
        """Read springs back: an array with the fields of mspring_spring_def. Their rest lengths are in metres."""
        return self._rows(lib.mspring_builder_get_springs, "mspring_spring_def", Span(ids, self.spring_count))

    # ------------------------------------------------------------------------------------------------- shapes

    @with_keywords("mspring_lattice_def")
    def add_lattice(self, cells: Any, materials: Union[MaterialLike, Iterable[MaterialLike]],
                    **fields: Unpack[LatticeKeywords]) -> np.ndarray:
        """Add a grid of cells, joined with their 8 neighbours. Returns each cell's particle id, -1 if it is empty.

        cells      (rows, columns), the top row first, as an image: the index of each cell's material, or -1 for an
                   empty cell. With one material it may be booleans. None: width and height say how many are full.
        materials  dicts of the fields of material(), or one dict
        """
        def_ = filled("mspring_lattice_def", {**fields, "cells": _cells(cells), "materials": materials})
        if def_.width * def_.height > MAX_SPRINGS:
            raise bad_argument(f"the lattice has {def_.width} x {def_.height} cells: that is too many")
        ids = np.empty((def_.height, def_.width), np.uint32)
        self._call(lib.mspring_builder_add_lattice, def_, pointer("mspring_id", ids))
        return optional_ids(ids)

    @with_keywords("mspring_rope_def")
    def add_rope(self, from_: int, to: int, segment_count: int, material: MaterialLike,
                 **fields: Unpack[RopeKeywords]) -> Tuple[np.ndarray, range]:
        """Add a chain of equal springs between two particles. Returns the ids along it and those of its springs."""
        def_ = filled("mspring_rope_def", {"to": to, "segment_count": segment_count, "material": material, **fields,
                                           "from": from_})
        ids, first = np.empty(min(def_.segment_count, MAX_SPRINGS) + 1, np.uint32), ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_rope, def_, pointer("mspring_id", ids), first)
        return ids.astype(np.int64), range(first[0], first[0] + def_.segment_count)

    @with_keywords("mspring_mesh_def")
    def add_mesh(self, vertices: Any, triangles: Any, material: MaterialLike,
                 **fields: Unpack[MeshKeywords]) -> Tuple[range, range]:
        """Add a mesh of triangles. Returns the ids of its particles, which follow the vertices, and of its springs.

        vertices   (n, 2), world positions, m
        triangles  (m, 3), indices of vertices
        """
        x, y = array_of("vertices", vertices, "f8", (None, 2)).T
        return self._add_shape(lib.mspring_builder_add_mesh, filled("mspring_mesh_def", {
            "x": x, "y": y, "triangles": triangles, "material": material, **fields}))

    @with_keywords("mspring_disc_def")
    def add_disc(self, x: float, y: float, radius: float, material: MaterialLike,
                 **fields: Unpack[DiscKeywords]) -> Tuple[range, range]:
        """Add a disc of rings around (x, y), m. Returns the ids of its particles, centre first, and springs."""
        return self._add_shape(lib.mspring_builder_add_disc, filled("mspring_disc_def", {
            "x": x, "y": y, "radius": radius, "material": material, **fields}))

    def _add_shape(self, function: Any, *arguments: Any) -> Tuple[range, range]:
        particle, spring = ffi.new("mspring_id *"), ffi.new("mspring_id *")
        self._call(function, *arguments, particle, spring)
        return range(particle[0], self.particle_count), range(spring[0], self.spring_count)

    def add_copies(self, other: Builder, count: int, offsets: Any = None) -> Tuple[range, range]:
        """Add copies of all that another builder holds. Returns the ids of their particles and springs.

        offsets  (count, 2), of each copy, m; None: all in the same place
        """
        stride, x, y = 0, ffi.NULL, ffi.NULL
        if offsets is not None:
            array = array_of("offsets", offsets, "f8", (count, 2))
            stride, x, y = 2, pointer("double", array), pointer("double", array, 1)
        if not isinstance(other, Builder):
            raise TypeError(f"other is {other!r}: it must be a massspring.Builder")
        first, second = sorted((self, other), key=id)  # in one order, so that threads cannot wait for each other
        with first._lock, second._lock:
            return self._add_shape(lib.mspring_builder_add_copies, other._live(), count, x, y, stride)

    def add_network(self, network: Network, particles: Ids = None) -> Tuple[np.ndarray, np.ndarray]:
        """Add what a network holds now: all of it, or these particles and the springs between them.

        Returns the builder's id of each particle and of each spring of the network, -1 for what was not added.
        """
        with network._lock:
            chosen = network._particles(particles)
            of_particle = np.empty(network.particle_count, np.uint32)
            of_spring = np.empty(network.spring_count, np.uint32)
            self._call(lib.mspring_builder_add_network, network._live(), *chosen.arguments,
                       pointer("mspring_id", of_particle), pointer("mspring_id", of_spring))
        return optional_ids(of_particle), optional_ids(of_spring)

    @with_keywords("mspring_network_def")
    def network(self, **settings: Unpack[NetworkKeywords]) -> Network:
        """Make a network of what the builder holds. gravity=(x, y) sets both."""
        from .network import Network
        return Network(self, **settings)


def particle_rows(positions: Any, velocities: Any, columns: Dict[str, Any]) -> np.ndarray:
    """Definitions of particles."""
    points = array_of("positions", positions, "f8", (None, 2))
    columns = {"x": points[:, 0], "y": points[:, 1], **columns}
    if velocities is not None:
        speeds = array_of("velocities", velocities, "f4", (len(points), 2))
        columns.update(vx=speeds[:, 0], vy=speeds[:, 1])
    return table("mspring_particle_def", len(points), columns)


def spring_rows(pairs: Any, columns: Dict[str, Any]) -> np.ndarray:
    """Definitions of springs."""
    ends = id_array("pairs", pairs, (None, 2))
    return table("mspring_spring_def", len(ends), {"a": ends[:, 0], "b": ends[:, 1], **columns})
