// Of the headers of libmassspring 0.3.0, by examples/bindings/generate: do not edit.
// Names, fields and functions are those of the headers, which are the manual.
// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace MassSpring {
    public enum mspring_result : int { MSPRING_OK = 0, MSPRING_ERROR_ARGUMENT = -1, MSPRING_ERROR_ID = -2, MSPRING_ERROR_MEMORY = -3, MSPRING_ERROR_LIMIT = -4, MSPRING_ERROR_STRUCT = -5, MSPRING_ERROR_DUPLICATE = -6, MSPRING_ERROR_UNSTABLE = -7, MSPRING_ERROR_BUSY = -8, MSPRING_ERROR_THREAD = -9, MSPRING_ERROR_EQUILIBRIUM = -10, MSPRING_ERROR_SNAPSHOT = -11, MSPRING_ERROR_OUTDATED = -12, MSPRING_ERROR_REFUSED = -13 }
    public enum mspring_struct : int { MSPRING_STRUCT_ALLOCATOR = 0, MSPRING_STRUCT_TASKS = 1, MSPRING_STRUCT_PARTICLE_DEF = 2, MSPRING_STRUCT_SPRING_DEF = 3, MSPRING_STRUCT_MATERIAL = 4, MSPRING_STRUCT_LATTICE_DEF = 5, MSPRING_STRUCT_ROPE_DEF = 6, MSPRING_STRUCT_MESH_DEF = 7, MSPRING_STRUCT_DISC_DEF = 8, MSPRING_STRUCT_SETTINGS = 9, MSPRING_STRUCT_NETWORK_DEF = 10, MSPRING_STRUCT_CLONE_DEF = 11, MSPRING_STRUCT_NETWORK_INFO = 12, MSPRING_STRUCT_STEP_INFO = 13, MSPRING_STRUCT_VIEW = 14, MSPRING_STRUCT_ENERGY = 15, MSPRING_STRUCT_BODY = 16, MSPRING_STRUCT_HOOK_ARGS = 17, MSPRING_STRUCT_HOOK_DEF = 18, MSPRING_STRUCT_FLOOR_DEF = 19, MSPRING_STRUCT_CONTACT_DEF = 20, MSPRING_STRUCT_CONTACT_INFO = 21, MSPRING_STRUCT_CONTACT_EVENT = 22, MSPRING_STRUCT_COLLIDER_DEF = 23, MSPRING_STRUCT_GRIP_DEF = 24, MSPRING_STRUCT_AREA_DEF = 25, MSPRING_STRUCT_ANGLE_DEF = 26, MSPRING_STRUCT_SETTLE_DEF = 1000, MSPRING_STRUCT_SETTLE_RESULT = 1001, MSPRING_STRUCT_TUNE_SCENE = 1002, MSPRING_STRUCT_TUNE_DEF = 1003, MSPRING_STRUCT_TUNE_ROW = 1004 }
    public enum mspring_simd : int { MSPRING_SIMD_AUTO = 0, MSPRING_SIMD_SCALAR = 1, MSPRING_SIMD_SSE2 = 2, MSPRING_SIMD_AVX2 = 3, MSPRING_SIMD_AVX512 = 4, MSPRING_SIMD_NEON = 5, MSPRING_SIMD_WASM = 6 }
    public enum mspring_kind : int { MSPRING_PARTICLES = 0, MSPRING_SPRINGS = 1, MSPRING_ELEMENTS = 2, MSPRING_GROUPS = 3, MSPRING_ACTUATORS = 4 }
    public enum mspring_preset : int { MSPRING_PRESET_STEEL = 0, MSPRING_PRESET_WOOD = 1, MSPRING_PRESET_RUBBER = 2, MSPRING_PRESET_JELLY = 3 }
    public enum mspring_solver : int { MSPRING_SOLVER_EXPLICIT = 0, MSPRING_SOLVER_IMPLICIT = 1, MSPRING_SOLVER_DIRECT = 2 }
    public enum mspring_integrator : int { MSPRING_INTEGRATOR_ALPHA = 0, MSPRING_INTEGRATOR_BDF2 = 1, MSPRING_INTEGRATOR_EULER = 2 }
    public enum mspring_guard : int { MSPRING_GUARD_GROWTH = 0, MSPRING_GUARD_RETRY = 1, MSPRING_GUARD_BOUNDS = 2, MSPRING_GUARD_IMPLICIT = 3, MSPRING_GUARD_CLAMP = 4, MSPRING_GUARD_CLAMP_BOUNDS = 5 }
    public enum mspring_push : int { MSPRING_PUSH_STEP = 0, MSPRING_PUSH_SUBSTEP = 1, MSPRING_PUSH_IMPULSE = 2 }
    public enum mspring_property : int { MSPRING_MASS = 0, MSPRING_INVERSE_MASS_SCALE = 1, MSPRING_X = 2, MSPRING_Y = 3, MSPRING_VX = 4, MSPRING_VY = 5, MSPRING_FRICTION = 6, MSPRING_RESTITUTION = 7, MSPRING_FLOOR_IMPULSE_X = 8, MSPRING_FLOOR_IMPULSE_Y = 9, MSPRING_TOUCH = 10, MSPRING_RELATIVE_X = 11, MSPRING_RELATIVE_Y = 12, MSPRING_RELATIVE_VX = 13, MSPRING_RELATIVE_VY = 14, MSPRING_PARTICLE_FLAGS = 128, MSPRING_LAYERS = 129, MSPRING_MASKS = 130, MSPRING_COMPONENT = 131, MSPRING_SLOT = 132, MSPRING_STIFFNESS = 256, MSPRING_DAMPING = 257, MSPRING_REST_LENGTH = 258, MSPRING_BREAK_STRAIN = 259, MSPRING_WARN_STRAIN = 260, MSPRING_RELAX_STRAIN = 261, MSPRING_YIELD_STRAIN = 262, MSPRING_HARDENING = 263, MSPRING_PLASTIC_LIMIT = 264, MSPRING_PLASTIC_STRAIN = 265, MSPRING_LENGTH = 272, MSPRING_DIRECTION_X = 273, MSPRING_DIRECTION_Y = 274, MSPRING_STRAIN = 275, MSPRING_TENSION = 276, MSPRING_ACTIVE_STIFFNESS = 277, MSPRING_ACTIVE_DAMPING = 278, MSPRING_ACTIVE_REST_LENGTH = 279, MSPRING_SPRING_FLAGS = 384, MSPRING_END_A = 385, MSPRING_END_B = 386, MSPRING_SLOT_A = 387, MSPRING_SLOT_B = 388, MSPRING_ELEMENT_STIFFNESS = 512, MSPRING_ELEMENT_DAMPING = 513, MSPRING_PRESSURE = 514, MSPRING_FILL = 515, MSPRING_REST_AREA = 516, MSPRING_REST_ANGLE = 517, MSPRING_AREA = 528, MSPRING_ACTIVE_PRESSURE = 529, MSPRING_ANGLE = 530, MSPRING_TORQUE = 531, MSPRING_ELEMENT_ENERGY = 532, MSPRING_ELEMENT_FLAGS = 640, MSPRING_GROUP_X = 768, MSPRING_GROUP_Y = 769, MSPRING_GROUP_VX = 770, MSPRING_GROUP_VY = 771, MSPRING_GROUP_MIN_X = 772, MSPRING_GROUP_MIN_Y = 773, MSPRING_GROUP_MAX_X = 774, MSPRING_GROUP_MAX_Y = 775, MSPRING_GROUP_FLAGS = 896, MSPRING_SIGNAL = 1024, MSPRING_ACTUATOR_SPRING = 1152 }
    public enum mspring_event_kind : int { MSPRING_EVENT_BROKEN = 0, MSPRING_EVENT_STRESSED = 1, MSPRING_EVENT_RELAXED = 2, MSPRING_EVENT_RESTORED = 3, MSPRING_EVENT_DETACHED = 4, MSPRING_EVENT_SPLIT = 5, MSPRING_EVENT_JOINED = 6, MSPRING_EVENT_YIELDED = 7 }
    public enum mspring_phase : int { MSPRING_PHASE_BEFORE_STEP = 0, MSPRING_PHASE_BEFORE_SUBSTEP = 1, MSPRING_PHASE_AFTER_SUBSTEP = 2 }
    public enum mspring_snapshot_contents : int { MSPRING_SNAPSHOT_ALL = 0, MSPRING_SNAPSHOT_FRAME = 1 }
    public enum mspring_reset : int { MSPRING_RESET_START = 0, MSPRING_RESET_MARK = 1 }
    public enum mspring_contact_event_kind : int { MSPRING_CONTACT_BEGAN = 0, MSPRING_CONTACT_ENDED = 1 }
    public enum mspring_collider_kind : int { MSPRING_COLLIDER_CHAIN = 0, MSPRING_COLLIDER_BOX = 1, MSPRING_COLLIDER_CIRCLE = 2 }
    public enum mspring_tune_measure : int { MSPRING_TUNE_BY_TRAJECTORY = 0, MSPRING_TUNE_BY_REST = 1, MSPRING_TUNE_BY_BENDING = 2, MSPRING_TUNE_BY_SCENE = 3 }
    public enum mspring_tune_quantity : int { MSPRING_TUNE_BROKEN = 0, MSPRING_TUNE_ENERGY = 1, MSPRING_TUNE_EXTENT = 2 }
    public enum mspring_layout : int { MSPRING_LAYOUT_COMPACT = 0, MSPRING_LAYOUT_WHOLE = 1 }
    public enum mspring_area_kind : int { MSPRING_AREA_ELASTIC = 0, MSPRING_AREA_GAS = 1 }
    public enum mspring_gradient_of : int { MSPRING_GRADIENT_STIFFNESS = 0, MSPRING_GRADIENT_DAMPING = 1, MSPRING_GRADIENT_REST_LENGTH = 2, MSPRING_GRADIENT_X = 3, MSPRING_GRADIENT_Y = 4, MSPRING_GRADIENT_VX = 5, MSPRING_GRADIENT_VY = 6 }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_allocator {
        public uint struct_size; public uint reserved; public IntPtr alloc; public IntPtr free; public IntPtr user;
        public static mspring_allocator Default() { mspring_allocator made; Native.Init(mspring_struct.MSPRING_STRUCT_ALLOCATOR, &made, sizeof(mspring_allocator)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tasks {
        public uint struct_size; public uint worker_count; public uint concurrent_count; public uint reserved; public IntPtr run; public IntPtr user; public IntPtr release;
        public static mspring_tasks Default() { mspring_tasks made; Native.Init(mspring_struct.MSPRING_STRUCT_TASKS, &made, sizeof(mspring_tasks)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_particle_def {
        public uint struct_size; public uint flags; public double x; public double y; public float vx; public float vy; public float mass; public uint reserved;
        public static mspring_particle_def Default() { mspring_particle_def made; Native.Init(mspring_struct.MSPRING_STRUCT_PARTICLE_DEF, &made, sizeof(mspring_particle_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_spring_def {
        public uint struct_size; public uint flags; public uint a; public uint b; public float stiffness; public float damping; public float rest_length; public float break_strain; public float warn_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
        public static mspring_spring_def Default() { mspring_spring_def made; Native.Init(mspring_struct.MSPRING_STRUCT_SPRING_DEF, &made, sizeof(mspring_spring_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_material {
        public uint struct_size; public uint particle_flags; public uint spring_flags; public float mass; public float stiffness; public float damping; public float break_strain; public float warn_strain; public float relax_strain; public float yield_strain; public float hardening; public float plastic_limit;
        public static mspring_material Default() { mspring_material made; Native.Init(mspring_struct.MSPRING_STRUCT_MATERIAL, &made, sizeof(mspring_material)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_lattice_def {
        public uint struct_size; public uint width; public uint height; public uint material_count; public double x; public double y; public double spacing; public IntPtr cells; public IntPtr materials; public float shear_share; public float bend_share;
        public static mspring_lattice_def Default() { mspring_lattice_def made; Native.Init(mspring_struct.MSPRING_STRUCT_LATTICE_DEF, &made, sizeof(mspring_lattice_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_rope_def {
        public uint struct_size; public uint segment_count; public uint from; public uint to; public IntPtr material; public float length_ratio; public uint reserved;
        public static mspring_rope_def Default() { mspring_rope_def made; Native.Init(mspring_struct.MSPRING_STRUCT_ROPE_DEF, &made, sizeof(mspring_rope_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_mesh_def {
        public uint struct_size; public uint vertex_count; public uint triangle_count; public float area_density; public IntPtr x; public IntPtr y; public IntPtr triangles; public IntPtr material; public float young_modulus; public uint reserved;
        public static mspring_mesh_def Default() { mspring_mesh_def made; Native.Init(mspring_struct.MSPRING_STRUCT_MESH_DEF, &made, sizeof(mspring_mesh_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_disc_def {
        public uint struct_size; public uint ring_count; public double x; public double y; public double radius; public IntPtr material; public IntPtr reserved_pointer; public float area_density; public float young_modulus; public uint centre_flags; public uint reserved;
        public static mspring_disc_def Default() { mspring_disc_def made; Native.Init(mspring_struct.MSPRING_STRUCT_DISC_DEF, &made, sizeof(mspring_disc_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_settings {
        public uint struct_size; public mspring_solver solver; public mspring_integrator integrator; public mspring_guard guard; public uint substeps; public uint max_substeps; public double substep_length; public float gravity_x; public float gravity_y; public float global_damping; public float max_speed; public float sleep_speed; public float sleep_time; public float relax_fraction; public float residual; public uint iterations; public uint tile_size; public uint coarse_period; public uint most_work;
        public static mspring_settings Default() { mspring_settings made; Native.Init(mspring_struct.MSPRING_STRUCT_SETTINGS, &made, sizeof(mspring_settings)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_network_def {
        public uint struct_size; public uint flags; public mspring_simd simd_level; public uint worker_count; public uint spare_particles; public uint spare_springs; public IntPtr allocator; public IntPtr tasks; public IntPtr reserved_pointers_0, reserved_pointers_1; public fixed uint reserved[4]; public mspring_settings settings;
        public static mspring_network_def Default() { mspring_network_def made; Native.Init(mspring_struct.MSPRING_STRUCT_NETWORK_DEF, &made, sizeof(mspring_network_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_clone_def {
        public uint struct_size; public uint copy_hooks; public IntPtr allocator; public IntPtr tasks; public uint worker_count; public uint reserved;
        public static mspring_clone_def Default() { mspring_clone_def made; Native.Init(mspring_struct.MSPRING_STRUCT_CLONE_DEF, &made, sizeof(mspring_clone_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_network_info {
        public uint struct_size; public mspring_simd simd_level; public uint worker_count; public uint busy_workers; public uint lattice_springs; public uint chain_springs; public uint irregular_springs; public uint particle_room; public uint spring_room; public uint reserved; public ulong memory_used;
        public static mspring_network_info Default() { mspring_network_info made; Native.Init(mspring_struct.MSPRING_STRUCT_NETWORK_INFO, &made, sizeof(mspring_network_info)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_step_info {
        public uint struct_size; public mspring_result result; public uint particle; public uint spring; public uint flags; public uint substeps; public ulong step_count; public ulong fallback_count; public double time; public double time_left; public double work; public uint is_asleep; public uint reserved;
        public static mspring_step_info Default() { mspring_step_info made; Native.Init(mspring_struct.MSPRING_STRUCT_STEP_INFO, &made, sizeof(mspring_step_info)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_view {
        public uint struct_size; public uint slot_count; public uint particle_count; public uint reserved; public ulong layout_generation; public ulong origin_generation; public double origin_x; public double origin_y; public IntPtr x; public IntPtr y; public IntPtr vx; public IntPtr vy; public IntPtr inverse_mass; public IntPtr particle_of_slot; public IntPtr slot_of_particle; public IntPtr reserved_pointer;
        public static mspring_view Default() { mspring_view made; Native.Init(mspring_struct.MSPRING_STRUCT_VIEW, &made, sizeof(mspring_view)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_column {
        public mspring_property property; public uint stride; public IntPtr values;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_event {
        public mspring_event_kind kind; public uint id; public uint other; public float strain;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_body {
        public uint struct_size; public uint particle_count; public uint head; public uint reserved; public double mass; public double x; public double y; public double vx; public double vy; public double inertia; public double angle; public double spin; public double px; public double py; public double angular; public double min_x; public double min_y; public double max_x; public double max_y;
        public static mspring_body Default() { mspring_body made; Native.Init(mspring_struct.MSPRING_STRUCT_BODY, &made, sizeof(mspring_body)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_energy {
        public uint struct_size; public uint bent_springs; public double kinetic; public double elastic; public double potential; public double dissipated; public ulong yield_count; public double largest_speed; public uint fastest; public uint strained; public double largest_strain;
        public static mspring_energy Default() { mspring_energy made; Native.Init(mspring_struct.MSPRING_STRUCT_ENERGY, &made, sizeof(mspring_energy)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_hook_args {
        public uint struct_size; public mspring_phase phase; public uint substep; public uint substep_count; public uint run_count; public uint worker; public uint first_slot; public uint slot_count; public double dt; public double origin_x; public double origin_y; public IntPtr x; public IntPtr y; public IntPtr vx; public IntPtr vy; public IntPtr force_x; public IntPtr force_y; public IntPtr inverse_mass; public IntPtr particle_of_slot; public IntPtr slot_of_particle; public IntPtr network; public IntPtr storage; public IntPtr result;
        public static mspring_hook_args Default() { mspring_hook_args made; Native.Init(mspring_struct.MSPRING_STRUCT_HOOK_ARGS, &made, sizeof(mspring_hook_args)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_hook_def {
        public uint struct_size; public mspring_phase phase; public IntPtr fn; public IntPtr user; public IntPtr release; public IntPtr retain; public uint period; public uint flags; public uint range_slots; public uint reserved; public IntPtr storage; public UIntPtr storage_stride; public double below_y;
        public static mspring_hook_def Default() { mspring_hook_def made; Native.Init(mspring_struct.MSPRING_STRUCT_HOOK_DEF, &made, sizeof(mspring_hook_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_observation {
        public mspring_property property; public uint index;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_floor_def {
        public uint struct_size; public uint plane_count; public double heights_x; public double heights_y; public double spacing; public IntPtr planes; public IntPtr heights; public uint height_count; public float friction; public float restitution; public uint reserved; public IntPtr plane_frictions; public IntPtr plane_restitutions; public IntPtr height_frictions; public IntPtr height_restitutions; public float silt_depth; public float silt_rate; public IntPtr silt_depths; public IntPtr reserved_pointer;
        public static mspring_floor_def Default() { mspring_floor_def made; Native.Init(mspring_struct.MSPRING_STRUCT_FLOOR_DEF, &made, sizeof(mspring_floor_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_contact_def {
        public uint struct_size; public uint flags; public double thickness; public float friction; public float restitution; public float push_speed; public uint sweeps; public uint capacity; public uint max_capacity; public uint event_capacity; public uint reserved;
        public static mspring_contact_def Default() { mspring_contact_def made; Native.Init(mspring_struct.MSPRING_STRUCT_CONTACT_DEF, &made, sizeof(mspring_contact_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_contact_info {
        public uint struct_size; public uint edges; public uint points; public uint pairs; public uint touching; public uint reserved; public double deepest;
        public static mspring_contact_info Default() { mspring_contact_info made; Native.Init(mspring_struct.MSPRING_STRUCT_CONTACT_INFO, &made, sizeof(mspring_contact_info)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_contact_event {
        public uint struct_size; public mspring_contact_event_kind kind; public uint point; public uint a; public uint b; public uint collider; public double x; public double y; public double normal_x; public double normal_y; public double impulse; public double friction;
        public static mspring_contact_event Default() { mspring_contact_event made; Native.Init(mspring_struct.MSPRING_STRUCT_CONTACT_EVENT, &made, sizeof(mspring_contact_event)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_collider_def {
        public uint struct_size; public mspring_collider_kind kind; public double x; public double y; public double angle; public double width; public double height; public double radius; public IntPtr points; public IntPtr reserved_pointer; public uint point_count; public uint flags; public float friction; public float restitution; public uint layers; public uint masks;
        public static mspring_collider_def Default() { mspring_collider_def made; Native.Init(mspring_struct.MSPRING_STRUCT_COLLIDER_DEF, &made, sizeof(mspring_collider_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_grip_def {
        public uint struct_size; public uint particle; public double x; public double y; public float stiffness; public float damping; public float max_force; public uint reserved;
        public static mspring_grip_def Default() { mspring_grip_def made; Native.Init(mspring_struct.MSPRING_STRUCT_GRIP_DEF, &made, sizeof(mspring_grip_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_settle_def {
        public uint struct_size; public uint flags; public uint max_iterations; public uint reserved; public double tolerance; public double relative_substep;
        public static mspring_settle_def Default() { mspring_settle_def made; Native.Init(mspring_struct.MSPRING_STRUCT_SETTLE_DEF, &made, sizeof(mspring_settle_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_settle_result {
        public uint struct_size; public uint iterations; public double residual; public double largest_force; public double displacement; public uint is_stable; public uint left_alone;
        public static mspring_settle_result Default() { mspring_settle_result made; Native.Init(mspring_struct.MSPRING_STRUCT_SETTLE_RESULT, &made, sizeof(mspring_settle_result)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tune_scene {
        public uint struct_size; public uint flags; public uint start_count; public uint reserved; public double duration; public double kick; public double tolerance; public double max_distance; public IntPtr prepare; public IntPtr reserved_pointer;
        public static mspring_tune_scene Default() { mspring_tune_scene made; Native.Init(mspring_struct.MSPRING_STRUCT_TUNE_SCENE, &made, sizeof(mspring_tune_scene)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tune_def {
        public uint struct_size; public uint setting_count; public double dt; public double duration; public double budget; public mspring_tune_measure measure; public uint flags; public double max_error; public double max_cost; public double max_drift; public IntPtr settings; public IntPtr clock; public IntPtr progress; public IntPtr user; public IntPtr scene; public IntPtr reserved_pointer;
        public static mspring_tune_def Default() { mspring_tune_def made; Native.Init(mspring_struct.MSPRING_STRUCT_TUNE_DEF, &made, sizeof(mspring_tune_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_tune_row {
        public uint struct_size; public uint flags; public uint setting; public uint step_count; public double min_cost; public double median_cost; public double trajectory_error; public double trajectory_share; public double energy_drift; public double bending; public double rest_error; public double rest_share; public double duration; public double moving_cost; public double resting_cost; public uint scene_starts; public uint fine_substeps; public double scene_cost; public double scene_distance; public fixed double scene_mean[3]; public fixed double scene_spread[3]; public fixed double fine_mean[3]; public fixed double fine_spread[3]; public double trajectory_spread; public mspring_settings settings;
        public static mspring_tune_row Default() { mspring_tune_row made; Native.Init(mspring_struct.MSPRING_STRUCT_TUNE_ROW, &made, sizeof(mspring_tune_row)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_area_def {
        public uint struct_size; public mspring_area_kind kind; public float stiffness; public float pressure; public float fill; public float rest_area;
        public static mspring_area_def Default() { mspring_area_def made; Native.Init(mspring_struct.MSPRING_STRUCT_AREA_DEF, &made, sizeof(mspring_area_def)); return made; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct mspring_angle_def {
        public uint struct_size; public float stiffness; public float damping; public float rest_angle;
        public static mspring_angle_def Default() { mspring_angle_def made; Native.Init(mspring_struct.MSPRING_STRUCT_ANGLE_DEF, &made, sizeof(mspring_angle_def)); return made; }
    }

    /// <summary>The C functions as they are. iOS links them into the program.</summary>
    public static unsafe class Native {
#if UNITY_IOS && !UNITY_EDITOR
        const string LIBRARY = "__Internal";
#else
        const string LIBRARY = "massspring";
#endif
        public const uint MSPRING_VERSION_MAJOR = 0u;
        public const uint MSPRING_VERSION_MINOR = 3u;
        public const uint MSPRING_VERSION_PATCH = 0u;
        public const uint MSPRING_VERSION = 3000u;
        public const uint MSPRING_NONE = 4294967295u;
        public const uint MSPRING_ALL = 4294967295u;
        public const uint MSPRING_MAX_PARTICLES = 67108864u;
        public const uint MSPRING_MAX_SPRINGS = 268435456u;
        public const double MSPRING_MAX_COORDINATE = 1000000000000.0;
        public const double MSPRING_MAX_SPEED = 1000000000000000.0;
        public const uint MSPRING_MAX_WORKERS = 256u;
        public const float MSPRING_NEVER = 3.40282347e+38f;
        public const float MSPRING_RELAX_STRAIN_DEFAULT = -1f;
        public const float MSPRING_REST_LENGTH_DISTANCE = -1f;
        public const float MSPRING_HARDENING_DEFAULT = 0.1f;
        public const float MSPRING_PLASTIC_LIMIT_DEFAULT = 0.5f;
        public const uint MSPRING_CELL_EMPTY = 65535u;
        public const uint MSPRING_MAX_SUBSTEPS = 1000000u;
        public const uint MSPRING_SUBSTEPS_AUTO = 4294967295u;
        public const uint MSPRING_SUBSTEPS_EVEN = 4294967294u;
        public const uint MSPRING_MAX_PLANES = 8u;
        public const uint MSPRING_MAX_HEIGHTS = 67108864u;
        public const uint MSPRING_MAX_COLLIDER_POINTS = 65536u;
        public const uint MSPRING_MAX_GRIPS = 16u;
        public const uint MSPRING_TUNE_QUANTITIES = 3u;
        public const uint MSPRING_MAX_AREA_PARTICLES = 4096u;
        public const float MSPRING_REST_ANGLE_PRESENT = 3.40282347e+38f;
        public const uint MSPRING_MAX_GRADIENT_STEPS = 16777216u;
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
        public const uint MSPRING_PARTICLE_ASLEEP = 256u;
        public const uint MSPRING_PARTICLE_REMOVED = 1024u;
        public const uint MSPRING_SPRING_RELATIVE = 1u;
        public const uint MSPRING_SPRING_DAMPING_RATIO = 2u;
        public const uint MSPRING_SPRING_PULL_ONLY = 4u;
        public const uint MSPRING_SPRING_PUSH_ONLY = 8u;
        public const uint MSPRING_SPRING_METRES = 16u;
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
        public const uint MSPRING_FIND_WHOLE = 1u;
        public const uint MSPRING_FIND_BROKEN = 2u;
        public const uint MSPRING_HOOK_CONCURRENT = 1u;
        public const uint MSPRING_HOOK_BELOW = 2u;
        public const uint MSPRING_GROUP_HELD = 1u;
        public const uint MSPRING_CONTACT_SELF = 1u;
        public const uint MSPRING_COLLIDER_CLOSED = 1u;
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
        public const uint MSPRING_ELEMENT_AREA = 1u;
        public const uint MSPRING_ELEMENT_ANGLE = 2u;
        public const uint MSPRING_ELEMENT_OPEN = 4u;
        public const uint MSPRING_ELEMENT_REMOVED = 1024u;

        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_version();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_version_string();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_features();
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_result_string(mspring_result result);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_init(mspring_struct kind, void* made, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_simd_available(mspring_simd level);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_simd_name(mspring_simd level);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_material_preset(mspring_material* material, mspring_preset preset, double spacing, double substep);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_create(mspring_allocator* allocator, IntPtr* builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_builder_destroy(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_builder_error(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_builder_forget_error(IntPtr builder);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_builder_count(IntPtr builder, mspring_kind kind);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_particles(IntPtr builder, mspring_particle_def* defs, uint count, uint* first_id);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_springs(IntPtr builder, mspring_spring_def* defs, uint count, uint* first_id);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_lattice(IntPtr builder, mspring_lattice_def* def, uint* cell_ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_rope(IntPtr builder, mspring_rope_def* def, uint* particles, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_mesh(IntPtr builder, mspring_mesh_def* def, uint* first_particle, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_disc(IntPtr builder, mspring_disc_def* def, uint* first_particle, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_copies(IntPtr builder, IntPtr from, uint count, double* x, double* y, uint stride, uint* first_particle, uint* first_spring);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_network(IntPtr builder, IntPtr network, uint* ids, uint first, uint count, uint* particle_ids, uint* spring_ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_get_particles(IntPtr builder, uint* ids, uint first, uint count, mspring_particle_def* defs);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_get_springs(IntPtr builder, uint* ids, uint first, uint count, mspring_spring_def* defs);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_read(IntPtr builder, void* archive, UIntPtr size, uint* skipped);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_get_network_def(IntPtr builder, mspring_network_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_create(IntPtr builder, mspring_network_def* def, IntPtr* network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_network_destroy(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_network_error(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern uint mspring_network_count(IntPtr network, mspring_kind kind);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_clone(IntPtr network, mspring_clone_def* def, IntPtr* clone);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_info(IntPtr network, mspring_network_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_settings(IntPtr network, mspring_settings* settings);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_settings(IntPtr network, mspring_settings* settings);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_step(IntPtr network, double dt);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_step_info(IntPtr network, mspring_step_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_wake(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_force(IntPtr network, uint particle, float x, float y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_forces(IntPtr network, mspring_push push, uint* ids, uint first, uint count, float* x, float* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_apply_torque(IntPtr network, uint* ids, uint first, uint count, float torque);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_positions(IntPtr network, uint* ids, uint first, uint count, double* x, double* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_positions(IntPtr network, uint* ids, uint first, uint count, double* x, double* y, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_velocities(IntPtr network, uint* ids, uint first, uint count, float* vx, float* vy, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_velocities(IntPtr network, uint* ids, uint first, uint count, float* vx, float* vy, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_view(IntPtr network, mspring_view* view);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_state_hash(IntPtr network, ulong* hash);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get(IntPtr network, mspring_property property, uint* ids, uint first, uint count, float* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set(IntPtr network, mspring_property property, uint* ids, uint first, uint count, float* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_integers(IntPtr network, mspring_property property, uint* ids, uint first, uint count, uint* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_integers(IntPtr network, mspring_property property, uint* ids, uint first, uint count, uint* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_columns(IntPtr network, uint* ids, uint first, uint count, mspring_column* columns, uint column_count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_break_springs(IntPtr network, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_restore_springs(IntPtr network, uint* ids, uint first, uint count, double ramp_seconds);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_detach_particles(IntPtr network, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_particles(IntPtr network, mspring_particle_def* defs, uint count, uint* ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_springs(IntPtr network, mspring_spring_def* defs, uint count, uint* ids);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_particles(IntPtr network, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_springs(IntPtr network, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_reuse_ids(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_compact(IntPtr network);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_reserve_events(IntPtr network, uint capacity);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_read_events(IntPtr network, mspring_event* events, uint capacity, uint* count, ulong* lost);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_update_components(IntPtr network, uint* count, uint* changed);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_body(IntPtr network, uint* ids, uint first, uint count, mspring_body* body);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_components(IntPtr network, uint first, uint count, mspring_body* bodies);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_energy(IntPtr network, mspring_energy* energy);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_stable_dt(IntPtr network, double* now, double* any_shape);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_suggest_substeps(IntPtr network, double dt, double safety, uint* substeps);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_nearest_particle(IntPtr network, double x, double y, double within, uint* particle, double* distance);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_nearest_spring(IntPtr network, double x, double y, double within, uint flags, uint* spring, double* fraction, double* distance);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_particles_in_circle(IntPtr network, double x, double y, double radius, uint* particles, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_particles_in_box(IntPtr network, double min_x, double min_y, double max_x, double max_y, uint* particles, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_springs_in_circle(IntPtr network, double x, double y, double radius, uint flags, uint* springs, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_springs_across(IntPtr network, double from_x, double from_y, double to_x, double to_y, uint flags, uint* springs, double* fractions, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_hook(IntPtr network, mspring_hook_def* def, uint* hook);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_hook(IntPtr network, uint hook);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_snapshot_size(IntPtr network, mspring_snapshot_contents contents, UIntPtr* size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_save(IntPtr network, mspring_snapshot_contents contents, void* snapshot, UIntPtr capacity, UIntPtr* size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_load(IntPtr network, void* snapshot, UIntPtr size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_write(IntPtr network, IntPtr write, void* user);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_groups(IntPtr network, uint* firsts, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_mark_groups(IntPtr network, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_reset_groups(IntPtr network, mspring_reset to, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_observe_groups(IntPtr network, uint* ids, uint first, uint count, mspring_observation* columns, uint column_count, double* rows, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_actuators(IntPtr network, uint* springs, uint count, uint changes);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_floor(IntPtr network, mspring_floor_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_floor(IntPtr network, mspring_floor_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_contact(IntPtr network, mspring_contact_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_contact(IntPtr network, mspring_contact_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_contact_info(IntPtr network, mspring_contact_info* info);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_read_contact_events(IntPtr network, mspring_contact_event* events, uint capacity, uint* count, ulong* lost);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_collider(IntPtr network, mspring_collider_def* def, uint* collider);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_collider(IntPtr network, uint collider);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_move_collider(IntPtr network, uint collider, double x, double y, double angle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_place_collider(IntPtr network, uint collider, double x, double y, double angle);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_collider(IntPtr network, uint collider, mspring_collider_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_collider_impulse(IntPtr network, uint collider, double* x, double* y, double* angular);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_grip(IntPtr network, mspring_grip_def* def, uint* grip);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_grip(IntPtr network, uint grip);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_set_grip(IntPtr network, uint grip, mspring_grip_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_move_grip(IntPtr network, uint grip, double x, double y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_grip(IntPtr network, uint grip, mspring_grip_def* def);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_grip_impulse(IntPtr network, uint grip, double* x, double* y);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_builder_add_strain_limits(IntPtr builder, uint* ids, uint first, uint count, float strain, float stiffening, uint* first_limit);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_settle(IntPtr network, mspring_settle_def* def, mspring_settle_result* result);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_tune_settings(IntPtr network, double dt, mspring_settings* settings, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_tune(IntPtr network, mspring_tune_def* def, mspring_tune_row* rows, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_describe(IntPtr network, byte* text, UIntPtr capacity, UIntPtr* size);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_job_begin(IntPtr network, mspring_layout layout, IntPtr* job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_job_run(IntPtr job, uint at_most, uint* left);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_job_finish(IntPtr network, IntPtr job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_job_error(IntPtr job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_job_destroy(IntPtr job);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_area(IntPtr network, mspring_area_def* def, uint* particles, uint count, uint* element);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_cell_areas(IntPtr network, mspring_area_def* def, uint* first_element, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_add_angles(IntPtr network, mspring_angle_def* def, uint* particles, uint count, uint stride, uint* first_element);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_remove_elements(IntPtr network, uint* ids, uint first, uint count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_network_get_element_particles(IntPtr network, uint element, uint* particles, uint capacity, uint* count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_create(IntPtr network, uint step_count, uint* forced, uint forced_count, IntPtr* gradient);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern void mspring_gradient_destroy(IntPtr gradient);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern byte* mspring_gradient_error(IntPtr gradient);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_step(IntPtr gradient, double dt, float* signals, float* forces);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_add_seeds(IntPtr gradient, uint* ids, uint first, uint count, double* positions, double* velocities);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_reverse(IntPtr gradient, uint step_count);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_get(IntPtr gradient, mspring_gradient_of of, uint* ids, uint first, uint count, double* values, uint stride);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_get_signals(IntPtr gradient, uint step, double* values);
        [DllImport(LIBRARY, CallingConvention = CallingConvention.Cdecl)] public static extern mspring_result mspring_gradient_get_forces(IntPtr gradient, uint step, double* values);
        internal static void Init(mspring_struct kind, void* made, int size) { MassSpringException.Check(mspring_init(kind, made, (UIntPtr)size)); }
    }
}
