"""Base classes of what is made from the headers.

SPDX-License-Identifier: MIT
"""
from typing import Any, ClassVar, Dict, Iterator, Optional, Tuple

NO_ID = 0xFFFFFFFF


class Error(Exception):
    """A call that failed. It has changed nothing.

    result    the mspring_result, below 0
    message   what was wrong, and where
    particle  id of the particle that a rejected step names, or None
    spring    id of the spring that a rejected step names, or None
    """

    def __init__(self, message: str, result: int = 0, particle: Optional[int] = None, spring: Optional[int] = None):
        super().__init__(message)
        self.message, self.result, self.particle, self.spring = message, result, particle, spring

    def __reduce__(self) -> Tuple[Any, ...]:  # workers of a pool send it home
        return type(self), (self.message, self.result, self.particle, self.spring)


class ClosedError(Error, ValueError):
    """A network or a builder was used after close()."""


class StaleViewError(Error, ValueError):
    """A view was used after the network had changed. Take a new one."""


class Record:
    """A report of the library: attributes by the names of the C struct. Ids that name nothing are None."""

    _fields: ClassVar[Dict[str, Any]] = {}

    def __init__(self, struct: Any):
        for name, kind in self._fields.items():
            value = getattr(struct, name)
            if kind == "mspring_id":
                value = None if value == NO_ID else value
            elif kind:
                try:
                    value = kind(value)
                except ValueError:
                    pass  # of a newer library
            elif not isinstance(value, (int, float)):
                value = tuple(value)
            setattr(self, name, value)

    def as_dict(self) -> Dict[str, Any]:
        """The attributes as a dict."""
        return {name: getattr(self, name) for name in self._fields}

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and other.as_dict() == self.as_dict()  # type: ignore[attr-defined]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self.as_dict().items())})"
