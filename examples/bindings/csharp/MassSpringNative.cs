// Of the headers of libmassspring 0.2.0, by examples/bindings/generate: do not edit.
// Names, fields and functions are those of the headers, which are the manual.
// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace MassSpring {
    public enum mspring_result : int { MSPRING_OK = 0, MSPRING_ERROR_ARGUMENT = -1, MSPRING_ERROR_ID = -2, MSPRING_ERROR_MEMORY = -3, MSPRING_ERROR_LIMIT = -4, MSPRING_ERROR_STRUCT = -5, MSPRING_ERROR_DUPLICATE = -6, MSPRING_ERROR_UNSTABLE = -7, MSPRING_ERROR_BUSY = -8, MSPRING_ERROR_THREAD = -9, MSPRING_ERROR_EQUILIBRIUM = -10, MSPRING_ERROR_SNAPSHOT = -11, MSPRING_ERROR_OUTDATED = -12 }
    public enum mspring_solver : int { MSPRING_SOLVER_EXPLICIT = 0, MSPRING_SOLVER_IMPLICIT = 1, MSPRING_SOLVER_DIRECT = 2 }
    public enum mspring_integrator : int { MSPRING_INTEGRATOR_GA0 = 0, MSPRING_INTEGRATOR_BDF2 = 1, MSPRING_INTEGRATOR_EULER = 2 }
    public enum mspring_simd : int { MSPRING_SIMD_AUTO = 0, MSPRING_SIMD_SCALAR = 1, MSPRING_SIMD_SSE2 = 2, MSPRING_SIMD_AVX2 = 3, MSPRING_SIMD_AVX512 = 4, MSPRING_SIMD_NEON = 5, MSPRING_SIMD_WASM = 6 }
    public enum mspring_guard : int { MSPRING_GUARD_GROWTH = 0, MSPRING_GUARD_RETRY = 1, MSPRING_GUARD_BOUNDS = 2, MSPRING_GUARD_IMPLICIT = 3, MSPRING_GUARD_CLAMP = 4, MSPRING_GUARD_CLAMP_BOUNDS = 5 }
    public enum mspring_property : int { MSPRING_MASS = 0, MSPRING_INVERSE_MASS_SCALE = 1, MSPRING_STIFFNESS = 2, MSPRING_DAMPING = 3, MSPRING_REST_LENGTH = 4, MSPRING_BREAK_STRAIN = 5, MSPRING_STRESS_STRAIN = 6, MSPRING_RELAX_STRAIN = 7, MSPRING_STRAIN = 8, MSPRING_LENGTH = 9, MSPRING_FORCE = 10, MSPRING_ACTIVE_STIFFNESS = 11, MSPRING_ACTIVE_DAMPING = 12, MSPRING_YIELD_STRAIN = 13, MSPRING_HARDENING = 14, MSPRING_PLASTIC_LIMIT = 15, MSPRING_PLASTIC_STRAIN = 16, MSPRING_ACTIVE_REST_LENGTH = 17 }
    public enum mspring_numbering : int { MSPRING_ENDS_IDS = 0, MSPRING_ENDS_SLOTS = 1 }
    public enum mspring_event_kind : int { MSPRING_EVENT_BROKEN = 0, MSPRING_EVENT_STRESSED = 1, MSPRING_EVENT_RELAXED = 2, MSPRING_EVENT_RESTORED = 3, MSPRING_EVENT_DETACHED = 4, MSPRING_EVENT_SPLIT = 5, MSPRING_EVENT_JOINED = 6, MSPRING_EVENT_YIELDED = 7 }
    public enum mspring_snapshot_contents : int { MSPRING_SNAPSHOT_ALL = 0, MSPRING_SNAPSHOT_FRAME = 1 }
    public enum mspring_reset : int { MSPRING_RESET_START = 0, MSPRING_RESET_MARK = 1 }
    public enum mspring_contact_event_kind : int { MSPRING_CONTACT_BEGAN = 0, MSPRING_CONTACT_ENDED = 1 }
    public enum mspring_collider_kind : int { MSPRING_COLLIDER_CHAIN = 0, MSPRING_COLLIDER_BOX = 1, MSPRING_COLLIDER_CIRCLE = 2 }
    public enum mspring_gradient_of : int { MSPRING_GRADIENT_STIFFNESS = 0, MSPRING_GRADIENT_DAMPING = 1, MSPRING_GRADIENT_REST_LENGTH = 2, MSPRING_GRADIENT_X = 3, MSPRING_GRADIENT_Y = 4, MSPRING_GRADIENT_VX = 5, MSPRING_GRADIENT_VY = 6 }
    public enum mspring_area_kind : int { MSPRING_AREA_ELASTIC = 0, MSPRING_AREA_GAS = 1 }
    public enum mspring_preset : int { MSPRING_PRESET_STEEL = 0, MSPRING_PRESET_WOOD = 1, MSPRING_PRESET_RUBBER = 2, MSPRING_PRESET_JELLY = 3 }
    public enum mspring_phase : int { MSPRING_PHASE_BEFORE_STEP = 0, MSPRING_PHASE_BEFORE_SUBSTEP = 1, MSPRING_PHASE_AFTER_SUBSTEP = 2 }
    public enum mspring_tune_measure : int { MSPRING_TUNE_BY_TRAJECTORY = 0, MSPRING_TUNE_BY_REST = 1, MSPRING_TUNE_BY_BENDING = 2, MSPRING_TUNE_BY_SCENE = 3 }
    public enum mspring_layout : int { MSPRING_LAYOUT_COMPACT = 0, MSPRING_LAYOUT_WHOLE = 1 }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_allocator {
        public uint struct_size; public uint reserved; public IntPtr alloc; public IntPtr free; public IntPtr user;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tasks {
        public uint struct_size; public uint worker_count; public uint concurrent_count; public uint reserved; public IntPtr run; public IntPtr user;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_particle_def {
        public uint struct_size; public uint flags; public double x; public double y; public float vx; public float vy; public float mass; public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_spring_def {
        public uint struct_size; public uint flags; public uint a; public uint b; public float stiffness; public float damping; public float rest_length; public float break_strain; public float stress_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_material {
        public uint struct_size; public uint particle_flags; public uint spring_flags; public float mass; public float stiffness; public float damping; public float break_strain; public float stress_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_lattice_def {
        public uint struct_size; public uint width; public uint height; public uint material_count; public double x; public double y; public double spacing; public IntPtr cells; public IntPtr materials; public float shear_share; public float bend_share;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_solver_def {
        public uint struct_size; public mspring_solver solver; public uint substeps; public uint max_substeps; public mspring_integrator integrator; public uint iterations; public uint tile_size; public uint coarse_period; public uint most_work; public float residual; public double substep_length;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_settings {
        public uint struct_size; public mspring_guard guard; public float gravity_x; public float gravity_y; public float global_damping; public float max_speed; public float sleep_speed; public float sleep_time; public float relax_fraction;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_network_def {
        public uint struct_size; public mspring_simd simd_level; public mspring_guard guard; public float gravity_x; public float gravity_y; public float global_damping; public float max_speed; public float sleep_speed; public float sleep_time; public float relax_fraction; public mspring_solver solver; public uint substeps; public uint max_substeps; public mspring_integrator integrator; public uint iterations; public uint tile_size; public uint coarse_period; public uint flags; public IntPtr allocator; public IntPtr tasks; public uint worker_count; public uint spare_particles; public uint spare_springs; public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_floor_def {
        public uint struct_size; public uint plane_count; public double heights_x; public double heights_y; public double spacing; public IntPtr planes; public IntPtr heights; public uint height_count; public float friction; public float restitution; public uint reserved; public IntPtr plane_frictions; public IntPtr plane_restitutions; public IntPtr height_frictions; public IntPtr height_restitutions; public float silt_depth; public float silt_rate;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_step_info {
        public uint struct_size; public mspring_result result; public uint particle; public uint spring; public uint flags; public uint substeps; public ulong step_count; public ulong fallback_count; public double time; public double largest_speed; public double time_left; public double work;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_view {
        public uint struct_size; public uint slot_count; public uint particle_count; public uint reserved; public ulong layout_generation; public ulong origin_generation; public double origin_x; public double origin_y; public IntPtr x; public IntPtr y; public IntPtr vx; public IntPtr vy; public IntPtr inverse_mass; public IntPtr particle_of_slot; public IntPtr slot_of_particle; public IntPtr reserved_pointer;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_event {
        public mspring_event_kind kind; public uint id; public uint other; public float strain;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_component {
        public uint struct_size; public uint head; public uint particle_count; public uint reserved; public double mass; public double x; public double y; public double px; public double py;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_body {
        public uint struct_size; public uint particle_count; public uint head; public uint reserved; public double mass; public double x; public double y; public double vx; public double vy; public double inertia; public double angle; public double spin; public double px; public double py; public double angular; public double min_x; public double min_y; public double max_x; public double max_y;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_contact_def {
        public uint struct_size; public uint flags; public double thickness; public float friction; public float restitution; public float push_speed; public uint sweeps; public uint capacity; public uint max_capacity;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_contact_info {
        public uint struct_size; public uint edges; public uint points; public uint pairs; public uint touching; public uint reserved; public double deepest;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_contact_event {
        public uint struct_size; public mspring_contact_event_kind kind; public uint point; public uint a; public uint b; public uint collider; public double x; public double y; public double normal_x; public double normal_y; public double impulse; public double friction;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_collider_def {
        public uint struct_size; public mspring_collider_kind kind; public double x; public double y; public double angle; public double width; public double height; public double radius; public IntPtr points; public IntPtr reserved_pointer; public uint point_count; public uint flags; public float friction; public float restitution; public uint groups; public uint masks;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_grip_def {
        public uint struct_size; public uint particle; public double x; public double y; public float stiffness; public float damping; public float max_force; public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_plasticity {
        public uint struct_size; public uint bent_springs; public ulong yield_count; public double dissipated;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_area_def {
        public uint struct_size; public mspring_area_kind kind; public float stiffness; public float pressure; public float fill; public uint reserved; public double rest_area;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_area_info {
        public uint struct_size; public uint particle_count; public uint is_open; public uint reserved; public double area; public double pressure; public double energy;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_angle_def {
        public uint struct_size; public float stiffness; public float damping; public uint flags; public double rest_angle;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_angle_info {
        public uint struct_size; public uint is_open; public uint a; public uint b; public uint c; public uint reserved; public double angle; public double torque; public double energy;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_rope_def {
        public uint struct_size; public uint spring_flags; public uint from; public uint to; public uint segment_count; public float mass; public float stiffness; public float damping; public float slack; public float break_strain; public float stress_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_mesh_def {
        public uint struct_size; public uint spring_flags; public uint vertex_count; public uint triangle_count; public IntPtr x; public IntPtr y; public IntPtr triangles; public float area_density; public float stiffness; public float young_modulus; public float damping; public float break_strain; public float stress_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_disc_def {
        public uint struct_size; public uint spring_flags; public uint centre_flags; public uint ring_count; public double x; public double y; public double radius; public float area_density; public float stiffness; public float young_modulus; public float damping; public float break_strain; public float stress_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_clone_def {
        public uint struct_size; public uint flags; public IntPtr allocator; public IntPtr tasks; public uint worker_count; public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_hook_args {
        public uint struct_size; public mspring_phase phase; public uint substep; public uint substep_count; public uint first_slot; public uint slot_count; public double dt; public double origin_x; public double origin_y; public IntPtr x; public IntPtr y; public IntPtr vx; public IntPtr vy; public IntPtr force_x; public IntPtr force_y; public IntPtr inverse_mass; public IntPtr particle_of_slot; public IntPtr slot_of_particle; public IntPtr network; public uint group_count; public uint worker; public IntPtr storage; public IntPtr reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_hook_def {
        public uint struct_size; public mspring_phase phase; public IntPtr fn; public IntPtr user; public uint period; public uint flags; public uint range_slots; public uint reserved; public IntPtr storage; public UIntPtr storage_stride; public double below_y;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_mutable_view {
        public uint struct_size; public uint slot_count; public uint particle_count; public uint reserved; public ulong layout_generation; public ulong origin_generation; public double origin_x; public double origin_y; public IntPtr x; public IntPtr y; public IntPtr vx; public IntPtr vy; public IntPtr inverse_mass; public IntPtr particle_of_slot; public IntPtr slot_of_particle; public IntPtr reserved_pointer;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_spring_info {
        public uint struct_size; public uint flags; public uint a; public uint b; public float stiffness; public float damping; public float rest_length; public float length; public float strain; public float force; public float nominal_stiffness; public float nominal_damping;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_settle_def {
        public uint struct_size; public uint flags; public uint max_iterations; public uint reserved; public double tolerance; public double relative_substep;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_settle_result {
        public uint struct_size; public uint iterations; public double residual; public double largest_force; public double displacement; public uint is_stable; public uint left_alone;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tune_scene {
        public uint struct_size; public uint flags; public uint start_count; public uint reserved; public double duration; public double kick; public double tolerance; public double max_distance; public IntPtr prepare; public IntPtr reserved_pointer;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tune_def {
        public uint struct_size; public uint setting_count; public double dt; public double duration; public double budget; public mspring_tune_measure measure; public uint flags; public double max_error; public double max_cost; public double max_drift; public IntPtr settings; public IntPtr clock; public IntPtr progress; public IntPtr user; public IntPtr scene; public IntPtr reserved_pointer;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tune_row {
        public uint struct_size; public uint flags; public uint setting; public mspring_solver solver; public mspring_integrator integrator; public uint substeps; public uint iterations; public uint tile_size; public uint coarse_period; public uint step_count; public double min_cost; public double median_cost; public double trajectory_error; public double trajectory_share; public double energy_drift; public double bending; public double rest_error; public double rest_share; public double duration; public double moving_cost; public double resting_cost; public uint scene_starts; public uint fine_substeps; public double scene_cost; public double scene_distance; public fixed double scene_mean[3]; public fixed double scene_spread[3]; public fixed double fine_mean[3]; public fixed double fine_spread[3]; public float residual; public float trajectory_spread;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_plan {
        public uint struct_size; public uint particle_count; public uint spring_count; public uint lattice_count; public uint lattice_particles; public uint lattice_springs; public uint lattice_rows; public uint lattice_blocks; public uint chain_count; public uint chain_particles; public uint chain_springs; public uint irregular_particles; public uint loose_particles; public uint irregular_springs; public uint pass_rows; public uint pass_lag; public uint pass_substeps; public uint slot_count; public uint block_width; public uint has_damping; public uint has_relative; public mspring_simd simd_level; public mspring_solver solver; public mspring_integrator integrator; public uint iterations; public uint tile_size; public uint tile_count; public uint coarse_values; public uint coarse_period; public uint irregular_layers; public ulong factor_values; public double factor_products; public uint pass_workers; public float residual;
    }

    /// <summary>The C functions as they are. iOS links them into the program.</summary>
    public static unsafe class Native {
#if UNITY_IOS && !UNITY_EDITOR
        const string LIBRARY = "__Internal";
#else
        const string LIBRARY = "massspring";
#endif
        public const uint MSPRING_VERSION_MAJOR = 0u;
        public const uint MSPRING_VERSION_MINOR = 2u;
        public const uint MSPRING_VERSION_PATCH = 0u;
        public const uint MSPRING_VERSION = 2000u;
        public const uint MSPRING_NONE = 4294967295u;
        public const uint MSPRING_MAX_PARTICLES = 67108864u;
        public const uint MSPRING_MAX_SPRINGS = 268435456u;
        public const double MSPRING_MAX_COORDINATE = 1000000000000.0;
        public const double MSPRING_MAX_SPEED = 1000000000000000.0;
        public const uint MSPRING_MAX_WORKERS = 256u;
        public const float MSPRING_NEVER = 3.40282347e+38f;
        public const float MSPRING_RELAX_STRAIN_DEFAULT = -1f;
        public const float MSPRING_REST_LENGTH_DISTANCE = -1f;
        public const uint MSPRING_CELL_EMPTY = 65535u;
        public const uint MSPRING_MAX_SUBSTEPS = 1000000u;
        public const uint MSPRING_SUBSTEPS_AUTO = 4294967295u;
        public const uint MSPRING_SUBSTEPS_EVEN = 4294967294u;
        public const uint MSPRING_MAX_PLANES = 8u;
        public const uint MSPRING_MAX_HEIGHTS = 67108864u;
        public const uint MSPRING_MAX_COLLIDER_POINTS = 65536u;
        public const uint MSPRING_MAX_GRIPS = 16u;
        public const uint MSPRING_MAX_GRADIENT_STEPS = 16777216u;
        public const float MSPRING_HARDENING_DEFAULT = 0.1f;
        public const float MSPRING_PLASTIC_LIMIT_DEFAULT = 0.5f;
        public const uint MSPRING_MAX_AREA_PARTICLES = 4096u;
        public const uint MSPRING_TUNE_QUANTITIES = 3u;
        public const uint MSPRING_FEATURE_THREADS = 1u;
        public const uint MSPRING_FEATURE_HOSTED = 2u;
        public const uint MSPRING_FEATURE_SHARED = 4u;
        public const uint MSPRING_FEATURE_IMPLICIT = 8u;
        public const uint MSPRING_FEATURE_DIRECT = 16u;
        public const uint MSPRING_FEATURE_FLOOR = 32u;
        public const uint MSPRING_FEATURE_CONTACT = 64u;
        public const uint MSPRING_FEATURE_LAWS = 128u;
        public const uint MSPRING_FEATURE_BATCH = 256u;
        public const uint MSPRING_FEATURE_LAB = 512u;
        public const uint MSPRING_PARTICLE_PINNED = 1u;
        public const uint MSPRING_SPRING_RELATIVE = 1u;
        public const uint MSPRING_SPRING_DAMPING_RATIO = 2u;
        public const uint MSPRING_SPRING_BROKEN = 256u;
        public const uint MSPRING_SPRING_STRESSED = 512u;
        public const uint MSPRING_SPRING_REMOVED = 1024u;
        public const uint MSPRING_NETWORK_RESERVE_DAMPING = 1u;
        public const uint MSPRING_NETWORK_RESERVE_RELATIVE = 2u;
        public const uint MSPRING_NETWORK_PRECISE = 4u;
        public const uint MSPRING_NETWORK_POSES = 8u;
        public const uint MSPRING_STEP_FALLBACK = 1u;
        public const uint MSPRING_STEP_CLAMPED = 2u;
        public const uint MSPRING_STEP_PUT_BACK = 4u;
        public const uint MSPRING_STEP_RETRIED = 8u;
        public const uint MSPRING_STEP_ASLEEP = 16u;
        public const uint MSPRING_STEP_FEWER = 32u;
        public const uint MSPRING_STEP_GREW = 64u;
        public const uint MSPRING_GROUP_HELD = 1u;
        public const uint MSPRING_OBSERVE_X = 0u;
        public const uint MSPRING_OBSERVE_Y = 1u;
        public const uint MSPRING_OBSERVE_VX = 2u;
        public const uint MSPRING_OBSERVE_VY = 3u;
        public const uint MSPRING_OBSERVE_MIN_X = 4u;
        public const uint MSPRING_OBSERVE_MIN_Y = 5u;
        public const uint MSPRING_OBSERVE_MAX_X = 6u;
        public const uint MSPRING_OBSERVE_MAX_Y = 7u;
        public const uint MSPRING_OBSERVE_HELD = 8u;
        public const uint MSPRING_OBSERVE_PARTICLES = 9u;
        public const uint MSPRING_CONTACT_SELF = 1u;
        public const uint MSPRING_COLLIDER_CLOSED = 1u;
        public const uint MSPRING_SPRING_PULL_ONLY = 4u;
        public const uint MSPRING_SPRING_PUSH_ONLY = 8u;
        public const uint MSPRING_ANGLE_REST_GIVEN = 1u;
        public const uint MSPRING_CLONE_HOOKS = 1u;
        public const uint MSPRING_HOOK_CONCURRENT = 1u;
        public const uint MSPRING_HOOK_BELOW = 2u;
        public const uint MSPRING_FIND_WHOLE = 1u;
        public const uint MSPRING_FIND_BROKEN = 2u;
        public const uint MSPRING_SETTLE_LEAVE_FLOATING = 1u;
        public const uint MSPRING_TUNE_NOTHING_ELSE = 1u;
        public const uint MSPRING_TUNE_SCENE_FLOOR = 1u;
        public const uint MSPRING_TUNE_SCENE_BREAKING = 2u;
        public const uint MSPRING_TUNE_SCENE_HOOKS = 4u;
        public const uint MSPRING_TUNE_HAS_COST = 1u;
        public const uint MSPRING_TUNE_HAS_TRAJECTORY = 2u;
        public const uint MSPRING_TUNE_HAS_REST = 4u;
        public const uint MSPRING_TUNE_REJECTED = 8u;
        public const uint MSPRING_TUNE_PARETO = 16u;
        public const uint MSPRING_TUNE_RECOMMENDED = 32u;
        public const uint MSPRING_TUNE_HAS_SCENE = 64u;
        public const uint MSPRING_TUNE_CHAOTIC = 128u;
        public const uint MSPRING_TUNE_BROKEN = 0u;
        public const uint MSPRING_TUNE_ENERGY = 1u;
        public const uint MSPRING_TUNE_EXTENT = 2u;

        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_version();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_version_string();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_features();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_result_string(mspring_result result);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_particle_def_init(mspring_particle_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_spring_def_init(mspring_spring_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_material_init(mspring_material* material, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_lattice_def_init(mspring_lattice_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_solver_def_init(mspring_solver_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_def_init(mspring_network_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_floor_def_init(mspring_floor_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_settings_init(mspring_settings* settings, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_allocator_init(mspring_allocator* allocator, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_tasks_init(mspring_tasks* tasks, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_create(mspring_allocator* allocator, IntPtr* builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_builder_destroy(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_builder_error(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_builder_particle_count(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_builder_spring_count(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_particle(IntPtr builder, mspring_particle_def* def, uint* id);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_particles(IntPtr builder, mspring_particle_def* defs, uint count, uint* first_id);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_spring(IntPtr builder, mspring_spring_def* def, uint* id);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_springs(IntPtr builder, mspring_spring_def* defs, uint count, uint* first_id);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_lattice(IntPtr builder, mspring_lattice_def* def, uint* cell_ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_get_particles(IntPtr builder, uint* ids, uint first, uint count, mspring_particle_def* defs);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_get_springs(IntPtr builder, uint* ids, uint first, uint count, mspring_spring_def* defs);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_read(IntPtr builder, void* archive, UIntPtr size, uint* skipped);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_create(IntPtr builder, mspring_network_def* def, IntPtr* network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_get_network_def(IntPtr builder, mspring_network_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_network_destroy(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_network_error(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_particle_count(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_spring_count(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_solver(IntPtr network, mspring_solver_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_solver(IntPtr network, mspring_solver_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_settings(IntPtr network, mspring_settings* settings);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_settings(IntPtr network, mspring_settings* settings);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_step(IntPtr network, double dt);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_step_info(IntPtr network, mspring_step_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_step_flags(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_is_asleep(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_wake(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_force(IntPtr network, uint particle, float x, float y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_forces(IntPtr network, uint first, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_forces_at(IntPtr network, uint* particles, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_impulses(IntPtr network, uint first, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_impulses_at(IntPtr network, uint* particles, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_torque(IntPtr network, uint* ids, uint first, uint count, float torque);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_floor(IntPtr network, mspring_floor_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_floor(IntPtr network, mspring_floor_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_floor_impulses(IntPtr network, uint first, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_view(IntPtr network, mspring_view* view);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_positions(IntPtr network, uint first, uint count, double* x, double* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_positions_float(IntPtr network, uint first, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_positions_at(IntPtr network, uint* particles, uint count, double* x, double* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_positions_float_at(IntPtr network, uint* particles, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_velocities(IntPtr network, uint first, uint count, float* vx, float* vy, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_velocities_at(IntPtr network, uint* particles, uint count, float* vx, float* vy, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_positions(IntPtr network, uint first, uint count, double* x, double* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_positions_float(IntPtr network, uint first, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_positions_at(IntPtr network, uint* particles, uint count, double* x, double* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_positions_float_at(IntPtr network, uint* particles, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_velocities(IntPtr network, uint first, uint count, float* vx, float* vy, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_velocities_at(IntPtr network, uint* particles, uint count, float* vx, float* vy, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_state_hash(IntPtr network, ulong* hash);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set(IntPtr network, mspring_property property, uint first, uint count, float* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_at(IntPtr network, mspring_property property, uint* ids, uint count, float* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get(IntPtr network, mspring_property property, uint first, uint count, float* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_at(IntPtr network, mspring_property property, uint* ids, uint count, float* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_ends(IntPtr network, uint first, uint count, mspring_numbering numbering, uint* a, uint* b, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_spring_flags(IntPtr network, uint first, uint count, uint* flags, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_max_strain(IntPtr network, float* strain, uint* spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_break_springs(IntPtr network, uint* springs, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_restore_springs(IntPtr network, uint* springs, uint count, double ramp_seconds);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_detach_particles(IntPtr network, uint* particles, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_has_particle(IntPtr network, uint particle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_has_spring(IntPtr network, uint spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_particles(IntPtr network, mspring_particle_def* defs, uint count, uint* ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_springs(IntPtr network, mspring_spring_def* defs, uint count, uint* ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_particles(IntPtr network, uint* particles, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_springs(IntPtr network, uint* springs, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_recycle(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_reserve_events(IntPtr network, uint capacity);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_read_events(IntPtr network, mspring_event* events, uint capacity, uint* count, ulong* lost);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_update_components(IntPtr network, uint* count, uint* changed);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_component_numbers(IntPtr network, uint first, uint count, uint* numbers, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_components(IntPtr network, uint first, uint count, mspring_component* components);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_energy(IntPtr network, double* kinetic, double* elastic, double* potential);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_momentum(IntPtr network, double* px, double* py, double* angular);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_bounds(IntPtr network, double* min_x, double* min_y, double* max_x, double* max_y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_body(IntPtr network, uint* ids, uint first, uint count, mspring_body* body);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_snapshot_size(IntPtr network, mspring_snapshot_contents contents, UIntPtr* size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_save(IntPtr network, mspring_snapshot_contents contents, void* snapshot, UIntPtr capacity, UIntPtr* size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_load(IntPtr network, void* snapshot, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_write(IntPtr network, IntPtr write, void* user);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_copies(IntPtr builder, IntPtr from, uint count, double* x, double* y, uint stride, uint* first_particle, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_groups(IntPtr network, uint* firsts, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_group_count(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_group_flags(IntPtr network, uint first, uint count, uint* flags, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_mark_groups(IntPtr network, uint* groups, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_reset_groups(IntPtr network, uint* groups, uint count, mspring_reset to);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_observe_groups(IntPtr network, uint first, uint count, uint* particles, uint particle_count, double* rows, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_actuators(IntPtr network, uint* springs, uint count, uint changes);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_actuator_count(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_signals(IntPtr network, uint first, uint count, float* signals, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_contact_def_init(mspring_contact_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_contact(IntPtr network, mspring_contact_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_contact(IntPtr network, mspring_contact_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_contact_groups(IntPtr network, uint first, uint count, uint groups, uint masks);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_contact_surface(IntPtr network, uint first, uint count, float friction, float restitution);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_contact_info(IntPtr network, mspring_contact_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_reserve_contact_events(IntPtr network, uint capacity);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_read_contact_events(IntPtr network, mspring_contact_event* events, uint capacity, uint* count, ulong* lost);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_collider_def_init(mspring_collider_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_collider(IntPtr network, mspring_collider_def* def, uint* collider);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_collider(IntPtr network, uint collider);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_move_collider(IntPtr network, uint collider, double x, double y, double angle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_place_collider(IntPtr network, uint collider, double x, double y, double angle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_collider(IntPtr network, uint collider, mspring_collider_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_collider_impulse(IntPtr network, uint collider, double* x, double* y, double* angular);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_grip_def_init(mspring_grip_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_grip(IntPtr network, mspring_grip_def* def, uint* grip);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_grip(IntPtr network, uint grip);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_grip(IntPtr network, uint grip, mspring_grip_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_move_grip(IntPtr network, uint grip, double x, double y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_grip(IntPtr network, uint grip, mspring_grip_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_grip_impulse(IntPtr network, uint grip, double* x, double* y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_create(IntPtr network, uint step_count, uint* forced, uint forced_count, IntPtr* gradient);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_gradient_destroy(IntPtr gradient);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_gradient_error(IntPtr gradient);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_step(IntPtr gradient, double dt, float* signals, float* forces);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_add_seeds(IntPtr gradient, uint* ids, uint first, uint count, double* positions, double* velocities);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_reverse(IntPtr gradient, uint step_count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_get(IntPtr gradient, mspring_gradient_of of, uint* ids, uint first, uint count, double* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_get_signals(IntPtr gradient, uint step, double* values);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_get_forces(IntPtr gradient, uint step, double* values);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_plasticity(IntPtr network, mspring_plasticity* report);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_strain_limits(IntPtr builder, uint first, uint count, float strain, float stiffening, uint* first_limit);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_area_def_init(mspring_area_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_area(IntPtr network, mspring_area_def* def, uint* particles, uint count, uint* area);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_cell_areas(IntPtr network, mspring_area_def* def, uint* first_area, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_area(IntPtr network, uint area);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_area(IntPtr network, uint area, mspring_area_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_area(IntPtr network, uint area, mspring_area_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_area_info(IntPtr network, uint area, mspring_area_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_area_particles(IntPtr network, uint area, uint* particles, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_areas(IntPtr network, uint* ids, double* areas, double* pressures, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_angle_def_init(mspring_angle_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_angles(IntPtr network, mspring_angle_def* def, uint* particles, uint count, uint* first_angle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_angle(IntPtr network, uint angle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_angle(IntPtr network, uint angle, mspring_angle_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_rest_angles(IntPtr network, uint first, uint count, double* rest_angles, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_angle(IntPtr network, uint angle, mspring_angle_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_angle_info(IntPtr network, uint angle, mspring_angle_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_angles(IntPtr network, uint* ids, double* angles, double* torques, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_material_preset(mspring_material* material, UIntPtr size, mspring_preset preset, double spacing, double substep);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_rope_def_init(mspring_rope_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_mesh_def_init(mspring_mesh_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_disc_def_init(mspring_disc_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_rope(IntPtr builder, mspring_rope_def* def, uint* particles, uint capacity, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_mesh(IntPtr builder, mspring_mesh_def* def, uint* first_particle, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_disc(IntPtr builder, mspring_disc_def* def, uint* first_particle, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_network(IntPtr builder, IntPtr network, uint* particles, uint count, uint* particle_ids, uint* spring_ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_clone_def_init(mspring_clone_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_clone(IntPtr network, mspring_clone_def* def, IntPtr* clone);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_hook_def_init(mspring_hook_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_hook(IntPtr network, mspring_hook_def* def, uint* hook);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_hook(IntPtr network, uint hook);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_nearest_particle(IntPtr network, double x, double y, double within, uint* particle, double* distance);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_particles_in_circle(IntPtr network, double x, double y, double radius, uint* particles, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_particles_in_box(IntPtr network, double min_x, double min_y, double max_x, double max_y, uint* particles, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_nearest_spring(IntPtr network, double x, double y, double within, uint flags, uint* spring, double* fraction, double* distance);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_springs_in_circle(IntPtr network, double x, double y, double radius, uint flags, uint* springs, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_springs_across(IntPtr network, double from_x, double from_y, double to_x, double to_y, uint flags, uint* springs, double* fractions, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_view_mutable(IntPtr network, mspring_mutable_view* view);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_spring(IntPtr network, uint spring, mspring_spring_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_extents(IntPtr network, float* length, float* direction_x, float* direction_y, float* strain);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_renew_relative_springs(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_sleepers(IntPtr network, uint first, uint count, byte* asleep, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_worker_count(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_simd mspring_network_simd_level(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_simd mspring_simd_supported();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_simd_available(mspring_simd level);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_simd_name(mspring_simd level);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_stable_dt(IntPtr network, double* now, double* any_shape);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_suggest_substeps(IntPtr network, double dt, double safety, uint* substeps);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_settle_def_init(mspring_settle_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_settle(IntPtr network, mspring_settle_def* def, mspring_settle_result* result);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_tune_scene_init(mspring_tune_scene* scene, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_tune_def_init(mspring_tune_def* def, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_tune_settings(IntPtr network, double dt, mspring_solver_def* settings, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_tune(IntPtr network, mspring_tune_def* def, mspring_tune_row* rows, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_tune_row_solver(mspring_tune_row* row, mspring_solver_def* solver);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_plan(IntPtr network, mspring_plan* plan);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern UIntPtr mspring_network_memory_used(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_compact(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_expand(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_job_begin(IntPtr network, mspring_layout layout, IntPtr* job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_job_run(IntPtr job, uint at_most, uint* left);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_job_finish(IntPtr network, IntPtr job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_job_error(IntPtr job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_job_destroy(IntPtr job);
    }
}
