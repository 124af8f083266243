/// @file fuzz_snapshot.c
/// Snapshots that were tampered with, and bytes that never were one: they are refused with a message and change
/// nothing, or give a network that goes on without anything that is not finite. Most get a checksum that fits, or
/// nothing would be seen of what is behind it.
///
/// SPDX-License-Identifier: MIT
#include "check.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <massspring/massspring.h>

#include "recipe.h"
#include "store/snapshot_format.h"
#include "support.h"

/// Of subjects; those from PLAIN on have material laws, too.
enum { PLAIN = 4, KINDS = 12, BATCH = 8, MOST_PARTICLES = 64, MOST_CHANGES = 8 };

/// A network with a bit of everything in its snapshot, made once.
typedef struct subject {
    mspring_network *network;
    mspring_settings solver;
    uint32_t particles;
    uint8_t *all, *frame;
    size_t all_size, frame_size;
    uint64_t hash;
} subject;

static uint64_t hash_of(const mspring_network *network) {
    uint64_t hash = 0;
    FUZZ_CHECK(mspring_network_get_state_hash(network, &hash) == MSPRING_OK);
    return hash;
}

static uint8_t *save(const mspring_network *network, mspring_snapshot_contents contents, size_t *size) {
    FUZZ_CHECK(mspring_network_get_snapshot_size(network, contents, size) == MSPRING_OK);
    uint8_t *bytes = malloc(*size);
    FUZZ_CHECK(bytes != NULL);
    FUZZ_CHECK(mspring_network_save(network, contents, bytes, *size, NULL) == MSPRING_OK);
    return bytes;
}

static recipe make_recipe(int kind) {
    uint64_t seed = 40 + (uint64_t)(kind % PLAIN);
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, kind & 1 ? 1 : 0}};
    recipe_stuff cable = stuff;
    const recipe_stuff relative = {.mass = {1, 2},
                                   .stiffness = {0.1, 0.2},
                                   .spring_flags = MSPRING_SPRING_RELATIVE,
                                   .pinned = 0.1,
                                   .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 5, 3, 0, 0, 1, kind & 1 ? &relative : &stuff, &seed);
    recipe_particle(&made, 8, 1, 1, MSPRING_PARTICLE_PINNED);
    cable.spring_flags = kind < PLAIN ? 0 : MSPRING_SPRING_PULL_ONLY;
    recipe_rope(&made, 0, made.particle_count - 1, 6, &cable, &seed);
    recipe_random_springs(&made, 5, &stuff, &seed);
    recipe_particle(&made, 0, 9, 1, 0);
    recipe_particle(&made, 4, 9, 1, MSPRING_PARTICLE_PINNED); // sleeps where that may be
    recipe_disturb(&made, 0.02, 0.1, &seed);
    return made;
}

// Edit what snapshots keep, so that every section is there.
static void add_and_remove(mspring_network *network) {
    mspring_particle_def particles[2];
    mspring_spring_def spring;
    mspring_id added[2], joint;
    const mspring_id removed = 7, removed_spring = 30;
    for (int i = 0; i < 2; i++) {
        FUZZ_CHECK(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]) == MSPRING_OK);
        particles[i].x = -2 - i;
    }
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_add_particles(network, particles, 2, added) == MSPRING_OK);
    spring.a = 0, spring.b = added[0], spring.stiffness = 30;
    FUZZ_CHECK(mspring_network_add_springs(network, &spring, 1, &joint) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_remove_particles(network, &removed, 0, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_remove_springs(network, &removed_spring, 0, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_remove_particles(network, &added[1], 0, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_step(network, 0.01) == MSPRING_OK);
}

// Springs that yield and some that have, areas around cells and one at an edge, angle springs.
static void add_laws(mspring_network *network) {
    const float yield = 0.01f, bend[2] = {0.05f, -0.03f};
    const mspring_id corners[3] = {0, 2, 6}, arms[6] = {0, 1, 2, 1, 2, 3}, gone = 2;
    const double rest = 0.25;
    mspring_area_def area;
    mspring_angle_def angle;
    FUZZ_CHECK(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, 40, &yield, 0) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 5, 2, bend, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area) == MSPRING_OK);
    area.stiffness = 20;
    FUZZ_CHECK(mspring_network_add_cell_areas(network, &area, NULL, NULL) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_remove_elements(network, NULL, gone, 1) == MSPRING_OK);
    area = (mspring_area_def){.struct_size = sizeof area, .kind = MSPRING_AREA_GAS, .pressure = 1, .fill = 1};
    FUZZ_CHECK(mspring_network_add_area(network, &area, corners, 3, NULL) == MSPRING_OK);
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle) == MSPRING_OK);
    angle.stiffness = 3;
    FUZZ_CHECK(mspring_network_add_angles(network, &angle, arms, 2, 3, NULL) == MSPRING_OK);
    uint32_t count = 0;
    mspring_id angles[2];
    FUZZ_CHECK(support_get_angles(network, angles, NULL, NULL, 2, &count) == MSPRING_OK && count == 2);
    FUZZ_CHECK(support_set_rest_angles(network, angles[0], 1, &rest, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_step(network, 0.01) == MSPRING_OK);
}

