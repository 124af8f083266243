/// The calls of a life.
#include "fail_nth.h"

#include <stdlib.h>

#include "support.h"

static mspring_result make_builder(life *l) {
    return mspring_builder_create(&l->allocator, &l->builder);
}

static mspring_result add_particles(life *l) {
    return mspring_builder_add_particles(l->builder, l->made.particles, l->made.particle_count, NULL);
}

static mspring_result add_particle(life *l) {
    return mspring_builder_add_particles(l->builder, &l->made.particles[0], 1, NULL);
}

static mspring_result add_springs(life *l) {
    return mspring_builder_add_springs(l->builder, l->made.springs, l->made.spring_count, NULL);
}

static mspring_result add_spring(life *l) {
    mspring_spring_def def = mspring_spring_def_default();
    def.a = 1;
    def.b = l->made.particle_count; // the one added alone
    def.stiffness = 0.1f;
    def.flags = MSPRING_SPRING_RELATIVE;
    def.rest_length = 2;
    return mspring_builder_add_springs(l->builder, &def, 1, NULL);
}

static mspring_result add_lattice(life *l) {
    static const uint16_t cells[20 * 10] = {0};
    mspring_material material;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    material.stiffness = 100;
    def.width = 20, def.height = 10, def.x = 50, def.cells = cells, def.materials = &material;
    def.material_count = 1;
    return mspring_builder_add_lattice(l->builder, &def, NULL);
}

static mspring_result add_rope(life *l) {
    mspring_material def_material = mspring_material_default();
    mspring_rope_def def = mspring_rope_def_default();
    def.material = &def_material;
    def.from = 2, def.to = l->made.particle_count + 5, def.segment_count = 30, def_material.stiffness = 100;
    return mspring_builder_add_rope(l->builder, &def, NULL, NULL);
}

static mspring_result add_disc(life *l) {
    const mspring_material material = mspring_material_default();
    mspring_disc_def def = mspring_disc_def_default();
    def.material = &material;
    def.ring_count = 6, def.y = 50, def.young_modulus = 100;
    return mspring_builder_add_disc(l->builder, &def, NULL, NULL);
}

static mspring_result add_network(life *l) {
    return mspring_builder_add_network(l->builder, l->network, NULL, 0, MSPRING_ALL, NULL, NULL);
}

static mspring_result create(life *l) {
    mspring_network_def def = support_def(-9.8f, 2);
    def.allocator = &l->allocator;
    def.flags = MSPRING_NETWORK_RESERVE_DAMPING;
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    def.spare_particles = 5;
    def.spare_springs = 5;
    return mspring_network_create(l->builder, &def, &l->network);
}

static mspring_result step(life *l) {
    return mspring_network_step(l->network, 0.005);
}

static mspring_result apply_force(life *l) {
    return mspring_network_apply_force(l->network, 1, 2, 3);
}

static mspring_result apply_forces(life *l) {
    const float x[2] = {1, 2}, y[2] = {3, 4};
    return mspring_network_apply_forces(l->network, MSPRING_PUSH_STEP, NULL, 2, 2, x, y, 1);
}

static mspring_result apply_blows(life *l) {
    const float x[2] = {1, 2}, y[2] = {3, 4};
    return mspring_network_apply_forces(l->network, MSPRING_PUSH_SUBSTEP, NULL, 2, 2, x, y, 1);
}

static void push(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; args->force_x && slot < args->first_slot + args->slot_count; slot++)
        args->force_x[slot] += 0.01f;
}

static mspring_result hook(life *l, mspring_phase phase, uint32_t period) {
    mspring_hook_def def = mspring_hook_def_default();
    def.phase = phase;
    def.period = period;
    def.fn = push;
    return mspring_network_add_hook(l->network, &def, NULL);
}

static mspring_result hook_before_step(life *l) {
    return hook(l, MSPRING_PHASE_BEFORE_STEP, 1);
}

static mspring_result hook_before_substep(life *l) {
    return hook(l, MSPRING_PHASE_BEFORE_SUBSTEP, 1);
}

static mspring_result hook_with_period(life *l) {
    return hook(l, MSPRING_PHASE_BEFORE_SUBSTEP, 2);
}

