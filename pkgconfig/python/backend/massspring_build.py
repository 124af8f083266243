"""Builds the wheel: PEP 517, without setuptools, so that nothing has to be fetched.

CMake builds the shared library, modules.py writes what follows from the headers, and both go into the wheel with the
package. Environment: MASSSPRING_LIBRARY names a shared library to use instead of building one, CMAKE_ARGS has further
options of CMake.

SPDX-License-Identifier: MIT
"""
import base64
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from io import BytesIO
from pathlib import Path

from platform_tag import platform_tag

PACKAGE = Path(__file__).resolve().parent.parent
SOURCE = PACKAGE.parent.parent
LIBRARY_NAMES = {"win32": "massspring.dll", "darwin": "libmassspring.dylib"}
LIBRARY = LIBRARY_NAMES.get(sys.platform, "libmassspring.so")
CMAKE_OPTIONS = ["-DCMAKE_BUILD_TYPE=Release", "-DMASSSPRING_TESTS=OFF", "-DMASSSPRING_EXAMPLES=OFF",
                 "-DMASSSPRING_BENCH=OFF", "-DMASSSPRING_INSTALL=OFF"]
GPU_HEADER = "src/gpu/include/massspring/massspring_gpu.h"
SOURCES = ("CMakeLists.txt", "LICENSE", "include", "src", "pkgconfig/python")
METADATA = """Metadata-Version: 2.1
Name: massspring
Version: {version}
Summary: Simulation of two-dimensional mass-spring-damper networks
License: MIT
Classifier: License :: OSI Approved :: MIT License
Classifier: Programming Language :: Python :: 3
Classifier: Programming Language :: C
Classifier: Topic :: Scientific/Engineering :: Physics
Classifier: Typing :: Typed
Requires-Python: >=3.8
Requires-Dist: numpy>=1.17
Requires-Dist: cffi>=1.12
Provides-Extra: plot
Requires-Dist: matplotlib; extra == "plot"
Provides-Extra: table
Requires-Dist: pandas; extra == "table"
Description-Content-Type: text/markdown

{readme}"""


def version():
    text = (SOURCE / "include/massspring/version.h").read_text(encoding="utf-8")
    return ".".join(re.search(rf"MSPRING_VERSION_{part} (\d+)", text).group(1) for part in ("MAJOR", "MINOR", "PATCH"))


def isolated(*arguments):
    """Run this Python as it is without pip's isolation, so that it sees the packages that are installed."""
    return [sys.executable, "-I", *arguments]


def get_requires_for_build_wheel(config_settings=None):
    missing = []
    if subprocess.run(isolated("-c", "import cffi, pycparser"), stderr=subprocess.DEVNULL, check=False).returncode:
        missing.append("cffi")
    if not shutil.which("cmake") and not os.environ.get("MASSSPRING_LIBRARY"):
        missing.append("cmake")
    return missing


def metadata():
    readme = (PACKAGE / "README.md").read_text(encoding="utf-8")
    return METADATA.format(version=version(), readme=readme)


def write_metadata(folder, platform="any"):
    info = Path(folder) / f"massspring-{version()}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(metadata(), encoding="utf-8")
    (info / "WHEEL").write_text("Wheel-Version: 1.0\nGenerator: massspring_build\nRoot-Is-Purelib: false\n"
                                f"Tag: py3-none-{platform}\n", encoding="utf-8")
    shutil.copy(SOURCE / "LICENSE", info / "LICENSE")
    return info.name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    return write_metadata(metadata_directory)


def build_library(folder):
    """The path of the shared library."""
    given = os.environ.get("MASSSPRING_LIBRARY")
    if given:
        return Path(given).resolve()
    options = list(CMAKE_OPTIONS)
    if sys.platform.startswith("linux"):
        options.append("-DCMAKE_SHARED_LINKER_FLAGS_RELEASE=-s")
    options += shlex.split(os.environ.get("CMAKE_ARGS", ""))
    subprocess.run(["cmake", "-S", str(SOURCE), "-B", str(folder), *options], check=True)
    subprocess.run(["cmake", "--build", str(folder), "--config", "Release", "--target", "massspring_shared",
                    "--parallel", str(os.cpu_count() or 1)], check=True)
    found = [path for path in folder.rglob(LIBRARY) if path.is_file()]
    if not found:
        raise FileNotFoundError(f"CMake has built no {LIBRARY} in {folder}")
    return found[0].resolve()


def write_wheel(path, root):
    """All files of root, with their hashes, the same bytes whenever it is done."""
    files = sorted(file for file in root.rglob("*") if file.is_file())
    info = next(file.parent for file in files if file.name == "METADATA").name
    rows = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        def add(name, data, mode=0o644):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, (0o100000 | mode) << 16
            wheel.writestr(entry, data)

        for file in files:
            name, data = file.relative_to(root).as_posix(), file.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            rows.append(f"{name},sha256={digest},{len(data)}\n")
            add(name, data, 0o755 if file.name == LIBRARY else 0o644)
        add(f"{info}/RECORD", "".join(rows) + f"{info}/RECORD,,\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    if not (SOURCE / "CMakeLists.txt").is_file():
        raise FileNotFoundError(f"{SOURCE} is no checkout of libmassspring: pip 21.3 or newer builds in place")
    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch) / "wheel"
        shutil.copytree(PACKAGE / "massspring", root / "massspring", ignore=shutil.ignore_patterns("__pycache__"))
        library = build_library(Path(scratch) / "build")
        shutil.copyfile(library, root / "massspring" / LIBRARY)
        subprocess.run(isolated(str(PACKAGE / "backend" / "modules.py"), str(SOURCE / "include/massspring"),
                                str(root / "massspring"), str(SOURCE / GPU_HEADER)), check=True)
        platform = platform_tag(library)
        name = f"massspring-{version()}-py3-none-{platform}.whl"
        write_metadata(root, platform)
        write_wheel(Path(wheel_directory) / name, root)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """The sources of library and package where they lie in the repository, and beside them what pip looks for."""
    name = f"massspring-{version()}"
    project = (PACKAGE / "pyproject.toml").read_text(encoding="utf-8")
    made = {"PKG-INFO": metadata(),
            "pyproject.toml": project.replace('["backend"]', '["pkgconfig/python/backend"]')}
    with tarfile.open(Path(sdist_directory) / f"{name}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        def anonymous(entry):
            if entry.name.endswith("__pycache__"):
                return None
            entry.uid = entry.gid = entry.mtime = 0
            entry.uname = entry.gname = ""
            return entry

        for path in SOURCES:
            archive.add(SOURCE / path, f"{name}/{path}", filter=anonymous)
        for path, text in made.items():
            entry, data = tarfile.TarInfo(f"{name}/{path}"), text.encode()
            entry.size = len(data)
            archive.addfile(entry, BytesIO(data))
    return f"{name}.tar.gz"
