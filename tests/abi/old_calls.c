/// @file old_calls.c
/// What a program of 0.2 may have that is otherwise in 0.3, a line for each: no line compiles (abi/check old_calls).
///
/// Arguments are those that compilers take for anything: NULL and 0. So what refuses a call is its name, or how many
/// arguments it has.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring_batch.h>
#include <massspring/massspring_contact.h>
#include <massspring/massspring_laws.h>
#include <massspring/massspring_tools.h>

extern mspring_builder *builder;
extern mspring_network *network;

// Calls.
static void call_1(void) { (void)mspring_allocator_init(NULL, 0); }
static void call_2(void) { (void)mspring_angle_def_init(NULL, 0); }
static void call_3(void) { (void)mspring_area_def_init(NULL, 0); }
static void call_4(void) { (void)mspring_builder_add_network(builder, network, NULL, 0, NULL, NULL); }
static void call_5(void) { (void)mspring_builder_add_particle(builder, NULL, NULL); }
static void call_6(void) { (void)mspring_builder_add_rope(builder, NULL, NULL, 0, NULL); }
static void call_7(void) { (void)mspring_builder_add_spring(builder, NULL, NULL); }
static void call_8(void) { (void)mspring_builder_add_strain_limits(builder, 0, 0, 0, 0, NULL); }
static void call_9(void) { (void)mspring_builder_particle_count(builder); }
static void call_10(void) { (void)mspring_builder_spring_count(builder); }
static void call_11(void) { (void)mspring_clone_def_init(NULL, 0); }
static void call_12(void) { (void)mspring_collider_def_init(NULL, 0); }
static void call_13(void) { (void)mspring_contact_def_init(NULL, 0); }
static void call_14(void) { (void)mspring_disc_def_init(NULL, 0); }
static void call_15(void) { (void)mspring_floor_def_init(NULL, 0); }
static void call_16(void) { (void)mspring_grip_def_init(NULL, 0); }
static void call_17(void) { (void)mspring_hook_def_init(NULL, 0); }
static void call_18(void) { (void)mspring_lattice_def_init(NULL, 0); }
static void call_19(void) { (void)mspring_material_init(NULL, 0); }
static void call_20(void) { (void)mspring_material_preset(NULL, 0, 0, 0, 0); }
static void call_21(void) { (void)mspring_mesh_def_init(NULL, 0); }
static void call_22(void) { (void)mspring_network_actuator_count(network); }
static void call_23(void) { (void)mspring_network_add_angles(network, NULL, NULL, 0, NULL); }
static void call_24(void) { (void)mspring_network_apply_forces(network, 0, 0, NULL, NULL, 0); }
static void call_25(void) { (void)mspring_network_apply_forces_at(network, NULL, 0, NULL, NULL, 0); }
static void call_26(void) { (void)mspring_network_apply_impulses(network, 0, 0, NULL, NULL, 0); }
static void call_27(void) { (void)mspring_network_apply_impulses_at(network, NULL, 0, NULL, NULL, 0); }
static void call_28(void) { (void)mspring_network_bounds(network, NULL, NULL, NULL, NULL); }
static void call_29(void) { (void)mspring_network_break_springs(network, NULL, 0); }
static void call_30(void) { (void)mspring_network_def_init(NULL, 0); }
static void call_31(void) { (void)mspring_network_detach_particles(network, NULL, 0); }
static void call_32(void) { (void)mspring_network_energy(network, NULL, NULL, NULL); }
static void call_33(void) { (void)mspring_network_expand(network); }
static void call_34(void) { (void)mspring_network_get(network, 0, 0, 0, NULL, 0); }
static void call_35(void) { (void)mspring_network_get_angle(network, 0, NULL); }
static void call_36(void) { (void)mspring_network_get_angle_info(network, 0, (mspring_angle_info *)0); }
static void call_37(void) { (void)mspring_network_get_angles(network, NULL, NULL, NULL, 0, NULL); }
static void call_38(void) { (void)mspring_network_get_area(network, 0, NULL); }
static void call_39(void) { (void)mspring_network_get_area_info(network, 0, (mspring_area_info *)0); }
static void call_40(void) { (void)mspring_network_get_area_particles(network, 0, NULL, 0, NULL); }
static void call_41(void) { (void)mspring_network_get_areas(network, NULL, NULL, NULL, 0, NULL); }
static void call_42(void) { (void)mspring_network_get_at(network, 0, NULL, 0, NULL, 0); }
static void call_43(void) { (void)mspring_network_get_component_numbers(network, 0, 0, NULL, 0); }
static void call_44(void) { (void)mspring_network_get_components(network, 0, 0, (mspring_component *)0); }
static void call_45(void) { (void)mspring_network_get_ends(network, 0, 0, 0, NULL, NULL, 0); }
static void call_46(void) { (void)mspring_network_get_extents(network, NULL, NULL, NULL, NULL); }
static void call_47(void) { (void)mspring_network_get_floor_impulses(network, 0, 0, NULL, NULL, 0); }
static void call_48(void) { (void)mspring_network_get_group_flags(network, 0, 0, NULL, 0); }
static void call_49(void) { (void)mspring_network_get_plan(network, (mspring_plan *)0); }
static void call_50(void) { (void)mspring_network_get_plasticity(network, (mspring_plasticity *)0); }
static void call_51(void) { (void)mspring_network_get_positions(network, 0, 0, NULL, NULL, 0); }
static void call_52(void) { (void)mspring_network_get_positions_at(network, NULL, 0, NULL, NULL, 0); }
static void call_53(void) { (void)mspring_network_get_positions_float(network, 0, 0, NULL, NULL, 0); }
static void call_54(void) { (void)mspring_network_get_positions_float_at(network, NULL, 0, NULL, NULL, 0); }
static void call_55(void) { (void)mspring_network_get_sleepers(network, 0, 0, NULL, 0); }
static void call_56(void) { (void)mspring_network_get_solver(network, (mspring_solver_def *)0); }
static void call_57(void) { (void)mspring_network_get_spring(network, 0, (mspring_spring_info *)0); }
static void call_58(void) { (void)mspring_network_get_spring_flags(network, 0, 0, NULL, 0); }
static void call_59(void) { (void)mspring_network_get_velocities(network, 0, 0, NULL, NULL, 0); }
static void call_60(void) { (void)mspring_network_get_velocities_at(network, NULL, 0, NULL, NULL, 0); }
static void call_61(void) { (void)mspring_network_group_count(network); }
static void call_62(void) { (void)mspring_network_has_particle(network, 0); }
static void call_63(void) { (void)mspring_network_has_spring(network, 0); }
static void call_64(void) { (void)mspring_network_is_asleep(network); }
static void call_65(void) { (void)mspring_network_mark_groups(network, NULL, 0); }
static void call_66(void) { (void)mspring_network_max_strain(network, NULL, NULL); }
static void call_67(void) { (void)mspring_network_memory_used(network); }
static void call_68(void) { (void)mspring_network_momentum(network, NULL, NULL, NULL); }
static void call_69(void) { (void)mspring_network_observe_groups(network, 0, 0, NULL, 0, NULL, 0); }
static void call_70(void) { (void)mspring_network_particle_count(network); }
static void call_71(void) { (void)mspring_network_recycle(network); }
static void call_72(void) { (void)mspring_network_remove_angle(network, 0); }
static void call_73(void) { (void)mspring_network_remove_area(network, 0); }
static void call_74(void) { (void)mspring_network_remove_particles(network, NULL, 0); }
static void call_75(void) { (void)mspring_network_remove_springs(network, NULL, 0); }
static void call_76(void) { (void)mspring_network_renew_relative_springs(network); }
static void call_77(void) { (void)mspring_network_reserve_contact_events(network, 0); }
static void call_78(void) { (void)mspring_network_reset_groups(network, NULL, 0, 0); }
static void call_79(void) { (void)mspring_network_restore_springs(network, NULL, 0, 0); }
static void call_80(void) { (void)mspring_network_set(network, 0, 0, 0, NULL, 0); }
static void call_81(void) { (void)mspring_network_set_angle(network, 0, NULL); }
static void call_82(void) { (void)mspring_network_set_area(network, 0, NULL); }
static void call_83(void) { (void)mspring_network_set_at(network, 0, NULL, 0, NULL, 0); }
static void call_84(void) { (void)mspring_network_set_contact_groups(network, 0, 0, 0, 0); }
static void call_85(void) { (void)mspring_network_set_contact_surface(network, 0, 0, 0, 0); }
static void call_86(void) { (void)mspring_network_set_positions(network, 0, 0, NULL, NULL, 0); }
static void call_87(void) { (void)mspring_network_set_positions_at(network, NULL, 0, NULL, NULL, 0); }
static void call_88(void) { (void)mspring_network_set_positions_float(network, 0, 0, NULL, NULL, 0); }
static void call_89(void) { (void)mspring_network_set_positions_float_at(network, NULL, 0, NULL, NULL, 0); }
static void call_90(void) { (void)mspring_network_set_rest_angles(network, 0, 0, NULL, 0); }
static void call_91(void) { (void)mspring_network_set_signals(network, 0, 0, NULL, 0); }
static void call_92(void) { (void)mspring_network_set_solver(network, (mspring_solver_def *)0); }
static void call_93(void) { (void)mspring_network_set_velocities(network, 0, 0, NULL, NULL, 0); }
static void call_94(void) { (void)mspring_network_set_velocities_at(network, NULL, 0, NULL, NULL, 0); }
static void call_95(void) { (void)mspring_network_simd_level(network); }
static void call_96(void) { (void)mspring_network_snapshot_size(network, 0, NULL); }
static void call_97(void) { (void)mspring_network_spring_count(network); }
static void call_98(void) { (void)mspring_network_stable_dt(network, NULL, NULL); }
static void call_99(void) { (void)mspring_network_state_hash(network, NULL); }
static void call_100(void) { (void)mspring_network_step_flags(network); }
static void call_101(void) { (void)mspring_network_view(network, NULL); }
static void call_102(void) { (void)mspring_network_view_mutable(network, (mspring_mutable_view *)0); }
static void call_103(void) { (void)mspring_network_worker_count(network); }
static void call_104(void) { (void)mspring_particle_def_init(NULL, 0); }
static void call_105(void) { (void)mspring_rope_def_init(NULL, 0); }
static void call_106(void) { (void)mspring_settings_init(NULL, 0); }
static void call_107(void) { (void)mspring_settle_def_init(NULL, 0); }
static void call_108(void) { (void)mspring_simd_supported(); }
static void call_109(void) { (void)mspring_solver_def_init((mspring_solver_def *)0, 0); }
static void call_110(void) { (void)mspring_spring_def_init(NULL, 0); }
static void call_111(void) { (void)mspring_tasks_init(NULL, 0); }
static void call_112(void) { (void)mspring_tune_def_init(NULL, 0); }
static void call_113(void) { (void)mspring_tune_row_solver(NULL, (mspring_solver_def *)0); }
static void call_114(void) { (void)mspring_tune_scene_init(NULL, 0); }
static void call_115(void) { (void)mspring_tune_settings(network, 0, (mspring_solver_def *)0, 0, NULL); }

