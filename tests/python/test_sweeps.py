"""Sweeps: the same hash whoever did which part, and nothing lost when one is killed.

SPDX-License-Identifier: MIT
"""
import os
import signal
import subprocess
import sys
import tempfile
import threading
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
    return {"drop": float(network.positions[:, 1].min()), "hash": network.state_hash}


def slow(stiffness, rows):
    time.sleep(0.2)
    return stiffness * rows


def slow_drop(stiffness, rows):
    time.sleep(0.3)
    return drop(stiffness, rows)


class Sweeps(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.alone = massspring.sweep(drop, GRID, processes=1)

    def test_processes(self):
        result = massspring.sweep(drop, GRID, processes=2, folder=self.folder.name)
        self.assertEqual(result.hash, self.alone.hash)
        self.assertEqual(result.array("drop").shape, (3, 2))
        self.assertEqual(dict(list(result)[3][0]), {"stiffness": 2e3, "rows": 3})
        again = massspring.sweep(drop, GRID, processes=1, folder=self.folder.name)
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

    def test_workers_and_functions(self):
        for engine in ("dask", 1, 5, np.int64(5), 2.0, True, object()):
            with self.assertRaisesRegex(TypeError, "engine is"):
                massspring.sweep(drop, GRID, engine=engine)
        for processes in ("5", 2.0, True, object()):
            with self.assertRaisesRegex(TypeError, "processes is"):
                massspring.sweep(drop, GRID, processes)
        for processes in (0, -1):
            with self.assertRaisesRegex(ValueError, "processes is"):
                massspring.sweep(drop, GRID, processes)
        client = type("Client", (), {"submit": None, "gather": None})()
        with self.assertRaisesRegex(TypeError, "beside an engine"):
            massspring.sweep(drop, GRID, 2, engine=client)
        for processes in (None, 2, 5):
            with self.assertRaisesRegex(TypeError, "other processes cannot import it"):
                massspring.sweep(lambda stiffness, rows: 1, GRID, processes)
        self.assertEqual(len(massspring.sweep(lambda stiffness, rows: 1, GRID, np.int64(1))), 6)

    def test_frame(self):
        try:
            frame = self.alone.frame()
        except ImportError:
            self.skipTest("no pandas here")
        self.assertEqual(list(frame.columns)[:2], ["stiffness", "rows"])
        self.assertEqual(list(frame["drop"]), [result["drop"] for result in self.alone.results])
        plain = massspring.sweep(lambda stiffness, rows: rows, GRID, 1).frame()
        self.assertEqual(list(plain["result"]), list(plain["rows"]))

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

    def start(self, *arguments):
        """A program of Dask, from this folder, so that it can import this file."""
        log = open(Path(self.folder.name) / "log", "a", encoding="utf-8")
        self.addCleanup(log.close)
        process = subprocess.Popen([sys.executable, "-m", *arguments], cwd=Path(__file__).parent, stdout=log, stderr=log)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_scheduler(self):
        """A scheduler and two workers, each a process of its own, of which one is killed on the way."""
        try:
            from distributed import Client
        except ImportError:
            self.skipTest("there is no distributed (Debian: python3-distributed)")
        where, kept = Path(self.folder.name) / "scheduler.json", Path(self.folder.name) / "kept"
        self.start("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                   "--scheduler-file", str(where))
        until = time.monotonic() + 60
        while not where.exists() and time.monotonic() < until:
            time.sleep(0.02)
        workers = [self.start("distributed.cli.dask_worker", "--scheduler-file", str(where), "--host", "127.0.0.1",
                              "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", self.folder.name,
                              "--name", str(number)) for number in range(2)]
        with Client(scheduler_file=str(where)) as client:
            client.wait_for_workers(2, timeout=60)
            self.assertEqual(massspring.sweep(drop, GRID, engine=client).hash, self.alone.hash)
            done = []

            def kill_one():
                while len(list(kept.glob("*.json"))) < 3 and time.monotonic() < until + 60:
                    time.sleep(0.02)
                done.extend((path, path.stat().st_mtime_ns) for path in kept.glob("*.json"))
                workers[0].kill()

            killer = threading.Thread(target=kill_one)
            killer.start()
            result = massspring.sweep(slow_drop, GRID, folder=kept, engine=client)
            killer.join()
            self.assertIsNotNone(workers[0].wait())
            self.assertIsNone(workers[1].poll())
            self.assertEqual(result.hash, self.alone.hash)
            # Nothing was lost, and nothing made twice.
            self.assertTrue(3 <= len(done) < 6, done)
            self.assertEqual([path.stat().st_mtime_ns for path, _ in done], [stamp for _, stamp in done])

    def test_dask(self):
        try:
            from distributed import Client, LocalCluster
        except ImportError:
            self.skipTest("there is no distributed (Debian: python3-distributed)")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            self.assertEqual(massspring.sweep(drop, GRID, engine=client).hash, self.alone.hash)


if __name__ == "__main__":
    unittest.main()
