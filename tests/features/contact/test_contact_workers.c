/// @file test_contact_workers.c
/// Contact by several workers: the same bits for any number of them and any host, where bodies shatter, settle and
/// sleep, with colliders, grips and a floor, with room that grows, and the same errors.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "hosts.h"
#include "support.h"

#include "features/contact/contacts.h"

#define DT (1.0 / 64)
#define MOST_STEPS 15u
#define WIDTH 64u
#define HEIGHT 48u
#define SIDE 56u ///< loose particles in a row of the pit

typedef struct setting {
    mspring_solver solver;
    uint32_t workers, substeps, capacity, max_capacity;
    const mspring_tasks *tasks;
} setting;

typedef struct scene {
    const char *name;
    mspring_network *(*make)(const setting *of);
    mspring_solver solver;
    uint32_t steps, substeps;
} scene;

static mspring_network *network_of(mspring_builder *builder, const setting *of, float gravity_y, double thickness) {
    mspring_network_def def = support_def(gravity_y, of->substeps);
    def.settings.solver = of->solver;
    def.settings.global_damping = 0.02F;
    def.settings.sleep_speed = 0.1F;
    def.settings.sleep_time = 0.18F;
    def.worker_count = of->workers;
    def.tasks = of->tasks;
    mspring_network *network = NULL;
    check_ok(mspring_network_create(builder, &def, &network));
    mspring_builder_destroy(builder);
    mspring_contact_def contact = {.struct_size = sizeof contact};
    check_ok(mspring_network_get_contact(network, &contact));
    contact.thickness = thickness;
    contact.friction = 0.4F;
    contact.capacity = of->capacity;
    contact.max_capacity = of->max_capacity;
    contact.flags = MSPRING_CONTACT_SELF;
    check_ok(mspring_network_set_contact(network, &contact));
    return network;
}

static void add_wall(mspring_network *network, double x0, double y0, double x1, double y1) {
    const double points[] = {x0, y0, x1, y1};
    mspring_collider_def def = {.struct_size = sizeof def};
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.points = points;
    def.point_count = 2;
    def.radius = 0.5F;
    check_ok(mspring_network_add_collider(network, &def, NULL));
}

static void hold(mspring_network *network, mspring_id particle, double x, double y) {
    mspring_grip_def def;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def));
    def.particle = particle;
    def.x = x;
    def.y = y;
    def.stiffness = 1e5F;
    def.damping = 1e4F;
    check_ok(mspring_network_add_grip(network, &def, NULL));
}

/// Two lattices meet and shatter before a wall, while a third sleeps. One of them is held at a corner.
static mspring_network *crash(const setting *of) {
    static uint16_t cells[WIDTH * HEIGHT];
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(NULL, &builder));
    mspring_material material;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    material.mass = 100;
    material.stiffness = 0.3F * 100 * 2560 * 2560 / 8;
    material.damping = 0.03F * 50 * 2560;
    material.break_strain = 0.1F;
    mspring_lattice_def lattice;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    lattice.width = WIDTH;
    lattice.height = HEIGHT;
    lattice.cells = cells;
    lattice.materials = &material;
    lattice.material_count = 1;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    lattice.x = WIDTH + 0.6;
    lattice.y = 0.2 * HEIGHT;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    lattice.width = 12;
    lattice.height = 6;
    lattice.x = WIDTH - 6;
    lattice.y = 1.3 * HEIGHT;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    mspring_network *network = network_of(builder, of, 0, 0.5);
    static float velocities[4 * WIDTH * HEIGHT];
    for (uint32_t i = WIDTH * HEIGHT; i < 2 * WIDTH * HEIGHT; i++)
        velocities[2 * i] = -80;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 2 * WIDTH * HEIGHT, velocities, velocities + 1, 2));
    add_wall(network, -2, -20, -2, 60);
    hold(network, WIDTH * HEIGHT - WIDTH, 0, HEIGHT - 1);
    return network;
}

