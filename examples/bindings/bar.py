"""The bending of a bar, in Python: 80 x 5 particles of iron, pinned at the left end, after a minute.

    python3 bar.py [path of the shared library]

SPDX-License-Identifier: MIT
"""
import ctypes
import ctypes.util
import sys
from ctypes import POINTER, byref, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint16, c_uint32, c_uint64, c_void_p


class Material(ctypes.Structure):
    KIND = 4  # mspring_struct
    _fields_ = [("struct_size", c_uint32), ("particle_flags", c_uint32), ("spring_flags", c_uint32),
                ("mass", c_float), ("stiffness", c_float), ("damping", c_float),
                ("break_strain", c_float), ("warn_strain", c_float), ("relax_strain", c_float),
                ("yield_strain", c_float), ("hardening", c_float), ("plastic_limit", c_float)]


class LatticeDef(ctypes.Structure):
    KIND = 5
    _fields_ = [("struct_size", c_uint32), ("width", c_uint32), ("height", c_uint32), ("material_count", c_uint32),
                ("x", c_double), ("y", c_double), ("spacing", c_double),
                ("cells", POINTER(c_uint16)), ("materials", POINTER(Material)),
                ("shear_share", c_float), ("bend_share", c_float)]


class Settings(ctypes.Structure):
    KIND = 9
    _fields_ = [("struct_size", c_uint32), ("solver", c_int32), ("integrator", c_int32), ("guard", c_int32),
                ("substeps", c_uint32), ("max_substeps", c_uint32), ("substep_length", c_double),
                ("gravity_x", c_float), ("gravity_y", c_float), ("global_damping", c_float), ("max_speed", c_float),
                ("sleep_speed", c_float), ("sleep_time", c_float), ("relax_fraction", c_float),
                ("residual", c_float), ("iterations", c_uint32), ("tile_size", c_uint32),
                ("coarse_period", c_uint32), ("most_work", c_uint32)]


PINNED = 1
FUNCTIONS = {  # name: result, arguments
    "result_string": (c_char_p, [c_int32]),
    "init": (c_int32, [c_int32, c_void_p, c_size_t]),
    "builder_create": (c_int32, [c_void_p, POINTER(c_void_p)]),
    "builder_destroy": (None, [c_void_p]),
    "builder_error": (c_char_p, [c_void_p]),
    "builder_add_lattice": (c_int32, [c_void_p, POINTER(LatticeDef), POINTER(c_uint32)]),
    "network_create": (c_int32, [c_void_p, c_void_p, POINTER(c_void_p)]),
    "network_destroy": (None, [c_void_p]),
    "network_get_settings": (c_int32, [c_void_p, POINTER(Settings)]),
    "network_set_settings": (c_int32, [c_void_p, POINTER(Settings)]),
    "network_step": (c_int32, [c_void_p, c_double]),
    "network_get_positions": (c_int32, [c_void_p, POINTER(c_uint32), c_uint32, c_uint32, POINTER(c_double),
                                        POINTER(c_double), c_uint32]),
    "network_get_state_hash": (c_int32, [c_void_p, POINTER(c_uint64)]),
}


class Library:
    """The functions without their prefix; those with a result code raise an error instead."""

    def __init__(self, path):
        loaded = ctypes.CDLL(path)
        for name, (result, arguments) in FUNCTIONS.items():
            function = getattr(loaded, "mspring_" + name)
            function.restype, function.argtypes = result, arguments
            if result is c_int32:
                function.errcheck = self.check
            setattr(self, name, function)

    def check(self, result, function, arguments):
        if result != 0:
            raise RuntimeError(f"{function.__name__}: {self.result_string(result).decode()}")
        return result

    def default(self, kind):
        made = kind()
        self.init(kind.KIND, byref(made), ctypes.sizeof(made))
        return made


def height_of(library, network, particle):
    x, y = c_double(), c_double()
    library.network_get_positions(network, None, particle, 1, byref(x), byref(y), 1)
    return y.value


def main():
    library = Library(sys.argv[1] if len(sys.argv) > 1 else ctypes.util.find_library("massspring"))
    width, height = 80, 5
    materials = (Material * 2)()  # 0 is free, 1 is pinned
    for i in range(2):
        materials[i] = library.default(Material)
        materials[i].mass, materials[i].stiffness = 73.4, 6.76e7
    materials[1].particle_flags = PINNED
    cells = (c_uint16 * (width * height))()
    for row in range(height):
        cells[row * width] = 1

    bar = library.default(LatticeDef)
    bar.width, bar.height, bar.material_count = width, height, 2
    bar.cells, bar.materials = cells, materials
    builder, network, ids = c_void_p(), c_void_p(), (c_uint32 * (width * height))()
    library.builder_create(None, byref(builder))
    library.builder_add_lattice(builder, byref(bar), ids)
    library.network_create(builder, None, byref(network))
    library.builder_destroy(builder)

    settings = library.default(Settings)
    library.network_get_settings(network, byref(settings))
    settings.global_damping = 1.0
    library.network_set_settings(network, byref(settings))
    free_end = ids[width - 1]
    top = height_of(library, network, free_end)
    for _ in range(60 * 64 * 30):
        library.network_step(network, 1.0 / (64 * 30))
    state = c_uint64()
    library.network_get_state_hash(network, byref(state))
    drop = top - height_of(library, network, free_end)
    print(f"the free end has dropped by {drop:.2f} m, hash {state.value:016x}")
    library.network_destroy(network)


main()
