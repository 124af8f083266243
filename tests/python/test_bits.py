"""The bits through Python are those of the C library.

SPDX-License-Identifier: MIT
"""
import copy
import multiprocessing
import os
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from bar import bar, bar_builder

import massspring

SOURCE = Path(os.environ["MASSSPRING_SOURCE"])
MASK = (1 << 64) - 1


def golden(name):
    lines = (SOURCE / "tests/golden/hashes.txt").read_text(encoding="utf-8").splitlines()
    return next(int(line.split()[1], 16) for line in lines if line.startswith(name + " "))


def run_of_golden(network):
    """What test_golden computes: the hashes of all states, mixed."""
    value = network.state_hash
    for _ in range(64):
        network.step(1 / 64)
        value = ((value << 7 | value >> 57) & MASK) ^ network.state_hash
    return value


def run_with_workers(count):
    with bar(worker_count=count) as network:
        return run_of_golden(network)


class Bits(unittest.TestCase):
    def test_golden_hash(self):
        for solver, substeps, name in (("explicit", 30, "bar_80x5"), ("implicit", 1, "implicit_bar"),
                                       ("direct", 1, "direct_bar")):
            for workers in (1, 2):
                with self.subTest(solver=solver, workers=workers):
                    with bar(solver=solver, substeps=substeps, worker_count=workers) as network:
                        self.assertEqual(run_of_golden(network), golden(name))

    def test_every_level(self):
        for level in massspring.Simd:
            if massspring.lib.mspring_simd_available(level):
                with self.subTest(level=level.name), bar(simd_level=level) as network:
                    self.assertEqual(run_of_golden(network), golden("bar_80x5"))

    def test_particles_and_springs_one_by_one(self):
        """The same network from arrays: the same bits."""
        with bar() as network:
            positions, ends = network.positions, network.ends
            stiffness, masses = network.get("stiffness"), network.get("mass")
            pinned = network.get("inverse_mass_scale") == 0
        builder = massspring.Builder()
        self.assertEqual(builder.add_particles(positions, mass=masses, pinned=pinned), range(400))
        builder.add_springs(ends, stiffness=stiffness)
        self.assertEqual(builder.get_particles(3)["mass"], masses[3])
        np.testing.assert_array_equal(builder.get_springs([5, 7])["b"], ends[[5, 7], 1])
        self.assertEqual(run_of_golden(builder.network(substeps=30)), golden("bar_80x5"))

    def test_count_of_steps(self):
        first, second = bar(), bar()
        first.step(1 / 64, 20)
        for _ in range(20):
            second.step(1 / 64)
        self.assertEqual(first.state_hash, second.state_hash)
        self.assertEqual(first.step_info.step_count, 20)
        self.assertAlmostEqual(first.time, 20 / 64)

    def test_snapshot_and_clone(self):
        network = bar()
        network.step(1 / 64, 10)
        for contents in ("all", "frame", massspring.SnapshotContents.ALL):
            snapshot = network.save(contents)
            self.assertIsInstance(snapshot, bytes)
            clone, copied = network.clone(), copy.deepcopy(network)
            network.step(1 / 64, 10)
            after = network.state_hash
            network.load(snapshot)
            for again in (network, clone, copied):
                again.step(1 / 64, 10)
                self.assertEqual(again.state_hash, after)

    def test_archive(self):
        network = bar(gravity=(0, -5))
        network.reserve_events(4000)
        network.step(1 / 64, 10)
        archive = network.archive
        with tempfile.TemporaryDirectory() as folder:
            network.write(Path(folder) / "bar.archive")
            networks = [massspring.Network.read(Path(folder) / "bar.archive"), massspring.Network.read(archive),
                        massspring.Network.read(bytearray(archive), worker_count=2)]
        for again in networks:
            self.assertEqual(again.archive, archive)
            again.step(1 / 64, 10)
        network.step(1 / 64, 10)
        self.assertEqual({again.state_hash for again in networks}, {network.state_hash})
        heavy = massspring.Network.read(archive, gravity=(0, -20))
        self.assertEqual(heavy.settings.gravity_y, -20)
        count = min(network.spring_count, 1500)
        network.break_springs(range(count))
        networks[0].break_springs(range(count))
        self.assertEqual(len(networks[0].read_events()), len(network.read_events()))
        self.assertRaisesRegex(massspring.SnapshotError, "cut off", massspring.Network.read, archive[:-30])
        self.assertRaises(FileNotFoundError, massspring.Network.read, "no such file")

    def test_threads_step_different_networks(self):
        networks = [bar() for _ in range(4)]
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(lambda network: network.step(1 / 64, 64), networks))
        self.assertEqual(len({network.state_hash for network in networks}), 1)

    def test_processes_step_networks(self):
        with multiprocessing.get_context("fork").Pool(2) as pool:
            self.assertEqual(set(pool.map(run_with_workers, (1, 2, 3))), {golden("bar_80x5")})

    def test_equilibrium(self):
        """20.06 m, as test_settle and the README have it."""
        network = bar()
        before = network.get_positions(79)[1]
        self.assertTrue(network.settle().is_stable)
        self.assertAlmostEqual(before - network.get_positions(79)[1], 20.0586, places=3)

    def test_views_show_the_positions(self):
        network = bar()
        network.step(1 / 64, 5)
        view = network.view
        slots = view.slot_of_particle
        world = np.stack([view.x[slots], view.y[slots]], 1).astype(float) + view.origin
        # Views lack the second words of positions: less than the last place of 80 m in single precision.
        np.testing.assert_allclose(world, network.positions, atol=8e-6)
        np.testing.assert_array_equal(view.vx[slots], network.velocities[:, 0])
        self.assertEqual(bar_builder().particle_count, len(slots))


if __name__ == "__main__":
    unittest.main()
