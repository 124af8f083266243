"""Simulation of two-dimensional mass-spring-damper networks.

    import massspring

    builder = massspring.Builder()
    builder.add_lattice(cells, materials)
    network = massspring.Network(builder, global_damping=1.0)
    network.step(1 / 64, 60 * 64)
    network.positions

Constants of the C headers are here without their prefix: massspring.PARTICLE_PINNED. Errors are massspring.Error and
its subclasses, one for each mspring_result. massspring.lib and massspring.ffi (cffi) lead to every C function.

SPDX-License-Identifier: MIT
"""
from . import _header, gpu, plotting
from ._core import enum_value, ffi, lib, text_of
from ._header import *  # noqa: F401,F403
from ._header import VERSION as __version__
from ._state import StateView
from ._types import ClosedError, Error, StaleViewError
from .batch import Batch
from .builder import Builder, material
from .gradient import Gradient, Gradients
from .network import Network
from .sweeps import SweepResult, sweep
from .tuning import TuneTable


def version() -> str:
    """The version of the library that runs."""
    return text_of(lib.mspring_version_string())


def features() -> int:
    """What the library that runs has: bits of FEATURE_."""
    return lib.mspring_features()


def simd_available(level: "Simd | SimdName") -> bool:  # noqa: F405
    """Whether networks can run at an instruction set here, such as "avx2"."""
    return bool(lib.mspring_simd_available(enum_value("mspring_simd", "level", level)))


__all__ = ["Batch", "Builder", "ClosedError", "Error", "Network", "StaleViewError", "StateView", "SweepResult",
           "TuneTable", "__version__", "features", "ffi", "gpu", "lib", "material", "plotting", "simd_available", "sweep",
           "version"]
__all__ += _header.__all__
