"""Sweeps: the same hash whoever did which part, and nothing lost when one is killed.

SPDX-License-Identifier: MIT
"""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
from bar import bar

import massspring

GRID = {"stiffness": [1e3, 2e3, 4e3], "rows": [2, 3]}


def drop(stiffness, rows):
    network = bar(10, rows)
    network.set("stiffness", np.float32(stiffness))
    network.step(1 / 64, 40)
    return {"drop": float(network.positions[:, 1].min()), "hash": network.state_hash()}


def slow(stiffness, rows):
    time.sleep(0.2)
    return stiffness * rows


class Sweeps(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.alone = massspring.sweep(drop, GRID, engine=1)

    def test_processes(self):
        result = massspring.sweep(drop, GRID, engine=2, folder=self.folder.name)
        self.assertEqual(result.hash, self.alone.hash)
        self.assertEqual(result.array("drop").shape, (3, 2))
        self.assertEqual(dict(list(result)[3][0]), {"stiffness": 2e3, "rows": 3})
        again = massspring.sweep(drop, GRID, engine=1, folder=self.folder.name)
        self.assertEqual(again.hash, self.alone.hash)

    def test_shards(self):
        for index in (1, 2):
            self.assertIsNone(massspring.sweep(drop, GRID, 1, self.folder.name, (index, 3)))
        self.assertEqual(massspring.sweep(drop, GRID, 1, self.folder.name, (0, 3)).hash, self.alone.hash)

    def test_mistakes(self):
        with self.assertRaises(ValueError):
            massspring.sweep(drop, GRID, 1, None, (0, 2))
        with self.assertRaises(ValueError):
            massspring.sweep(drop, GRID, 1, self.folder.name, (2, 2))
        massspring.sweep(slow, {"stiffness": [1], "rows": [2]}, 1, self.folder.name)
        with self.assertRaises(ValueError):
            massspring.sweep(slow, {"stiffness": [1], "rows": [3]}, 1, self.folder.name)
        with self.assertRaises(TypeError):
            massspring.sweep(object, {}, 1)

    def test_killed_and_resumed(self):
        program = f"import massspring, test_sweeps as t; massspring.sweep(t.slow, t.GRID, 1, {self.folder.name!r})"
        process = subprocess.Popen([sys.executable, "-c", program], cwd=Path(__file__).parent)
        until = time.monotonic() + 60
        while not list(Path(self.folder.name).glob("*.json")) and time.monotonic() < until:
            time.sleep(0.02)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        kept = {path: path.stat().st_mtime_ns for path in Path(self.folder.name).glob("*.json")}
        self.assertTrue(0 < len(kept) < 6)
        result = massspring.sweep(slow, GRID, 1, self.folder.name)
        self.assertEqual(result.results, [2e3, 3e3, 4e3, 6e3, 8e3, 12e3])
        self.assertEqual({path: path.stat().st_mtime_ns for path in kept}, kept)

    def test_dask(self):
        try:
            from distributed import Client, LocalCluster
        except ImportError:
            self.skipTest("there is no distributed (Debian: python3-distributed)")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            self.assertEqual(massspring.sweep(drop, GRID, client).hash, self.alone.hash)


if __name__ == "__main__":
    unittest.main()
