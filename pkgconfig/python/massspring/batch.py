"""Many copies of bodies in a network: driven, observed, held and put back singly.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _header
from ._calls import count_of, output
from ._core import Ids, Span, bad_argument, dtype_of, enum_value, id_array, lib, pointer, with_keywords
from .builder import Builder
from .network import Network

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import NetworkKeywords, PropertyName, Reset, ResetName

# What a row begins with: numbers of the group itself.
OF_GROUP = ("group_x", "group_y", "group_vx", "group_vy", "group_min_x", "group_min_y", "group_max_x", "group_max_y",
            "group_flags")


@with_keywords("mspring_network_def")
class Batch:
    """count copies of what a builder holds, in one network; or, of pairs (builder, count), of several. Each is a group.

    actuators     ids of springs of the builder: their rest lengths follow signals. Of several: a list for each
    changes       in how many parts a step takes them to their signals
    observations  properties, and of which particles, springs, elements or actuators of each group: {"strain": [3, 4]}.
                  Where a group has no such thing, the number is 0.
    offsets       (count, 2), where each copy stands, m. None: in the same place, as groups do not touch each other
    substeps      must be given
    device        "gpu", or "gpu:" and a number: on a device of OpenCL, with the same bits (massspring.gpu); it needs
                  the library massspring_gpu

    A group that a step would throw out of bounds (max_speed) is held where it was, until reset(). The others have the
    same bits as if it were not there. network is the Network: give it floor and contact. Steps release the GIL.
    Of DLPack, as torch.from_dlpack() takes it, a batch is its rows.
    """

    count: int
    network: Network
    first_particles: np.ndarray
    first_springs: np.ndarray

    def __new__(cls, *_: Any, device: str = "cpu", **__: Any) -> Batch:
        if device == "cpu":
            return super().__new__(cls)
        if str(device).partition(":")[0] != "gpu":
            raise bad_argument(f"device is {device!r}: it must be 'cpu', 'gpu', or 'gpu:' and a number")
        from .gpu import GpuBatch
        if cls is not Batch and not issubclass(cls, GpuBatch):
            raise TypeError(f"{cls.__name__} is of the processor: derive it from massspring.gpu.GpuBatch")
        return super().__new__(GpuBatch if cls is Batch else cls)

    def __init__(self, bodies: Union[Builder, Sequence[Tuple[Builder, int]]], count: Optional[int] = None, *,
                 actuators: Any = (), changes: int = 1, observations: Optional[Mapping[PropertyName, Any]] = None,
                 offsets: Any = None, device: str = "cpu", **settings: Unpack[NetworkKeywords]):
        if "substeps" not in settings:
            raise TypeError("a batch needs substeps: automatic ones would follow the stiffest of its groups")
        if isinstance(bodies, Builder):
            pairs, listed = [(bodies, 1 if count is None else count)], [actuators]
        else:
            pairs, listed = list(bodies), list(actuators) or [()] * len(bodies)
        if len(listed) != len(pairs):
            raise bad_argument(f"actuators has {len(listed)} lists: it must have one for each of {len(pairs)} bodies")
        self.count = sum(count_of("count", number) for _, number in pairs)
        self.device = device
        self._make(pairs, offsets, settings)
        self._set_actuators(pairs, [id_array("actuators", one) for one in listed], changes)
        self._observe(dict(observations or {}))
        self._begin()

    def _make(self, pairs: List[Tuple[Builder, int]], offsets: Any, settings: Any) -> None:
        """A network with its groups."""
        self.network = Network(self._builder(pairs, offsets), **{"guard": "bounds", **settings})
        self.network._change(lib.mspring_network_set_groups, pointer("mspring_id", self.first_particles),
                             len(self.first_particles) - 1)

    def _begin(self) -> None:
        self.observe()

    def _builder(self, pairs: List[Tuple[Builder, int]], offsets: Any) -> Builder:
        """A builder of all copies."""
        made, particles, springs, done = Builder(), [0], [0], 0
        for builder, number in pairs:
            part = None if offsets is None else np.asarray(offsets)[done:done + number]
            made.add_copies(builder, number, part)
            for firsts, size in ((particles, builder.particle_count), (springs, builder.spring_count)):
                firsts += range(firsts[-1] + size, firsts[-1] + number * size + 1, size) if size else firsts[-1:] * number
            done += number
        if offsets is not None and len(offsets) != done:
            raise bad_argument(f"offsets has {len(offsets)} rows: it must have {done}")
        self.first_particles, self.first_springs = np.array(particles, np.uint32), np.array(springs, np.uint32)
        return made

    def _set_actuators(self, pairs: List[Tuple[Builder, int]], listed: List[np.ndarray], changes: int) -> None:
        """Actuators in the order of groups. Signals are a rectangle, of which a group uses the first ones of its row."""
        springs, group = [], 0
        self._signals = np.ones((self.count, max(len(one) for one in listed)), np.float32)
        self._used = np.zeros(self._signals.shape, bool)
        for (builder, number), one in zip(pairs, listed):
            if one.size and one.max() >= builder.spring_count:
                raise _header.IdError(f"actuators has {one.max()}, but there are {builder.spring_count} springs",
                                      _header.ERROR_ID)
            springs.append((self.first_springs[group:group + number, None] + one).ravel())
            self._used[group:group + number, :len(one)] = True
            group += number
        self._connect(springs, listed, changes)

    def _connect(self, springs: List[np.ndarray], listed: List[np.ndarray], changes: int) -> None:
        self.network.set_actuators(np.concatenate(springs), changes)

    def _observe(self, wanted: Dict[Any, Any]) -> None:
        """The columns of a row."""
        self._places: Dict[int, Any] = {}
        columns = []
        for name, ids in [*((name, None) for name in OF_GROUP), *wanted.items()]:
            number = enum_value("mspring_property", "observations", name)
            if ids is None and number >> 8 != _header.GROUPS:
                raise TypeError(f"observations has no ids for {name}: give a list")
            indices = [0] if ids is None else id_array("observations", ids).tolist()
            self._places[number] = len(columns) if ids is None else slice(len(columns), len(columns) + len(indices))
            columns += [(number, index) for index in indices]
        self._columns = np.array(columns, dtype_of("mspring_observation"))
        self.rows = np.zeros((self.count, len(columns)))

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        return f"Batch({self.count} groups, {self.first_particles[-1]} particles, {self.first_springs[-1]} springs)"

    def __enter__(self) -> Batch:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the network."""
        self.network.close()

    # ---------------------------------------------------------------------------------------------------- steps

    @property
    def signals(self) -> np.ndarray:
        """The signals of the next step, float32 (count, actuators). Write into it, then call step(signals=None)."""
        return self._signals

    def step(self, dt: float, signals: Any = None, count: int = 1) -> None:
        """Take count steps of dt, s.

        signals  rest lengths as multiples of those at first, 0.01 to 100: (count, actuators) or (actuators,). They are
                 copied into signals, which the steps use. They stay until others are given.
        """
        wanted = self._signals
        if signals is not None:
            is_dlpack = hasattr(signals, "__dlpack__") and not hasattr(signals, "__array__")
            array = np.from_dlpack(signals) if is_dlpack else np.asarray(signals)
            if array.dtype.kind not in "biuf":
                raise TypeError(f"signals has the dtype {array.dtype}: it must be real numbers")
            try:
                wanted = np.broadcast_to(array, self._signals.shape)
            except ValueError:
                raise bad_argument(f"signals has the shape {array.shape}: it must be {self._signals.shape}") from None
        self._advance(dt, wanted, count)
        self._signals[...] = wanted

    def _advance(self, dt: float, signals: np.ndarray, count: int) -> None:
        if signals.size:
            self.network.set("signal", signals.ravel() if self._used.all() else signals[self._used])
        self.network.step(dt, count)

    def _groups(self, groups: Ids) -> Tuple[Any, ...]:
        return Span(groups, self.count, "groups").arguments

    def mark(self, groups: Ids = None) -> None:
        """Remember the state of groups, of all for None, for reset(to="mark")."""
        self.network._change(lib.mspring_network_mark_groups, *self._groups(groups))

    def reset(self, groups: Ids = None, to: Union[Reset, ResetName] = "start") -> None:
        """Put groups back to their "start" or their "mark", and hold them no more. groups: ids, a mask, None for all."""
        self.network._change(lib.mspring_network_reset_groups, enum_value("mspring_reset", "to", to),
                             *self._groups(groups))

    # --------------------------------------------------------------------------------------------- observations

    def observe(self, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Read all groups, and return a row for each: (count, columns) of float64.

        Without out they are rows, which batch["strain"], centres, velocities, boxes and held show.
        """
        rows = self.rows if out is None else output(out, self.rows.shape, "f8")
        self.network._read(lib.mspring_network_observe_groups, *self._groups(None),
                           pointer("mspring_observation", self._columns), len(self._columns), pointer("double", rows),
                           rows.shape[1])
        return rows

    def __getitem__(self, name: PropertyName) -> np.ndarray:
        """A property at the last observe(): (count, ids) as observations has them, (count,) of groups; a view."""
        number = enum_value("mspring_property", "name", name)
        if number not in self._places:
            raise KeyError(f"{name} is not among the observations")
        return self.rows[:, self._places[number]]

    @property
    def centres(self) -> np.ndarray:
        """Centres of mass at the last observe(), m: (count, 2), a view."""
        return self.rows[:, 0:2]

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of the centres at the last observe(), m/s: (count, 2), a view."""
        return self.rows[:, 2:4]

    @property
    def boxes(self) -> np.ndarray:
        """Smallest boxes at the last observe(), m: (count, 4) of min x, min y, max x, max y, a view."""
        return self.rows[:, 4:8]

    @property
    def held(self) -> np.ndarray:
        """Which groups were held at the last observe(): booleans."""
        return self.rows[:, 8].astype(np.uint32) & _header.GROUP_HELD != 0

    def positions(self, group: int) -> np.ndarray:
        """World positions of one group's particles, m: (particles, 2)."""
        first, size = self._particles_of(group)
        return self.network.get_positions(range(first, first + size))

    def _particles_of(self, group: int) -> Tuple[int, int]:
        if not 0 <= group < self.count:
            raise _header.IdError(f"there is no group {group}, but only {self.count}", _header.ERROR_ID)
        first, end = self.first_particles[group:group + 2].tolist()
        return first, end - first

    @property
    def state_hash(self) -> int:
        """Hash of the state: equal on all devices."""
        return self.network.state_hash

    def __dlpack__(self, **how: Any) -> Any:
        """The rows for another library, without a copy."""
        return self.rows.__dlpack__(**how)

    def __dlpack_device__(self) -> Tuple[int, int]:
        """The processor: observations are read from the device."""
        return self.rows.__dlpack_device__()
