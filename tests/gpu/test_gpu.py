"""Batches on a device of OpenCL, here PoCL: the bits of the processor.

SPDX-License-Identifier: MIT
"""
import importlib.util
import os
import subprocess
import sys
import unittest

import numpy as np

import massspring
from massspring import gpu

DT = 1 / 64


def setUpModule():
    try:
        found = gpu.devices()
    except gpu.DeviceError as error:
        raise unittest.SkipTest(str(error))
    print(*found, sep="\n")


def body(rng):
    """A lattice with a rope, or a body of chance."""
    builder = massspring.Builder()
    if rng.random() < 0.5:
        damping = rng.choice([0.0, 3.0])
        cells = builder.add_lattice(np.zeros(rng.integers(2, 7, 2), int),
                                    {"mass": 1, "stiffness": 800, "damping": damping}, y=rng.uniform(0.1, 2))
        end = builder.add_particle(8, 1, mass=0.5, pinned=bool(rng.random() < 0.3))
        builder.add_rope(int(cells[0, -1]), end, 4, {"mass": 0.3, "stiffness": 500})
        return builder
    count = int(rng.integers(3, 40))
    builder.add_particles(rng.uniform(0, 4, (count, 2)) + [0, 0.2], mass=rng.uniform(0.5, 2, count))
    for i in range(1, count):
        for other in {i - 1, int(rng.integers(0, i))}:
            builder.add_spring(i, other, stiffness=rng.uniform(50, 900), damping=rng.uniform(0, 3))
    return builder


def pair(seed):
    """The same batch on the processor and on the device."""
    rng = np.random.default_rng(seed)
    builder, count = body(rng), int(rng.integers(1, 30))
    actuators = rng.permutation(builder.spring_count)[:rng.integers(0, min(6, builder.spring_count))]
    particles = rng.integers(0, builder.particle_count, 3).tolist()
    options = {"substeps": int(rng.integers(1, 33)), "gravity": (rng.uniform(-1, 1), -9.8),
               "global_damping": rng.choice([0, 0.4]), "actuators": actuators, "changes": int(rng.choice([1, 4, 256])),
               "max_speed": rng.choice([6.0, 1000.0]),
               "offsets": rng.uniform(-1, 1, (count, 2)) if rng.random() < 0.5 else None,
               "observations": {"x": particles, "vy": particles[:1], "relative_x": particles, "mass": particles}}
    made = [massspring.Batch(builder, count, device=device, **options) for device in ("cpu", "gpu")]
    for batch in made:
        batch.network.set_floor(planes=[[0, 0, 0.1, 1]], friction=0.5, restitution=0.2)
    return made, rng


