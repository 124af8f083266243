"""Batches: copies that are driven, observed, held and put back singly, by views without a copy.

SPDX-License-Identifier: MIT
"""
import threading
import time
import unittest

import numpy as np

import massspring

SIDE = 6
DT = 1 / 64


def robot(stiffness=2000.0):
    builder = massspring.Builder()
    builder.add_lattice(np.zeros((SIDE, SIDE), int), {"mass": 1, "stiffness": stiffness, "damping": 5}, y=1.0)
    return builder


def batch(count=16, **options):
    made = massspring.Batch(robot(), count, substeps=20, gravity=(0, -9.8), max_speed=1000, **options)
    made.network.set_floor(planes=[[0, 0, 0, 1]], friction=0.8)
    return made


class Batches(unittest.TestCase):
    def test_groups_are_alike_until_driven(self):
        b = batch(5, actuators=[0, 3, 7], observations={"vx": [0, 35], "signal": [1]})
        b.step(DT, count=20)
        rows = b.observe()
        np.testing.assert_array_equal(rows, np.repeat(rows[:1], 5, 0))
        signals = np.ones((5, 3))
        signals[2] = 1.2
        b.step(DT, signals, count=20)
        self.assertIs(b.observe(), rows)
        self.assertTrue((rows[[0, 1, 3, 4]] == rows[0]).all() and (rows[2] != rows[0]).any())
        self.assertEqual(b.signals.shape, (5, 3))
        b.signals[...] = 1
        b.step(DT)
        self.assertEqual((b.centres.base is rows, b["vx"].shape, b["group_x"].shape), (True, (5, 2), (5,)))
        self.assertAlmostEqual(b["signal"][2, 0], 1.2, places=6)

    def test_observations_are_those_of_the_network(self):
        b = batch(4, offsets=[[0, 0], [10, 0], [20, 1], [30, 0]], 
                  observations={"relative_x": [7], "x": [7, 0], "strain": [3, 1], "spring_flags": [5]})
        b.step(DT, count=30)
        out = np.empty_like(b.observe())
        self.assertIs(b.observe(out), out)
        positions = b.network.positions.reshape(4, -1, 2)
        np.testing.assert_allclose(b.centres, positions.mean(1), rtol=0, atol=1e-12)  # rounding of 36 sums
        np.testing.assert_array_equal(b.boxes[:, 2:], positions.max(1))
        np.testing.assert_allclose(b["relative_x"][:, 0], positions[:, 7, 0] - b.centres[:, 0], rtol=0, atol=1e-12)
        np.testing.assert_array_equal(b["x"], positions[:, [7, 0], 0])
        strains = b.network.get("strain").reshape(4, -1)
        np.testing.assert_array_equal(b["strain"].astype(np.float32), strains[:, [3, 1]])
        self.assertFalse(b["spring_flags"].any())
        np.testing.assert_array_equal(b.positions(2), positions[2])

    def test_one_goes_wrong_and_the_others_do_not_know(self):
        b, without = batch(), batch(15)
        stiff = slice(*b.first_springs[7:9].tolist())
        b.network.set("stiffness", np.float32(1e10), stiff)
        b.step(DT, count=50)
        without.step(DT, count=50)
        b.observe(), without.observe()
        self.assertEqual(list(np.flatnonzero(b.held)), [7])
        rest = np.delete(np.arange(16), 7)
        np.testing.assert_array_equal(b.rows[rest], without.rows)
        b.network.set("stiffness", np.float32(2000), stiff)
        b.reset(b.held)
        b.step(DT, count=50)
        b.observe()
        np.testing.assert_array_equal(b.rows[7], without.rows[0])

    def test_marks(self):
        b = batch(3)
        b.step(DT, count=10)
        b.mark([1])
        at_mark = b.positions(1)
        b.step(DT, count=10)
        b.reset(to="mark")
        np.testing.assert_array_equal(b.positions(1), at_mark)
        np.testing.assert_array_equal(b.positions(0), robot().network().positions)
        b.reset([])

    def test_different_bodies(self):
        """Each kind of body does what it does in a batch of its own."""
        small = massspring.Builder()
        small.add_lattice(np.zeros((2, 3), int), {"mass": 1, "stiffness": 500, "damping": 5}, y=1.0)
        options = {"substeps": 20, "gravity": (0, -9.8), "max_speed": 1000}
        observed = {"strain": [0, 40]}
        both = massspring.Batch([(robot(), 2), (small, 3)], actuators=[[0, 3, 7], [1]], observations=observed,
                                offsets=np.zeros((5, 2)), **options)
        alone = massspring.Batch(robot(), 2, actuators=[0, 3, 7], observations=observed, **options)
        self.assertEqual((len(both), both.signals.shape, both.network.group_count), (5, (5, 3), 5))
        self.assertEqual(both.network.actuator_count, 2 * 3 + 3 * 1)
        signals = np.random.default_rng(2).uniform(0.9, 1.1, (5, 3))
        both.step(DT, signals, count=20)
        alone.step(DT, signals[:2], count=20)
        np.testing.assert_array_equal(both.observe()[:2], alone.observe())
        self.assertFalse(both["strain"][2:, 1].any())  # there is no spring 40
        np.testing.assert_array_equal(both.network.get("signal")[6:], signals[2:, 0].astype(np.float32))
        self.assertEqual(both.positions(4).shape, (6, 2))
        both.reset([4])
        np.testing.assert_array_equal(both.positions(4), small.network().positions)

    def test_mistakes(self):
        with self.assertRaises(TypeError):
            massspring.Batch(robot(), 2)
        with self.assertRaises(massspring.IdError):
            batch(2, actuators=[1000])
        with self.assertRaises(massspring.ArgumentError):
            batch(2, guard="growth")
        b = batch(2, actuators=[1])
        for wrong in (np.ones((3, 1)), np.full(1, np.nan)):
            with self.assertRaises(massspring.ArgumentError):
                b.step(DT, wrong)
        with self.assertRaises(massspring.IdError):
            b.reset([2])
        with self.assertRaises(massspring.ArgumentError):
            b.network.set_settings(substeps="auto")
        with self.assertRaises(massspring.ArgumentError):
            batch(2, observations={"colour": [0]})
        with self.assertRaises(massspring.ArgumentError):
            batch(2, offsets=np.zeros((3, 2)))
        with self.assertRaises(massspring.ArgumentError):
            massspring.Batch([(robot(), 2), (robot(), 1)], actuators=[[0]], substeps=4)
        with self.assertRaisesRegex(KeyError, "strain"):
            b["strain"]
        np.testing.assert_array_equal(b.signals, np.ones((2, 1)))
        with self.assertRaises(TypeError):
            batch(2, observations={"strain": None})

    def test_steps_release_the_gil(self):
        b, ticks, done = batch(256), [0], threading.Event()

        def count():
            while not done.is_set():
                ticks[0] += 1
                time.sleep(0)

        other = threading.Thread(target=count)
        other.start()
        b.step(DT, count=50)
        done.set()
        other.join()
        self.assertGreater(ticks[0], 10)


if __name__ == "__main__":
    unittest.main()
