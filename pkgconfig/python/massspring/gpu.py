"""Batches on a graphics card, or on any other device of OpenCL: the same bits, many more bodies.

Batch(builder, count, device="gpu") makes one. The library massspring_gpu is loaded then.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import os
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any, List, Tuple, Union

import numpy as np

from . import _header
from ._calls import count_of, output
from ._core import Ids, Span, as_number, bad_argument, enum_value, fail, pointer, text_of
from ._types import ClosedError, Error
from .batch import Batch
from .builder import Builder

if TYPE_CHECKING:
    from ._header import Reset, ResetName

LIBRARY = {"win32": "massspring_gpu.dll", "darwin": "libmassspring_gpu.dylib"}.get(sys.platform, "libmassspring_gpu.so")
ERROR_DEVICE = -100
ANY = 0xFFFFFFFF
MOST_BODIES = 64  # of a network that a device repeats: from as many equal ones on, some are swept in another order

_loaded: Any = None


class DeviceError(Error, RuntimeError):
    """There is no library massspring_gpu, no OpenCL or no such device, the device is unsuitable, or it failed."""


def load() -> Tuple[Any, Any]:
    """The ffi and the library of massspring_gpu. It uses the library massspring of this package.

    It is the one that the environment variable MASSSPRING_GPU_LIBRARY names. Otherwise it lies beside this module, or
    where the system finds it.
    """
    global _loaded
    if _loaded is not None:
        return _loaded
    try:
        from ._gpu_bindings import ffi
    except ImportError:
        raise DeviceError("this package was built without massspring_gpu.h", ERROR_DEVICE) from None
    given = os.environ.get("MASSSPRING_GPU_LIBRARY")
    minor = _header.VERSION.rsplit(".", 1)[0]
    system = f"{LIBRARY}.{minor}" if LIBRARY.endswith(".so") else LIBRARY
    whys = []
    for path in [given] if given else [str(Path(__file__).with_name(LIBRARY)), system]:
        try:
            _loaded = ffi, ffi.dlopen(path)
            return _loaded
        except OSError as error:
            whys.append(str(error))
    raise DeviceError("there is no library massspring_gpu: build it with -DMASSSPRING_GPU=ON, and set "
                      f"MASSSPRING_GPU_LIBRARY to its path ({'; '.join(whys)})", ERROR_DEVICE)


def _check(result: int, message: Any) -> None:
    if result == ERROR_DEVICE:
        raise DeviceError(text_of(message), result)
    if result:
        fail(result, text_of(message))


def devices() -> List[str]:
    """The devices: number, name and, if one is unsuitable, why."""
    ffi, gpu = load()
    text = ffi.new("char[]", 1 << 16)
    _check(gpu.mspring_gpu_describe_devices(ffi.NULL, text, len(text)), text)
    return text_of(text).splitlines()


def _number_of(device: str) -> int:
    _, colon, number = device.partition(":")
    if not colon:
        return ANY
    if not number.isdecimal() or int(number) >= ANY:
        raise bad_argument(f"device is {device!r}: it must be 'cpu', 'gpu', or 'gpu:' and a number")
    return int(number)


class GpuBatch(Batch):
    """A Batch whose bodies are on a device.

    network has the first bodies: 64 at most, or as many as offsets has. Give it a floor. The first step, observation or
    reset puts the bodies on the device and closes network. rows are 0 until observe(), which reads all bodies at once;
    positions() waits for the device for each.
    """

    _batch: Any = None
    _closed = False

    def _make(self, pairs: List[Tuple[Builder, int]], offsets: Any, settings: Any) -> None:
        if len(pairs) != 1:
            raise bad_argument(f"there are {len(pairs)} builders: all bodies on a device are of one")
        (builder, count), = pairs
        load()
        self._lock = threading.RLock()
        self._number = _number_of(self.device)
        super()._make([(builder, min(count, MOST_BODIES) if offsets is None else count)], offsets, settings)
        self.first_particles, self.first_springs = (np.arange(count + 1, dtype=np.uint32) * np.uint32(size)
                                                    for size in (builder.particle_count, builder.spring_count))

    def _connect(self, springs: List[np.ndarray], listed: List[np.ndarray], changes: int) -> None:
        self._actuators, self._changes = listed[0], count_of("changes", changes)

    def _begin(self) -> None:
        """Observations are made on the device, which has no bodies yet."""

    def _live(self) -> Tuple[Any, Any]:
        """The functions of the library, and the batch. The caller has the lock."""
        ffi, gpu = load()
        if self._closed:
            raise ClosedError("this batch is closed")
        if self._batch is None:
            message, made = ffi.new("char[]", 1024), ffi.new("mspring_gpu **")
            actuators = pointer("mspring_id", self._actuators)
            def_ = ffi.new("mspring_gpu_def *")
            _check(gpu.mspring_gpu_def_init(def_, ffi.sizeof(def_[0])), message)
            def_.device, def_.body_count, def_.changes = self._number, self.count, self._changes
            def_.actuators, def_.actuator_count = actuators, len(self._actuators)
            def_.message, def_.message_size = message, len(message)
            with self.network._lock:
                _check(gpu.mspring_gpu_create(self.network._live(), def_, made), message)
            self._batch = ffi.gc(made[0], gpu.mspring_gpu_destroy)
            self.network.close()
        return gpu, self._batch

    def _call(self, name: str, *arguments: Any) -> None:
        with self._lock:
            gpu, batch = self._live()
            try:
                result = getattr(gpu, name)(batch, *arguments)
            except OverflowError as overflow:
                raise bad_argument(str(overflow)) from None
            _check(result, gpu.mspring_gpu_error(batch))

    def close(self) -> None:
        """Free the bodies."""
        with self._lock:
            self._closed, self._batch = True, None
            self.network.close()

    def _advance(self, dt: float, signals: np.ndarray, count: int) -> None:
        count, dt = count_of("count", count), as_number(dt)
        with self._lock:
            if signals.size:
                numbers = np.ascontiguousarray(signals, np.float32)
                self._call("mspring_gpu_set_signals", 0, numbers.size, pointer("float", numbers), 1)
            for _ in range(count):
                self._call("mspring_gpu_step", dt)

    def mark(self, groups: Ids = None) -> None:
        """A device has no marks: reset() goes back to the start."""
        raise bad_argument("a batch on a device has no marks")

    def reset(self, groups: Ids = None, to: Union[Reset, ResetName] = "start") -> None:
        """Put groups back to their "start", and hold them no more. groups: ids, a mask, None for all."""
        if enum_value("mspring_reset", "to", to) != enum_value("mspring_reset", "to", "start"):
            self.mark()
        span = Span(groups, self.count, "groups")
        which = span.ids if span.ids is not None else np.arange(span.first, span.first + span.count)
        if which.size and which.max() >= self.count:
            raise _header.IdError(f"groups has {which.max()}, but there are {self.count}", _header.ERROR_ID)
        mask = np.zeros(self.count, np.uint8)
        mask[which] = 1
        self._call("mspring_gpu_reset", pointer("uint8_t", mask))

    def observe(self, out: Any = None) -> np.ndarray:
        """Read all groups, and return a row for each: (count, columns) of float64.

        observations may be mass, x, y, vx, vy, and those relative to the centre. Without out they are rows.
        """
        rows = self.rows if out is None else output(out, self.rows.shape, "f8")
        self._call("mspring_gpu_observe", 0, self.count, pointer("mspring_observation", self._columns),
                   len(self._columns), pointer("double", rows), rows.shape[1])
        return rows

    def positions(self, group: int) -> np.ndarray:
        """World positions of one group's particles, m: (particles, 2)."""
        first, size = self._particles_of(group)
        made = np.empty((size, 2))
        self._call("mspring_gpu_get_positions", first, size, pointer("double", made), pointer("double", made, 1), 2)
        return made

    @property
    def state_hash(self) -> int:
        """Hash of the state: that of a network with as many groups."""
        ffi, _ = load()
        made = ffi.new("uint64_t *")
        self._call("mspring_gpu_get_state_hash", made)
        return int(made[0])
