"""Gradients are differences of the network's own steps, and those of torch are these.

Differences of single precision: 1e-7 of positions of a metre over changes of 1e-3 is 1e-4, so tolerances are 1e-3 of the
largest derivative. tests/gradient compares with double precision.

SPDX-License-Identifier: MIT
"""
import unittest

import massspring
import numpy as np

DT, STEPS = 1 / 64, 12


def made():
    builder = massspring.Builder()
    cells = np.zeros((3, 5), int)
    cells[:, 0] = 1
    soft = {"mass": 1.0, "stiffness": 300.0, "damping": 1.0}
    builder.add_lattice(cells, [soft, {**soft, "pinned": True}])
    return massspring.Network(builder, substeps=8, gravity_y=-3.0)


def with_actuators(network):
    network.set_actuators([1, 5, 9], changes=4)
    return network


SIGNALS = np.random.default_rng(1).uniform(0.9, 1.1, (STEPS, 3)).astype("f4")


def loss(positions, velocities):
    w = np.cos(np.arange(positions.size)).reshape(positions.shape)
    return (w * positions).sum() + 0.1 * (w * velocities).sum(), w, 0.1 * w


class GradientTest(unittest.TestCase):
    def check(self, by, name, ids, change, set_):
        largest = np.abs(by).max()
        for i in ids:
            values = []
            for sign in (1, -1):
                with with_actuators(made()) as network:
                    set_(network, i, sign * change)
                    values.append(network.gradient(loss, STEPS, dt=DT, signals=SIGNALS).loss)
            self.assertAlmostEqual((values[0] - values[1]) / (2 * change), by[i], delta=1e-3 * largest, msg=(name, i))

    def test_differences(self):
        with with_actuators(made()) as network:
            g = network.gradient(loss, STEPS, dt=DT, signals=SIGNALS)
            self.assertEqual(g.signals.shape, (STEPS, 3))
        self.check(g.stiffness, "stiffness", [0, 7, 20], 3.0,
                   lambda n, i, d: n.set("stiffness", n.get("stiffness", i) + d, i))

        def move(network, i, d):
            at = network.positions
            at[i, 0] += d
            network.set_positions(at)
        self.check(g.positions[:, 0], "x", [3, 8, 14], 1e-3, move)

        largest = np.abs(g.signals).max()
        for step, actuator in ((0, 0), (5, 2), (STEPS - 1, 1)):
            values = []
            for change in (1e-2, -1e-2):
                signals = SIGNALS.astype("f8")
                signals[step, actuator] += change
                with with_actuators(made()) as network:
                    values.append(network.gradient(loss, STEPS, dt=DT, signals=signals).loss)
            self.assertAlmostEqual((values[0] - values[1]) / 2e-2, g.signals[step, actuator], delta=1e-3 * largest)

    def test_same_bits(self):
        with made() as a, made() as b:
            a.gradient(loss, STEPS, dt=DT)
            b.step(DT, STEPS)
            self.assertEqual(a.state_hash, b.state_hash)

    def test_terms_of_all_steps(self):
        with made() as network, massspring.Gradient(network, 4, forced=[6]) as run:
            for _ in range(4):
                run.step(DT, forces=[[0.5, 1.0]])
            for _ in range(4):  # the sum of the height of particle 6
                run.add_seeds([[0.0, 1.0]], ids=[6])
                run.reverse(1)
            self.assertTrue((np.diff(run.forces[:, 0, 1]) < 0).all())  # earlier forces act for longer

    def test_errors(self):
        with made() as network, massspring.Gradient(network, 1) as run:
            run.step(DT)
            with self.assertRaisesRegex(massspring.Error, "has its 1 steps"):
                run.step(DT)
            with self.assertRaisesRegex(massspring.Error, "stiffness, damping"):
                run.get("mass")
            with self.assertRaisesRegex(massspring.IdError, "no step 1"):
                run.signals_of(1)
            with self.assertRaisesRegex(massspring.IdError, "too large"):
                run.get("stiffness", 9999)
        with made() as network:
            network.set_contact(thickness=0.1)
            with self.assertRaisesRegex(massspring.Error, "contact"):
                massspring.Gradient(network, 1)

    def test_torch(self):
        try:
            import torch
        except ImportError:
            self.skipTest("no torch")
        from massspring.torch_steps import steps
        with with_actuators(made()) as network:
            expected = network.gradient(loss, STEPS, dt=DT, signals=SIGNALS)
        with with_actuators(made()) as network:
            stiffness = torch.tensor(network.get("stiffness"), requires_grad=True)
            signals = torch.tensor(SIGNALS, requires_grad=True)
            positions, velocities = steps(network, DT, STEPS, stiffness=stiffness, signals=signals)
            w = torch.cos(torch.arange(positions.numel(), dtype=torch.float64)).reshape(positions.shape)
            value = (w * positions).sum() + 0.1 * (w * velocities).sum()
            value.backward()
        self.assertAlmostEqual(value.item(), expected.loss, delta=1e-9)
        np.testing.assert_allclose(stiffness.grad.numpy(), expected.stiffness, rtol=1e-5, atol=1e-9)
        np.testing.assert_allclose(signals.grad.numpy(), expected.signals, rtol=1e-5, atol=1e-7)


if __name__ == "__main__":
    unittest.main()