/// Loose particles fall into a pit, where those below fall asleep.
static mspring_network *pit(const setting *of) {
    uint64_t seed = 5;
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(NULL, &builder));
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.x = (i % SIDE) * 1.04 + support_random_between(&seed, 0, 0.02);
        particle.y = (i / SIDE) * 1.01;
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    }
    mspring_network *network = network_of(builder, of, -9.8F, 1);
    add_wall(network, -10, -1.01, SIDE * 1.04 + 10, -1.01);
    add_wall(network, -1.1, -5, -1.1, 2.0 * SIDE);
    add_wall(network, SIDE * 1.04, -5, SIDE * 1.04, 2.0 * SIDE);
    return network;
}

static const scene scenes[] = {
    {"crash", crash, MSPRING_SOLVER_EXPLICIT, MOST_STEPS, 40},
    {"pit", pit, MSPRING_SOLVER_EXPLICIT, 10, 8},
    {"implicit crash", crash, MSPRING_SOLVER_IMPLICIT, 2, 2},
    {"implicit pit", pit, MSPRING_SOLVER_IMPLICIT, 1, 1},
};

/// What a run shows: hashes of all steps, and the most of each kind of thing that workers may share.
typedef struct shown {
    uint64_t hashes[MOST_STEPS];
    uint32_t points, pairs, candidates, constraints, grew;
    bool has_broken, has_slept;
} shown;

static uint32_t larger(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

static shown run(const scene *of, const setting *with) {
    setting all = *with;
    shown seen = {0};
    all.solver = of->solver;
    all.substeps = of->substeps;
    mspring_network *network = of->make(&all);
    const mspringi_contacts *contacts = network->contacts;
    for (uint32_t step = 0; step < of->steps; step++) {
        mspring_step_info info = {.struct_size = sizeof info};
        support_steps(network, 1, DT);
        check_ok(mspring_network_get_step_info(network, &info));
        seen.hashes[step] = support_hash(network);
        seen.points = larger(seen.points, contacts->outline.point_count);
        seen.pairs = larger(seen.pairs, contacts->count);
        seen.candidates = larger(seen.candidates, contacts->candidate_count);
        seen.constraints = larger(seen.constraints, contacts->constraint_count);
        seen.grew += (info.flags & MSPRING_STEP_GREW) != 0;
        seen.has_broken |= network->edits.links > 0;
        seen.has_slept |= network->sleep.sleeping > 0;
    }
    mspring_network_destroy(network);
    return seen;
}

/// Shown by one worker's run; made once.
static const shown *expected_of(const scene *of) {
    static shown all[COUNT_OF(scenes)];
    static bool is_made[COUNT_OF(scenes)];
    const size_t number = (size_t)(of - scenes);
    if (!is_made[number])
        all[number] = run(of, &(setting){.workers = 1});
    is_made[number] = true;
    return &all[number];
}

static shown compare(const scene *of, const setting *with, const char *who) {
    const shown *expected = expected_of(of);
    const shown seen = run(of, with);
    for (uint32_t step = 0; step < of->steps; step++)
        if (seen.hashes[step] != expected->hashes[step])
            fail_msg("%s, %s, %u workers, capacity %u: other bits in step %u", of->name, who,
                     with->tasks ? with->tasks->worker_count : with->workers, with->capacity, step);
    return seen;
}

/// Enough of all things that several workers share them (LEAST_... in pair_list.c and constraints.c).
static void check_enough(const scene *of, const shown *seen) {
    printf("%s: %u points, %u pairs, %u candidates, %u constraints\n", of->name, seen->points, seen->pairs,
           seen->candidates, seen->constraints);
    assert_true(seen->points > 256);
    if (of->make == crash && of->solver == MSPRING_SOLVER_EXPLICIT)
        assert_true(seen->has_broken && seen->has_slept && seen->pairs > 4096 && seen->candidates > 2048);
    else if (of->make == pit)
        assert_true(seen->candidates > 4096 && seen->constraints > 1024);
}

static void any_number_of_workers_gives_the_same_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(scenes); i++) {
        const bool is_short = ROUNDS_ARE_FEW || scenes[i].solver != MSPRING_SOLVER_EXPLICIT;
        check_enough(&scenes[i], expected_of(&scenes[i]));
        for (uint32_t n = 0; n < (is_short ? 2 : 3); n++)
            (void)compare(&scenes[i], &(setting){.workers = (uint32_t[]){2, 8, 3}[n]}, "threads");
    }
}

