"""Each group of calls does what it says, once.

SPDX-License-Identifier: MIT
"""
import subprocess
import sys
import unittest

import numpy as np
from bar import IRON, bar, pair

import massspring


def square(builder, x, y, **fields):
    """A block of 4 x 4 cells."""
    return builder.add_lattice(np.zeros((4, 4), int), {"mass": 4, "stiffness": 20000, "damping": 20}, x=x, y=y, **fields)


class Calls(unittest.TestCase):
    def test_lattice_of_cells(self):
        builder = massspring.Builder()
        ids = builder.add_lattice(np.array([[True, False], [True, True]]), massspring.material(mass=2, stiffness=5))
        np.testing.assert_array_equal(ids, [[0, -1], [1, 2]])
        more = builder.add_lattice([[0, -1], [1, 1]], [IRON, {**IRON, "pinned": True}], x=10.0)
        np.testing.assert_array_equal(more, [[3, -1], [4, 5]])
        steel = massspring.material("steel", spacing=0.1, mass=7)
        self.assertEqual((steel["mass"], steel["spring_flags"]), (7, massspring.SPRING_RELATIVE | massspring.SPRING_DAMPING_RATIO))
        full = builder.add_lattice(None, steel, width=3, height=2, x=20.0)
        np.testing.assert_array_equal(full, [[6, 7, 8], [9, 10, 11]])
        network = builder.network()
        np.testing.assert_array_equal(network.get("inverse_mass_scale")[:6], [1, 1, 1, 1, 0, 0])
        np.testing.assert_allclose(network.get_positions(4), [10, 0])
        np.testing.assert_array_equal(network.ends[0], [0, 1])

    def test_rope_mesh_disc_and_network(self):
        builder = massspring.Builder()
        builder.add_particles([[0, 0], [10, 0]], pinned=[True, False], mass=[1, 2])
        rope = massspring.material(mass=3, stiffness=100, pull_only=True, metres=True)
        particles, springs = builder.add_rope(0, 1, 5, rope, length_ratio=1.5)
        self.assertEqual((list(particles), springs), ([0, 2, 3, 4, 5, 1], range(0, 5)))
        self.assertEqual(builder.get_springs(0)["flags"], massspring.SPRING_PULL_ONLY | massspring.SPRING_METRES)
        self.assertEqual((builder.get_particles(2)["mass"], builder.get_springs(0)["rest_length"]), (3, 3))
        self.assertEqual(builder.add_mesh([[0, 5], [1, 5], [0, 6]], [[0, 1, 2]], {"stiffness": 3}),
                         (range(6, 9), range(5, 8)))
        self.assertEqual(builder.add_disc(3, 9, 1, {"mass": 2}, ring_count=1, young_modulus=10.0, centre_pinned=True),
                         (range(9, 16), range(8, 20)))
        self.assertEqual(list(builder.get_particles()["flags"][8:11]), [0, massspring.PARTICLE_PINNED, 0])
        self.assertEqual(builder.add_strain_limits([5, 6], 0.1, 9), range(20, 22))
        network = builder.network()
        of_particle, of_spring = massspring.Builder().add_network(network, [0, 1, 2])
        np.testing.assert_array_equal(of_particle[:4], [0, 1, 2, -1])
        np.testing.assert_array_equal(of_spring[:2], [0, -1])
        self.assertEqual(sum(network.info[4:7]), 22)  # springs of lattices, of chains, of neither
        copies = massspring.Builder()
        self.assertEqual(copies.add_copies(builder, 3, [[0, 0], [50, 0], [100, 0]]), (range(48), range(66)))
        self.assertEqual(copies.get_particles(17)["x"], 60)

    def test_areas_and_angles(self):
        builder = massspring.Builder()
        square(builder, 0.0, 0.0)
        line = list(builder.add_particles([[10 + i, 0] for i in range(4)]))
        builder.add_springs([line[:2], line[1:3], line[2:]], stiffness=100)
        network = builder.network()
        areas = network.add_cell_areas(stiffness=50)
        gas = network.add_area([0, 3, 15, 12], kind="gas", pressure=2.0)
        network.set("fill", 3, gas)
        self.assertEqual((len(areas), network.get("fill", gas)), (9, 3))
        angles = network.add_angles([line[:3], line[1:]], stiffness=4.0)
        self.assertEqual((list(angles), list(network.get_element_particles(angles[1]))), ([gas + 1, gas + 2], line[1:]))
        self.assertEqual(list(network.add_angles(line, stiffness=0, rest_angle=0.25)), [gas + 3, gas + 4])
        self.assertEqual(network.get("rest_angle", gas + 4), 0.25)
        network.set("rest_angle", [0.5, -0.5], angles)
        network.set("element_damping", 0.25, angles[0])
        self.assertEqual(network.columns("rest_angle", "element_damping", ids=angles[0]), [0.5, 0.25])
        self.assertAlmostEqual(network.get("torque", angles[1]), -4 * np.sin(0.5), places=6)
        flags = network.get("element_flags")
        self.assertEqual([int((flags == flag).sum()) for flag in (massspring.ELEMENT_AREA, massspring.ELEMENT_ANGLE)], [10, 4])
        self.assertEqual(list(network.get_element_particles(gas)), [12, 15, 3, 0])  # counter-clockwise
        np.testing.assert_allclose(network.get("area", range(10)), [1] * 9 + [9])
        network.remove_elements([angles[0], areas[0]])
        self.assertEqual(network.get("element_flags")[areas[0]], massspring.ELEMENT_REMOVED)
        self.assertEqual(network.element_count, 14)
        with self.assertRaises(massspring.IdError):
            network.get("rest_angle", [angles[0]])
        network.step(1 / 64)

    def test_properties_by_ids(self):
        network = bar(20, 5)
        network.set("mass", 5)
        network.set("mass", [6, 7], [3, 9])
        network.set("mass", [8, 8], slice(0, 2))
        self.assertEqual([network.get("mass", one) for one in (0, 3, 9, 10)], [8, 6, 7, 5])
        mask = np.arange(network.particle_count) % 2 == 1
        np.testing.assert_array_equal(network.get("mass", mask)[:5], [8, 6, 5, 5, 7])
        np.testing.assert_array_equal(network.get(massspring.Property.MASS, range(9, 2, -6)), [7, 6])
        out = np.empty(network.spring_count, np.float32)
        self.assertIs(network.get("strain", out=out), out)
        length, strain, flags = network.columns("length", "strain", "spring_flags")
        np.testing.assert_array_equal(out, strain)
        np.testing.assert_array_equal(length, network.get("length"))
        self.assertEqual((flags.dtype, network.get("end_b", 0)), (np.uint32, network.ends[0, 1]))
        np.testing.assert_array_equal(network.columns("end_a", "end_b", ids=[7, 3])[1], network.ends[[7, 3], 1])

    def test_positions_velocities_and_forces(self):
        network = pair()
        network.positions = [[0, 0], [2, 0]]
        network.set_velocities([0, 3], 1)
        np.testing.assert_array_equal(network.positions, [[0, 0], [2, 0]])
        np.testing.assert_array_equal(network.get_velocities([1, 0]), [[0, 3], [0, 0]])
        self.assertEqual((network.get("strain", 0), network.get("tension", 0)), (1, 10))
        energy, body = network.energy, network.body
        self.assertEqual((energy.kinetic, energy.elastic, energy.potential, energy.largest_speed), (4.5, 5, 0, 3))
        self.assertEqual((energy.largest_strain, energy.strained, energy.fastest), (1, 0, 1))
        self.assertEqual((body.py, body.max_x, body), (3, 2, network.get_body()))
        network.apply_forces([0, -3], 1, "impulse")
        network.apply_forces([[1, 0], [-1, 0]])
        network.apply_forces([[1, 0], [-1, 0]], push="substep")
        out = np.empty((2, 2))
        self.assertIs(network.get_positions(out=out), out)
        self.assertEqual(network.body.py, 0)

    def test_bodies_and_torques(self):
        network = bar(20, 5, poses=True, gravity=(0, 0))
        body = network.get_body()
        self.assertEqual((body.particle_count, body.head, body.angle), (network.particle_count, 0, 0))
        self.assertEqual(network.get_body([3, 4]).mass, network.get_body(slice(3, 5)).mass)
        for _ in range(10):
            network.apply_torque(2.0, range(network.particle_count))
            network.apply_torque(1.0, [7, 8])
            network.step(1 / 64)
        self.assertNotEqual(network.body.spin, 0)
        self.assertNotEqual(network.body.angle, 0)

    def test_edits_and_events(self):
        network = bar(20, 5, spare_particles=2, spare_springs=4)
        network.reserve_events(100)
        count, springs = network.particle_count, network.spring_count
        self.assertEqual(list(network.add_particles([[30, 0], [31, 0]], mass=3)), [count, count + 1])
        self.assertEqual(list(network.add_springs([[count, count + 1]], stiffness=5)), [springs])
        self.assertEqual(network.update_components(), (2, True))
        self.assertEqual([component.head for component in network.components], [0, count])
        self.assertEqual(network.components[1].mass, 6)
        self.assertEqual(network.get("component", count), 1)
        network.read_events()
        network.break_springs([4, springs])
        events = network.read_events()
        np.testing.assert_array_equal(events["id"], [4, springs])
        self.assertEqual((events["kind"][0], network.events_lost), (massspring.EventKind.BROKEN, 0))
        self.assertEqual(network.get("spring_flags", 4), massspring.SPRING_BROKEN)
        self.assertIn("BROKEN", repr(massspring.EventKind(events["kind"][0])))
        network.restore_springs(4, ramp_seconds=0.5)
        network.detach_particles([5])
        network.remove_springs(springs)
        network.remove_particles(count)
        network.reuse_ids()
        self.assertEqual([network.get("particle_flags", range(one, one + 1))[0] for one in (count, 1)], [massspring.PARTICLE_REMOVED, 0])
        network.step(1 / 64)

    def test_floor(self):
        network = pair(gravity=(0, -10))
        network.set_floor([[0, -1, 0, 2]], friction=0.5)
        network.step(1 / 64, 128)
        np.testing.assert_allclose(network.positions[:, 1], -1, atol=1e-5)
        self.assertGreater(network.get("floor_impulse_y", 0), 0)
        self.assertEqual((network.floor.plane_count, network.floor.friction), (1, 0.5))
        network.set_floor(heights=np.zeros(5), heights_x=-2, heights_y=-3, height_frictions=[0, 1, 0, 1])
        self.assertEqual(network.floor.height_count, 5)
        network.set_floor(heights=np.zeros(3), silt_depths=[0, 2, 1], silt_rate=3)
        self.assertEqual((network.floor.silt_depth, network.floor.silt_rate), (0, 3))
        with self.assertRaisesRegex(massspring.ArgumentError, "silt_depths"):
            network.set_floor(heights=np.zeros(3), silt_depths=[0, 2, 1], silt_depth=1)
        network.set_floor(heights=[0], heights_y=-4)  # level ground
        self.assertEqual((network.floor.height_count, network.floor.heights_y), (1, -4))
        network.clear_floor()
        self.assertEqual(network.floor.height_count, 0)

    def test_contact_colliders_and_grips(self):
        builder = massspring.Builder()
        square(builder, 0, 0.5)
        square(builder, 0.5, 5)
        network = builder.network(substeps=20)
        network.set_contact(thickness=0.4, friction=0.5, event_capacity=1000)
        network.set("layers", 3, range(0, 16))
        network.set("friction", 0.2, range(0, 16))
        self.assertEqual(network.columns("layers", "friction", ids=3), [3, np.float32(0.2)])
        network.set("friction", None)
        ground = network.add_collider("chain", [[-10, -1], [10, -1]], friction=1, closed=False)
        paddle = network.add_collider("box", width=2, height=1, x=-8)
        network.move_collider(paddle, -7, 0, 0.5)
        grip = network.add_grip(0, x=0, y=3, stiffness=500, damping=100)
        network.move_grip(grip, 0, 3.5)
        network.step(1 / 64)
        self.assertGreater(network.get_grip_impulse(grip)[1], 0)
        network.set_grip(grip, stiffness=10)
        self.assertEqual((network.get_grip(grip).stiffness, network.get_grip(grip).particle), (10, 0))
        network.remove_grip(grip)
        network.step(1 / 64, 200)
        self.assertGreater(network.contact_info.touching, 0)
        events = network.read_contact_events()
        began = events[events["kind"] == massspring.ContactEventKind.BEGAN]
        self.assertIn(ground, began["collider"])
        self.assertEqual((len(network.clone().read_contact_events()), network.contact_events_lost), (0, 0))
        self.assertLess(network.get_collider_impulse(ground)[1], 0)
        self.assertGreater(network.body.min_y, -1)
        self.assertEqual((network.contact.friction, network.get_collider(paddle).kind.name), (0.5, "BOX"))
        network.place_collider(paddle, 0, 50)
        network.remove_collider(paddle)
        network.clear_contact()
        self.assertEqual(network.contact.capacity, 0)

    def test_queries(self):
        network = bar(20, 5)
        nearest, distance = network.nearest_particle(0.2, 4.1)
        self.assertEqual(nearest, 0)
        self.assertAlmostEqual(distance, np.hypot(0.2, 0.1))
        self.assertEqual(network.nearest_particle(0, 99, within=1)[0], None)
        np.testing.assert_array_equal(network.particles_in_circle(0, 4, 1), [0, 1, 20])
        self.assertEqual(len(network.particles_in_box(0, 0, 1, 1)), 4)
        springs, fractions = network.springs_across((0.5, -1), (0.5, 5))
        self.assertEqual((len(springs), len(fractions)), (13, 13))
        self.assertEqual(network.get("active_stiffness", springs[0]), np.float32(IRON["stiffness"]))
        spring, fraction, distance = network.nearest_spring(0.25, 4)
        self.assertEqual((network.get("length", spring), fraction, distance), (1, 0.25, 0))
        self.assertEqual(network.nearest_spring(0, 4, flags=massspring.FIND_BROKEN)[0], None)
        near = network.springs_in_circle(0.5, 4, 0.25)
        self.assertIn(spring, near)
        network.break_springs(near)
        np.testing.assert_array_equal(network.springs_in_circle(0.5, 4, 0.25, massspring.FIND_BROKEN), near)
        self.assertEqual(len(network.springs_across((0.5, 3.9), (0.5, 4.1))[0]), 0)
        self.assertGreater(len(network.springs_across((0.5, 3.9), (0.5, 4.1), massspring.FIND_BROKEN)[0]), 0)

    def test_settings(self):
        network = bar(20, 5, gravity=(1, -2), sleep_speed=0.01, precise=True)
        network.set_settings(global_damping=1, guard="clamp")
        self.assertEqual((network.settings.gravity_x, network.settings.guard), (1, massspring.Guard.CLAMP))
        network.set_settings(substep_length=1 / 256)
        network.step(1 / 1024)
        self.assertEqual((network.step_info.step_count, network.step_info.time_left), (0, 1 / 1024))
        network.step(1 / 128)
        self.assertEqual((network.step_info.time, network.settings.substep_length), (1 / 128, 1 / 256))
        network.set_settings(**network.settings._asdict())
        network.set_settings(solver="implicit", substeps=2, substep_length=None)
        self.assertEqual((network.settings.solver.name, network.settings.substeps), ("IMPLICIT", 2))
        now, any_shape = network.stable_dt
        self.assertTrue(now >= any_shape > 0)
        self.assertEqual(network.suggest_substeps(1 / 64), int(np.ceil(1 / 64 / now / 0.95)))
        network.wake()
        self.assertFalse(network.step_info.is_asleep or (network.get("particle_flags") & massspring.PARTICLE_ASLEEP).any())
        self.assertEqual((network.info.worker_count, network.info.memory_used > 1000), (1, True))
        self.assertTrue(massspring.simd_available(network.info.simd_level))
        self.assertIn("lattice", network.description)

    def test_tuning(self):
        network = bar(20, 5)
        table = network.tune([{"substeps": 30}, {"solver": "implicit", "substeps": 2}], duration=0.25, budget=5)
        self.assertEqual([row["solver"] for row in table], ["explicit", "implicit"])
        self.assertGreater(table[0]["median_cost"], 0)
        self.assertIsNone(table[0]["scene_cost"])
        self.assertEqual(len(table.columns()["substeps"]), 2)
        network.set_settings(**table[1]["settings"])
        self.assertEqual(network.settings.substeps, 2)
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.assertRaises(ImportError, table.frame)
        else:
            self.assertEqual(list(table.frame()["substeps"]), [30, 2])

    def test_modules_that_the_guide_names(self):
        program = "import massspring; massspring.plotting.draw_tuning; massspring.Batch"
        subprocess.run([sys.executable, "-c", program], check=True)

    def test_plot(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("there is no matplotlib")
        matplotlib.use("Agg")
        from matplotlib import pyplot

        from massspring.plotting import draw_tuning
        figure, (left, right) = pyplot.subplots(1, 2)
        network = bar(20, 5)
        network.break_springs([3])
        network.detach_particles(99)
        lines = network.plot(left, "tension")
        self.assertEqual(len(lines.get_segments()), int((network.get("spring_flags") == 0).sum()))
        network.plot(left, color="black")
        draw_tuning(network.tune(duration=0.1, budget=2), right)
        figure.canvas.draw()
        pyplot.close(figure)


if __name__ == "__main__":
    unittest.main()
