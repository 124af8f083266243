// The bending of a bar, in C#: 80 x 5 particles of iron, pinned at the left end, after a minute. With --layout it prints
// size and offsets of all structs, as `generate --layout` does in C.
//
//     mcs -unsafe Bar.cs MassSpring.cs MassSpringNative.cs && LD_LIBRARY_PATH=/path/of/the/library mono Bar.exe
//
// SPDX-License-Identifier: MIT
using System;
using System.Reflection;
using System.Runtime.InteropServices;
using MassSpring;

static class Bar {
    const int WIDTH = 80, HEIGHT = 5;

    static void PrintLayout() {
        foreach (Type type in typeof(Native).Assembly.GetTypes()) {
            if (!type.IsValueType || type.IsEnum || !type.Name.StartsWith("mspring_")) continue;
            type.GetMethod("Default")?.Invoke(null, null); // the library knows it, and refuses too small a size
            Console.WriteLine("{0} {1}", type.Name, Marshal.SizeOf(type));
            foreach (FieldInfo field in type.GetFields(BindingFlags.Public | BindingFlags.Instance))
                Console.WriteLine("{0}.{1} {2}", type.Name, field.Name, Marshal.OffsetOf(type, field.Name));
        }
    }

    static int Main(string[] arguments) {
        if (arguments.Length == 1 && arguments[0] == "--layout") {
            PrintLayout();
            return 0;
        }
        mspring_material iron = mspring_material.Default();
        iron.mass = 73.4f;
        iron.stiffness = 6.76e7f;
        mspring_material wall = iron;
        wall.particle_flags = Native.MSPRING_PARTICLE_PINNED;
        var cells = new ushort[WIDTH * HEIGHT];
        for (int row = 0; row < HEIGHT; row++) cells[row * WIDTH] = 1;
        using (var builder = new Builder()) {
            int freeEnd = builder.AddLattice(WIDTH, HEIGHT, cells, iron, wall)[WIDTH - 1];
            using (var network = new Network(builder)) {
                mspring_settings settings = network.Settings;
                settings.global_damping = 1;
                network.Settings = settings;
                var x = new double[network.ParticleCount];
                var y = new double[network.ParticleCount];
                network.Positions(x, y);
                double top = y[freeEnd];
                for (int step = 0; step < 60 * 64 * 30; step++) network.Step(1 / (64.0 * 30));
                network.Positions(x, y);
                FormattableString said = $"the free end has dropped by {top - y[freeEnd]:F2} m, hash {network.StateHash():x16}";
                Console.WriteLine(FormattableString.Invariant(said));

                var vertices = new float[3 * x.Length];
                unsafe {
                    fixed (float* to = vertices) network.Positions(to, 3);
                }
                if (vertices[3 * freeEnd + 1] != (float)y[freeEnd]) throw new Exception("a vertex is elsewhere");

                byte[] before = network.Save();
                network.Step(1.0 / 64);
                ulong after = network.StateHash();
                network.Load(before);
                network.Step(1.0 / 64);
                if (network.StateHash() != after) throw new Exception("a loaded snapshot goes elsewhere");
                try {
                    network.BreakSprings(1000000);
                    return 1;
                } catch (MassSpringException problem) {
                    if (problem.Result != mspring_result.MSPRING_ERROR_ID) throw;
                }
            }
        }
        return 0;
    }
}
