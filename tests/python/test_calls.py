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
        network = builder.network()
        np.testing.assert_array_equal(network.get("inverse_mass_scale"), [1, 1, 1, 1, 0, 0])
        np.testing.assert_allclose(network.get_positions(4), [10, 0])
        np.testing.assert_array_equal(network.ends[0], [0, 1])

    def test_rope_mesh_disc_and_network(self):
        builder = massspring.Builder()
        builder.add_particles([[0, 0], [10, 0]], pinned=[True, False], mass=[1, 2])
        particles, springs = builder.add_rope(0, 1, 5, stiffness=100)
        self.assertEqual((list(particles), springs), ([0, 2, 3, 4, 5, 1], range(0, 5)))
        self.assertEqual(builder.add_mesh([[0, 5], [1, 5], [0, 6]], [[0, 1, 2]], stiffness=3), (range(6, 9), range(5, 8)))
        self.assertEqual(builder.add_disc(3, 9, 1, ring_count=1, young_modulus=10.0), (range(9, 16), range(8, 20)))
        self.assertEqual(builder.add_strain_limits(springs, 0.1, 9), range(20, 25))
        network = builder.network()
        of_particle, of_spring = massspring.Builder().add_network(network, [0, 1, 2])
        np.testing.assert_array_equal(of_particle[:4], [0, 1, 2, -1])
        np.testing.assert_array_equal(of_spring[:2], [0, -1])
        self.assertEqual(network.plan.chain_count + network.plan.irregular_particles > 0, True)

    def test_areas_and_angles(self):
        builder = massspring.Builder()
        square(builder, 0.0, 0.0)
        line = list(builder.add_particles([[10 + i, 0] for i in range(4)]))
        builder.add_springs([line[:2], line[1:3], line[2:]], stiffness=100)
        network = builder.network()
        areas = network.add_cell_areas(stiffness=50)
        gas = network.add_area([0, 3, 15, 12], kind="gas", pressure=2.0)
        network.set_area(gas, fill=3)
        self.assertEqual((len(areas), network.get_area(gas).fill, network.get_area_info(gas).particle_count), (9, 3, 4))
        angles = network.add_angles([line[:3], line[1:]], stiffness=4.0)
        self.assertEqual((list(angles), network.get_angle_info(angles[1]).b), ([gas + 1, gas + 2], line[2]))
        network.set_rest_angles([0.5, -0.5], angles)
        network.set_angle(angles[0], damping=0.25)
        self.assertEqual((network.get_angle(angles[0]).rest_angle, network.get_angle(angles[0]).damping), (0.5, 0.25))
        self.assertAlmostEqual(network.get_angle_info(angles[1]).torque, -4 * np.sin(0.5))
        self.assertEqual((len(network.get_areas()[0]), list(network.get_angles()[0])), (10, list(angles)))
        self.assertEqual(list(network.get_area_particles(gas)), [12, 15, 3, 0])  # counter-clockwise
        np.testing.assert_allclose(network.get_areas()[1], [1] * 9 + [9])
        network.remove_angle(angles[0])
        network.remove_area(areas[0])
        with self.assertRaises(massspring.IdError):
            network.get_angle(angles[0])
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
        np.testing.assert_array_equal(out, network.strains)

    def test_positions_velocities_and_forces(self):
        network = pair()
        network.positions = [[0, 0], [2, 0]]
        network.set_velocities([0, 3], 1)
        np.testing.assert_array_equal(network.positions, [[0, 0], [2, 0]])
        np.testing.assert_array_equal(network.get_velocities([1, 0]), [[0, 3], [0, 0]])
        self.assertEqual((network.get("strain", 0), network.get("force", 0)), (1, 10))
        self.assertEqual(network.energy(), (4.5, 5, 0))
        self.assertEqual(network.energy().total, 9.5)
        self.assertEqual((network.momentum().y, network.bounds().max_x, network.max_strain()), (3, 2, (1, 0)))
        network.apply_impulses([0, -3], 1)
        network.apply_forces([[1, 0], [-1, 0]])
        out = np.empty((2, 2), np.float32)
        self.assertIs(network.get_positions(out=out), out)
        self.assertEqual(network.momentum().y, 0)

    def test_bodies_and_torques(self):
        network = bar(20, 5, flags=massspring.NETWORK_POSES, gravity=(0, 0))
        body = network.get_body()
        self.assertEqual((body.particle_count, body.head, body.angle), (network.particle_count, 0, 0))
        self.assertEqual(network.get_body([3, 4]).mass, network.get_body(slice(3, 5)).mass)
        for _ in range(10):
            network.apply_torque(2.0, range(network.particle_count))
            network.apply_torque(1.0, [7, 8])
            network.step(1 / 64)
        self.assertNotEqual(network.get_body().spin, 0)
        self.assertNotEqual(network.get_body().angle, 0)

    def test_edits_and_events(self):
        network = bar(20, 5, spare_particles=2, spare_springs=4)
        network.reserve_events(100)
        count, springs = network.particle_count, network.spring_count
        self.assertEqual(list(network.add_particles([[30, 0], [31, 0]], mass=3)), [count, count + 1])
        self.assertEqual(list(network.add_springs([[count, count + 1]], stiffness=5)), [springs])
        self.assertEqual(network.update_components(), (2, True))
        self.assertEqual([component.head for component in network.components], [0, count])
        self.assertEqual(network.components[1].mass, 6)
        self.assertEqual(network.component_numbers[count], 1)
        network.read_events()
        network.break_springs([4, springs])
        events = network.read_events()
        np.testing.assert_array_equal(events["id"], [4, springs])
        self.assertEqual((events["kind"][0], network.events_lost), (massspring.EventKind.BROKEN, 0))
        self.assertEqual(network.spring_flags[4] & massspring.SPRING_BROKEN, massspring.SPRING_BROKEN)
        self.assertIn("BROKEN", repr(massspring.EventKind(events["kind"][0])))
        network.restore_springs(4, ramp_seconds=0.5)
        network.detach_particles([5])
        network.remove_springs(springs)
        network.remove_particles(count)
        network.recycle()
        self.assertEqual((network.has_particle(count), network.has_particle(0), network.has_spring(-1)),
                         (False, True, False))
        network.step(1 / 64)

    def test_floor(self):
        network = pair(gravity=(0, -10))
        network.set_floor([[0, -1, 0, 2]], friction=0.5)
        network.step(1 / 64, 128)
        np.testing.assert_allclose(network.positions[:, 1], -1, atol=1e-5)
        self.assertGreater(network.floor_impulses[0, 1], 0)
        self.assertEqual((network.floor.plane_count, network.floor.friction), (1, 0.5))
        network.set_floor(heights=np.zeros(5), heights_x=-2, heights_y=-3, height_frictions=[0, 1, 0, 1])
        self.assertEqual(network.floor.height_count, 5)
        network.clear_floor()
        self.assertEqual(network.floor.height_count, 0)

    def test_contact_colliders_and_grips(self):
        builder = massspring.Builder()
        square(builder, 0, 0.5)
        square(builder, 0.5, 5)
        network = builder.network(substeps=20)
        network.set_contact(thickness=0.4, friction=0.5)
        network.reserve_contact_events(1000)
        network.set_contact_groups(3, 0xFFFFFFFF, range(0, 16))
        network.set_contact_surface(friction=0.2, ids=range(0, 16))
        network.set_contact_surface()
        ground = network.add_collider("chain", [[-10, -1], [10, -1]], friction=1)
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
        self.assertGreater(network.bounds().min_y, -1)
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
        self.assertEqual(network.get_spring(int(springs[0])).stiffness, np.float32(IRON["stiffness"]))
        spring, fraction, distance = network.nearest_spring(0.25, 4)
        self.assertEqual((network.get_spring(spring).length, fraction, distance), (1, 0.25, 0))
        self.assertEqual(network.nearest_spring(0, 4, flags=massspring.FIND_BROKEN)[0], None)
        near = network.springs_in_circle(0.5, 4, 0.25)
        self.assertIn(spring, near)
        network.break_springs(near)
        np.testing.assert_array_equal(network.springs_in_circle(0.5, 4, 0.25, massspring.FIND_BROKEN), near)
        self.assertEqual(len(network.springs_across((0.5, 3.9), (0.5, 4.1))[0]), 0)
        self.assertGreater(len(network.springs_across((0.5, 3.9), (0.5, 4.1), massspring.FIND_BROKEN)[0]), 0)

    def test_settings_and_solver(self):
        network = bar(20, 5, gravity=(1, -2), sleep_speed=0.01)
        network.set_settings(global_damping=1, guard="clamp")
        self.assertEqual((network.settings.gravity_x, network.settings.guard), (1, massspring.Guard.CLAMP))
        network.set_solver(substep_length=1 / 256)
        network.step(1 / 1024)
        self.assertEqual((network.step_info.step_count, network.step_info.time_left), (0, 1 / 1024))
        network.step(1 / 128)
        self.assertEqual((network.step_info.time, network.solver.substep_length), (1 / 128, 1 / 256))
        network.set_solver(solver="implicit", substeps=2)
        self.assertEqual((network.solver.solver.name, network.plan.solver), ("IMPLICIT", 1))
        now, any_shape = network.stable_dt()
        self.assertTrue(now >= any_shape > 0)
        self.assertEqual(network.suggest_substeps(1 / 64), int(np.ceil(1 / 64 / now / 0.95)))
        network.wake()
        self.assertFalse(network.is_asleep or network.sleepers.any())
        self.assertEqual((network.worker_count, network.memory_used > 1000), (1, True))
        self.assertIn(network.simd_level, ("scalar", "sse2", "avx2", "avx512", "neon"))

    def test_tuning(self):
        network = bar(20, 5)
        table = network.tune([{"substeps": 30}, {"solver": "implicit", "substeps": 2}], duration=0.25, budget=5)
        self.assertEqual([row["solver"] for row in table], ["explicit", "implicit"])
        self.assertGreater(table[0]["median_cost"], 0)
        self.assertIsNone(table[0]["scene_cost"])
        self.assertEqual(len(table.columns()["substeps"]), 2)
        network.set_solver(**table.solver_of(table[1]))
        self.assertEqual(network.solver.substeps, 2)
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
        lines = network.plot(left, "force")
        self.assertEqual(len(lines.get_segments()), int((network.spring_flags == 0).sum()))
        network.plot(left, color="black")
        draw_tuning(network.tune(duration=0.1, budget=2), right)
        figure.canvas.draw()
        pyplot.close(figure)


if __name__ == "__main__":
    unittest.main()
