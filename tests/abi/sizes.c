/// @file sizes.c
/// Sizes of all public structs, with pointers of 64 and of 32 bits. Compiled only.
///
/// They are the sums of their fields: there is no padding, so a new field makes its struct larger on every system,
/// and what an old program left there is never read.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL
#include <massspring/massspring.h>
#include <massspring/massspring_gradient.h>

#define SIZE(type, on_64_bits, on_32_bits)                                                                         \
    _Static_assert(sizeof(void *) == 8   ? sizeof(type) == (on_64_bits)                                            \
                   : sizeof(void *) == 4 ? sizeof(type) == (on_32_bits)                                            \
                                         : 1,                                                                      \
                   "the size of " #type " is another");

SIZE(mspring_allocator, 32, 20)
SIZE(mspring_tasks, 40, 28)
SIZE(mspring_particle_def, 40, 40)
SIZE(mspring_spring_def, 52, 52)
SIZE(mspring_material, 48, 48)
SIZE(mspring_lattice_def, 64, 56)
SIZE(mspring_rope_def, 32, 28)
SIZE(mspring_mesh_def, 56, 40)
SIZE(mspring_disc_def, 64, 56)
SIZE(mspring_settings, 80, 80)
SIZE(mspring_network_def, 152, 136)
SIZE(mspring_clone_def, 32, 24)
SIZE(mspring_network_info, 48, 48)
SIZE(mspring_step_info, 72, 72)
SIZE(mspring_view, 112, 80)
SIZE(mspring_column, 16, 12)
SIZE(mspring_event, 16, 16)
SIZE(mspring_body, 136, 136)
SIZE(mspring_energy, 72, 72)
SIZE(mspring_hook_args, 152, 104)
SIZE(mspring_hook_def, 80, 56)
SIZE(mspring_floor_def, 120, 88)
SIZE(mspring_contact_def, 48, 48)
SIZE(mspring_contact_info, 32, 32)
SIZE(mspring_contact_event, 72, 72)
SIZE(mspring_collider_def, 96, 88)
SIZE(mspring_grip_def, 40, 40)
SIZE(mspring_area_def, 24, 24)
SIZE(mspring_angle_def, 16, 16)
SIZE(mspring_observation, 8, 8)
SIZE(mspring_settle_def, 32, 32)
SIZE(mspring_settle_result, 40, 40)
SIZE(mspring_tune_scene, 64, 56)
SIZE(mspring_tune_def, 112, 88)
SIZE(mspring_tune_row, 312, 312)

#define ENUM(type) _Static_assert(sizeof(type) == 4 && (type)-1 < 0, #type " is no int of 32 bits");

ENUM(mspring_result)
ENUM(mspring_struct)
ENUM(mspring_simd)
ENUM(mspring_kind)
ENUM(mspring_preset)
ENUM(mspring_solver)
ENUM(mspring_integrator)
ENUM(mspring_guard)
ENUM(mspring_push)
ENUM(mspring_property)
ENUM(mspring_event_kind)
ENUM(mspring_phase)
ENUM(mspring_snapshot_contents)
ENUM(mspring_contact_event_kind)
ENUM(mspring_collider_kind)
ENUM(mspring_area_kind)
ENUM(mspring_reset)
ENUM(mspring_tune_measure)
ENUM(mspring_layout)
ENUM(mspring_gradient_of)