// Structs and enums.
static void type_1(mspring_solver_def *it) { (void)it; }
static void type_2(mspring_component *it) { (void)it; }
static void type_3(mspring_plasticity *it) { (void)it; }
static void type_4(mspring_area_info *it) { (void)it; }
static void type_5(mspring_angle_info *it) { (void)it; }
static void type_6(mspring_mutable_view *it) { (void)it; }
static void type_7(mspring_spring_info *it) { (void)it; }
static void type_8(mspring_plan *it) { (void)it; }
static void type_9(mspring_numbering *it) { (void)it; }

// Fields of structs that there still are.
static void field_1(mspring_spring_def *it) { (void)it->stress_strain; }
static void field_2(mspring_material *it) { (void)it->stress_strain; }
static void field_3(mspring_network_def *it) { (void)it->guard; }
static void field_4(mspring_network_def *it) { (void)it->gravity_x; }
static void field_5(mspring_network_def *it) { (void)it->gravity_y; }
static void field_6(mspring_network_def *it) { (void)it->global_damping; }
static void field_7(mspring_network_def *it) { (void)it->max_speed; }
static void field_8(mspring_network_def *it) { (void)it->sleep_speed; }
static void field_9(mspring_network_def *it) { (void)it->sleep_time; }
static void field_10(mspring_network_def *it) { (void)it->relax_fraction; }
static void field_11(mspring_network_def *it) { (void)it->solver; }
static void field_12(mspring_network_def *it) { (void)it->substeps; }
static void field_13(mspring_network_def *it) { (void)it->max_substeps; }
static void field_14(mspring_network_def *it) { (void)it->integrator; }
static void field_15(mspring_network_def *it) { (void)it->iterations; }
static void field_16(mspring_network_def *it) { (void)it->tile_size; }
static void field_17(mspring_network_def *it) { (void)it->coarse_period; }
static void field_18(mspring_step_info *it) { (void)it->largest_speed; }
static void field_19(mspring_collider_def *it) { (void)it->groups; }
static void field_20(mspring_angle_def *it) { (void)it->flags; }
static void field_21(mspring_rope_def *it) { (void)it->spring_flags; }
static void field_22(mspring_rope_def *it) { (void)it->mass; }
static void field_23(mspring_rope_def *it) { (void)it->stiffness; }
static void field_24(mspring_rope_def *it) { (void)it->damping; }
static void field_25(mspring_rope_def *it) { (void)it->slack; }
static void field_26(mspring_rope_def *it) { (void)it->break_strain; }
static void field_27(mspring_rope_def *it) { (void)it->stress_strain; }
static void field_28(mspring_rope_def *it) { (void)it->relax_strain; }
static void field_29(mspring_rope_def *it) { (void)it->yield_strain; }
static void field_30(mspring_rope_def *it) { (void)it->hardening; }
static void field_31(mspring_rope_def *it) { (void)it->plastic_limit; }
static void field_32(mspring_mesh_def *it) { (void)it->spring_flags; }
static void field_33(mspring_mesh_def *it) { (void)it->stiffness; }
static void field_34(mspring_mesh_def *it) { (void)it->damping; }
static void field_35(mspring_mesh_def *it) { (void)it->break_strain; }
static void field_36(mspring_mesh_def *it) { (void)it->stress_strain; }
static void field_37(mspring_mesh_def *it) { (void)it->relax_strain; }
static void field_38(mspring_mesh_def *it) { (void)it->yield_strain; }
static void field_39(mspring_mesh_def *it) { (void)it->hardening; }
static void field_40(mspring_mesh_def *it) { (void)it->plastic_limit; }
static void field_41(mspring_disc_def *it) { (void)it->spring_flags; }
static void field_42(mspring_disc_def *it) { (void)it->stiffness; }
static void field_43(mspring_disc_def *it) { (void)it->damping; }
static void field_44(mspring_disc_def *it) { (void)it->break_strain; }
static void field_45(mspring_disc_def *it) { (void)it->stress_strain; }
static void field_46(mspring_disc_def *it) { (void)it->relax_strain; }
static void field_47(mspring_disc_def *it) { (void)it->yield_strain; }
static void field_48(mspring_disc_def *it) { (void)it->hardening; }
static void field_49(mspring_disc_def *it) { (void)it->plastic_limit; }
static void field_50(mspring_clone_def *it) { (void)it->flags; }
static void field_51(mspring_hook_args *it) { (void)it->group_count; }
static void field_52(mspring_tune_row *it) { (void)it->solver; }
static void field_53(mspring_tune_row *it) { (void)it->integrator; }
static void field_54(mspring_tune_row *it) { (void)it->substeps; }
static void field_55(mspring_tune_row *it) { (void)it->iterations; }
static void field_56(mspring_tune_row *it) { (void)it->tile_size; }
static void field_57(mspring_tune_row *it) { (void)it->coarse_period; }
static void field_58(mspring_tune_row *it) { (void)it->residual; }

