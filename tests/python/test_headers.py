"""What is new in a header is in the package after the next build, without a change of the package.

SPDX-License-Identifier: MIT
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import massspring

SOURCE = Path(os.environ["MASSSPRING_SOURCE"])

class Headers(unittest.TestCase):
    def test_every_function_is_declared(self):
        text = "".join(path.read_text(encoding="utf-8") for path in (SOURCE / "include/massspring").glob("*.h"))
        names = re.findall(r"^(?:MSPRING_NODISCARD )?MSPRING_API [^;]*?\b(mspring_\w+)\(", text, flags=re.M)
        self.assertGreater(len(names), 100)
        for name in names:
            self.assertTrue(callable(getattr(massspring.lib, name)), name)
        source = "".join(path.read_text(encoding="utf-8") for path in (SOURCE / "pkgconfig/python").rglob("*.py"))
        print("left to massspring.lib:", *sorted(name for name in names if name not in source))

    def test_structs_have_the_size_that_the_library_knows(self):
        for kind, number in massspring._header.STRUCTS.items():
            size = massspring.ffi.sizeof(kind)
            made = massspring.ffi.new(kind + " *")
            self.assertEqual(massspring.lib.mspring_init(number, made, size), 0, kind)
            self.assertEqual(made.struct_size, size)

    def test_docstrings_have_meaning_and_range(self):
        text = massspring.Network.set_settings.__doc__
        self.assertIn('\nsolver: "explicit", "implicit", "direct"; default', text)
        self.assertIn('as words: "auto", "even"', text)
        text = massspring.Builder.add_spring.__doc__
        self.assertIn("\nbreak_strain: > 0. If the size", text)
        self.assertNotIn("[allocates]", text)

    def test_a_changed_header(self):
        with tempfile.TemporaryDirectory() as scratch:
            include, package = Path(scratch) / "include", Path(scratch) / "package"
            shutil.copytree(SOURCE / "include/massspring", include)
            package.mkdir()
            header = include / "core.h"
            text = header.read_text(encoding="utf-8")
            text = text.replace("} mspring_settings;", "    float wind;  ///< m/s, any; default 0\n} mspring_settings;")
            text = text.replace("    MSPRING_RESULT_INT =", "    MSPRING_ERROR_WIND = -99, ///< too much wind\n"
                                "    MSPRING_RESULT_INT =")
            text = text.replace("/// A network: its", "#define MSPRING_MAX_WIND 7u\n#define MSPRING_WIND_CALM 0.5f\n"
                                "/// A network: its")
            text = text.replace("    MSPRING_SPRING_PULL_ONLY =", "    MSPRING_SPRING_FURRY = 1 << 7, ///< has fur\n"
                                "    MSPRING_SPRING_PULL_ONLY =")
            header.write_text(text, encoding="utf-8")
            subprocess.run([sys.executable, str(SOURCE / "pkgconfig/python/backend/modules.py"), str(include),
                            str(package)], check=True, stdout=subprocess.DEVNULL)
            made = (package / "_header.py").read_text(encoding="utf-8")
            for expected in ("    wind: float  # m/s, any; default 0", "'wind': Field('float', (), 'm/s, any; default 0'),",
                             "    wind: Union[float, Literal['calm'], None]", "'wind': {'calm': 0.5}",
                             "'furry': Flag('spring_flags', 128, 'has fur'),", "    furry: bool",
                             "class WindError(Error):", "ERRORS[-99] = WindError", "MAX_WIND = 7"):
                self.assertIn(expected, made)
            compile(made, "_header.py", "exec")


if __name__ == "__main__":
    unittest.main()
