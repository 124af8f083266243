"""The platform that a wheel's tag names, from what its shared library needs.

    platform_tag.py LIBRARY

manylinux_2_34_x86_64: the library loads where glibc is 2.34 or newer (PEP 600). It must need nothing but parts of glibc,
and readelf (binutils) must be there to say so; otherwise it is the platform of this Python, such as linux_x86_64.

SPDX-License-Identifier: MIT
"""
import re
import shutil
import subprocess
import sys
import sysconfig

OF_GLIBC = re.compile(r"(lib(c|m|pthread|dl|rt)|ld-linux[\w-]*|ld64)\.so\.\d$")


def glibc_needed(library):
    """The newest glibc whose symbols the library takes, as (major, minor), or None if it needs more than glibc."""
    said = subprocess.run(["readelf", "-d", "-V", "-W", str(library)], capture_output=True, text=True, check=True,
                          env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"}).stdout
    needed = re.findall(r"\(NEEDED\).*\[(.*)\]", said)
    versions = re.findall(r"Name: GLIBC_(\d+)\.(\d+)", said)
    if not versions or not all(OF_GLIBC.match(name) for name in needed):
        return None
    return max((int(major), int(minor)) for major, minor in versions)


def platform_tag(library):
    ours = re.sub(r"[.-]", "_", sysconfig.get_platform())
    glibc = glibc_needed(library) if ours.startswith("linux_") and shutil.which("readelf") else None
    return ours if glibc is None else f"manylinux_{glibc[0]}_{glibc[1]}_{ours[len('linux_'):]}"


if __name__ == "__main__":
    print(platform_tag(sys.argv[1]))
