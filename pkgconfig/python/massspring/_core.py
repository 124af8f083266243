"""The shared library, and how Python's values become its arguments.

SPDX-License-Identifier: MIT
"""
import inspect
import operator
import re
import sys
import textwrap
import weakref
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Tuple, TypeVar, Union

import numpy as np

from . import _header
from ._bindings import ffi
from ._types import NO_ID, ClosedError, Error, Field, Flag

LIBRARY = {"win32": "massspring.dll", "darwin": "libmassspring.dylib"}.get(sys.platform, "libmassspring.so")
lib = ffi.dlopen(str(Path(__file__).with_name(LIBRARY)))

_RUNS = ffi.string(lib.mspring_version_string()).decode()
if _RUNS.rsplit(".", 1)[0] != _header.VERSION.rsplit(".", 1)[0]:
    raise ImportError(f"{LIBRARY} is version {_RUNS}, and this package was made for {_header.VERSION}")

Ids = Union[None, int, range, slice, Iterable[int], np.ndarray]
MAX_IDS = 1 << 32
DTYPES = {"double": "f8", "float": "f4", "uint16_t": "u2", "uint32_t": "u4", "mspring_id": "u4"}
_kept: Any = weakref.WeakKeyDictionary()  # what structs point to, as long as they live


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

def defaults(kind: str) -> Any:
    """A struct with its defaults, to change or for the library to fill."""
    struct = ffi.new(kind + " *")
    result = lib.mspring_init(_header.STRUCTS[kind], struct, ffi.sizeof(struct[0]))
    if result:
        fail(result, f"{kind} has {ffi.sizeof(struct[0])} bytes here")
    return struct


def array_for(kind: str, count: int) -> Any:
    """Structs for the library to fill."""
    structs = ffi.new(kind + "[]", count)
    for struct in structs:
        struct.struct_size = ffi.sizeof(struct)
    return structs


def record_of(kind: str, struct: Any) -> Any:
    """A report as a named tuple. Ids that name nothing are None, special numbers have their names."""
    cls, kinds = _header.REPORTS[kind]
    return cls(*(_attribute(name, of, getattr(struct, name)) for name, of in kinds.items()))


def _attribute(name: str, kind: str, value: Any) -> Any:
    if kind in _header.REPORTS:
        return record_of(kind, value)
    if kind in _header.ENUMS:
        try:
            return _header.ENUMS[kind](value)
        except ValueError:
            return value  # of a newer library
    if kind == "mspring_id":
        return None if value == NO_ID else value
    if name.startswith("is_"):
        return bool(value)
    if isinstance(value, int):
        return next((word for word, number in _header.WORDS.get(name, {}).items() if number == value), value)
    return value if isinstance(value, float) else tuple(value)


def enum_value(kind: str, name: str, value: Any) -> int:
    """A member of an enum: itself, its number, or its name in any case, such as "implicit"."""
    members = _header.ENUMS[kind].__members__
    number = members.get(value.upper()) if isinstance(value, str) else operator.index(value)
    if number is None or number not in members.values():
        raise bad_argument(f"{name} is {value!r}: it must be one of {', '.join(members).lower()}")
    return int(number)


def filled(kind: str, values: Dict[str, Any]) -> Any:
    """A struct with its defaults and these keyword arguments."""
    return changed(kind, defaults(kind), values)


def changed(kind: str, struct: Any, values: Dict[str, Any]) -> Any:
    """Set fields of a struct, or of structs in it, by keyword arguments.

    What the headers say decides: flags are booleans by name, gravity=(x, y) sets two fields, None is the default, and
    an array sets the fields that count it.
    """
    _kept[struct] = kept = []
    arrays: List[Tuple[Any, str, Field, Any]] = []
    given = set(values)
    for name, value in sorted(values.items(), key=lambda item: item[0] in _header.FLAGS[kind]):  # after flags=
        of, inner = _owner(kind, struct, name)
        fields, flag = _header.KEYWORDS[of], _header.FLAGS[of].get(name)
        if flag is not None:
            bits = getattr(inner, flag.field)
            setattr(inner, flag.field, bits | flag.bit if _is_true(name, value) else bits & ~flag.bit)
        elif name not in fields:
            for part, number in zip("xy", (None, None) if value is None else pair(name, value)):
                _assign(of, inner, f"{name}_{part}", number)
        elif "*" in fields[name].kind:
            arrays.append((inner, name, fields[name], value))
        else:
            _assign(of, inner, name, value)
    for inner, name, field, value in sorted(arrays, key=lambda item: "-" in "".join(item[2].shape)):
        kept.append(_point(inner, name, field, value, given))
    return struct


def _owner(kind: str, struct: Any, name: str) -> Tuple[str, Any]:
    """The struct that has a keyword argument: this one, or one in it."""
    if _has(kind, name):
        return kind, struct
    for field, (of, _, _) in _header.KEYWORDS[kind].items():
        if of in _header.KEYWORDS and _has(of, name):
            return of, getattr(struct, field)
    raise unknown(kind, name)


