"""The shared library, and how Python's values become its arguments.

SPDX-License-Identifier: MIT
"""
import operator
import re
import sys
import textwrap
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Optional, Tuple, TypeVar, Union

import numpy as np

from . import _header
from ._bindings import ffi
from ._types import NO_ID, ClosedError, Error

LIBRARY = {"win32": "massspring.dll", "darwin": "libmassspring.dylib"}.get(sys.platform, "libmassspring.so")
lib = ffi.dlopen(str(Path(__file__).with_name(LIBRARY)))

_RUNS = ffi.string(lib.mspring_version_string()).decode()
if _RUNS.rsplit(".", 1)[0] != _header.VERSION.rsplit(".", 1)[0]:
    raise ImportError(f"{LIBRARY} is version {_RUNS}, and this package was made for {_header.VERSION}")

Ids = Union[None, int, range, slice, Iterable[int], np.ndarray]
MAX_IDS = 1 << 32


def text_of(pointer: Any) -> str:
    return ffi.string(pointer).decode(errors="replace")


def fail(result: int, message: str, particle: Optional[int] = None, spring: Optional[int] = None) -> None:
    """Raise the error of a result below 0."""
    name = text_of(lib.mspring_result_string(result))
    kind = _header.ERRORS.get(result, Error)
    raise kind(f"{name}: {message}" if message else name, result, particle, spring)


def bad_argument(message: str) -> Error:
    return _header.ArgumentError(message, _header.ERROR_ARGUMENT)


# ---------------------------------------------------------------------------------------------------- structs

def enum_value(kind: str, name: str, value: Any) -> int:
    """A member of an enum: itself, its number, or its name in any case, such as "implicit"."""
    if not isinstance(value, str):
        return int(value)
    members = _header.ENUMS[kind].__members__
    if value.upper() not in members:
        raise bad_argument(f"{name} is {value!r}: it must be one of {', '.join(members).lower()}")
    return int(members[value.upper()])


def fields_of(kind: str) -> Dict[str, Any]:
    return dict(ffi.typeof(kind).fields)


def expand(kind: str, values: Dict[str, Any]) -> Dict[str, Any]:
    """Keyword arguments that stand for several fields: gravity=(x, y) and pinned=True."""
    fields, expanded = fields_of(kind), {}
    for name, value in values.items():
        if name not in fields and name + "_x" in fields and name + "_y" in fields:
            try:
                expanded[name + "_x"], expanded[name + "_y"] = value
            except (TypeError, ValueError):
                raise bad_argument(f"{name} is {value!r}: it must be a pair of numbers") from None
        elif name == "pinned" and ("particle_flags" in fields or kind == "mspring_particle_def"):
            flags = "particle_flags" if "particle_flags" in fields else "flags"
            pinned = np.where(np.asarray(value, bool), _header.PARTICLE_PINNED, 0)
            expanded[flags] = values.get(flags, 0) | (int(pinned) if pinned.ndim == 0 else pinned)
        elif name not in expanded:
            expanded[name] = value
    return expanded


def check_names(kind: str, values: Iterable[str], taken: Tuple[str, ...] = ()) -> Dict[str, Any]:
    fields = fields_of(kind)
    for name in values:
        field = fields.get(name)
        if field is None or name in taken or name == "struct_size" or name.startswith("reserved") or \
                field.type.kind in ("pointer", "function"):
            known = ", ".join(sorted(_header.ABOUT.get(kind, ())))
            raise TypeError(f"{name} is no keyword argument here: there are {known}")
    return fields


