"""How a network's functions are called: one thread at a time, errors as exceptions.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import operator
import threading
import weakref
from typing import Any, Optional, Tuple

import numpy as np

from . import _header
from ._core import Handle, Ids, Span, as_number, bad_argument, changed, defaults, ffi, lib, pointer, record_of
from ._types import Error


class Export:
    """The memory of one array of a view. It keeps the network's memory as long as numpy shows it."""

    def __init__(self, owner: Any, address: Any, count: int, dtype: str):
        self._owner = owner
        self.__array_interface__ = {"data": (int(ffi.cast("uintptr_t", address)), True), "shape": (count,),
                                    "typestr": np.dtype(dtype).str, "version": 3}


class NetworkCalls(Handle):
    """A network's pointer, its lock, and calls with them."""

    _kind = "network"

    def _take(self, made: Any) -> None:
        self._lock = threading.RLock()
        self._changes = 0  # calls that may have changed what views show
        self._was_compacted = False
        self._exports: weakref.WeakSet[Export] = weakref.WeakSet()
        self._pointer = ffi.gc(made, lib.mspring_network_destroy)

    def _call(self, function: Any, arguments: Tuple[Any, ...], changes: int) -> None:
        arguments = tuple(map(as_number, arguments))
        with self._lock:
            live = self._live()
            self._changes += changes
            try:
                self._checked(function, lib.mspring_network_error, arguments)
            except Error:
                if not changes:  # the first failure of a reading call keeps its message until a call that may change
                    lib.mspring_network_read_events(live, ffi.NULL, 0, ffi.new("uint32_t *"), ffi.NULL)
                raise

    def _read(self, function: Any, *arguments: Any) -> None:
        """A call that changes nothing that views show."""
        self._call(function, arguments, 0)

    def _change(self, function: Any, *arguments: Any) -> None:
        """A call that may change it."""
        self._call(function, arguments, 1)

    def _relayout(self, function: Any, *arguments: Any) -> None:
        """A call that moves the state to other memory, which no array may show then."""
        with self._lock:
            if len(self._exports):
                raise BufferError("arrays of a view of this network exist: delete them, as this call moves its memory")
            self._change(function, *arguments)

    def _report(self, kind: str, function: Any, *arguments: Any) -> Any:
        struct = defaults(kind)
        self._read(function, *arguments, struct)
        return record_of(kind, struct)

    def _modify(self, kind: str, get: Any, set_: Any, which: Tuple[Any, ...], values: Any) -> None:
        """Change some fields of what the network has."""
        with self._lock:
            struct = defaults(kind)
            self._read(get, *which, struct)
            self._change(set_, *which, changed(kind, struct, values))

    def _made(self, function: Any, *arguments: Any) -> int:
        made = ffi.new("mspring_id *")
        self._change(function, *arguments, made)
        return made[0]

    def _doubles(self, function: Any, count: int, *arguments: Any) -> Tuple[float, ...]:
        made = ffi.new("double[]", count)
        self._read(function, *arguments, *(made + index for index in range(count)))
        return tuple(made)

    # -------------------------------------------------------------------------------------------- what there is

    def _count(self, kind: int) -> int:
        with self._lock:
            return lib.mspring_network_count(self._live(), kind)

    @property
    def particle_count(self) -> int:
        """Particles, removed ones included. All ids are below it."""
        return self._count(_header.PARTICLES)

    @property
    def spring_count(self) -> int:
        """Springs, removed ones included. All ids are below it."""
        return self._count(_header.SPRINGS)

    @property
    def element_count(self) -> int:
        """Areas and angle springs, removed ones included. All ids are below it."""
        return self._count(_header.ELEMENTS)

    @property
    def group_count(self) -> int:
        """Groups of a batch."""
        return self._count(_header.GROUPS)

    @property
    def actuator_count(self) -> int:
        """Springs that follow signals."""
        return self._count(_header.ACTUATORS)

    @property
    def pointer(self) -> Any:
        """The mspring_network * for massspring.lib, for calls that this class lacks. The header's rules hold."""
        return self._live()

    def _particles(self, ids: Ids) -> Span:
        return Span(ids, self.particle_count)

    def _springs(self, ids: Ids) -> Span:
        return Span(ids, self.spring_count)

    def _pairs(self, function: Any, span: Span, ctype: str, out: np.ndarray) -> np.ndarray:
        """Read pairs, such as positions, into an array (n, 2)."""
        self._read(function, *span.arguments, pointer(ctype, out), pointer(ctype, out, 1), 2)
        return out[0] if span.is_one else out

    def _set_pairs(self, function: Any, before: Tuple[Any, ...], span: Span, ctype: str, name: str,
                   values: Any) -> None:
        array = np.asarray(values)
        if array.dtype.kind not in "biuf":
            raise TypeError(f"{name} has the dtype {array.dtype}: it must be real numbers")
        if array.shape not in ((2,), (span.count, 2)):
            raise bad_argument(f"{name} has the shape {array.shape}: it must be (2,) or ({span.count}, 2)")
        with np.errstate(over="ignore"):
            array = np.ascontiguousarray(array, "f8" if ctype == "double" else "f4")
        self._change(function, *before, *span.arguments, pointer(ctype, array), pointer(ctype, array, 1),
                     0 if array.ndim == 1 else 2)


def count_of(name: str, value: Any) -> int:
    """A number of things, 0 or more."""
    count = operator.index(value)
    if count < 0:
        raise bad_argument(f"{name} is {count}: it must not be negative")
    return count


def output(out: Optional[np.ndarray], shape: Tuple[int, ...], dtype: Any) -> np.ndarray:
    """An array to fill: a new one, or the caller's if it fits."""
    if out is None:
        return np.empty(shape, dtype)
    if not isinstance(out, np.ndarray) or out.shape != shape or out.dtype != np.dtype(dtype) or \
            not out.flags.c_contiguous or not out.flags.writeable:
        raise bad_argument(f"out must be a contiguous, writeable array of the shape {shape} and the dtype {dtype}")
    return out
