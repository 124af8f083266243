/// @file archives.c
///
/// SPDX-License-Identifier: MIT
#include "archives.h"

#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "store/snapshot_format.h"
#include "archive/archive_format.h"

static mspring_result MSPRING_CALL append(const void *bytes, size_t size, void *user) {
    archived *to = user;
    while (to->room < to->size + size) {
        to->room = to->room > 0 ? 2 * to->room : 4096;
        to->bytes = realloc(to->bytes, to->room);
        assert_non_null(to->bytes);
    }
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
    return MSPRING_OK;
}

archived archives_write(const mspring_network *network) {
    archived made = {NULL, 0, 0};
    check_ok(mspring_network_write(network, append, &made));
    return made;
}

mspring_network *archives_read(const archived *from, uint32_t workers) {
    mspring_builder *builder = support_builder();
    mspring_network *network = NULL;
    mspring_network_def def = {.struct_size = sizeof def};
    uint32_t skipped = 99;
    if (mspring_builder_read(builder, from->bytes, from->size, &skipped) != MSPRING_OK)
        fail_msg("%s", support_builder_error(builder));
    assert_int_equal(skipped, 0);
    check_ok(mspring_builder_get_network_def(builder, &def));
    def.worker_count = workers;
    if (mspring_network_create(builder, &def, &network) != MSPRING_OK)
        fail_msg("%s", support_builder_error(builder));
    mspring_builder_destroy(builder);
    return network;
}

mspring_network *archives_check_same(const mspring_network *network, uint32_t workers) {
    const archived first = archives_write(network);
    mspring_network *made = archives_read(&first, workers);
    const archived second = archives_write(made);
    assert_int_equal(first.size, second.size);
    for (size_t i = 0; i < first.size; i++)
        if (first.bytes[i] != second.bytes[i])
            fail_msg("byte %zu of %zu differs", i, first.size);
    free(first.bytes);
    free(second.bytes);
    return made;
}

void archives_check_goes_on(mspring_network *network, mspring_network *other, uint32_t steps) {
    size_t sizes[2];
    for (uint32_t i = 0; i < steps; i++) {
        assert_int_equal(support_hash(network), support_hash(other));
        support_steps(network, 1, 1.0 / 64);
        support_steps(other, 1, 1.0 / 64);
    }
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &sizes[0]));
    check_ok(mspring_network_get_snapshot_size(other, MSPRING_SNAPSHOT_ALL, &sizes[1]));
    assert_int_equal(sizes[0], sizes[1]);
    uint8_t *bytes[2] = {malloc(sizes[0]), malloc(sizes[1])};
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, bytes[0], sizes[0], NULL));
    check_ok(mspring_network_save(other, MSPRING_SNAPSHOT_ALL, bytes[1], sizes[1], NULL));
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
}

/* ------------------------------------------------------------------------------------------------- networks */

static recipe make_recipe(int kind) {
    uint64_t seed = 70 + (uint64_t)kind;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, kind & 1 ? 1 : 0}};
    const recipe_stuff relative = {.mass = {1, 2},
                                   .stiffness = {0.1, 0.2},
                                   .spring_flags = MSPRING_SPRING_RELATIVE,
                                   .pinned = 0.1,
                                   .holes = 0.1};
    recipe_stuff cable = stuff;
    recipe made = {0};
    recipe_lattice(&made, 5, 3, 0, 0, 1, kind & 1 ? &relative : &stuff, &seed);
    recipe_particle(&made, 8, 1, 1, MSPRING_PARTICLE_PINNED);
    cable.spring_flags = (kind < 4 ? 0u : MSPRING_SPRING_PULL_ONLY) | (kind & 2 ? MSPRING_SPRING_METRES : 0u);
    recipe_rope(&made, 0, made.particle_count - 1, 6, &cable, &seed);
    recipe_random_springs(&made, 5, &stuff, &seed);
    recipe_particle(&made, 0, 9, 1, 0);
    recipe_particle(&made, 4, 9, 1, MSPRING_PARTICLE_PINNED); // sleeps where that may be
    recipe_disturb(&made, 0.02, 0.1, &seed);
    recipe_shuffle(&made, &seed, NULL);
    return made;
}

