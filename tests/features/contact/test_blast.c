/// @file test_blast.c
/// Fragments a hundred times faster than all else: they add their own pairs and no others, and whoever meets them
/// is found, whenever the lists were made.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "bodies.h"
#include "snapshots.h"

#include "features/contact/contacts.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define STEPS 24u
#define BLAST 6u ///< step before which it happens
#define WIDTH 12u
#define HEIGHT 8u
#define BLOCKS 3u

typedef struct setting {
    mspring_solver solver;
    mspring_simd level;
    uint32_t workers, substeps;
} setting;

/// Blocks that lie beside each other, apart by half a thickness more than they touch.
static mspring_network *blocks(const setting *of) {
    bodies *b = bodies_begin(DT / 40);
    for (uint32_t i = 0; i < BLOCKS; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = WIDTH,
                                              .height = HEIGHT,
                                              .x = i * (WIDTH - 1 + 1.5 * THICKNESS),
                                              .y = 0.5 * (HEIGHT - 1),
                                              .spacing = 1,
                                              .mass = 20,
                                              .f = 0.3});
    mspring_network_def def = support_def(-9.8f, of->substeps);
    def.solver = of->solver;
    def.simd_level = of->level;
    def.worker_count = of->workers;
    mspring_network *network = bodies_network(b, &def);
    static const double plane[4] = {0, -0.01, 0, 1};
    mspring_floor_def floor;
    check_ok(mspring_floor_def_init(&floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0));
    bodies_free(b);
    return network;
}

/// Tear a hole into the first block, and throw what was in it to all sides.
static void blow_up(mspring_network *network, float speed) {
    mspring_id torn[WIDTH * HEIGHT];
    uint32_t count = 0;
    for (mspring_id p = 0; p < WIDTH * HEIGHT; p++)
        if (p % WIDTH > 7 && p / WIDTH > 1 && p / WIDTH < 7)
            torn[count++] = p;
    check_ok(mspring_network_detach_particles(network, torn, count));
    for (uint32_t i = 0; i < count; i++) {
        const float vx = speed * ((float)(torn[i] % WIDTH) - 9), vy = speed * ((float)(torn[i] / WIDTH) - 4);
        check_ok(mspring_network_set_velocities(network, torn[i], 1, &vx, &vy, 1));
    }
}

/// What a host does besides, none of which may change a bit.
typedef enum besides { NOTHING, DROP_LISTS, ROLL_BACK } besides;

static void fly(const setting *of, besides what, uint64_t *hashes) {
    mspring_network *network = blocks(of);
    for (uint32_t step = 0; step < STEPS; step++) {
        if (step == BLAST)
            blow_up(network, 40);
        if (what == DROP_LISTS)
            check_ok(mspring_network_set_contact_groups(network, 0, BLOCKS * WIDTH * HEIGHT, 1, UINT32_MAX));
        if (what == ROLL_BACK && step >= BLAST && step % 4 == 3) {
            saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
            support_steps(network, 3, DT);
            snapshots_load(network, &frame);
            free(frame.bytes);
        }
        support_steps(network, 1, DT);
        hashes[step] = support_hash(network);
    }
    mspring_network_destroy(network);
}

static void compare(const setting *of, besides what, const uint64_t *expected) {
    uint64_t hashes[STEPS];
    fly(of, what, hashes);
    for (uint32_t step = 0; step < STEPS; step++)
        if (hashes[step] != expected[step])
            fail_msg("solver %d, level %d, %u workers, %u substeps, besides %d: other bits in step %u", of->solver,
                     of->level, of->workers, of->substeps, what, step);
}

static void fly_likewise(mspring_solver solver, uint32_t substeps) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    setting of = {solver, MSPRING_SIMD_AUTO, 1, substeps};
    uint64_t expected[STEPS];
    fly(&of, NOTHING, expected);
    compare(&of, DROP_LISTS, expected);
    compare(&of, ROLL_BACK, expected);
    of.workers = 3;
    compare(&of, NOTHING, expected);
    for (uint32_t i = 0; i < count; i++) {
        of.level = levels[i];
        compare(&of, NOTHING, expected);
    }
}

static void bits_do_not_depend_on_lists(void **state) {
    (void)state;
    fly_likewise(MSPRING_SOLVER_EXPLICIT, 40);
    fly_likewise(MSPRING_SOLVER_EXPLICIT, 120);
    fly_likewise(MSPRING_SOLVER_IMPLICIT, 8);
}

/// Pairs and candidates in all steps after the first, whose list is made before the splinter has left.
static void count_pairs(float speed, uint32_t sums[2]) {
    mspring_network *network = blocks(&(setting){MSPRING_SOLVER_EXPLICIT, MSPRING_SIMD_AUTO, 1, 40});
    const mspring_id splinter = BLOCKS * WIDTH * HEIGHT - 1; // thrown out of the last block, upwards
    const float x = 0;
    check_ok(mspring_network_detach_particles(network, &splinter, 1));
    check_ok(mspring_network_set_velocities(network, splinter, 1, &x, &speed, 1));
    sums[0] = sums[1] = 0;
    for (uint32_t step = 0; step < STEPS; step++) {
        support_steps(network, 1, DT);
        sums[0] += step > 0 ? network->contacts->count : 0;
        sums[1] += step > 0 ? network->contacts->candidate_count : 0;
    }
    mspring_network_destroy(network);
}

/// Before, a splinter of 1000 m/s gave all points its reach: 30 times as many pairs. Lists reach three times as far
/// where few pairs are candidates, so twice as many pairs are within what may vary.
static void a_fast_splinter_adds_its_own_pairs_only(void **state) {
    (void)state;
    uint32_t slow[2], fast[2];
    count_pairs(1, slow);
    count_pairs(1000, fast);
    printf("pairs %u and %u, candidates %u and %u\n", slow[0], fast[0], slow[1], fast[1]);
    assert_true(slow[0] > 20 * STEPS);
    assert_true(fast[0] < 2 * slow[0] && fast[1] < slow[1] + STEPS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_do_not_depend_on_lists),
        cmocka_unit_test(a_fast_splinter_adds_its_own_pairs_only),
    };
    return cmocka_run_group_tests_name("blast", tests, NULL, NULL);
}