def assign(struct: Any, name: str, field: Any, value: Any) -> None:
    """Set a field. The library judges the value; what no C number can hold is judged here."""
    try:
        if field.type.kind == "enum":
            setattr(struct, name, enum_value(field.type.cname.replace("enum ", ""), name, value))
        elif field.type.cname in ("float", "double"):
            setattr(struct, name, float(value))
        else:
            if isinstance(value, (float, np.floating)):
                raise TypeError
            setattr(struct, name, int(value))
    except OverflowError:
        raise bad_argument(f"{name} is {value!r}: it must be a number of type {field.type.cname}") from None
    except (TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise TypeError(f"{name} is {value!r}: it must be a number of type {field.type.cname}") from None


def init_of(kind: str) -> Callable[[Any, int], int]:
    return getattr(lib, kind + "_init")


def filled(kind: str, values: Dict[str, Any], taken: Tuple[str, ...] = ()) -> Any:
    """A struct with its defaults and these fields. The caller sets the fields that are taken."""
    struct = ffi.new(kind + " *")
    result = init_of(kind)(struct, ffi.sizeof(struct[0]))
    if result:
        fail(result, kind)
    return changed(kind, struct, values, taken)


def changed(kind: str, struct: Any, values: Dict[str, Any], taken: Tuple[str, ...] = ()) -> Any:
    values = expand(kind, values)
    fields = check_names(kind, values, taken)
    for name, value in values.items():
        assign(struct, name, fields[name], value)
    return struct


def empty(kind: str) -> Any:
    """A struct for the library to fill."""
    struct = ffi.new(kind + " *")
    struct.struct_size = ffi.sizeof(struct[0])
    return struct


def dtype_of(kind: str) -> np.dtype:
    """The numpy dtype of a struct of numbers."""
    fields = [(name, field) for name, field in ffi.typeof(kind).fields if field.type.kind in ("primitive", "enum")]
    formats = []
    for _, field in fields:
        name = field.type.cname
        size = ffi.sizeof(field.type)
        letter = "f" if name in ("float", "double") else "i" if field.type.kind == "enum" or name[0] == "i" else "u"
        formats.append(f"{letter}{size}")
    return np.dtype({"names": [name for name, _ in fields], "formats": formats,
                     "offsets": [field.offset for _, field in fields], "itemsize": ffi.sizeof(kind)})


def table(kind: str, count: int, values: Dict[str, Any], taken: Tuple[str, ...] = ()) -> np.ndarray:
    """Structs with their defaults and these columns, each a number or an array of numbers."""
    values = expand(kind, values)
    check_names(kind, values, taken)
    default = np.frombuffer(ffi.buffer(filled(kind, {})), dtype_of(kind))
    rows = np.repeat(default, count)
    for name, value in values.items():
        rows[name] = column(name, value, count, rows.dtype[name])
    return rows


def column(name: str, value: Any, count: int, dtype: np.dtype) -> np.ndarray:
    """An array that fits, or an error that says why not."""
    array = np.asarray(value)
    if array.dtype.kind not in "biuf" or (dtype.kind != "f" and array.dtype.kind == "f"):
        raise TypeError(f"{name} has the dtype {array.dtype}: it must be one that {dtype} can hold")
    if array.shape not in ((), (count,)):
        raise bad_argument(f"{name} has the shape {array.shape}: it must be a number or have the shape ({count},)")
    if dtype.kind != "f" and array.size and (array.min() < np.iinfo(dtype).min or array.max() > np.iinfo(dtype).max):
        raise bad_argument(f"{name} has a value that no {dtype} can hold")
    with np.errstate(over="ignore"):  # infinity, which the library judges
        return array.astype(dtype)


# ----------------------------------------------------------------------------------------------------- arrays

def numbers(name: str, value: Any, dtype: str, shape: Tuple[Optional[int], ...]) -> np.ndarray:
    """A contiguous array of floating-point numbers with this shape; None is any length."""
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} has the dtype {array.dtype}: it must be real numbers")
    if array.ndim != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        wanted = ", ".join("n" if want is None else str(want) for want in shape)
        raise bad_argument(f"{name} has the shape {array.shape}: it must be ({wanted})")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype)


def as_number(value: Any) -> Any:
    """A number, or what the library takes for one, that runs no code of its own later: __float__ may close a network."""
    if isinstance(value, (int, float, ffi.CData)):
        return value
    try:
        return operator.index(value)
    except TypeError:
        return float(value) if hasattr(value, "__float__") else value


def as_numbers(values: Tuple[Any, ...]) -> Tuple[Any, ...]:
    return tuple(as_number(value) for value in values)


def one_id(name: str, value: Any) -> int:
    """An id as the library takes it."""
    number = int(value)
    if not 0 <= number < MAX_IDS:
        raise _header.IdError(f"{name} has {number}, and ids are 0 to {MAX_IDS - 2}", _header.ERROR_ID)
    return number


def id_array(name: str, value: Any, shape: Tuple[Optional[int], ...] = (None,)) -> np.ndarray:
    """Ids as the library takes them. A number that is no id is an IdError."""
    array = np.asarray(value)
    if array.size == 0:
        array = array.astype(np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} has the dtype {array.dtype}: ids must be integers")
    if array.ndim != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        raise bad_argument(f"{name} has the shape {array.shape}: it must be that of a list of ids")
    if array.size and (array.min() < 0 or array.max() >= MAX_IDS):
        raise _header.IdError(f"{name} has {array.min()} to {array.max()}, and ids are 0 to {MAX_IDS - 2}",
                              _header.ERROR_ID)
    return np.ascontiguousarray(array, np.uint32)


def pointer(kind: str, array: np.ndarray, offset: int = 0) -> Any:
    """A pointer to an array's numbers, from its element offset on. The caller keeps it or the array."""
    numbers_ = ffi.from_buffer(kind + "[]", array)
    return numbers_ + offset if offset else numbers_


def optional_ids(array: np.ndarray) -> np.ndarray:
    """Ids as int64, with -1 where there is none."""
    wide = array.astype(np.int64)
    wide[array == NO_ID] = -1
    return wide


# -------------------------------------------------------------------------------------------------- docstrings

Documented = TypeVar("Documented")


def with_keywords(*kinds: str) -> Callable[[Documented], Documented]:
    """Append to a docstring which keyword arguments the structs give. For type checkers, what has it stays what it is."""
    def add(function: Documented) -> Documented:
        lines = []
        for kind in kinds:
            for name, about in _header.ABOUT.get(kind, {}).items():
                if not re.match(r".*_count$", name) or name in ("worker_count", "segment_count", "ring_count",
                                                                 "start_count"):
                    lines.append(textwrap.fill(f"{name}: {about}", 110, subsequent_indent="    "))
        function.__doc__ = f"{function.__doc__}\n\nKeyword arguments:\n\n" + "\n".join(lines)
        return function
    return add


class Handle:
    """An object of the library: its pointer, until close()."""

    _kind = ""
    _pointer: Any = None

    def _live(self) -> Any:
        live = self._pointer
        if live is None:
            raise ClosedError(f"this {self._kind} is closed")
        return live

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._pointer is None