static void add_and_remove(mspring_network *network) {
    mspring_particle_def particles[3];
    mspring_spring_def springs[2];
    mspring_id added[3], joints[2];
    const mspring_id removed = 7, removed_spring = 30;
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]));
        particles[i].x = -2 - i;
    }
    check_ok(mspring_network_add_particles(network, particles, 3, added));
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &springs[i], sizeof springs[i]));
        springs[i].a = i, springs[i].b = added[i], springs[i].stiffness = 30;
    }
    check_ok(mspring_network_add_springs(network, springs, 2, joints));
    check_ok(mspring_network_remove_particles(network, &removed, 0, 1));
    check_ok(mspring_network_remove_springs(network, &removed_spring, 0, 1));
    check_ok(mspring_network_remove_particles(network, &added[1], 0, 1));
    check_ok(mspring_network_remove_springs(network, &joints[0], 0, 1));
}

static void add_laws(mspring_network *network) {
    const float yield = 0.01f, bend[2] = {0.05f, -0.03f};
    const mspring_id corners[3] = {0, 2, 6}, arms[6] = {0, 1, 2, 1, 2, 3};
    mspring_area_def area;
    mspring_angle_def angle;
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0,
                                 mspring_network_count(network, MSPRING_SPRINGS), &yield, 0));
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 5, 2, bend, 1));
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.stiffness = 20;
    check_ok(mspring_network_add_cell_areas(network, &area, NULL, NULL));
    area = (mspring_area_def){
        .struct_size = sizeof area, .kind = MSPRING_AREA_GAS, .pressure = 1, .fill = 1, .rest_area = 1};
    check_ok(mspring_network_add_area(network, &area, corners, 3, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    angle.stiffness = 3;
    check_ok(mspring_network_add_angles(network, &angle, arms, 2, 3, NULL));
}

static void add_contact(mspring_network *network) {
    const double planes[8] = {0, -4, 0, 30, -30, 0, 2, 0}, points[6] = {0, 0, 3, 0, 3, 2};
    const float heights[4] = {-6, -5, -5.5f, -6}, frictions[2] = {0.1f, 0.7f}, bounces[3] = {0, 0.5f, 0.25f};
    mspring_contact_def contact;
    mspring_collider_def collider;
    mspring_grip_def grip;
    mspring_floor_def ground;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.friction = 0.4f, contact.sweeps = 6;
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(support_set_layers(network, 2, 3, 6, 3));
    check_ok(support_set_surface(network, 1, 4, 0.5f, 0.25f));
    check_ok(support_reserve_contact_events(network, 50));
    for (int i = 0; i < 4; i++) {
        mspring_id id;
        check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &collider, sizeof collider));
        collider.kind = i < 3 ? (mspring_collider_kind)i : MSPRING_COLLIDER_CIRCLE;
        collider.x = 4 * i, collider.y = -3, collider.radius = 1, collider.friction = 0.3f;
        collider.points = points, collider.point_count = i == 0 ? 3 : 0;
        collider.flags = i == 0 ? MSPRING_COLLIDER_CLOSED : 0;
        check_ok(mspring_network_add_collider(network, &collider, &id));
        if (i == 1)
            check_ok(mspring_network_move_collider(network, id, 4.2, -3, 0.1));
        if (i == 3)
            check_ok(mspring_network_remove_collider(network, id));
    }
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 3, grip.x = 3, grip.y = 1, grip.stiffness = 20, grip.max_force = 50;
    check_ok(mspring_network_add_grip(network, &grip, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &ground, sizeof ground));
    ground.planes = planes, ground.plane_count = 2, ground.plane_frictions = frictions;
    ground.heights = heights, ground.height_count = 4, ground.height_restitutions = bounces;
    ground.heights_x = -10, ground.spacing = 5, ground.silt_depth = 0.5f, ground.silt_rate = 1;
    check_ok(mspring_network_set_floor(network, &ground));
}

static void add_batch(mspring_network *network) {
    const mspring_id firsts[2] = {0, mspring_network_count(network, MSPRING_PARTICLES)}, moved[2] = {8, 9};
    const float signals[2] = {0.5f, 1.25f};
    check_ok(support_set_guard(network, MSPRING_GUARD_BOUNDS)); // groups need it
    check_ok(mspring_network_set_groups(network, firsts, 1));
    check_ok(mspring_network_set_actuators(network, moved, 2, 3));
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_mark_groups(network, NULL, 0, MSPRING_ALL));
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1));
}