static mspring_result stable_dt(life *l) {
    double now = 0, any_shape = 0;
    return mspring_network_get_stable_dt(l->network, &now, &any_shape);
}

static mspring_result suggest_substeps(life *l) {
    uint32_t substeps = 0;
    return mspring_network_suggest_substeps(l->network, 0.01, 0.9, &substeps);
}

static mspring_result set_masses(life *l) {
    const float masses[3] = {3, 4, 5};
    return mspring_network_set(l->network, MSPRING_MASS, NULL, 1, 3, masses, 1);
}

static mspring_result set_scales(life *l) {
    const float scales[2] = {0.5f, 0};
    return mspring_network_set(l->network, MSPRING_INVERSE_MASS_SCALE, NULL, 4, 2, scales, 1);
}

static mspring_result set_rest_lengths(life *l) {
    const float lengths[2] = {1.01f, 1.02f};
    return mspring_network_set(l->network, MSPRING_REST_LENGTH, NULL, 5, 2, lengths, 1);
}

static mspring_result break_springs(life *l) {
    const mspring_id springs[3] = {1, 7, 9};
    return mspring_network_break_springs(l->network, springs, 0, 3);
}

static mspring_result restore_springs(life *l) {
    const mspring_id springs[2] = {7, 9};
    return mspring_network_restore_springs(l->network, springs, 0, 2, 0.5);
}

static mspring_result detach(life *l) {
    const mspring_id particle = 8;
    return mspring_network_detach_particles(l->network, &particle, 0, 1);
}

static mspring_result grow_particle(life *l) {
    mspring_particle_def particle = mspring_particle_def_default();
    particle.x = 3, particle.y = 10;
    return mspring_network_add_particles(l->network, &particle, 1, &l->added);
}

static mspring_result grow_spring(life *l) {
    mspring_spring_def spring = mspring_spring_def_default();
    mspring_id id;
    spring.a = 1, spring.b = l->added, spring.stiffness = 50, spring.flags = MSPRING_SPRING_METRES;
    return mspring_network_add_springs(l->network, &spring, 1, &id);
}

static mspring_result remove_particle(life *l) {
    const mspring_id particle = 12;
    return mspring_network_remove_particles(l->network, &particle, 0, 1);
}

static mspring_result remove_springs(life *l) {
    const mspring_id springs[2] = {80, 81};
    return mspring_network_remove_springs(l->network, springs, 0, 2);
}

static mspring_result set_break_strains(life *l) {
    const float strains[2] = {0.4f, 0.5f};
    return mspring_network_set(l->network, MSPRING_BREAK_STRAIN, NULL, 3, 2, strains, 1);
}

static mspring_result set_stress_strains(life *l) {
    const float strains[2] = {0.1f, 0.2f};
    return mspring_network_set(l->network, MSPRING_WARN_STRAIN, NULL, 3, 2, strains, 1);
}

static mspring_result set_yield_strains(life *l) {
    const float strains[2] = {0.01f, 0.02f};
    return mspring_network_set(l->network, MSPRING_YIELD_STRAIN, NULL, 3, 2, strains, 1);
}

static mspring_result add_area(life *l) {
    const mspring_id first = l->made.particle_count;
    const mspring_id corners[3] = {first + 1, first + 2, first + 25};
    mspring_area_def def = mspring_area_def_default();
    def.stiffness = 10;
    return mspring_network_add_area(l->network, &def, corners, 3, NULL);
}

static mspring_result add_cell_areas(life *l) {
    mspring_area_def def = mspring_area_def_default();
    def.stiffness = 10;
    return mspring_network_add_cell_areas(l->network, &def, NULL, NULL);
}

static mspring_result add_angles(life *l) {
    const mspring_id first = l->made.particle_count;
    const mspring_id three[3] = {first + 1, first + 2, first + 3};
    mspring_angle_def def = mspring_angle_def_default();
    def.stiffness = 0.1f;
    return mspring_network_add_angles(l->network, &def, three, 1, 3, NULL);
}

static mspring_result remove_angle(life *l) {
    mspring_id id = 0;
    support_angle_info info;
    while (support_get_angle_info(l->network, id, &info) != MSPRING_OK)
        id++;
    return mspring_network_remove_elements(l->network, NULL, id, 1);
}