def _has(kind: str, name: str) -> bool:
    fields = _header.KEYWORDS[kind]
    return (name in fields and fields[name].kind not in _header.KEYWORDS) or name in _header.FLAGS[kind] or \
        (name + "_x" in fields and name + "_y" in fields)


def unknown(kind: str, name: str) -> TypeError:
    return TypeError(f"{name} is no keyword argument here: there are {', '.join(name for name, _ in _arguments(kind))}")


def _arguments(kind: str) -> Iterator[Tuple[str, str]]:
    """All keyword arguments of a struct, with what they mean."""
    for name, (of, _, about) in _header.KEYWORDS[kind].items():
        if of in _header.KEYWORDS:
            yield from _arguments(of)
        elif of in _header.ENUMS:
            yield name, f"{_quoted(_header.ENUMS[of].__members__)}; {about}"
        else:
            words = _quoted(_header.WORDS.get(name, ()))
            yield name, f"{about}; as words: {words}" if words else about
    yield from ((name, about) for name, (_, _, about) in _header.FLAGS[kind].items())


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f'"{name.lower()}"' for name in names)


def _is_true(name: str, value: Any) -> bool:
    if np.ndim(value) or value not in (False, True):
        raise TypeError(f"{name} is {value!r}: it must be True or False")
    return bool(value)


def pair(name: str, value: Any) -> Tuple[Any, Any]:
    try:
        x, y = value
    except (TypeError, ValueError):
        raise bad_argument(f"{name} is {value!r}: it must be a pair of numbers") from None
    return x, y


def plain(kind: str, name: str, value: Any) -> Any:
    """What a value stands for: None for the default, a word for a special number or a member of an enum."""
    field = _header.KEYWORDS[kind][name]
    if value is None:
        return getattr(defaults(kind), name)
    if field.kind in _header.ENUMS:
        return enum_value(field.kind, name, value)
    return word(name, value)


def word(name: str, value: Any) -> Any:
    """The number that a word stands for, such as "auto" for substeps; other values are left alone."""
    if not isinstance(value, str):
        return value
    words = _header.WORDS.get(name)
    if words is None:
        raise TypeError(f"{name} is {value!r}: it must be a number")
    if value.lower() not in words:
        raise bad_argument(f"{name} is {value!r}: it must be a number or one of {', '.join(words)}")
    return words[value.lower()]