static void any_host_gives_the_same_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(scenes); i++) {
        for (uint32_t workers = 2; workers < 4; workers++) {
            host hosts[HOST_COUNT];
            hosts_fill(hosts, workers);
            for (int h = 0; h < HOST_COUNT; h++) {
                if (((size_t)h + i + workers) % (ROUNDS_ARE_FEW ? 6 : 4) > 0)
                    continue;
                (void)compare(&scenes[i], &(setting){.workers = 1, .tasks = &hosts[h].tasks}, hosts[h].name);
                assert_true(hosts[h].runs > 0);
            }
        }
    }
}

/// Where a worker has no room for what it finds, one worker finds all of it again, and then the list grows.
static void room_that_grows_changes_no_bits(void **state) {
    (void)state;
    for (uint32_t n = 0; n < (ROUNDS_ARE_FEW ? 1 : 2); n++) {
        const shown seen = compare(&scenes[0], &(setting){.workers = 3, .capacity = n == 0 ? 1 : 3000}, "threads");
        assert_true(seen.grew > 0);
    }
}

static uint32_t steps_with(uint32_t workers, uint32_t capacity, uint64_t *hash) {
    mspring_network *network =
        crash(&(setting){.workers = workers, .substeps = 40, .capacity = capacity, .max_capacity = capacity});
    uint32_t step = 0;
    while (step < MOST_STEPS && mspring_network_step(network, DT) == MSPRING_OK)
        step++;
    if (step < MOST_STEPS)
        check_contains(mspring_network_error(network), "larger max_capacity");
    *hash = support_hash(network);
    mspring_network_destroy(network);
    return step;
}

/// Steps fail for any number of workers alike.
static void the_same_step_lacks_room(void **state) {
    (void)state;
    for (uint32_t n = 0; n < (ROUNDS_ARE_FEW ? 1 : 3); n++) {
        uint64_t hash, expected;
        const uint32_t capacity = (uint32_t[]){200, 500, 800}[n], steps = steps_with(1, capacity, &expected);
        printf("capacity %u: %u steps\n", capacity, steps);
        assert_true(steps < MOST_STEPS);
        assert_int_equal(steps_with(2, capacity, &hash), steps);
        assert_int_equal(hash, expected);
        assert_int_equal(steps_with(8, capacity, &hash), steps);
        assert_int_equal(hash, expected);
    }
}

/// Clones have workers of their own, fewer or more than the original.
static void clones_give_the_same_bits(void **state) {
    (void)state;
    for (uint32_t workers = 1; workers < (ROUNDS_ARE_FEW ? 4 : 5); workers += 3) {
        mspring_network *network = pit(&(setting){.workers = workers, .substeps = scenes[1].substeps});
        mspring_clone_def def;
        check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
        def.worker_count = 5 - workers;
        mspring_network *clone = NULL;
        check_ok(mspring_network_clone(network, &def, &clone));
        mspring_network_destroy(network);
        assert_int_equal(clone->contacts->most_shares, 5 - workers);
        for (uint32_t step = 0; step < scenes[1].steps; step++) {
            support_steps(clone, 1, DT);
            assert_int_equal(support_hash(clone), expected_of(&scenes[1])->hashes[step]);
        }
        mspring_network_destroy(clone);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_workers_gives_the_same_bits),
        cmocka_unit_test(any_host_gives_the_same_bits),
        cmocka_unit_test(room_that_grows_changes_no_bits),
        cmocka_unit_test(the_same_step_lacks_room),
        cmocka_unit_test(clones_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
