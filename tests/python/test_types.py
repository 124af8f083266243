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
b.add_particles(np.zeros((2, 2)), mas=np.ones(2))  # wrong
b.add_spring(0, 1, stiffness=1e3, damping=1, break_strain=None, rest_length="distance", pull_only=True, metres=True)
b.add_spring(0, 1, stifness=1e3)  # wrong
b.add_spring(0, 1, rest_length="auto")  # wrong
b.add_springs([[0, 1]], pull_onley=True)  # wrong
rubber = ms.material("rubber", mass=3, pinned=True)
b.add_lattice(np.zeros((2, 2), np.uint8), rubber, spacing=0.5, x=1)
b.add_lattice(None, rubber, width=3, height=2)
b.add_lattice(np.zeros((2, 2), np.uint8), ms.material("steel", mas=3))  # wrong
ms.material("gold")  # wrong
b.add_rope(0, 1, 4, {"stiffness": 1e3}, length_ratio=1.1)
b.add_rope(0, 1, 4)  # wrong
b.add_disc(0, 0, 1, rubber, ring_count=2, spoke_count=3)  # wrong
n = b.network(substeps="auto", gravity=(0, -9.8), solver="implicit", guard=ms.Guard.GROWTH, precise=True)
b.network(substep=3)  # wrong
b.network(substeps="automatic")  # wrong
b.network(solver="implict")  # wrong
ms.Network(b, gravity=3)  # wrong
n.set("stiffness", 1.0)
n.set("break_strain", None, 3)
n.set("stiffnes", 1.0)  # wrong
n.get(ms.Property.STRAIN, range(3))
n.get("force")  # wrong
length, strain = n.columns("length", "strain", ids=range(3))
n.columns("length", "strian")  # wrong
time: float = n.step_info.time
n.step_info()  # wrong
n.step_info.tiem  # wrong
n.step_info.time = 3  # wrong
if n.step_info.flags & ms.StepFlags.CLAMPED and n.step_info.is_asleep:
    n.step(1 / 64, 3)
n.step("1")  # wrong
n.set_floor(planes=[[0, 0, 0, 1]], friction=0.5)
n.set_floor(planes=[[0, 0, 0, 1]], fricton=0.5)  # wrong
n.set_contact(thickness=0.1)
n.set_contact(thick=0.1)  # wrong
n.add_collider("circle", radius=1, x=2)
n.add_collider("cricle", radius=1)  # wrong
n.add_grip(0, max_force=3)
n.add_grip(0, maximum=3)  # wrong
n.set_settings(iterations=3, global_damping=1, max_speed=3, substeps="even")
n.set_settings(global_dampin=1)  # wrong
n.settings.substeps = 3  # wrong
n.add_area([0, 1, 2], stiffness=3, kind="elastic")
n.add_area([0, 1, 2], kind="plastic")  # wrong
n.settle(tolerence=3)  # wrong
n.apply_forces([1, 0], push="impulse")
n.apply_forces([1, 0], push="substep")
n.apply_forces([1, 0], push="impuls")  # wrong
particle: Optional[int] = n.energy.strained
mass: float = n.body.mass + n.get_body([0, 1]).mass
n.energy()  # wrong
n.positions[0] += 1
n.position  # wrong
ms.plotting.draw(n)
batch = ms.Batch(b, 3, substeps=4, gravity=(0, 0), observations={"strain": [0, 1]})
ms.Batch([(b, 3), (b, 2)], substeps=4)
ms.Batch(b, 3, substeps=4, device="gpu").observe().sum()
ms.Batch(b, 3, substeps=4, device=3)  # wrong
ms.gpu.devices()[0].upper()
ms.Batch([b, 3], substeps=4)  # wrong
ms.Batch(b, 3, substeps=4, observations={"starin": [0, 1]})  # wrong
ms.Batch(b, 3, substeps=4, graviti=(0, 0))  # wrong
batch.network.step(1)
batch["strain"].sum()
batch["starin"]  # wrong
batch.reset(to="mark")
batch.reset(to="begin")  # wrong
grid = {"stiffness": [1.0]}
r = ms.sweep(drop, grid, engine=1)
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
