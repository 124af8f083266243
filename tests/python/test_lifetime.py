"""Freed objects are errors, arrays of views keep their memory, nothing leaks, and threads wait for each other.

SPDX-License-Identifier: MIT
"""
import copy
import gc
import pickle
import threading
import unittest

import numpy as np
from bar import bar, bar_builder, pair

import massspring
from massspring import ClosedError, StaleViewError


def resident():
    """Bytes of memory in use, on Linux."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


class Lifetime(unittest.TestCase):
    def test_a_handle_is_not_shared(self):
        builder = massspring.Builder()
        for copied in (copy.copy, copy.deepcopy, pickle.dumps):
            self.assertRaises(TypeError, copied, builder)
        self.assertRaises(TypeError, massspring.Network.read, 5)

    def test_closed_objects(self):
        builder = massspring.Builder()
        builder.add_particle(0, 0)
        with builder.network() as network:
            view = network.view
        builder.close()
        builder.close()
        network.close()
        self.assertTrue(network.closed and builder.closed)
        for read in (lambda: network.positions, lambda: network.step(1), network.clone, network.save,
                     lambda: network.energy, lambda: network.particle_count, lambda: network.get("mass", 0),
                     lambda: view.x, lambda: network.plot(), lambda: network.view, lambda: builder.particle_count,
                     lambda: builder.get_springs(), lambda: network.archive, lambda: network.columns("x"), builder.network,
                     lambda: builder.add_particle(0, 0), lambda: builder.add_network(network), network.__enter__,
                     lambda: network.load(b""), lambda: network.tune(), lambda: network.info):
            self.assertRaises(ClosedError, read)
        self.assertEqual((repr(network), repr(builder)), ("Network(closed)", "Builder(closed)"))

    def test_numbers_that_close_what_they_are_for(self):
        class Closing:
            def __init__(self, closes):
                self.closes = closes

            def __float__(self):
                self.closes.close()
                return 1 / 64

        class ClosingIndex(Closing):
            def __index__(self):
                self.closes.close()
                return 1

        calls = [
            lambda network, bad: network.step(bad),
            lambda network, bad: network.step(bad, 0),
            lambda network, bad: network.step(1 / 64, bad),
            lambda network, bad: network.nearest_particle(bad, 0),
            lambda network, bad: network.nearest_particle(0, bad),
            lambda network, bad: network.restore_springs(0, bad),
            lambda network, bad: network.set_settings(gravity_x=bad),
            lambda network, bad: network.move_grip(0, bad, 0),
            lambda network, bad: network.set_floor([[0, 0, 0, 1]], friction=bad),
            lambda network, bad: network.reserve_events(bad),
            lambda network, bad: network.get_collider(bad),
            lambda network, bad: network.remove_collider(bad),
        ]
        for number, call in enumerate(calls):
            for kind in (Closing, ClosingIndex):
                network = pair()
                with self.subTest(call=number, kind=kind.__name__), self.assertRaises((ClosedError, TypeError)):
                    call(network, kind(network))
                network.close()
        network = pair()
        with self.assertRaises(ClosedError):
            network.step(Closing(network))
        for call in (lambda builder, bad: builder.add_particle(bad, 0), lambda builder, bad: builder.add_spring(0, bad),
                     lambda builder, bad: builder.add_disc(0, 0, bad, {}), lambda builder, bad: builder.network(substeps=bad)):
            builder = bar_builder()
            with self.assertRaises((ClosedError, TypeError)):
                call(builder, ClosingIndex(builder))

    def test_views_are_stale_after_a_step(self):
        network = bar()
        view = network.view
        y, before = view.y, view.y.copy()
        network.step(1 / 64, 4)
        for name in ("x", "origin", "slot_count", "slot_of_particle"):
            self.assertRaises(StaleViewError, getattr, view, name)
        self.assertLess(y.sum(), before.sum())  # an array goes on with the network
        self.assertIs(type(y), np.ndarray)
        np.testing.assert_array_equal(y, network.view.y)

    def test_views_are_read_only(self):
        y = pair().view.y
        with self.assertRaises(ValueError):
            y[0] = 1
        with self.assertRaises(ValueError):
            y.flags.writeable = True

    def test_arrays_outlive_the_network(self):
        network = bar()
        part = network.view.x[3:50]
        expected = part.copy()
        network.close()
        del network
        gc.collect()
        others = [bar() for _ in range(5)]  # which would take the memory if it were free
        np.testing.assert_array_equal(part, expected)
        self.assertEqual(len(others), 5)

    def test_no_array_sees_memory_move(self):
        network = bar(guard="clamp")
        network.break_springs(range(0, 400))
        array = network.view.x
        self.assertRaises(BufferError, network.compact)
        del array
        network.compact()
        array = network.view.x
        self.assertRaises(BufferError, network.restore_springs, 5)
        del array
        network.restore_springs(5)
        network.step(1 / 64)

    def test_a_thousand_of_each(self):
        def make():
            with bar(20, 5, spare_particles=2) as network:
                network.step(1 / 64)
                network.load(network.save())
                network.clone()
                network.view.x
                try:
                    network.step(float("nan"))
                except massspring.ArgumentError:
                    pass

        for _ in range(100):
            make()
        gc.collect()
        before = resident()
        for _ in range(1000):
            make()
        gc.collect()
        # A leaked network of 100 particles would be over 30 kB, so a thousand over 30 MB.
        self.assertLess(resident() - before, 4e6)

    def test_one_network_in_many_threads(self):
        network, wrong = bar(40, 5), []

        def work():
            try:
                for _ in range(50):
                    network.step(1 / 64)
                    network.positions, network.energy, network.view.x
            except StaleViewError:
                pass  # of another thread's step, as it must be
            except Exception as error:  # pylint: disable=broad-except
                wrong.append(error)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])
        self.assertGreaterEqual(network.step_info.step_count, 50)

    def test_close_while_another_thread_steps(self):
        network, ended = bar(), []

        def work():
            try:
                while True:
                    network.step(1 / 64, 10)
            except ClosedError:
                ended.append(True)

        thread = threading.Thread(target=work)
        thread.start()
        network.step(1 / 64, 10)
        network.close()
        thread.join()
        self.assertEqual(ended, [True])

    def test_steps_release_the_gil(self):
        """While a thread makes one long step, this one goes on."""
        network, ticks = bar(), 0
        network.set_settings(substeps=40000)  # some tenths of a second
        thread = threading.Thread(target=network.step, args=(1 / 64,))
        thread.start()
        while thread.is_alive():
            ticks += 1
        self.assertGreater(ticks, 1000)

    def test_errors_and_networks_in_pools(self):
        error = massspring.UnstableError("text", -7, 3, None)
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((type(again), again.particle, str(again)), (massspring.UnstableError, 3, "text"))
        network = pair()
        network.step(1 / 64, 3)
        again = pickle.loads(pickle.dumps(network))
        for one in (network, again):
            one.step(1 / 64, 5)
        self.assertEqual(again.state_hash, network.state_hash)
        self.assertEqual(again.time, network.time)


if __name__ == "__main__":
    unittest.main()