class OnADevice(unittest.TestCase):
    def test_bits_are_those_of_the_processor(self):
        held = 0
        for seed in range(8):
            (cpu, device), rng = pair(seed)
            for _ in range(12):
                dt = DT * rng.choice([1, 1, 0.7, 1.3])
                signals = rng.uniform(0.8, 1.25, cpu.signals.shape) if rng.random() < 0.6 else None
                count = int(rng.integers(1, 4))
                for batch in (cpu, device):
                    batch.step(dt, signals, count)
                np.testing.assert_array_equal(cpu.observe(), device.observe(), f"seed {seed}")
                np.testing.assert_array_equal(cpu.signals, device.signals)
                self.assertEqual(cpu.state_hash, device.state_hash, f"seed {seed}")
                held += int(device.held.sum())
                if rng.random() < 0.3:
                    mask = rng.random(len(cpu)) < 0.4
                    for batch in (cpu, device):
                        batch.reset(mask)
            last = len(cpu) - 1
            np.testing.assert_array_equal(cpu.positions(last), device.positions(last))
            self.assertEqual((cpu.first_particles.tolist(), len(cpu)), (device.first_particles.tolist(), len(device)))
            device.close()
        self.assertGreater(held, 0)

    def test_many_that_are_partly_lattice(self):
        """The processor sweeps such bodies in another order from 64 on."""
        rng = np.random.default_rng(4)
        builder = massspring.Builder()
        builder.add_lattice(np.zeros((5, 6), int), {"mass": 1, "stiffness": 800, "damping": 1}, y=1.0)
        builder.add_particles(rng.uniform(7, 10, (30, 2)))
        for i in range(30, 60):
            for other in {int(number) for number in rng.integers(0, i, 3)}:
                builder.add_spring(i, other, stiffness=rng.uniform(50, 300), damping=0.5)
        for count in (60, 70):
            cpu, device = (massspring.Batch(builder, count, substeps=6, device=kind) for kind in ("cpu", "gpu"))
            for batch in (cpu, device):
                batch.step(DT, count=3)
            self.assertEqual(cpu.state_hash, device.state_hash)

    def test_arrays_of_other_libraries(self):
        """Rows go out and signals come in by DLPack, without a copy."""
        (cpu, device), _ = pair(3)
        device.step(DT)
        rows = device.observe()
        self.assertEqual(device.__dlpack_device__(), (1, 0))
        self.assertEqual(np.from_dlpack(device).ctypes.data, rows.ctypes.data)

        class Signals:
            def __init__(self, array):
                self.array = array

            def __dlpack__(self, **how):
                return self.array.__dlpack__(**how)

            def __dlpack_device__(self):
                return self.array.__dlpack_device__()

        cpu.step(DT)
        for batch in (cpu, device):
            batch.step(DT, Signals(np.full(batch.signals.shape, 1.1)))
        self.assertEqual(cpu.state_hash, device.state_hash)

    @unittest.skipIf(importlib.util.find_spec("torch") is None, "no torch here (Debian: python3-torch)")
    def test_torch(self):
        import torch

        (_, device), _ = pair(5)
        rows = torch.from_dlpack(device)
        device.step(DT, torch.full(device.signals.shape, 1.1, dtype=torch.float64))
        device.observe()
        self.assertEqual((rows.data_ptr(), rows[0, 1].item()), (device.rows.ctypes.data, device.rows[0, 1]))

    def test_mistakes(self):
        (_, device), _ = pair(1)
        self.assertIsInstance(device, massspring.Batch)
        device.observe()
        with self.assertRaises(massspring.ArgumentError):
            device.mark()
        with self.assertRaises(massspring.ArgumentError):
            device.reset(to="mark")
        with self.assertRaises(massspring.IdError):
            device.reset([len(device)])
        with self.assertRaises(massspring.IdError):
            device.positions(len(device))
        with self.assertRaises(massspring.ClosedError):  # the bodies have left it
            device.network.set_floor(planes=[[0, 0, 0, 1]])
        before = device.state_hash
        for dt in (0.0, float("nan"), -1):
            with self.assertRaises(massspring.ArgumentError):
                device.step(dt)
        if device.signals.size:
            with self.assertRaises(massspring.ArgumentError):
                device.step(DT, 1e9)
        with self.assertRaises(TypeError):
            device.step("1")
        self.assertEqual(device.state_hash, before)
        device.close()
        with self.assertRaises(massspring.ClosedError):
            device.step(DT)
        builder = massspring.Builder()
        builder.add_lattice(np.zeros((2, 2), int), {"mass": 1, "stiffness": 9})
        for wrong in ("cuda", "gpu:", "gpu:-1", "gpu:x", 3, None):
            with self.assertRaises(massspring.ArgumentError, msg=wrong):
                massspring.Batch(builder, 2, substeps=4, device=wrong)
        with self.assertRaises(massspring.ArgumentError):
            massspring.Batch([(builder, 2), (builder, 1)], substeps=4, device="gpu")
        with self.assertRaises(TypeError):
            type("Mine", (massspring.Batch,), {})(builder, 2, substeps=4, device="gpu")
        with self.assertRaisesRegex(gpu.DeviceError, "no device 999"):
            massspring.Batch(builder, 2, substeps=4, device="gpu:999").step(DT)
        with self.assertRaisesRegex(massspring.ArgumentError, "cannot observe"):
            massspring.Batch(builder, 2, substeps=4, device="gpu", observations={"strain": [0]}).observe()
        self.assertEqual(massspring.Batch(builder, substeps=4, device="gpu").observe().shape, (1, 9))

    @unittest.skipUnless(sys.platform == "linux", "reads /proc/self/maps")
    def test_both_libraries_use_the_same_massspring(self):
        with open("/proc/self/maps", encoding="utf-8") as maps:
            self.assertEqual(len({line.split()[-1] for line in maps if "libmassspring.so" in line}), 1)

    def test_a_library_that_is_missing(self):
        program = "import massspring as m\nfrom massspring import gpu\ntry: gpu.load()\nexcept m.Error as e: print(e)"
        for path in ("", "/nowhere/libmassspring_gpu.so"):
            says = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True,
                                  env={**os.environ, "MASSSPRING_GPU_LIBRARY": path}).stdout
            self.assertIn("-DMASSSPRING_GPU=ON", says)
            self.assertIn("MASSSPRING_GPU_LIBRARY", says)
            self.assertIn(path or "libmassspring_gpu.so.", says)


if __name__ == "__main__":
    unittest.main()