// Constants.
static double constant_1(void) { return MSPRING_INTEGRATOR_GA0; }
static double constant_2(void) { return MSPRING_STRESS_STRAIN; }
static double constant_3(void) { return MSPRING_FORCE; }
static double constant_4(void) { return MSPRING_ENDS_IDS; }
static double constant_5(void) { return MSPRING_ENDS_SLOTS; }
static double constant_6(void) { return MSPRING_OBSERVE_X; }
static double constant_7(void) { return MSPRING_OBSERVE_Y; }
static double constant_8(void) { return MSPRING_OBSERVE_VX; }
static double constant_9(void) { return MSPRING_OBSERVE_VY; }
static double constant_10(void) { return MSPRING_OBSERVE_MIN_X; }
static double constant_11(void) { return MSPRING_OBSERVE_MIN_Y; }
static double constant_12(void) { return MSPRING_OBSERVE_MAX_X; }
static double constant_13(void) { return MSPRING_OBSERVE_MAX_Y; }
static double constant_14(void) { return MSPRING_OBSERVE_HELD; }
static double constant_15(void) { return MSPRING_OBSERVE_PARTICLES; }
static double constant_16(void) { return MSPRING_ANGLE_REST_GIVEN; }
static double constant_17(void) { return MSPRING_CLONE_HOOKS; }
