"""Hostile input is an exception that says why, and changes nothing.

SPDX-License-Identifier: MIT
"""
import unittest

import numpy as np
from bar import IRON, bar, bar_builder, pair

import massspring
from massspring import ArgumentError, Error, IdError

NAN, INF = float("nan"), float("inf")


class Arguments(unittest.TestCase):
    def rejected(self, errors, call, *arguments, **keywords):
        with self.assertRaises(errors) as caught:
            call(*arguments, **keywords)
        self.assertTrue(str(caught.exception))
        return caught.exception

    def test_network_calls_change_nothing(self):
        network = bar(20, 5, spare_particles=4, spare_springs=4)
        network.step(1 / 64)
        before, count = network.state_hash(), network.particle_count
        wrong = ((ArgumentError, IdError, TypeError), (
            ("step", NAN), ("step", -1), ("step", 0), ("step", INF), ("step", "1"), ("step", 1 / 64, -1),
            ("step", 1 / 64, 1.5),
            ("set_positions", [[NAN, 0]] * count), ("set_positions", np.zeros(3)), ("set_positions", "text"),
            ("set_positions", np.zeros((count, 2), complex)), ("set_positions", [0, 0], count),
            ("set_positions", [0, 0], -1), ("set_positions", [0, 0], [0, 1 << 40]), ("set_positions", [0, 0], 1.5),
            ("set_positions", [0, 0], [[0]]), ("set_positions", [0, 0], np.ones(3, bool)),
            ("set_velocities", [1e30, 0]), ("set_velocities", [INF, 0]),
            ("apply_forces", [NAN, 0]), ("apply_impulses", [[1, 2, 3]]), ("apply_forces", None),
            ("get", "colour"), ("get", 99), ("get", "strain", [network.spring_count]), ("get", "mass", range(5, 500)),
            ("get_positions", None, np.zeros((count, 2), int)), ("get_positions", None, np.zeros((count, 4))[:, ::2]),
            ("set", "mass", -1), ("set", "strain", 0), ("set", "mass", [1, 2]), ("set", "mass", [[1]]),
            ("set", "stiffness", NAN), ("set", "stiffness", "stiff"),
            ("break_springs", [-1]), ("break_springs", [0, 1 << 31]), ("restore_springs", [0], NAN),
            ("remove_particles", 1 << 31), ("add_particles", [[NAN, 0]]), ("add_particles", [0, 0]),
            ("add_springs", [[0, 0]]), ("add_springs", [[0, 5000]]),
            ("set_floor", [[0, 0, 0]]), ("set_floor", [[0, 0, 0, 0]]), ("set_floor", None, [NAN, 0]),
            ("set_floor", [[0, 0, 0, 1]], None, [1, 2]),
            ("add_collider", "circle"), ("add_collider", "square"), ("add_grip", count), ("move_grip", 7, 0, 0),
            ("set_contact_groups", 1, 1 << 32), ("set_contact_groups", 1, 1, [3]),
            ("set_contact_surface", NAN), ("set_contact_surface", 0.1, 2), ("set_contact_surface", 0.1, 0, [3]),
            ("load", b""), ("load", b"x" * 1000), ("load", "text"), ("save", "most"), ("tune", []),
            ("remove_grip", -1), ("reserve_events", -1),
            ("remove_collider", 1 << 40), ("read_contact_events",), ("nearest_particle", NAN, 0),
            ("particles_in_circle", 0, 0, -1), ("suggest_substeps", NAN),
            ("springs_across", (0, NAN), (1, 1)), ("update_components", 1)))
        for name, *arguments in wrong[1]:
            with self.subTest(call=name, arguments=str(arguments)[:60]):
                self.rejected(wrong[0] + (massspring.SnapshotError, BufferError), getattr(network, name), *arguments)
                self.assertEqual(network.state_hash(), before)
        for keywords in ({"gravity": (NAN, 0)}, {"gravity": 3}, {"guard": "all"}, {"max_speed": -1}, {"speed": 1},
                         {"struct_size": 1}, {"guard": 77}, {"gravity_y": "down"}):
            with self.subTest(settings=keywords):
                self.rejected((Error, TypeError), network.set_settings, **keywords)
        for keywords in ({"substeps": 0}, {"substeps": 1 << 40}, {"substeps": 1.5}, {"solver": "fast"},
                         {"substeps": -1}):
            with self.subTest(solver=keywords):
                self.rejected((Error, TypeError), network.set_solver, **keywords)
        self.assertEqual((network.settings.gravity_y, network.solver.substeps), (np.float32(-9.8), 30))

    def test_builder_calls_change_nothing(self):
        builder = bar_builder(4, 4)
        before = builder.particle_count, builder.spring_count
        wrong = (
            ("add_particle", (NAN, 0), {}), ("add_particle", (0, 0), {"mass": -1}), ("add_particle", (0, 0), {"m": 1}),
            ("add_particle", ("x", 0), {}), ("add_particles", ([1, 2],), {}),
            ("add_particles", ([[0, 1]],), {"mass": [1, 2]}), ("add_particles", ([[0, 1]],), {"mass": "1"}),
            ("add_particles", ([[0, 1]],), {"flags": 0.5}), ("add_particles", ([[0, 1]],), {"flags": -1}),
            ("add_particles", ([[0, 1]],), {"velocities": [[0, 0], [1, 1]]}),
            ("add_particles", ([[0, 1]],), {"struct_size": 1000}), ("add_particles", ([[0, 1e300]],), {}),
            ("add_spring", (0, 0), {}), ("add_spring", (0, 99), {"stiffness": 1}), ("add_spring", (-1, 0), {}),
            ("add_springs", ([[0, 1, 2]],), {}), ("add_springs", ([[0, 0.5]],), {}), ("add_springs", ([[0, -5]],), {}),
            ("add_lattice", ([1, 2], IRON), {}), ("add_lattice", (np.zeros((0, 3), int), IRON), {}),
            ("add_lattice", (np.ones((2, 2), int), IRON), {}), ("add_lattice", (np.ones((2, 2)), IRON), {}),
            ("add_lattice", (np.full((2, 2), 70000), IRON), {}), ("add_lattice", ([[0, 0]], {"mass": NAN}), {}),
            ("add_lattice", ([[0, 0]], {"weight": 1}), {}), ("add_lattice", ([[0, 0]], IRON), {"spacing": 0}),
            ("add_lattice", ([[0, 0]], IRON), {"cells": 0}), ("add_lattice", ([[0, 0]], 5), {}),
            ("add_strain_limits", (range(99), 0.1, 9), {}), ("add_strain_limits", (range(2), NAN, 9), {}),
            ("add_strain_limits", (range(0, 4, 2), 0.1, 9), {}),
            ("add_rope", (0, 1, 0), {}), ("add_rope", (0, 1, -1), {}), ("add_rope", (0, 99, 3), {}),
            ("add_rope", (0, 1, 1 << 31), {}), ("add_mesh", ([[0, 0]], [[0, 1, 2]]), {}),
            ("add_mesh", ([[0, 0, 0]], []), {}), ("add_disc", (0, 0, -1), {}), ("add_disc", (0, 0, 1), {"ring_count": 0}))
        for name, arguments, keywords in wrong:
            with self.subTest(call=name, arguments=str(arguments)[:60], keywords=keywords):
                self.rejected((Error, TypeError), getattr(builder, name), *arguments, **keywords)
                self.assertEqual((builder.particle_count, builder.spring_count), before)
        self.rejected(Error, massspring.Builder().network)
        self.rejected(TypeError, builder.network, worker_counts=2)
        self.rejected(TypeError, massspring.Network, None)
        self.rejected(Error, massspring.material, "gold")

    def test_results_are_classes(self):
        builder = bar_builder(2, 2)
        builder.add_spring(0, 1, stiffness=1)
        self.rejected(massspring.DuplicateError, builder.network)
        self.rejected(massspring.LimitError, pair().add_particles, [[0, 0]])
        self.rejected(massspring.EquilibriumError, pair(gravity=(0, -1)).settle)
        error = self.rejected(massspring.IdError, pair().get_positions, 2)
        self.assertIsInstance(error, IndexError)
        self.assertEqual(error.result, massspring.Result.ERROR_ID)
        for result in massspring.Result:
            if result < 0:
                self.assertTrue(issubclass(massspring._header.ERRORS[result], Error))

    def test_culprit_of_a_step(self):
        network = bar(substeps=1, guard="growth")
        before = network.state_hash()
        error = self.rejected(massspring.UnstableError, network.step, 1 / 64, 50)
        self.assertIsInstance(error, ArithmeticError)
        self.assertTrue(error.particle is not None or error.spring is not None)
        self.assertIn("unstable", str(error))
        self.assertEqual(network.state_hash(), before)

    def test_infinity_means_never(self):
        network = pair()
        network.set("break_strain", INF)
        self.assertEqual(network.get("break_strain", 0), massspring.NEVER)


if __name__ == "__main__":
    unittest.main()
