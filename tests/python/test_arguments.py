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
        before, count = network.state_hash, network.particle_count
        wrong = ((ArgumentError, IdError, TypeError), (
            ("step", NAN), ("step", -1), ("step", 0), ("step", INF), ("step", "1"), ("step", 1 / 64, -1),
            ("step", 1 / 64, 1.5),
            ("set_positions", [[NAN, 0]] * count), ("set_positions", np.zeros(3)), ("set_positions", "text"),
            ("set_positions", np.zeros((count, 2), complex)), ("set_positions", [0, 0], count),
            ("set_positions", [0, 0], -1), ("set_positions", [0, 0], [0, 1 << 40]), ("set_positions", [0, 0], 1.5),
            ("set_positions", [0, 0], [[0]]), ("set_positions", [0, 0], np.ones(3, bool)),
            ("set_velocities", [1e30, 0]), ("set_velocities", [INF, 0]),
            ("apply_forces", [NAN, 0]), ("apply_forces", [[1, 2, 3]]), ("apply_forces", None),
            ("get", "mass", True), ("get", "mass", range(1 << 70)), ("springs_across", (0, 0, 0), (1, 1)),
            ("apply_forces", [1, 0], None, "shove"), ("columns",), ("columns", "strain", "mass"), ("columns", "colour"),
            ("get", "colour"), ("get", 99), ("get", 0x990), ("get", -1), ("get", "strain", [network.spring_count]), ("get", "mass", range(5, 500)),
            ("get_positions", None, np.zeros((count, 2), int)), ("get_positions", None, np.zeros((count, 4))[:, ::2]),
            ("set", "mass", -1), ("set", "strain", 0), ("set", "mass", [1, 2]), ("set", "mass", [[1]]),
            ("set", "stiffness", NAN), ("set", "stiffness", "stiff"), ("set", "stiffness", None, 1 << 30),
            ("set", "length", None), ("set", "layers", 1.5), ("set", "layers", 1 << 32), ("set", "layers", -1),
            ("break_springs", [-1]), ("break_springs", [0, 1 << 31]), ("restore_springs", [0], NAN),
            ("remove_particles", 1 << 31), ("add_particles", [[NAN, 0]]), ("add_particles", [0, 0]),
            ("add_springs", [[0, 0]]), ("add_springs", [[0, 5000]]),
            ("set_floor", [[0, 0, 0]]), ("set_floor", [[0, 0, 0, 0]]), ("set_floor", None, [NAN, 0]),
            ("set_floor", [[0, 0, 0, 1]], None, [1, 2]),
            ("add_collider", "circle"), ("add_collider", "square"), ("add_grip", count), ("move_grip", 7, 0, 0),
            ("set", "layers", 1), ("set", "friction", 0.1), ("remove_elements", 0), ("get", "pressure", 0),
            ("load", b""), ("load", b"x" * 1000), ("load", "text"), ("save", "most"), ("tune", []),
            ("remove_grip", -1), ("reserve_events", -1),
            ("remove_collider", 1 << 40), ("read_contact_events",), ("nearest_particle", NAN, 0),
            ("particles_in_circle", 0, 0, -1), ("suggest_substeps", NAN),
            ("springs_across", (0, NAN), (1, 1)), ("update_components", 1)))
        for name, *arguments in wrong[1]:
            with self.subTest(call=name, arguments=str(arguments)[:60]):
                self.rejected(wrong[0] + (massspring.SnapshotError, BufferError), getattr(network, name), *arguments)
                self.assertEqual(network.state_hash, before)
        for keywords in ({"gravity": (NAN, 0)}, {"gravity": 3}, {"guard": "all"}, {"max_speed": -1}, {"speed": 1},
                         {"struct_size": 1}, {"guard": 77}, {"gravity_y": "down"}, {"substeps": 0}, {"substeps": 1 << 40}, {"substeps": 1.5},
                         {"solver": "fast"}, {"substeps": -1}, {"substeps": "most"}, {"precise": True}):
            with self.subTest(settings=keywords):
                self.rejected((Error, TypeError), network.set_settings, **keywords)
        self.assertEqual((network.settings.gravity_y, network.settings.substeps), (np.float32(-9.8), 30))
        with self.assertRaises(AttributeError):
            network.settings.substeps = 3

    def test_builder_calls_change_nothing(self):
        builder = bar_builder(4, 4)
        before = builder.particle_count, builder.spring_count
        wrong = (
            ("add_particle", (NAN, 0), {}), ("add_particle", (0, 0), {"mass": -1}), ("add_particle", (0, 0), {"m": 1}),
            ("add_particle", (0, 0), {"pinned": 0.7}), ("add_particle", (0, 0), {"removed": True}),
            ("add_particles", ([[0, 1]],), {"pinned": [2]}), ("add_particles", ([[0, 1]],), {"pinned": [0.5]}),
            ("add_spring", (0, 1), {"damping_ratio": 0.7}), ("add_spring", (0, 1), {"rest_length": "auto"}),
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
            ("add_lattice", ([[0, 0]], IRON), {"width": 5}), ("add_lattice", ([[0, 0]], 5), {}),
            ("add_lattice", (None, IRON), {"width": 0, "height": 3}), ("add_lattice", ([[0, 0]], []), {}),
            ("add_lattice", (None, IRON), {"width": 1 << 31, "height": 1 << 31}), ("add_lattice", ([[0, 0]], [5]), {}),
            ("add_strain_limits", (range(99), 0.1, 9), {}), ("add_strain_limits", (range(2), NAN, 9), {}),
            ("add_strain_limits", ([0, 99], 0.1, 9), {}), ("add_strain_limits", (0.5, 0.1, 9), {}),
            ("add_rope", (0, 1, 0, IRON), {}), ("add_rope", (0, 1, -1, IRON), {}), ("add_rope", (0, 99, 3, IRON), {}),
            ("add_rope", (0, 1, 1 << 31, IRON), {}), ("add_rope", (0, 1, 3, None), {}), ("add_rope", (0, 1, 3, [IRON]), {}),
            ("add_mesh", ([[0, 0]], [[0, 1, 2]], IRON), {}), ("add_mesh", ([[0, 0, 0]], [], IRON), {}),
            ("add_disc", (0, 0, -1, IRON), {}), ("add_disc", (0, 0, 1, IRON), {"ring_count": 0}),
            ("get_particles", (99,), {}), ("get_springs", ([-1],), {}), ("add_copies", (massspring.Builder(), -1), {}),
            ("add_copies", (builder, 2), {}), ("add_copies", (3, 2), {}),
            ("add_copies", (massspring.Builder(), 2, [[0, 0]]), {}))
        for name, arguments, keywords in wrong:
            with self.subTest(call=name, arguments=str(arguments)[:60], keywords=keywords):
                self.rejected((Error, TypeError), getattr(builder, name), *arguments, **keywords)
                self.assertEqual((builder.particle_count, builder.spring_count), before)
        self.rejected(Error, massspring.Builder().network)
        self.rejected(TypeError, builder.network, worker_counts=2)
        self.rejected(TypeError, massspring.Network, None)
        self.rejected(Error, massspring.material, "gold")
        self.rejected(TypeError, massspring.material, "steel", mas=3)
        builder.network().close()  # no failure is left behind

    def test_results_are_classes(self):
        builder = bar_builder(2, 2)
        builder.add_spring(0, 1, stiffness=1)
        self.rejected(massspring.DuplicateError, builder.network)
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
        before = network.state_hash
        error = self.rejected(massspring.UnstableError, network.step, 1 / 64, 50)
        self.assertIsInstance(error, ArithmeticError)
        self.assertTrue(error.particle is not None or error.spring is not None)
        self.assertIn("unstable", str(error))
        self.assertEqual(network.state_hash, before)

    def test_messages_are_of_the_call(self):
        """Reading calls that fail in turn: the library keeps the first message until a call that may change."""
        network = pair()
        for call, text in ((lambda: network.nearest_particle(NAN, 0), "point"), (lambda: network.get("mass", [7]), "particle 7"),
                           (lambda: network.nearest_spring(0, 0, flags=0), "flags"), (lambda: network.clone(worker_count=0), "worker_count")):
            self.assertIn(text, str(self.rejected(Error, call)))

    def test_one_id_is_a_list_of_one(self):
        network = bar(20, 5)
        network.remove_particles(3)
        for call in (lambda: network.get("mass", 3), lambda: network.set("mass", 1, 3), lambda: network.get_positions(3),
                     lambda: network.set_velocities([0, 0], 3), lambda: network.get_body(3)):
            self.assertIn("particle 3 has been removed", str(self.rejected(IdError, call)))
        self.assertEqual(network.get("particle_flags", range(3, 4)), massspring.PARTICLE_REMOVED)

    def test_infinity_means_never(self):
        network = pair()
        network.set("break_strain", INF)
        self.assertEqual(network.get("break_strain", 0), massspring.NEVER)

    def test_none_means_the_default(self):
        network = pair()
        network.set("break_strain", 0.5)
        network.set("break_strain", None)
        network.set("relax_strain", "default", 0)
        self.assertEqual(network.get("break_strain", 0), massspring.NEVER)
        network.set_settings(substeps=3, max_speed=5, substep_length=None)
        self.assertEqual(network.settings.substeps, 3)
        network.set_settings(substeps="even", max_speed=None)
        self.assertEqual((network.settings.substeps, network.settings.max_speed), ("even", 1e6))
        network.set_settings(substeps=None, gravity=None)
        self.assertEqual((network.settings.substeps, network.settings.gravity_y), ("auto", np.float32(-9.8)))
        network.set_contact(thickness=0.1, push_speed=None)
        network.set("friction", 0.5, 0)
        network.set("friction", None)
        network.set("masks", None)
        self.assertEqual([network.get(name, 0) for name in ("friction", "masks", "layers")], [-1, 0xFFFFFFFF, 1])


if __name__ == "__main__":
    unittest.main()
