"""The code cells of the notebooks run, one after the other, without jupyter.

SPDX-License-Identifier: MIT
"""
import contextlib
import io
import json
import os
import sys
import unittest
from pathlib import Path
from unittest import mock

EXAMPLES = Path(os.environ["MASSSPRING_SOURCE"]) / "pkgconfig/python/examples"


def pictures():
    """Where there is no matplotlib, something that takes all calls."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        axes = mock.MagicMock()
        pyplot = mock.MagicMock(gca=lambda: axes, subplots=lambda *_, **__: (mock.MagicMock(), [axes] * 3))
        return {"matplotlib": mock.MagicMock(pyplot=pyplot), "matplotlib.pyplot": pyplot,
                "matplotlib.collections": mock.MagicMock()}
    return {}


class Notebooks(unittest.TestCase):
    def test_cells_run(self):
        notebooks = sorted(EXAMPLES.glob("*.ipynb"))
        self.assertTrue(notebooks)
        for path in notebooks:
            book = json.loads(path.read_text(encoding="utf-8"))
            self.assertEqual(book["nbformat"], 4)
            names = {"__name__": "__main__"}
            said = io.StringIO()
            with mock.patch.dict(sys.modules, pictures()), contextlib.redirect_stdout(said):
                for number, cell in enumerate(book["cells"]):
                    if cell["cell_type"] == "code":
                        self.assertEqual(cell["outputs"], [], f"{path.name}, cell {number}: clear the outputs")
                        exec(compile("".join(cell["source"]), f"{path.name}, cell {number}", "exec"), names)
            print(said.getvalue(), end="")

    def test_without_matplotlib(self):
        with mock.patch.dict(sys.modules, {"matplotlib": None}):
            self.assertIn("matplotlib.pyplot", pictures())


if __name__ == "__main__":
    unittest.main()