// No equilibrium is looked for of one with sides that have no springs.
static mspring_result remove_area(life *l) {
    return mspring_network_remove_elements(l->network, NULL, 0, 1);
}

static mspring_result reserve_events(life *l) {
    return mspring_network_reserve_events(l->network, 50);
}

static mspring_result update_components(life *l) {
    return mspring_network_update_components(l->network, NULL, NULL);
}

static mspring_result get_extents(life *l) {
    float *length = test_malloc(mspring_network_count(l->network, MSPRING_SPRINGS) * sizeof *length);
    const mspring_result result = support_get_extents(l->network, length, NULL, NULL, NULL);
    test_free(length);
    return result;
}

static mspring_result clone(life *l) {
    return mspring_network_clone(l->network, NULL, &l->clone);
}

static mspring_result save(life *l) {
    check_ok(mspring_network_get_snapshot_size(l->network, MSPRING_SNAPSHOT_ALL, &l->snapshot_size));
    free(l->snapshot);
    l->snapshot = malloc(l->snapshot_size);
    assert_non_null(l->snapshot);
    return mspring_network_save(l->network, MSPRING_SNAPSHOT_ALL, l->snapshot, l->snapshot_size, NULL);
}

static mspring_result set_floor(life *l) {
    static const double plane[4] = {0, -1, 0, 1};
    static const float heights[3] = {-2, -1, -2};
    mspring_floor_def def = mspring_floor_def_default();
    def.planes = plane, def.plane_count = 1;
    def.heights = heights, def.height_count = 3;
    return mspring_network_set_floor(l->network, &def);
}

static mspring_result set_groups(life *l) {
    const uint32_t firsts[] = {0, mspring_network_count(l->network, MSPRING_PARTICLES)};
    return mspring_network_set_groups(l->network, firsts, 1);
}

static mspring_result mark_groups(life *l) {
    return mspring_network_mark_groups(l->network, NULL, 0, MSPRING_ALL);
}

static mspring_result reset_groups(life *l) {
    return mspring_network_reset_groups(l->network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL);
}

static mspring_result drop_groups(life *l) {
    return mspring_network_set_groups(l->network, NULL, 0);
}

static mspring_result set_actuators(life *l) {
    const mspring_id springs[2] = {3, 11};
    return mspring_network_set_actuators(l->network, springs, 2, 2);
}

static mspring_result set_signals(life *l) {
    return mspring_network_set(l->network, MSPRING_SIGNAL, NULL, 0, 2, &(float){1.01f}, 0);
}

static mspring_result drop_actuators(life *l) {
    return mspring_network_set_actuators(l->network, NULL, 0, 1);
}

static mspring_result add_copies(life *l) {
    mspring_builder *one = support_builder();
    (void)support_particle(one, 200, 2, 3);
    const mspring_result result = mspring_builder_add_copies(l->builder, one, 100, NULL, NULL, 0, NULL, NULL);
    mspring_builder_destroy(one);
    return result;
}

static mspring_result drop_fallback(life *l) {
    return support_set_guard(l->network, MSPRING_GUARD_BOUNDS);
}

static mspring_result set_contact(life *l) {
    mspring_contact_def def = mspring_contact_def_default();
    def.thickness = 1e-3;
    return mspring_network_set_contact(l->network, &def);
}

static mspring_result change_contact(life *l) {
    mspring_contact_def def = {.struct_size = sizeof def};
    check_ok(mspring_network_get_contact(l->network, &def));
    def.thickness *= 2;
    def.capacity *= 2;
    return mspring_network_set_contact(l->network, &def);
}

static mspring_result set_surface(life *l) {
    return support_set_surface(l->network, 0, 5, 0.1f, 0.5f);
}

static mspring_result add_colliders(life *l) {
    mspring_collider_def def;
    mspring_result result = MSPRING_OK;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_BOX;
    for (int i = 0; i < 3 && result == MSPRING_OK; i++) {
        def.x = 100 + 2 * i;
        result = mspring_network_add_collider(l->network, &def, NULL);
    }
    return result;
}