def _assign(kind: str, struct: Any, name: str, value: Any) -> None:
    """Set a number. The library judges the value; what no C number can hold is judged here."""
    ctype = _header.KEYWORDS[kind][name].kind
    try:
        value = plain(kind, name, value)
        if ctype in ("float", "double"):
            setattr(struct, name, float(value))
        else:
            if isinstance(value, (float, np.floating)):
                raise TypeError
            setattr(struct, name, int(value))
    except OverflowError:
        raise bad_argument(f"{name} is {value!r}: it must be a number of type {ctype}") from None
    except (TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise TypeError(f"{name} is {value!r}: it must be a number of type {ctype}") from None


def _point(struct: Any, name: str, field: Field, value: Any, given: Any) -> Any:
    """Set a pointer to numbers or structs, and the fields that count them. Returns what must be kept."""
    if value is None:
        return None
    kind = re.sub(r"^const | \*$", "", field.kind)
    if kind in _header.KEYWORDS:
        listed = [value] if isinstance(value, dict) or not field.shape else list(value)
        kept = ffi.new(kind + "[]", len(listed))
        for target, one in zip(kept, listed):
            if not isinstance(one, dict):
                raise TypeError(f"{name} is {value!r}: it must be a dict" + " or a list of dicts" * bool(field.shape))
            target_ = filled(kind, one)
            ffi.memmove(ffi.addressof(target), target_, ffi.sizeof(kind))
        shape, data = (len(listed),), kept
    else:
        kept = array_of(name, value, DTYPES[kind], tuple(_length(struct, part, given) for part in field.shape))
        shape, data = kept.shape, pointer(kind, kept)
    for part, length in zip(field.shape, shape):
        if part.isidentifier():
            setattr(struct, part, length)
            given.add(part)
    setattr(struct, name, data)
    return kept


def _length(struct: Any, part: str, given: Any) -> Optional[int]:
    """A length that an array must have; None: any, as nothing has said it yet."""
    counter, _, less = part.partition(" - ")
    if part.isdigit():
        return int(part)
    return max(getattr(struct, counter) - int(less or 0), 0) if counter in given or less else None


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


def table(kind: str, count: int, values: Dict[str, Any]) -> np.ndarray:
    """Structs with their defaults and these columns, each a number or an array of numbers."""
    rows = np.repeat(np.frombuffer(ffi.buffer(defaults(kind)), dtype_of(kind)), count)
    for name, value in sorted(values.items(), key=lambda item: item[0] in _header.FLAGS[kind]):
        flag = _header.FLAGS[kind].get(name)
        if flag is not None:
            bits = column(name, value, count, np.dtype("u4"))
            if (bits > 1).any():
                raise bad_argument(f"{name} has a value that is neither True nor False")
            rows[flag.field] = (rows[flag.field] & ~np.uint32(flag.bit)) | bits * np.uint32(flag.bit)
        elif name in _header.KEYWORDS[kind]:
            rows[name] = column(name, plain(kind, name, value), count, rows.dtype[name])
        else:
            raise unknown(kind, name)
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
        return array.astype(dtype, copy=False)


# ----------------------------------------------------------------------------------------------------- arrays

def array_of(name: str, value: Any, dtype: str, shape: Tuple[Optional[int], ...]) -> np.ndarray:
    """A contiguous array of numbers with this shape; None is any length. A number that is no id is an IdError."""
    array = np.asarray(value)
    wanted = ", ".join("n" if want is None else str(want) for want in shape)
    is_float = dtype[0] == "f"
    if array.size == 0 and array.ndim <= len(shape) and array.dtype.kind in "biuf":
        array = np.zeros([want or 0 if axis else 0 for axis, want in enumerate(shape)], dtype)
    if array.dtype.kind not in ("biuf" if is_float else "iu"):
        raise TypeError(f"{name} has the dtype {array.dtype}: it must be {'real numbers' if is_float else 'integers'}")
    if array.ndim != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        raise bad_argument(f"{name} has the shape {array.shape}: it must be ({wanted})")
    if not is_float and array.size and (array.min() < 0 or array.max() > np.iinfo(dtype).max):
        raise _header.IdError(f"{name} has {array.min()} to {array.max()}, and must be 0 to {np.iinfo(dtype).max}",
                              _header.ERROR_ID)
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


def one_id(name: str, value: Any) -> int:
    """An id as the library takes it."""
    number = int(value)
    if not 0 <= number < MAX_IDS:
        raise _header.IdError(f"{name} has {number}, and ids are 0 to {MAX_IDS - 2}", _header.ERROR_ID)
    return number


def id_array(name: str, value: Any, shape: Tuple[Optional[int], ...] = (None,)) -> np.ndarray:
    return array_of(name, value, "u4", shape)


class Span:
    """Which things a call is about: a range of ids, or a list of them. arguments are the call's (ids, first, count)."""

    def __init__(self, ids: Ids, total: int, name: str = "ids"):
        self.first, self.count, self.is_one = 0, total, False
        self.ids: Optional[np.ndarray] = None
        if ids is None:
            pass
        elif isinstance(ids, (bool, np.bool_)):
            raise TypeError(f"{name} is {ids}: it must be an id, ids, a mask or None")
        elif isinstance(ids, (int, np.integer)):
            self.is_one, self.first, self.count = True, one_id(name, ids), 1
            self.arguments = (ffi.new("mspring_id *", self.first), 0, 1)  # a list, in which a removed one is an error
            return
        else:
            self._take(range(*ids.indices(total)) if isinstance(ids, slice) else ids, total, name)
        self.arguments = (optional("mspring_id", self.ids), self.first, self.count)

    def _take(self, ids: Any, total: int, name: str) -> None:
        if isinstance(ids, range) and ids and ids[-1] >= total:
            raise _header.IdError(f"{name} is {ids}, but ids are below {total}", _header.ERROR_ID)
        if isinstance(ids, range) and ids.step == 1 and ids.start >= 0:
            self.first, self.count = ids.start if ids else 0, len(ids)
            return
        array = np.asarray(ids)
        if array.dtype.kind == "b":
            if array.shape != (total,):
                raise bad_argument(f"{name} has the shape {array.shape}: a mask must have the shape ({total},)")
            array = np.flatnonzero(array)
        self.ids = id_array(name, array)
        self.count = len(array)


def pointer(kind: str, array: np.ndarray, offset: int = 0) -> Any:
    """A pointer to an array's numbers, from its element offset on. The caller keeps it or the array."""
    numbers = ffi.from_buffer(kind + "[]", array)
    return numbers + offset if offset else numbers


def optional(kind: str, array: Optional[np.ndarray]) -> Any:
    return ffi.NULL if array is None else pointer(kind, array)


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
        lines = [textwrap.fill(f"{name}: {about}", 110, subsequent_indent="    ")
                 for kind in kinds for name, about in _arguments(kind)]
        function.__doc__ = f"{inspect.cleandoc(function.__doc__ or '')}\n\nKeyword arguments, of which None is the default:\n\n" + "\n".join(lines)
        return function
    return add


class Handle:
    """An object of the library: its pointer, until close()."""

    _kind = ""
    _pointer: Any = None

    def __reduce__(self) -> Tuple[Any, ...]:
        raise TypeError(f"a {self._kind} can be neither pickled nor copied")

    def _live(self) -> Any:
        live = self._pointer
        if live is None:
            raise ClosedError(f"this {self._kind} is closed")
        return live

    def _checked(self, function: Any, error: Any, arguments: Tuple[Any, ...]) -> None:
        """Call a function of the library; error is the one that tells what was wrong. The caller has the lock."""
        live = self._live()
        try:
            result = function(live, *arguments)
        except OverflowError as overflow:
            raise bad_argument(str(overflow)) from None
        if result:
            fail(result, text_of(error(live)))

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._pointer is None
