"""How a network's functions are called: one thread at a time, errors as exceptions.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import operator
import threading
import weakref
from typing import Any, Optional, Tuple

import numpy as np

from ._core import Handle, Ids, as_numbers, bad_argument, changed, empty, fail, ffi, id_array, lib, one_id, pointer, text_of


class Span:
    """Which particles or springs a call is about: a range of ids, or a list of them."""

    def __init__(self, ids: Ids, total: int):
        self.first, self.ids, self.is_one = 0, None, False
        if ids is None:
            self.count = total
        elif isinstance(ids, slice):
            self._take_range(range(*ids.indices(total)))
        elif isinstance(ids, range):
            self._take_range(ids)
        elif isinstance(ids, (int, np.integer)):
            self.is_one = True
            self.first, self.count = one_id("ids", ids), 1
        else:
            self._take_list(np.asarray(ids), total)

    def _take_range(self, ids: range) -> None:
        if ids.step == 1 and ids.start >= 0:
            self.first, self.count = ids.start, len(ids)
        else:
            self.ids = id_array("ids", np.arange(ids.start, ids.stop, ids.step))
            self.count = len(self.ids)

    def _take_list(self, ids: np.ndarray, total: int) -> None:
        if ids.dtype.kind == "b":
            if ids.shape != (total,):
                raise bad_argument(f"ids has the shape {ids.shape}: a mask must have the shape ({total},)")
            ids = np.flatnonzero(ids)
        self.ids = id_array("ids", ids)
        self.count = len(self.ids)

    def as_list(self) -> np.ndarray:
        """The ids one by one, for calls that have no range."""
        return self.ids if self.ids is not None else id_array("ids", np.arange(self.first, self.first + self.count))

    def must_be_range(self) -> None:
        if self.ids is not None:
            raise bad_argument("ids must be one id, a range without steps, a slice or None here")


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

    def _check(self, result: int, live: Any) -> None:
        if result:
            fail(result, text_of(lib.mspring_network_error(live)))

    def _value(self, function: Any, *arguments: Any) -> Any:
        """A shared call that cannot fail."""
        arguments = as_numbers(arguments)
        with self._lock:
            return function(self._live(), *arguments)

    @staticmethod
    def _result(function: Any, live: Any, arguments: Tuple[Any, ...]) -> int:
        try:
            return function(live, *arguments)
        except OverflowError as error:
            raise bad_argument(str(error)) from None

    def _read(self, function: Any, *arguments: Any) -> None:
        """A shared call."""
        arguments = as_numbers(arguments)
        with self._lock:
            live = self._live()
            self._check(self._result(function, live, arguments), live)

    def _change(self, function: Any, *arguments: Any) -> None:
        """An exclusive call."""
        arguments = as_numbers(arguments)
        with self._lock:
            live = self._live()
            self._changes += 1
            self._check(self._result(function, live, arguments), live)

    def _relayout(self, function: Any, *arguments: Any) -> None:
        """A call that moves the state to other memory, which no array may show then."""
        with self._lock:
            if len(self._exports):
                raise BufferError("arrays of a view of this network exist: delete them, as this call moves its memory")
            self._change(function, *arguments)

    def _report(self, cls: Any, kind: str, function: Any, *arguments: Any) -> Any:
        struct = empty(kind)
        self._read(function, *arguments, struct)
        return cls(struct)

    def _modify(self, kind: str, get: Any, set_: Any, values: Any) -> None:
        """Change some fields of what the network has."""
        with self._lock:
            struct = empty(kind)
            self._read(get, struct)
            self._change(set_, changed(kind, struct, values))

    def _modify_one(self, kind: str, get: Any, set_: Any, number: int, values: Any) -> None:
        """The same of one of several things."""
        with self._lock:
            struct = empty(kind)
            self._read(get, number, struct)
            self._change(set_, number, changed(kind, struct, dict(values)))

    def _made(self, function: Any, def_: Any) -> int:
        made = ffi.new("mspring_id *")
        self._change(function, def_, made)
        return made[0]

    def _pairs(self, function: Any, function_at: Any, span: Span, ctype: str, out: np.ndarray) -> np.ndarray:
        """Read pairs, such as positions, into an array (n, 2)."""
        x, y = pointer(ctype, out), pointer(ctype, out, 1)
        if span.ids is None:
            self._read(function, span.first, span.count, x, y, 2)
        else:
            self._read(function_at, pointer("mspring_id", span.ids), span.count, x, y, 2)
        return out[0] if span.is_one else out

    def _set_pairs(self, function: Any, function_at: Any, span: Span, ctype: str, name: str, values: Any) -> None:
        array = pair_values(name, values, span, "f8" if ctype == "double" else "f4")
        stride = 0 if array.ndim == 1 else 2
        x, y = pointer(ctype, array), pointer(ctype, array, 1)
        if span.ids is None:
            self._change(function, span.first, span.count, x, y, stride)
        else:
            self._change(function_at, pointer("mspring_id", span.ids), span.count, x, y, stride)

    @property
    def particle_count(self) -> int:
        """Particles, removed ones included. All ids are below it."""
        return self._value(lib.mspring_network_particle_count)

    @property
    def spring_count(self) -> int:
        """Springs, removed ones included. All ids are below it."""
        return self._value(lib.mspring_network_spring_count)

    @property
    def pointer(self) -> Any:
        """The mspring_network * for massspring.lib, for calls that this class lacks. The header's rules hold."""
        return self._live()


def pair_values(name: str, values: Any, span: Span, dtype: str) -> np.ndarray:
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} has the dtype {array.dtype}: it must be real numbers")
    if array.shape not in ((2,), (span.count, 2)):
        raise bad_argument(f"{name} has the shape {array.shape}: it must be (2,) or ({span.count}, 2)")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype)


def count_of(name: str, value: Any) -> int:
    """A number of things, 0 or more."""
    count = operator.index(value)
    if count < 0:
        raise bad_argument(f"{name} is {count}: it must not be negative")
    return count


def output(out: Optional[np.ndarray], shape: Tuple[int, ...], dtype: str) -> np.ndarray:
    """An array to fill: a new one, or the caller's if it fits."""
    if out is None:
        return np.empty(shape, dtype)
    if not isinstance(out, np.ndarray) or out.shape != shape or out.dtype != np.dtype(dtype) or \
            not out.flags.c_contiguous or not out.flags.writeable:
        raise bad_argument(f"out must be a contiguous, writeable array of the shape {shape} and the dtype {dtype}")
    return out

