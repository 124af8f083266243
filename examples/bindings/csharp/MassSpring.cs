// libmassspring for C#: Unity, Godot, .NET and mono. Copy this file and MassSpringNative.cs into a project that allows
// unsafe code, and put the shared library where it looks for native ones (Unity: Assets/Plugins).
//
//     using (var builder = new Builder()) {
//         int[] ids = builder.AddLattice(24, 4, cells, steel, wall);
//         using (var network = new Network(builder)) {
//             network.Step(1.0 / 60);
//             network.Positions(x, y);
//         }
//     }
//
// It wraps the calls of most games. Native has all others, under the names of the headers: network.Handle is the pointer
// for these functions, and network.Check throws with the message of a failed call. mspring_grip_def.Default() is a struct
// with its defaults; it throws if the library has another layout of it.
//
// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace MassSpring {
    public sealed class MassSpringException : Exception {
        public readonly mspring_result Result;

        MassSpringException(mspring_result result, string message) : base(message) { Result = result; }

        /// <summary>Throws if a call has failed; message: the error message of the object.</summary>
        public static unsafe void Check(mspring_result result, byte* message = null) {
            if (result == mspring_result.MSPRING_OK) return;
            string said = message == null ? "" : ": " + Text(message);
            throw new MassSpringException(result, Text(Native.mspring_result_string(result)) + said);
        }

        public static unsafe string Text(byte* text) { return Marshal.PtrToStringAnsi((IntPtr)text); }
    }

    /// <summary>Collects particles and springs.</summary>
    public sealed unsafe class Builder : IDisposable {
        public IntPtr Handle { get; private set; }

        public Builder() {
            IntPtr made;
            MassSpringException.Check(Native.mspring_builder_create(null, &made));
            Handle = made;
        }

        public void Check(mspring_result result) {
            if (result == mspring_result.MSPRING_OK) return;
            try {
                MassSpringException.Check(result, Native.mspring_builder_error(Handle));
            } finally {
                Native.mspring_builder_forget_error(Handle); // it is thrown once, and the builder goes on
            }
        }

        public int AddParticle(double x, double y, float mass = 1, bool pinned = false) {
            mspring_particle_def def = mspring_particle_def.Default();
            uint id;
            def.x = x;
            def.y = y;
            def.mass = mass;
            def.flags = pinned ? Native.MSPRING_PARTICLE_PINNED : 0;
            Check(Native.mspring_builder_add_particles(Handle, &def, 1, &id));
            return (int)id;
        }

        public int AddSpring(int a, int b, float stiffness, float damping = 0) {
            mspring_spring_def def = mspring_spring_def.Default();
            uint id;
            def.a = (uint)a;
            def.b = (uint)b;
            def.stiffness = stiffness;
            def.damping = damping;
            Check(Native.mspring_builder_add_springs(Handle, &def, 1, &id));
            return (int)id;
        }

        /// <summary>cells: top row first, indices of materials or MSPRING_CELL_EMPTY. Returns the particle of each cell,
        /// -1 for none.</summary>
        public int[] AddLattice(int width, int height, ushort[] cells, params mspring_material[] materials) {
            if (cells.Length != width * height) throw new ArgumentException("cells must have width * height values");
            mspring_lattice_def def = mspring_lattice_def.Default();
            var ids = new int[cells.Length];
            fixed (ushort* cell = cells)
            fixed (mspring_material* material = materials)
            fixed (int* id = ids) {
                def.width = (uint)width;
                def.height = (uint)height;
                def.cells = (IntPtr)cell;
                def.materials = (IntPtr)material;
                def.material_count = (uint)materials.Length;
                Check(Native.mspring_builder_add_lattice(Handle, &def, (uint*)id));
            }
            return ids;
        }

        public void Dispose() {
            Native.mspring_builder_destroy(Handle);
            Handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Builder() { Dispose(); }
    }

    /// <summary>Particles and springs that move. Any thread may call it, but only one at a time.</summary>
    public sealed unsafe class Network : IDisposable {
        public IntPtr Handle { get; private set; }
        public int ParticleCount { get { return Count(mspring_kind.MSPRING_PARTICLES); } }
        public int SpringCount { get { return Count(mspring_kind.MSPRING_SPRINGS); } }

        public Network(Builder builder) : this(builder, mspring_network_def.Default()) { }

        public Network(Builder builder, mspring_network_def def) {
            IntPtr made;
            builder.Check(Native.mspring_network_create(builder.Handle, &def, &made));
            Handle = made;
        }

        public int Count(mspring_kind kind) { return (int)Native.mspring_network_count(Handle, kind); }

        public void Check(mspring_result result) {
            if (result == mspring_result.MSPRING_OK) return;
            try {
                MassSpringException.Check(result, Native.mspring_network_error(Handle));
            } finally { // what reads and fails keeps its message until a call that may change, such as this one
                uint count;
                Native.mspring_network_read_events(Handle, null, 0, &count, null);
            }
        }

        void CheckRoom(Array array, int values) {
            if (array.Length < values) throw new ArgumentException("the array needs room for " + values + " values");
        }

        public void Step(double dt) { Check(Native.mspring_network_step(Handle, dt)); }

        public mspring_settings Settings {
            get {
                mspring_settings made = mspring_settings.Default();
                Check(Native.mspring_network_get_settings(Handle, &made));
                return made;
            }
            set { Check(Native.mspring_network_set_settings(Handle, &value)); }
        }

        /// <summary>Fills both with world positions, by id.</summary>
        public void Positions(double[] x, double[] y) {
            CheckRoom(x, ParticleCount);
            CheckRoom(y, ParticleCount);
            fixed (double* toX = x, toY = y)
                Check(Native.mspring_network_get_positions(Handle, null, 0, (uint)ParticleCount, toX, toY, 1));
        }

        /// <summary>x, y of one particle after the other, as vertices of a mesh have them. stride: floats from one to
        /// the next, 3 for a Vector3[] that is pinned.</summary>
        public void Positions(float* vertices, int stride) {
            mspring_column* both = stackalloc mspring_column[2];
            both[0].property = mspring_property.MSPRING_X;
            both[1].property = mspring_property.MSPRING_Y;
            both[0].stride = both[1].stride = (uint)stride;
            both[0].values = (IntPtr)vertices;
            both[1].values = (IntPtr)(vertices + 1);
            Check(Native.mspring_network_get_columns(Handle, null, 0, (uint)ParticleCount, both, 2));
        }

        // The number of things that have a property: bits 8 and up are their kind.
        uint CountOf(mspring_property property, Array values) {
            int count = Count((mspring_kind)((int)property >> 8));
            CheckRoom(values, count);
            return (uint)count;
        }

        /// <summary>Reads a property of all things of its kind, as MSPRING_STRAIN of all springs.</summary>
        public void Get(mspring_property property, float[] values) {
            uint count = CountOf(property, values);
            fixed (float* to = values) Check(Native.mspring_network_get(Handle, property, null, 0, count, to, 1));
        }

        /// <summary>Reads a property of integers, as MSPRING_SPRING_FLAGS.</summary>
        public void Get(mspring_property property, uint[] values) {
            uint count = CountOf(property, values);
            fixed (uint* to = values) Check(Native.mspring_network_get_integers(Handle, property, null, 0, count, to, 1));
        }

        public void Set(mspring_property property, float[] values) {
            uint count = CountOf(property, values);
            fixed (float* from = values) Check(Native.mspring_network_set(Handle, property, null, 0, count, from, 1));
        }

        public void ApplyForce(int particle, float x, float y) {
            Check(Native.mspring_network_apply_force(Handle, (uint)particle, x, y));
        }

        public void BreakSprings(params int[] springs) {
            fixed (int* ids = springs)
                Check(Native.mspring_network_break_springs(Handle, (uint*)ids, 0, (uint)springs.Length));
        }

        /// <summary>Holds a particle softly, as a mouse does. Returns the grip.</summary>
        public int AddGrip(int particle, double x, double y, float stiffness, float damping) {
            mspring_grip_def def = mspring_grip_def.Default();
            uint id;
            def.particle = (uint)particle;
            def.x = x;
            def.y = y;
            def.stiffness = stiffness;
            def.damping = damping;
            Check(Native.mspring_network_add_grip(Handle, &def, &id));
            return (int)id;
        }

        public void MoveGrip(int grip, double x, double y) {
            Check(Native.mspring_network_move_grip(Handle, (uint)grip, x, y));
        }

        public void RemoveGrip(int grip) { Check(Native.mspring_network_remove_grip(Handle, (uint)grip)); }

        /// <summary>Saves all that the following steps depend on, for rollback and network play.</summary>
        public byte[] Save() {
            UIntPtr size;
            var contents = mspring_snapshot_contents.MSPRING_SNAPSHOT_FRAME;
            Check(Native.mspring_network_get_snapshot_size(Handle, contents, &size));
            var made = new byte[(int)size];
            fixed (byte* to = made)
                Check(Native.mspring_network_save(Handle, contents, to, size, null));
            return made;
        }

        public void Load(byte[] snapshot) {
            fixed (byte* from = snapshot)
                Check(Native.mspring_network_load(Handle, from, (UIntPtr)snapshot.Length));
        }

        /// <summary>Equal states have equal hashes on every machine.</summary>
        public ulong StateHash() {
            ulong hash;
            Check(Native.mspring_network_get_state_hash(Handle, &hash));
            return hash;
        }

        public void Dispose() {
            Native.mspring_network_destroy(Handle);
            Handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Network() { Dispose(); }
    }
}