// Contact with a collider, grips and a floor.
static void add_contact(mspring_network *network) {
    const double plane[4] = {0, 1, 0, 30};
    mspring_contact_def contact;
    mspring_collider_def collider;
    mspring_grip_def grip;
    mspring_floor_def ground;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_set_contact(network, &contact) == MSPRING_OK);
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &collider, sizeof collider) == MSPRING_OK);
    collider.kind = MSPRING_COLLIDER_CIRCLE, collider.x = 2, collider.y = -3, collider.radius = 1;
    FUZZ_CHECK(mspring_network_add_collider(network, &collider, NULL) == MSPRING_OK);
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip) == MSPRING_OK);
    grip.particle = 3, grip.x = 3, grip.y = 1, grip.stiffness = 20;
    FUZZ_CHECK(mspring_network_add_grip(network, &grip, NULL) == MSPRING_OK);
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &ground, sizeof ground) == MSPRING_OK);
    ground.planes = plane, ground.plane_count = 1;
    FUZZ_CHECK(mspring_network_set_floor(network, &ground) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_step(network, 0.01) == MSPRING_OK);
}

// One group of all, and actuators that are on their way.
static void add_batch(mspring_network *network) {
    const mspring_id firsts[2] = {0, mspring_network_count(network, MSPRING_PARTICLES)}, moved[2] = {8, 9};
    const float signals[2] = {0.5f, 1.25f};
    FUZZ_CHECK(support_set_guard(network, MSPRING_GUARD_BOUNDS) == MSPRING_OK); // groups need it
    FUZZ_CHECK(mspring_network_set_groups(network, firsts, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_set_actuators(network, moved, 2, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1) == MSPRING_OK);
}

static void edit(mspring_network *network, int kind) {
    const bool implicit = kind & 2;
    const float strains[2] = {0.5f, 0.7f}, lower[2] = {0.2f, 0.3f}, mass = 3, scale = 0.5f;
    const mspring_id broken[2] = {1, 4};
    FUZZ_CHECK(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 2, 2, strains, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 2, 2, lower, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_break_springs(network, broken, 0, 2) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_step(network, 0.01) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_restore_springs(network, broken, 0, 1, 1.0) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_set(network, MSPRING_MASS, NULL, 3, 1, &mass, 1) == MSPRING_OK);
    if (!implicit)
        FUZZ_CHECK(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 5, 1, &scale, 1) == MSPRING_OK);
    if (kind >= PLAIN)
        add_laws(network);
    if (kind % 3 == 0)
        add_and_remove(network);
    if (kind >= BATCH)
        add_contact(network);
    if (kind == KINDS - 1)
        add_batch(network);
    FUZZ_CHECK(mspring_network_apply_force(network, 6, 3, -2) == MSPRING_OK);
}

static subject make_subject(int kind) {
    subject made = {.network = NULL};
    recipe from = make_recipe(kind);
    mspring_network_def def = support_def(-9.8f, 2);
    static const mspring_guard guards[PLAIN] = {MSPRING_GUARD_CLAMP, MSPRING_GUARD_IMPLICIT, MSPRING_GUARD_CLAMP,
                                                MSPRING_GUARD_GROWTH};
    def.settings.guard = guards[kind % PLAIN];
    def.spare_particles = def.spare_springs = kind % 3 == 0 ? 3 : 0;
    def.settings.sleep_speed = kind % 2 == 0 ? 1e-3f : 0;
    def.settings.sleep_time = 0;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_SETTINGS, &made.solver, sizeof made.solver) == MSPRING_OK);
    made.solver.substeps = 2;
    made.solver.solver = kind == 10                      ? MSPRING_SOLVER_DIRECT
                         : kind & 2 && kind != KINDS - 1 ? MSPRING_SOLVER_IMPLICIT
                                                         : MSPRING_SOLVER_EXPLICIT;
    def.flags = kind == 9 ? MSPRING_NETWORK_PRECISE : 0;
    made.solver.integrator = kind & 1 ? MSPRING_INTEGRATOR_BDF2 : MSPRING_INTEGRATOR_ALPHA;
    made.network = recipe_network(&from, &def);
    FUZZ_CHECK(support_set_solver(made.network, &made.solver) == MSPRING_OK);
    recipe_free(&from);
    edit(made.network, kind);
    made.particles = mspring_network_count(made.network, MSPRING_PARTICLES);
    FUZZ_CHECK(made.particles <= MOST_PARTICLES);
    made.all = save(made.network, MSPRING_SNAPSHOT_ALL, &made.all_size);
    made.frame = save(made.network, MSPRING_SNAPSHOT_FRAME, &made.frame_size);
    made.hash = hash_of(made.network);
    return made;
}

