"""The builder: particles, springs, lattices, ropes, meshes and discs, of which networks are made.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Dict, Iterable, Optional, Tuple, Union

import numpy as np

from ._core import (Handle, as_numbers, bad_argument, enum_value, fail, ffi, filled, id_array, lib, numbers,
                    optional_ids, pointer, table, text_of, with_keywords)
from ._header import CELL_EMPTY, MAX_SPRINGS

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import (DiscKeywords, LatticeKeywords, MaterialKeywords, MeshKeywords, NetworkKeywords,
                          ParticleKeywords, Preset, RopeKeywords, SpringKeywords)
    from .network import Network

MaterialLike = Dict[str, Any]


@with_keywords("mspring_material")
def material(preset: Union[Preset, str, None] = None, spacing: float = 1.0, substep: float = 1 / 64 / 30,
             **fields: Unpack[MaterialKeywords]) -> MaterialLike:
    """A material of lattice cells, as the dict that Builder.add_lattice() takes. pinned=True pins its particles.

    preset   "steel", "wood", "rubber" or "jelly": how it looks. Its springs are relative to substep (s), the step's
             length over the substeps, for a lattice of this spacing (m).
    """
    if preset is None:
        filled("mspring_material", dict(fields))  # mistakes show here
        return dict(fields)
    made = ffi.new("mspring_material *")
    result = lib.mspring_material_preset(made, ffi.sizeof(made[0]), enum_value("mspring_preset", "preset", preset),
                                         spacing, substep)
    if result:
        fail(result, f"no preset with a spacing of {spacing} m and a substep of {substep} s")
    names = [name for name, _ in ffi.typeof("mspring_material").fields]
    of_preset = {name: getattr(made, name) for name in names if name != "struct_size" and name[:8] != "reserved"}
    return {**of_preset, **fields}


def _materials(materials: Any) -> Any:
    """An array of structs, of dicts."""
    if isinstance(materials, dict):
        materials = [materials]
    array = ffi.new("mspring_material[]", len(materials))
    for index, fields in enumerate(materials):
        array[index] = filled("mspring_material", dict(fields))[0]
    return array


def _cells(cells: Any) -> np.ndarray:
    array = np.asarray(cells)
    if array.ndim != 2 or array.size == 0:
        raise bad_argument(f"cells has the shape {array.shape}: it must be (rows, columns)")
    if array.dtype.kind == "b":
        return np.where(array, 0, CELL_EMPTY).astype(np.uint16)
    if array.dtype.kind not in "iu":
        raise TypeError(f"cells has the dtype {array.dtype}: it must be integers, or bool for one material")
    if array.max() > CELL_EMPTY:
        raise bad_argument(f"cells has {array.max()}: materials are numbered from 0 to {CELL_EMPTY - 1}")
    return np.ascontiguousarray(np.where(array < 0, CELL_EMPTY, array), np.uint16)


class Builder(Handle):
    """Collects particles and springs. It can make any number of networks.

    Ids are 0, 1, 2 ... in the order in which particles and springs are added. Units are SI; the y axis points up.
    Use it in a with statement, call close(), or let it be collected. Calls from several threads wait for each other.
    """

    _kind = "builder"

    def __init__(self) -> None:
        self._lock = threading.Lock()
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
        arguments = as_numbers(arguments)
        with self._lock:
            live = self._live()
            result = function(live, *arguments)
            if result:
                fail(result, text_of(lib.mspring_builder_error(live)))

    @property
    def particle_count(self) -> int:
        """Particles added so far."""
        return lib.mspring_builder_particle_count(self._live())

    @property
    def spring_count(self) -> int:
        """Springs added so far."""
        return lib.mspring_builder_spring_count(self._live())

    def __repr__(self) -> str:
        if self.closed:
            return "Builder(closed)"
        return f"Builder({self.particle_count} particles, {self.spring_count} springs)"

    # ------------------------------------------------------------------------------------ particles and springs

    @with_keywords("mspring_particle_def")
    def add_particle(self, x: float, y: float, **fields: Unpack[ParticleKeywords]) -> int:
        """Add one particle at the world position (x, y), m. Returns its id. pinned=True pins it."""
        made = ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_particle, filled("mspring_particle_def", {"x": x, "y": y, **fields}), made)
        return made[0]

    @with_keywords("mspring_particle_def")
    def add_particles(self, positions: Any, velocities: Any = None, **columns: Any) -> range:
        """Add particles: all of them or, on error, none. Returns their ids.

        positions   (n, 2), world positions, m
        velocities  (n, 2), of now, m/s
        Keyword arguments are numbers, or arrays of n numbers. pinned takes booleans.
        """
        rows = particle_rows(positions, velocities, columns)
        made = ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_particles, pointer("mspring_particle_def", rows), len(rows), made)
        return range(made[0], made[0] + len(rows)) if len(rows) else range(0)

    @with_keywords("mspring_spring_def")
    def add_spring(self, a: int, b: int, **fields: Unpack[SpringKeywords]) -> int:
        """Add one spring between the particles a and b. Returns its id."""
        made = ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_spring, filled("mspring_spring_def", {"a": a, "b": b, **fields}), made)
        return made[0]

    @with_keywords("mspring_spring_def")
    def add_springs(self, pairs: Any, **columns: Any) -> range:
        """Add springs: all of them or, on error, none. Returns their ids.

        pairs  (n, 2), ids of the particles that they join
        Keyword arguments are numbers, or arrays of n numbers.
        """
        rows = spring_rows(pairs, columns)
        made = ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_springs, pointer("mspring_spring_def", rows), len(rows), made)
        return range(made[0], made[0] + len(rows)) if len(rows) else range(0)

    def add_strain_limits(self, springs: range, strain: float, stiffening: float) -> range:
        """Have springs stiffen beyond a strain. Returns the ids of their limits, which are springs beside them.

        springs     a range of ids, as add_springs() returns it
        strain      above 0: of stretching; below 0, above -1: of pressing
        stiffening  by how many times their stiffness they get stiffer, up to 30
        """
        if len(springs) and springs.step != 1:
            raise bad_argument(f"springs is {springs}: it must be a range without steps")
        made = ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_strain_limits, springs.start, len(springs), strain, stiffening, made)
        return range(made[0], made[0] + len(springs))

    # ------------------------------------------------------------------------------------------------- shapes

    @with_keywords("mspring_lattice_def")
    def add_lattice(self, cells: Any, materials: Union[MaterialLike, Iterable[MaterialLike]],
                    **fields: Unpack[LatticeKeywords]) -> np.ndarray:
        """Add a grid of cells, joined with their 8 neighbours. Returns each cell's particle id, -1 if it is empty.

        cells      (rows, columns), the top row first, as an image: the index of each cell's material, or -1 for an
                   empty cell. With one material it may be booleans.
        materials  dicts of the fields of material(), or one dict
        """
        grid, structs = _cells(cells), _materials(list(materials) if not isinstance(materials, dict) else materials)
        taken = ("width", "height", "material_count")
        def_ = filled("mspring_lattice_def", dict(fields), taken)
        def_.height, def_.width = grid.shape
        def_.material_count = len(structs)
        def_.cells, def_.materials = pointer("uint16_t", grid), structs
        ids = np.empty(grid.shape, np.uint32)
        self._call(lib.mspring_builder_add_lattice, def_, pointer("mspring_id", ids))
        return optional_ids(ids)

    @with_keywords("mspring_rope_def")
    def add_rope(self, from_: int, to: int, segment_count: int,
                 **fields: Unpack[RopeKeywords]) -> Tuple[np.ndarray, range]:
        """Add a chain of equal springs between two particles. Returns the ids along it and those of its springs."""
        def_ = filled("mspring_rope_def", {"to": to, "segment_count": segment_count, **fields, "from": from_})
        ids, first = np.empty(min(max(segment_count, 0), MAX_SPRINGS) + 1, np.uint32), ffi.new("mspring_id *")
        self._call(lib.mspring_builder_add_rope, def_, pointer("mspring_id", ids), len(ids), first)
        return ids.astype(np.int64), range(first[0], first[0] + segment_count)

    @with_keywords("mspring_mesh_def")
    def add_mesh(self, vertices: Any, triangles: Any, **fields: Unpack[MeshKeywords]) -> Tuple[range, range]:
        """Add a mesh of triangles. Returns the ids of its particles, which follow the vertices, and of its springs.

        vertices   (n, 2), world positions, m
        triangles  (m, 3), indices of vertices
        """
        points = numbers("vertices", vertices, "f8", (None, 2))
        x, y = np.ascontiguousarray(points[:, 0]), np.ascontiguousarray(points[:, 1])
        corners = id_array("triangles", triangles, (None, 3)) if np.size(triangles) else np.empty((0, 3), np.uint32)
        def_ = filled("mspring_mesh_def", dict(fields), ("vertex_count", "triangle_count"))
        def_.vertex_count, def_.triangle_count = len(points), len(corners)
        def_.x, def_.y = pointer("double", x), pointer("double", y)
        def_.triangles = pointer("uint32_t", corners)
        return self._add_shape(lib.mspring_builder_add_mesh, def_)

    @with_keywords("mspring_disc_def")
    def add_disc(self, x: float, y: float, radius: float, **fields: Unpack[DiscKeywords]) -> Tuple[range, range]:
        """Add a disc of rings around (x, y), m. Returns the ids of its particles, centre first, and springs."""
        return self._add_shape(lib.mspring_builder_add_disc,
                               filled("mspring_disc_def", {"x": x, "y": y, "radius": radius, **fields}))

    def _add_shape(self, function: Any, def_: Any) -> Tuple[range, range]:
        particle, spring = ffi.new("mspring_id *"), ffi.new("mspring_id *")
        self._call(function, def_, particle, spring)
        return range(particle[0], self.particle_count), range(spring[0], self.spring_count)

    def add_network(self, network: Network, particles: Optional[Any] = None) -> Tuple[np.ndarray, np.ndarray]:
        """Add what a network holds now: all of it, or these particles and the springs between them.

        Returns the builder's id of each particle and of each spring of the network, -1 for what was not added.
        """
        chosen = None if particles is None else id_array("particles", particles)
        with network._lock:
            of_particle = np.empty(network.particle_count, np.uint32)
            of_spring = np.empty(network.spring_count, np.uint32)
            self._call(lib.mspring_builder_add_network, network._live(),
                       ffi.NULL if chosen is None else pointer("mspring_id", chosen),
                       0 if chosen is None else len(chosen), pointer("mspring_id", of_particle),
                       pointer("mspring_id", of_spring))
        return optional_ids(of_particle), optional_ids(of_spring)

    @with_keywords("mspring_network_def")
    def network(self, **settings: Unpack[NetworkKeywords]) -> Network:
        """Make a network of what the builder holds. gravity=(x, y) sets both."""
        from .network import Network
        return Network(self, **settings)


def particle_rows(positions: Any, velocities: Any, columns: Dict[str, Any]) -> np.ndarray:
    """Definitions of particles."""
    points = numbers("positions", positions, "f8", (None, 2))
    columns = {"x": points[:, 0], "y": points[:, 1], **columns}
    if velocities is not None:
        speeds = numbers("velocities", velocities, "f4", (len(points), 2))
        columns.update(vx=speeds[:, 0], vy=speeds[:, 1])
    return table("mspring_particle_def", len(points), columns)


def spring_rows(pairs: Any, columns: Dict[str, Any]) -> np.ndarray:
    """Definitions of springs."""
    ends = id_array("pairs", pairs, (None, 2)) if np.size(pairs) else np.empty((0, 2), np.uint32)
    return table("mspring_spring_def", len(ends), {"a": ends[:, 0], "b": ends[:, 1], **columns})

