"""Many copies of one body in a network: driven, observed, held and put back singly.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from . import _header
from ._calls import Span, count_of, output
from ._core import Ids, bad_argument, enum_value, ffi, id_array, lib, numbers, pointer, with_keywords
from .builder import Builder
from .network import Network

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import NetworkKeywords, Reset


def _add_copies(robot: Builder, count: int, offsets: Any) -> Builder:
    """A builder of count copies."""
    stride, x, y = 0, ffi.NULL, ffi.NULL
    if offsets is not None:
        array = numbers("offsets", offsets, "f8", (count, 2))
        stride, x, y = 2, pointer("double", array), pointer("double", array, 1)
    made = Builder()
    with robot._lock:
        made._call(lib.mspring_builder_add_copies, robot._live(), count, x, y, stride, ffi.NULL, ffi.NULL)
    return made


@with_keywords("mspring_network_def")
class Batch:
    """count copies of what a builder holds, in one network. Each of them is a group.

    actuators  ids of springs of the builder: their rest lengths follow signals
    changes    in how many parts a step takes them to their signals
    probes     ids of particles of the builder, of which observations have positions and velocities
    offsets    (count, 2), where each copy stands, m. None: all in the same place, as groups do not touch each other
    substeps   must be given

    A group that a step would throw out of bounds (max_speed) is held where it was, until reset(). The others have the
    same bits as if it were not there. network is the Network: give it floor and contact. Steps release the GIL.
    """

    count: int
    particles: int
    springs: int
    network: Network
    actuators: np.ndarray
    probes: np.ndarray

    def __init__(self, builder: Builder, count: int, *, actuators: Any = (), changes: int = 1, probes: Any = (),
                 offsets: Any = None, **settings: Unpack[NetworkKeywords]):
        self.count = count_of("count", count)
        if "substeps" not in settings:
            raise TypeError("a batch needs substeps: automatic ones would follow the stiffest of its groups")
        self.particles, self.springs = builder.particle_count, builder.spring_count
        self.network = Network(_add_copies(builder, self.count, offsets), **{"guard": "bounds", **settings})
        firsts = np.arange(self.count + 1, dtype=np.uint32) * np.uint32(self.particles)
        self.network._change(lib.mspring_network_set_groups, pointer("mspring_id", firsts), self.count)
        self.actuators, self.probes = id_array("actuators", actuators), id_array("probes", probes)
        self._set_actuators(count_of("changes", changes))
        self._rows = np.zeros((self.count, _header.OBSERVE_PARTICLES + 4 * len(self.probes)))
        self._signals = np.ones((self.count, len(self.actuators)), np.float32)
        self.observe()

    def _set_actuators(self, changes: int) -> None:
        if self.actuators.size and self.actuators.max() >= self.springs:
            raise _header.IdError(f"actuators has {self.actuators.max()}, but there are {self.springs} springs",
                                  _header.ERROR_ID)
        springs = np.arange(self.count, dtype=np.uint32)[:, None] * np.uint32(self.springs) + self.actuators
        springs = np.ascontiguousarray(springs.ravel(), np.uint32)
        self.network._change(lib.mspring_network_set_actuators, pointer("mspring_id", springs), len(springs), changes)

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        return f"Batch({self.count} groups of {self.particles} particles and {self.springs} springs)"

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
        if signals is not None:
            array = np.asarray(signals)
            if array.dtype.kind not in "biuf":
                raise TypeError(f"signals has the dtype {array.dtype}: it must be real numbers")
            try:
                self._signals[...] = array
            except ValueError:
                raise bad_argument(f"signals has the shape {array.shape}: it must be {self._signals.shape}") from None
        if self._signals.size:
            self.network._change(lib.mspring_network_set_signals, 0, self._signals.size,
                                 pointer("float", self._signals), 1)
        self.network.step(dt, count)

    def _choice(self, groups: Ids) -> Any:
        """The list and the number of chosen groups. The caller keeps the list."""
        if groups is None:
            return None, 0
        listed = Span(groups, self.count).as_list()
        return (listed, len(listed)) if len(listed) else (None, None)

    def mark(self, groups: Ids = None) -> None:
        """Remember the state of groups, of all for None, for reset(to="mark")."""
        listed, count = self._choice(groups)
        if count is not None:
            self.network._change(lib.mspring_network_mark_groups,
                                 ffi.NULL if listed is None else pointer("uint32_t", listed), count)

    def reset(self, groups: Ids = None, to: "Reset | str" = "start") -> None:
        """Put groups back to their "start" or their "mark", and hold them no more. groups: ids, a mask, None for all."""
        listed, count = self._choice(groups)
        if count is not None:
            self.network._change(lib.mspring_network_reset_groups,
                                 ffi.NULL if listed is None else pointer("uint32_t", listed), count,
                                 enum_value("mspring_reset", "to", to))

    # --------------------------------------------------------------------------------------------- observations

    def observe(self, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Read all groups, and return a row for each: (count, columns) of float64.

        Without out the rows are the batch's own, which centres, velocities, boxes, held and probe_states show.
        """
        rows = self._rows if out is None else output(out, self._rows.shape, "f8")
        self.network._read(lib.mspring_network_observe_groups, 0, self.count, pointer("uint32_t", self.probes),
                           len(self.probes), pointer("double", rows), rows.shape[1])
        return rows

    @property
    def centres(self) -> np.ndarray:
        """Centres of mass at the last observe(), m: (count, 2), a view."""
        return self._rows[:, _header.OBSERVE_X:_header.OBSERVE_Y + 1]

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of the centres at the last observe(), m/s: (count, 2), a view."""
        return self._rows[:, _header.OBSERVE_VX:_header.OBSERVE_VY + 1]

    @property
    def boxes(self) -> np.ndarray:
        """Smallest boxes at the last observe(), m: (count, 4) of min x, min y, max x, max y, a view."""
        return self._rows[:, _header.OBSERVE_MIN_X:_header.OBSERVE_MAX_Y + 1]

    @property
    def held(self) -> np.ndarray:
        """Which groups were held at the last observe(): booleans."""
        return self._rows[:, _header.OBSERVE_HELD] > 0

    @property
    def probe_states(self) -> np.ndarray:
        """Probes at the last observe(): (count, probes, 4) of position relative to the centre and velocity, a view."""
        return self._rows[:, _header.OBSERVE_PARTICLES:].reshape(self.count, len(self.probes), 4)

    def positions(self, group: int) -> np.ndarray:
        """World positions of one group's particles, m: (particles, 2)."""
        if not 0 <= group < self.count:
            raise _header.IdError(f"there is no group {group}, but only {self.count}", _header.ERROR_ID)
        return self.network.get_positions(range(group * self.particles, (group + 1) * self.particles))