static void check_finite(const subject *s) {
    double x[MOST_PARTICLES], y[MOST_PARTICLES];
    float vx[MOST_PARTICLES], vy[MOST_PARTICLES];
    FUZZ_CHECK(mspring_network_get_positions(s->network, NULL, 0, s->particles, x, y, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_get_velocities(s->network, NULL, 0, s->particles, vx, vy, 1) == MSPRING_OK);
    for (uint32_t i = 0; i < s->particles; i++)
        FUZZ_CHECK(isfinite(x[i]) && isfinite(y[i]) && isfinite(vx[i]) && isfinite(vy[i]));
}

// Change some values of the snapshot, which has room for no more than it holds.
static void tamper(uint8_t *bytes, size_t size, fuzz_bytes *from) {
    static const float values[] = {0, -1, 1e-45f, 1e30f, -1e30f, INFINITY, -INFINITY, NAN};
    for (int changes = fuzz_byte(from) % (MOST_CHANGES + 1); changes > 0; changes--) {
        const uint8_t kind = fuzz_byte(from);
        const size_t at = (fuzz_byte(from) * 256u + fuzz_byte(from)) % size, word = at / 4 * 4;
        if (kind < 100)
            bytes[at] = fuzz_byte(from);
        else if (kind < 180 && word + sizeof values[0] <= size)
            memcpy(bytes + word, &values[kind % COUNT_OF(values)], sizeof values[0]);
        else
            bytes[at] ^= (uint8_t)(1u << kind % 8);
    }
}

static void renew_checksum(uint8_t *bytes, size_t size) {
    if (size < MSPRINGI_SNAPSHOT_HEADER_BYTES + MSPRINGI_SNAPSHOT_CHECKSUM_BYTES)
        return;
    const size_t summed = size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    mspringi_checksum checksum = {{0}, {0}};
    mspringi_kernels_scalar.checksum(NULL, bytes, summed / MSPRINGI_CHECKSUM_UNIT, &checksum);
    const uint64_t value = mspringi_checksum_value(&checksum);
    for (int byte = 0; byte < 8; byte++)
        bytes[summed + (size_t)byte] = (uint8_t)(value >> 8 * byte);
}

// Load what may be anything, and go on from it.
static void try_load(subject *s, const uint8_t *bytes, size_t size) {
    if (mspring_network_load(s->network, bytes, size) != MSPRING_OK) {
        FUZZ_CHECK(strlen(mspring_network_error(s->network)) > 0);
        FUZZ_CHECK(hash_of(s->network) == s->hash);
        fuzz_check_saves(s->network, &(fuzz_saved){s->all, s->all_size}, "a refused load");
        return;
    }
    check_finite(s);
    fuzz_check_network(s->network);
    // A million substeps would be allowed.
    FUZZ_CHECK(support_set_solver(s->network, &s->solver) == MSPRING_OK);
    (void)!fuzz_step(s->network, 0.01);
    check_finite(s);
    FUZZ_CHECK(mspring_network_load(s->network, s->all, s->all_size) == MSPRING_OK);
    FUZZ_CHECK(hash_of(s->network) == s->hash);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static subject subjects[KINDS];
    fuzz_bytes bytes = {data, size, 0};
    const uint8_t how = fuzz_byte(&bytes);
    subject *s = &subjects[how % KINDS];
    if (!s->network)
        *s = make_subject(how % KINDS);
    if (how / KINDS % 16 == 0) { // not even begun as one
        try_load(s, data, size);
        return 0;
    }
    const bool all = how & 64;
    size_t length = all ? s->all_size : s->frame_size;
    uint8_t *copy = malloc(length);
    FUZZ_CHECK(copy != NULL);
    memcpy(copy, all ? s->all : s->frame, length);
    tamper(copy, length, &bytes);
    if (how & 128) // the rest of a section may become another's
        length -= fuzz_byte(&bytes) % 4 * MSPRINGI_CHECKSUM_UNIT % length;
    if (fuzz_byte(&bytes) % 8 > 0)
        renew_checksum(copy, length);
    try_load(s, copy, length);
    free(copy);
    return 0;
}
