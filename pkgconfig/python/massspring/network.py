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
from ._core import (Ids, as_number, bad_argument, changed, defaults, enum_value, fail, ffi, filled, lib, pointer, text_of,
                    with_keywords)
from ._edits import EditCalls
from ._laws import LawCalls
from ._measure import MeasureCalls
from ._state import StateCalls
from .builder import Builder
from .gradient import Gradients, gradient_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import (CloneKeywords, NetworkKeywords, Settings, SettingsKeywords, SnapshotContents,
                          SnapshotContentsName, StepInfo)


@with_keywords("mspring_network_def")
class Network(StateCalls, EditCalls, BodyCalls, LawCalls, MeasureCalls):
    """Masses joined by springs with dampers, in two dimensions. Units are SI; the y axis points up.

    Network(builder, **settings) makes one of what the builder holds. gravity=(x, y) sets both. Enums and special numbers
    may be given as text: solver="implicit", substeps="auto". Flags are booleans: precise=True.

    What takes no argument and changes nothing is a property.

    Use it in a with statement, call close(), or let it be collected. Steps release the GIL: networks step in parallel
    in threads. Calls on one network from several threads wait for each other. A call that fails changes nothing.
    Hooks and compaction jobs of the C library are left out: massspring.lib and Network.pointer lead to them.
    """

    def __init__(self, builder: Builder, **settings: Unpack[NetworkKeywords]):
        if not isinstance(builder, Builder):
            raise TypeError(f"builder is {builder!r}: it must be a massspring.Builder")
        self._create(builder, filled("mspring_network_def", dict(settings)))

    def _create(self, builder: Builder, def_: Any) -> None:
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

    @with_keywords("mspring_clone_def")
    def clone(self, **fields: Unpack[CloneKeywords]) -> Network:
        """Make an independent copy. The same calls on both give the same bits."""
        made = ffi.new("mspring_network **")
        self._read(lib.mspring_network_clone, filled("mspring_clone_def", dict(fields)), made)
        copy = Network.__new__(Network)
        copy._take(made[0])
        copy._was_compacted = self._was_compacted
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

    def set_actuators(self, springs: Ids, changes: int = 1) -> None:
        """Make springs actuators: their rest lengths follow set("signal", ...), and the signals of gradient().

        springs  these replace the actuators that there are; their lengths of now are signal 1
        changes  in how many even parts a step takes a length to its signal, 1 to 256
        """
        span = self._springs(springs)
        ids = span.ids if span.ids is not None else np.arange(span.first, span.first + span.count, dtype=np.uint32)
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
        return self._report("mspring_step_info", lib.mspring_network_get_step_info)

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.step_info.time

    def wake(self) -> None:
        """Wake all of the network."""
        self._change(lib.mspring_network_wake)

    # ------------------------------------------------------------------------------------------------- settings

    @property
    def settings(self) -> Settings:
        """The settings that the next step uses, those of the solver included. set_settings() changes them."""
        return self._report("mspring_settings", lib.mspring_network_get_settings)

    @with_keywords("mspring_settings")
    def set_settings(self, **fields: Unpack[SettingsKeywords]) -> None:
        """Change some settings: all that are given or, on error, none. The others stay. gravity=(x, y) sets both."""
        self._modify("mspring_settings", lib.mspring_network_get_settings, lib.mspring_network_set_settings, (),
                     dict(fields))

    # ------------------------------------------------------------------------------------------------ snapshots

    def save(self, contents: Union[SnapshotContents, SnapshotContentsName] = "all") -> bytes:
        """Save a snapshot: all that the following steps depend on, or a "frame" for quick rollback.

        It fits networks that are made of the same particles and springs. Floor, contact and colliders are not in it.
        """
        number, size = enum_value("mspring_snapshot_contents", "contents", contents), ffi.new("size_t *")
        with self._lock:
            self._read(lib.mspring_network_get_snapshot_size, number, size)
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

    @property
    def archive(self) -> bytes:
        """An archive as bytes: all of the network but hooks, components and unread events.

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
        archive = self.archive
        with open(path, "wb") as file:
            file.write(archive)

    @classmethod
    @with_keywords("mspring_network_def")
    def read(cls, source: Union[bytes, str, os.PathLike[str]], **settings: Unpack[NetworkKeywords]) -> Network:
        """Make a network of an archive. It continues where the archived one was, with the same ids.

        source    bytes of an archive, or the path of a file
        settings  override those of the archive, such as worker_count
        """
        if isinstance(source, (str, os.PathLike)):
            with open(source, "rb") as file:
                source = file.read()
        return cls._of_archive(memoryview(source).tobytes(), dict(settings))

    @classmethod
    def _of_archive(cls, archive: bytes, settings: Dict[str, Any]) -> Network:
        network, def_ = cls.__new__(cls), defaults("mspring_network_def")
        with Builder() as builder:
            builder._call(lib.mspring_builder_read, ffi.from_buffer(archive), len(archive), ffi.NULL)
            builder._call(lib.mspring_builder_get_network_def, def_)
            network._create(builder, changed("mspring_network_def", def_, settings))
        network._was_compacted = True  # perhaps
        return network

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self)._of_archive, (self.archive, {})

    # ------------------------------------------------------------------------------------------------- pictures

    def plot(self, ax: Any = None, color: Any = "strain", **options: Any) -> Any:
        """Draw the springs with matplotlib, coloured by a property. See massspring.plotting.draw()."""
        from .plotting import draw
        self._live()
        return draw(self, ax, color, **options)

