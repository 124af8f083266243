"""Base classes of what is made from the headers.

SPDX-License-Identifier: MIT
"""
from typing import Any, NamedTuple, Optional, Tuple

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


class Field(NamedTuple):
    """A field of a struct as a keyword argument."""

    kind: str                # its type in C
    shape: Tuple[str, ...]   # of an array: numbers, fields that count, or "field - 1"
    about: str


class Flag(NamedTuple):
    """A flag as a keyword argument."""

    field: str
    bit: int
    about: str
