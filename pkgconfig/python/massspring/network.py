"""The network: it is made of a builder, stepped, read and edited.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Tuple, Union

import numpy as np

from . import _header
from ._bodies import BodyCalls
from ._calls import count_of
from ._core import (as_number, bad_argument, changed, empty, enum_value, fail, ffi, filled, id_array, lib, pointer, text_of,
                    with_keywords)
from ._edits import EditCalls
from ._laws import LawCalls
from ._measure import MeasureCalls
from ._state import StateCalls
from .builder import Builder
from .gradient import Gradients, gradient_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import (NetworkKeywords, Settings, SettingsKeywords, SnapshotContents, SolverDef, SolverKeywords,
                          StepInfo)


@with_keywords("mspring_network_def")
class Network(StateCalls, EditCalls, BodyCalls, LawCalls, MeasureCalls):
    """Masses joined by springs with dampers, in two dimensions. Units are SI; the y axis points up.

    Network(builder, **settings) makes one of what the builder holds. Each keyword has the default of the C library.
    gravity=(x, y) sets both. Enums may be given as text: solver="implicit".

    Use it in a with statement, call close(), or let it be collected. Steps release the GIL: networks step in parallel
    in threads. Calls on one network from several threads wait for each other. A call that fails changes nothing.
    Hooks and compaction jobs of the C library are left out: massspring.lib and Network.pointer lead to them.
    """

    def __init__(self, builder: Builder, **settings: Unpack[NetworkKeywords]):
        if not isinstance(builder, Builder):
            raise TypeError(f"builder is {builder!r}: it must be a massspring.Builder")
        def_ = filled("mspring_network_def", dict(settings))
        made = ffi.new("mspring_network **")
        builder._call(lib.mspring_network_create, def_, made)
        self._take(made[0])

    def close(self) -> None:
        """Free the network. Arrays of its views stay valid: the last of them frees the memory."""
        if self._pointer is None:
            return
        with self._lock:
            self._pointer = None

    def __enter__(self) -> Network:
        self._live()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.closed:
            return "Network(closed)"
        return f"Network({self.particle_count} particles, {self.spring_count} springs)"

    def clone(self, worker_count: int = 1) -> Network:
        """Make an independent copy. The same calls on both give the same bits. It has no hooks."""
        def_ = filled("mspring_clone_def", {"worker_count": worker_count})
        made = ffi.new("mspring_network **")
        self._read(lib.mspring_network_clone, def_, made)
        copy = Network.__new__(Network)
        copy._take(made[0])
        copy._was_compacted, copy._event_capacity = self._was_compacted, self._event_capacity
        copy._contact_capacity, copy._component_count = self._contact_capacity, self._component_count
        return copy

    def __copy__(self) -> Network:
        return self.clone()

    def __deepcopy__(self, memo: Any) -> Network:
        return self.clone()

    # ----------------------------------------------------------------------------------------------------- step

    def step(self, dt: float, count: int = 1) -> None:
        """Evolve the network by count steps of dt, s. The GIL is released in each.

        Pass equal dt: if it differs from step to step and little damps, explicit steps add energy.

        A step that fails is rolled back. Its error has the particle or the spring that was the cause; the steps
        before it count.
        """
        count, step = count_of("count", count), lib.mspring_network_step
        dt = as_number(dt)
        with self._lock:
            live = self._live()
            self._changes += 1
            for _ in range(count):
                result = step(live, dt)
                if result:
                    self._fail_step(result, live)

    def _fail_step(self, result: int, live: Any) -> None:
        message = text_of(lib.mspring_network_error(live))
        info = self.step_info
        is_its = info.result == result
        fail(result, message, info.particle if is_its else None, info.spring if is_its else None)

    def set_actuators(self, springs: Any, changes: int = 1) -> None:
        """Make springs actuators, whose rest lengths follow the signals of gradient(). Their lengths of now are signal 1.

        springs  ids; these replace the actuators that there are
        changes  in how many even parts a step takes a length to its signal, 1 to 256
        """
        ids = id_array("springs", springs)
        self._change(lib.mspring_network_set_actuators, pointer("mspring_id", ids), len(ids),
                     count_of("changes", changes))

    def gradient(self, loss: Callable[..., Any], steps: int, *, dt: float, signals: Any = None, forces: Any = None,
                 forced: Any = ()) -> Gradients:
        """Step as often as steps says by dt, s, and return a loss with its derivatives.

        loss     called with the final positions and velocities, returns (value, its derivatives by positions, and by
                 velocities if they count); each (particles, 2)
        signals  (steps, actuators) or None
        forces   (steps, forced, 2) on the particles forced, N, or None

        The network is then at the end. Gradient goes step by step, for a loss with terms of earlier states.
        """
        return gradient_of(self, loss, count_of("steps", steps), dt, signals, forces, forced)

    @property
    def step_info(self) -> StepInfo:
        """Report of the last step, and of all steps so far."""
        return self._report(_header.StepInfo, "mspring_step_info", lib.mspring_network_get_step_info)

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.step_info.time

    @property
    def is_asleep(self) -> bool:
        """Whether all of the network sleeps."""
        return bool(self._value(lib.mspring_network_is_asleep))

    def wake(self) -> None:
        """Wake all of the network."""
        self._change(lib.mspring_network_wake)

    # ------------------------------------------------------------------------------------------------- settings

    @property
    def settings(self) -> Settings:
        """The settings that the next step uses."""
        return self._report(_header.Settings, "mspring_settings", lib.mspring_network_get_settings)

    @with_keywords("mspring_settings")
    def set_settings(self, **fields: Unpack[SettingsKeywords]) -> None:
        """Change some settings: all that are given or, on error, none. gravity=(x, y) sets both."""
        self._modify("mspring_settings", lib.mspring_network_get_settings, lib.mspring_network_set_settings,
                     dict(fields))

    @property
    def solver(self) -> SolverDef:
        """The solver and its settings."""
        return self._report(_header.SolverDef, "mspring_solver_def", lib.mspring_network_get_solver)

    @with_keywords("mspring_solver_def")
    def set_solver(self, **fields: Unpack[SolverKeywords]) -> None:
        """Change the solver, or some of its settings. The others stay."""
        self._modify("mspring_solver_def", lib.mspring_network_get_solver, lib.mspring_network_set_solver, dict(fields))

    # ------------------------------------------------------------------------------------------------ snapshots

    def save(self, contents: Union[SnapshotContents, str] = "all") -> bytes:
        """Save a snapshot: all that the following steps depend on, or a "frame" for quick rollback.

        It fits networks that are made of the same particles and springs. Floor, contact and colliders are not in it.
        """
        number, size = enum_value("mspring_snapshot_contents", "contents", contents), ffi.new("size_t *")
        with self._lock:
            self._read(lib.mspring_network_snapshot_size, number, size)
            room = np.empty(size[0], np.uint8)
            self._read(lib.mspring_network_save, number, pointer("char", room), len(room), size)
        return room[:size[0]].tobytes()

    def load(self, snapshot: bytes) -> None:
        """Load a snapshot: the following steps repeat those after it was saved, bit for bit."""
        buffer = memoryview(snapshot)
        if not buffer.c_contiguous:
            raise bad_argument("the snapshot's bytes must lie together")
        with self._lock:
            self._change(lib.mspring_network_load, ffi.from_buffer(buffer), buffer.nbytes)

    # ------------------------------------------------------------------------------------------------- archives

    def archive(self) -> bytes:
        """Return an archive as bytes: all of the network but hooks, components and unread events.

        This and all later versions read it, on every machine. Networks are pickled as archives.
        """
        pieces: List[bytes] = []

        @ffi.callback("mspring_write_fn", error=_header.ERROR_MEMORY)
        def write(piece: Any, size: int, _: Any) -> int:
            pieces.append(ffi.buffer(piece, size)[:])
            return 0

        self._read(lib.mspring_network_write, write, ffi.NULL)
        return b"".join(pieces)

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Write an archive to a file. Network.read() makes a network that continues from it."""
        archive = self.archive()
        with open(path, "wb") as file:
            file.write(archive)

    @classmethod
    @with_keywords("mspring_network_def")
    def read(cls, source: Union[bytes, str, os.PathLike[str]], **settings: Unpack[NetworkKeywords]) -> Network:
        """Make a network of an archive. It continues where the archived one was, with the same ids.

        source    bytes of archive(), or the path of a file
        settings  override those of the archive, such as worker_count
        """
        if isinstance(source, (str, os.PathLike)):
            with open(source, "rb") as file:
                source = file.read()
        return cls._of_archive(bytes(source), dict(settings))

    @classmethod
    def _of_archive(cls, archive: bytes, settings: Dict[str, Any]) -> Network:
        made, def_ = ffi.new("mspring_network **"), empty("mspring_network_def")
        with Builder() as builder:
            builder._call(lib.mspring_builder_read, ffi.from_buffer(archive), len(archive), ffi.NULL)
            builder._call(lib.mspring_builder_get_network_def, def_)
            builder._call(lib.mspring_network_create, changed("mspring_network_def", def_, settings), made)
        network = cls.__new__(cls)
        network._take(made[0])
        network._was_compacted = True  # perhaps
        network._event_capacity = network._contact_capacity = 1024  # read at a time
        return network

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self)._of_archive, (self.archive(), {})

    # ------------------------------------------------------------------------------------------------- pictures

    def plot(self, ax: Any = None, color: Any = "strain", **options: Any) -> Any:
        """Draw the springs with matplotlib, coloured by a property. See massspring.plotting.draw()."""
        from .plotting import draw
        self._live()
        return draw(self, ax, color, **options)