static mspring_result add_grip(life *l) {
    mspring_grip_def def = mspring_grip_def_default();
    def.particle = 1;
    def.x = l->made.particles[1].x;
    def.y = l->made.particles[1].y;
    return mspring_network_add_grip(l->network, &def, NULL);
}

static mspring_result reserve_contact_events(life *l) {
    return support_reserve_contact_events(l->network, 50);
}

static mspring_result drop_contact(life *l) {
    return mspring_network_set_contact(l->network, NULL);
}

static mspring_result compact(life *l) {
    return mspring_network_compact(l->network);
}

static mspring_result expand(life *l) {
    return support_expand(l->network);
}

// Destroy the network. The next one has allocated nothing on demand yet when it loads the snapshot.
static mspring_result start_again(life *l) {
    mspring_network_destroy(l->network);
    l->network = NULL;
    return MSPRING_OK;
}

static mspring_result load(life *l) {
    return mspring_network_load(l->network, l->snapshot, l->snapshot_size);
}

static mspring_result set_solver(life *l, mspring_solver solver, mspring_integrator integrator) {
    mspring_settings def = mspring_settings_default();
    def.solver = solver;
    def.integrator = integrator;
    return support_set_solver(l->network, &def);
}

static mspring_result use_implicit(life *l) {
    return set_solver(l, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2);
}

static mspring_result use_direct(life *l) {
    return set_solver(l, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA);
}

static mspring_result settle(life *l) {
    mspring_settle_def def = mspring_settle_def_default();
    def.flags = MSPRING_SETTLE_LEAVE_FLOATING;
    return mspring_network_settle(l->network, &def, NULL);
}

const life_call life_calls[] = {
    {"builder", make_builder},
    {"particles", add_particles},
    {"particle", add_particle},
    {"springs", add_springs},
    {"spring", add_spring},
    {"lattice", add_lattice},
    {"rope", add_rope},
    {"disc", add_disc},
    {"create", create},
    {"stable_dt", stable_dt},
    {"suggest_substeps", suggest_substeps},
    {"force", apply_force},
    {"step", step},
    {"forces", apply_forces},
    {"blows", apply_blows},
    {"hook before step", hook_before_step},
    {"hook before substep", hook_before_substep},
    {"hook with period", hook_with_period},
    {"step", step},
    {"masses", set_masses},
    {"inverse mass scales", set_scales},
    {"rest lengths", set_rest_lengths},
    {"break strains", set_break_strains},
    {"stress strains", set_stress_strains},
    {"yield strains", set_yield_strains},
    {"area", add_area},
    {"areas of cells", add_cell_areas},
    {"angles", add_angles},
    {"events", reserve_events},
    {"break", break_springs},
    {"step", step},
    {"restore", restore_springs},
    {"detach", detach},
    {"grow by a particle", grow_particle},
    {"grow by a spring", grow_spring},
    {"remove", remove_particle},
    {"remove springs", remove_springs},
    {"floor", set_floor},
    {"step", step},
    {"no fallback", drop_fallback},
    {"actuators", set_actuators},
    {"signals", set_signals},
    {"step", step},
    {"groups", set_groups},
    {"mark", mark_groups},
    {"step", step},
    {"reset", reset_groups},
    {"step", step},
    {"no actuators", drop_actuators},
    {"no groups", drop_groups},
    {"contact", set_contact},
    {"contact events", reserve_contact_events},
    {"surface", set_surface},
    {"colliders", add_colliders},
    {"grip", add_grip},
    {"step", step},
    {"other contact", change_contact},
    {"step", step},
    {"compact", compact},
    {"step", step},
    {"expand", expand},
    {"step", step},
    {"no contact", drop_contact},
    {"contact again", set_contact},
    {"components", update_components},
    {"extents", get_extents},
    {"clone", clone},
    {"step", step},
    {"save", save},
    {"start again", start_again},
    {"create again", create},
    {"load", load},
    {"step", step},
    {"contact in implicit steps", set_contact},
    {"implicit", use_implicit},
    {"step", step},
    {"direct", use_direct},
    {"step", step},
    {"no area", remove_area},
    {"no angle", remove_angle},
    {"settle", settle},
    {"step", step},
    {"network", add_network},
    {"copies", add_copies},
};
const size_t life_call_count = COUNT_OF(life_calls);