static void edit(mspring_network *network, int kind) {
    const float strains[2] = {0.5f, 0.7f}, lower[2] = {0.2f, 0.3f}, mass = 3, scale = 0.5f;
    const mspring_id broken[3] = {1, 4, 11};
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 2, 2, strains, 1));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 2, 2, lower, 1));
    check_ok(mspring_network_break_springs(network, broken, 0, 3));
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_restore_springs(network, broken, 0, 1, 1.0)); // on a ramp
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 3, 1, &mass, 1));
    if (kind % 4 < 2)
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 5, 1, &scale, 1));
    if (kind >= 4)
        add_laws(network);
    if (kind % 3 == 0)
        add_and_remove(network);
    if (kind >= 8)
        add_contact(network);
    if (kind == 11)
        add_batch(network);
    check_ok(mspring_network_reserve_events(network, 20));
    support_steps(network, 2, 1.0 / 64);
    if (kind == 6)
        check_ok(mspring_network_compact(network));
    check_ok(mspring_network_apply_force(network, 6, 3, -2));
    const float blow = 40;
    if (kind % 3 == 1)
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, NULL, 2, 3, &blow, &blow, 0));
}

mspring_network *archives_make(int kind) {
    static const mspring_guard guards[4] = {MSPRING_GUARD_CLAMP, MSPRING_GUARD_IMPLICIT, MSPRING_GUARD_CLAMP,
                                            MSPRING_GUARD_GROWTH};
    recipe from = make_recipe(kind);
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_settings solver;
    def.settings.guard = guards[kind % 4];
    def.spare_particles = def.spare_springs = kind % 3 == 0 ? 4 : 0;
    def.settings.sleep_speed = kind % 2 == 0 ? 1e-3f : 0;
    def.settings.sleep_time = 0;
    def.flags = kind == 9 ? MSPRING_NETWORK_PRECISE : kind == 10 ? MSPRING_NETWORK_POSES : 0;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.substeps = kind == 4 ? MSPRING_SUBSTEPS_EVEN : 4;
    solver.solver = kind == 10                 ? MSPRING_SOLVER_DIRECT
                    : kind & 2 && kind != 11 ? MSPRING_SOLVER_IMPLICIT
                                             : MSPRING_SOLVER_EXPLICIT;
    solver.integrator = kind & 1 ? MSPRING_INTEGRATOR_BDF2 : MSPRING_INTEGRATOR_ALPHA;
    solver.coarse_period = kind == 2 ? 8 : 0;
    mspring_network *network = recipe_network(&from, &def);
    check_ok(support_set_solver(network, &solver));
    recipe_free(&from);
    edit(network, kind);
    return network;
}

/* --------------------------------------------------------------------------------------------------- forging */

uint8_t *archives_chunk(const archived *in, const char *tag, size_t *size) {
    mspringi_read_chunk chunk;
    size_t at = MSPRINGI_ARCHIVE_HEAD_BYTES;
    while (mspringi_archive_next(in->bytes, in->size, &at, &chunk)) {
        if (memcmp(chunk.tag, tag, 4) != 0)
            continue;
        *size = chunk.size;
        return in->bytes + (chunk.bytes - in->bytes);
    }
    return NULL;
}

void archives_renew(archived *of) {
    mspringi_read_chunk chunk;
    size_t at = MSPRINGI_ARCHIVE_HEAD_BYTES;
    while (at < of->size && mspringi_archive_next(of->bytes, of->size, &at, &chunk)) {
        uint8_t *const head = of->bytes + (chunk.bytes - of->bytes) - MSPRINGI_CHUNK_HEAD_BYTES;
        const uint64_t hash = mspringi_chunk_hash(head, chunk.bytes, chunk.size);
        for (int i = 0; i < 8; i++)
            head[16 + i] = (uint8_t)(hash >> 8 * i);
    }
}

const char *archives_refused(const archived *from) {
    static char message[300];
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    check_ok(mspring_builder_create(&allocator, &builder));
    mspring_result result = mspring_builder_read(builder, from->bytes, from->size, NULL);
    if (result == MSPRING_OK) {
        mspring_network_def def = {.struct_size = sizeof def};
        check_ok(mspring_builder_get_network_def(builder, &def));
        def.allocator = &allocator;
        result = mspring_network_create(builder, &def, &network);
    } else {
        assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
        assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 0);
    }
    if (result != MSPRING_ERROR_SNAPSHOT)
        fail_msg("result %d: %s", (int)result, support_builder_error(builder));
    assert_null(network);
    strcpy(message, support_builder_error(builder));
    mspring_builder_destroy(builder);
    check_watched_clean(&watched);
    return message;
}
