"""What type checkers see: mistakes are found, and programs without one pass.

SPDX-License-Identifier: MIT
"""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

MYPY = shutil.which("mypy") or shutil.which("mypy", path="/usr/bin")

# Each line with a mistake says so.
PROGRAM = '''
from typing import Optional
import numpy as np
import massspring as ms

def drop(stiffness: float) -> float:
    return stiffness

b = ms.Builder()
first: int = b.add_particle(0, 0, mass=1, pinned=True)
b.add_particle(1, 0, mas=1)  # wrong
b.add_particle(1, 0, mass="heavy")  # wrong
b.add_particles(np.zeros((2, 2)), mass=np.ones(2), pinned=True)
b.add_spring(0, 1, stiffness=1e3, damping=1)
b.add_spring(0, 1, stifness=1e3)  # wrong
b.add_lattice(np.zeros((2, 2), np.uint8), ms.material("steel", mass=3, pinned=True), spacing=0.5, x=1)
b.add_lattice(np.zeros((2, 2), np.uint8), ms.material("steel", mas=3))  # wrong
b.add_rope(0, 1, 4, stiffness=1e3)
b.add_disc(0, 0, 1, ring_count=2, spoke_count=3)  # wrong
n = b.network(substeps=3, gravity=(0, -9.8), solver="implicit", guard=ms.Guard.GROWTH)
b.network(substep=3)  # wrong
ms.Network(b, gravity=3)  # wrong
n.set("stiffness", 1.0)
n.set("stiffnes", 1.0)  # wrong
n.get(ms.Property.STRAIN, range(3))
n.get("tension")  # wrong
time: float = n.step_info.time
n.step_info()  # wrong
n.step_info.tiem  # wrong
n.step(1 / 64, 3)
n.step("1")  # wrong
n.set_floor(planes=[[0, 0, 0, 1]], friction=0.5)
n.set_floor(planes=[[0, 0, 0, 1]], fricton=0.5)  # wrong
n.set_contact(thickness=0.1)
n.set_contact(thick=0.1)  # wrong
n.add_collider("circle", radius=1, x=2)
n.add_grip(0, max_force=3)
n.add_grip(0, maximum=3)  # wrong
n.set_solver(iterations=3)
n.set_settings(global_damping=1, max_speed=3)
n.set_settings(global_dampin=1)  # wrong
n.add_area([0, 1, 2], stiffness=3)
n.settle(tolerence=3)  # wrong
particle: Optional[int] = n.max_strain()[1]
n.positions[0] += 1
n.position  # wrong
ms.plotting.draw(n)
batch = ms.Batch(b, 3, substeps=4, gravity=(0, 0))
ms.Batch(b, 3, substeps=4, graviti=(0, 0))  # wrong
batch.network.step(1)
batch.reset(to="mark")
r = ms.sweep(drop, {"stiffness": [1.0]}, engine=1)
r.array("x")  # wrong
if r:
    r.array("x")
    r.frame()
with ms.Builder() as other:
    other.nework()  # wrong
try:
    n.load(b"")
except ms.SnapshotError as error:
    code: int = error.result
'''


@unittest.skipIf(MYPY is None, "no mypy here (Debian: apt-get install mypy)")
class Types(unittest.TestCase):
    def test_mistakes_and_nothing_else(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "program.py"
            path.write_text(PROGRAM, encoding="utf-8")
            says = subprocess.run([MYPY, "--python-executable", sys.executable, "--strict", "--cache-dir", folder,
                                   path.name], cwd=folder, capture_output=True, text=True, check=False).stdout
        found = {int(line) for line in re.findall(r"^program.py:(\d+): error", says, flags=re.M)}
        planted = {number for number, line in enumerate(PROGRAM.split("\n"), 1) if line.endswith("# wrong")}
        self.assertEqual(found, planted, says)


if __name__ == "__main__":
    unittest.main()
