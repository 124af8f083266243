/// @file test_blast.c
/// Fragments a hundred times faster than all else: they add their own pairs and no others, and whoever meets them
/// is found, whenever the lists were made.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "allocator.h"
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
    uint32_t workers, substeps, capacity, max_capacity;
    const mspring_allocator *allocator;
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
    def.settings.solver = of->solver;
    def.simd_level = of->level;
    def.worker_count = of->workers;
    def.allocator = of->allocator;
    mspring_network *network = bodies_network(b, &def);
    static const double plane[4] = {0, -0.01, 0, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    mspring_contact_def contact = bodies_contact(THICKNESS, 0.3f, 0);
    contact.capacity = of->capacity;
    contact.max_capacity = of->max_capacity;
    check_ok(mspring_network_set_contact(network, &contact));
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
    check_ok(mspring_network_detach_particles(network, torn, 0, count));
    for (uint32_t i = 0; i < count; i++) {
        const float vx = speed * ((float)(torn[i] % WIDTH) - 9), vy = speed * ((float)(torn[i] / WIDTH) - 4);
        check_ok(mspring_network_set_velocities(network, NULL, torn[i], 1, &vx, &vy, 1));
    }
}

static mspring_step_info info_of(const mspring_network *network) {
    mspring_step_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_step_info(network, &info));
    return info;
}

static mspring_contact_def contact_of(const mspring_network *network) {
    mspring_contact_def def = {.struct_size = sizeof def};
    check_ok(mspring_network_get_contact(network, &def));
    return def;
}

/// Other things that a host does. None of them may change a bit.
typedef enum besides { NOTHING, DROP_LISTS, ROLL_BACK } besides;

/// Returns how many steps made room.
static uint32_t fly(const setting *of, besides what, uint64_t *hashes) {
    mspring_network *network = blocks(of);
    uint32_t grew = 0;
    for (uint32_t step = 0; step < STEPS; step++) {
        if (step == BLAST)
            blow_up(network, 40);
        if (what == DROP_LISTS)
            check_ok(support_set_layers(network, 0, BLOCKS * WIDTH * HEIGHT, 1, UINT32_MAX));
        if (what == ROLL_BACK && step >= BLAST && step % 4 == 3) {
            saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
            support_steps(network, 3, DT);
            snapshots_load(network, &frame);
            free(frame.bytes);
        }
        support_steps(network, 1, DT);
        hashes[step] = support_hash(network);
        grew += (info_of(network).flags & MSPRING_STEP_GREW) != 0;
        assert_true(info_of(network).work == 1 || what != NOTHING || of->solver != MSPRING_SOLVER_EXPLICIT);
    }
    mspring_network_destroy(network);
    return grew;
}

static uint32_t compare(const setting *of, besides what, const uint64_t *expected) {
    uint64_t hashes[STEPS];
    const uint32_t grew = fly(of, what, hashes);
    for (uint32_t step = 0; step < STEPS; step++)
        if (hashes[step] != expected[step])
            fail_msg("solver %d, level %d, %u workers, %u substeps, besides %d: other bits in step %u", of->solver,
                     of->level, of->workers, of->substeps, what, step);
    return grew;
}

static void fly_likewise(mspring_solver solver, uint32_t substeps) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    setting of = {.solver = solver, .workers = 1, .substeps = substeps};
    uint64_t expected[STEPS];
    (void)fly(&of, NOTHING, expected);
    (void)compare(&of, DROP_LISTS, expected);
    (void)compare(&of, ROLL_BACK, expected);
    of.workers = 3;
    (void)compare(&of, NOTHING, expected);
    for (uint32_t i = 0; i < count; i++) {
        of.level = levels[i];
        (void)compare(&of, NOTHING, expected);
    }
}

static void bits_do_not_depend_on_lists(void **state) {
    (void)state;
    fly_likewise(MSPRING_SOLVER_EXPLICIT, 40);
    if (!ROUNDS_ARE_FEW)
        fly_likewise(MSPRING_SOLVER_EXPLICIT, 120);
    fly_likewise(MSPRING_SOLVER_IMPLICIT, 8);
}

/// Pairs and candidates in all steps after the first, whose list is made before the splinter has left.
static void count_pairs(float speed, uint32_t sums[2]) {
    mspring_network *network = blocks(&(setting){.workers = 1, .substeps = 40});
    const mspring_id splinter = BLOCKS * WIDTH * HEIGHT - 1; // thrown out of the last block, upwards
    const float x = 0;
    check_ok(mspring_network_detach_particles(network, &splinter, 0, 1));
    check_ok(mspring_network_set_velocities(network, NULL, splinter, 1, &x, &speed, 1));
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

/* ------------------------------------------------------------------------------------------------------ room */

static void grow(mspring_solver solver, uint32_t substeps) {
    setting of = {.solver = solver, .workers = 1, .substeps = substeps, .capacity = 1u << 16};
    uint64_t expected[STEPS];
    assert_int_equal(fly(&of, NOTHING, expected), 0);
    for (uint32_t part = 0; part < 5; part += ROUNDS_ARE_FEW ? 2 : 1) {
        of.capacity = (uint32_t[]){0, 1, 100, 1000, 1u << 18}[part];
        const uint32_t grew = compare(&of, NOTHING, expected);
        assert_true(grew > 0 || (part != 1 && part != 2));
    }
    of.capacity = 50;
    if (!ROUNDS_ARE_FEW)
        (void)compare(&of, DROP_LISTS, expected);
    (void)compare(&of, ROLL_BACK, expected);
}

static void room_that_grows_changes_no_bits(void **state) {
    (void)state;
    grow(MSPRING_SOLVER_EXPLICIT, 40);
    grow(MSPRING_SOLVER_IMPLICIT, 8);
    if (!ROUNDS_ARE_FEW)
        grow(MSPRING_SOLVER_DIRECT, 8);
}

/// As many pairs as may be: no step allocates, and one that needs more changes nothing.
static void fixed_room_never_grows(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network *network = blocks(
        &(setting){.workers = 1, .substeps = 40, .capacity = 150, .max_capacity = 150, .allocator = &allocator});
    assert_int_equal(contact_of(network).max_capacity, 150);
    support_steps(network, BLAST, DT);
    blow_up(network, 40);
    const size_t calls = watched.calls;
    mspring_result result = MSPRING_OK;
    uint64_t before = 0;
    for (uint32_t step = 0; step < STEPS && result == MSPRING_OK; step++) {
        before = support_hash(network);
        result = mspring_network_step(network, DT);
    }
    assert_int_equal(result, MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "larger max_capacity");
    assert_true(watched.calls == calls && support_hash(network) == before);
    mspring_contact_def def = contact_of(network);
    def.max_capacity = 0; // from now on it may grow
    check_ok(mspring_network_set_contact(network, &def));
    assert_true(support_hash(network) == before);
    check_ok(mspring_network_step(network, DT));
    assert_true(info_of(network).flags & MSPRING_STEP_GREW);
    assert_true(contact_of(network).capacity > 150 && contact_of(network).max_capacity > 4 * 4096);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
}

/// Whichever allocation fails, the step changes nothing, and the next one is as if it had not been tried.
static void a_failed_allocation_changes_nothing(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        setting of = {.solver = (mspring_solver)solver, .workers = 1, .substeps = 40, .capacity = 1u << 16};
        mspring_network *enough = blocks(&of);
        of.capacity = 1;
        of.allocator = &allocator;
        mspring_network *network = blocks(&of);
        const uint64_t before = support_hash(network);
        mspring_result result = MSPRING_ERROR_MEMORY;
        for (size_t n = 1; n < 200 && result != MSPRING_OK; n++) {
            watched.fail_at = watched.calls + n;
            result = mspring_network_step(network, DT);
            assert_true(result == MSPRING_OK || result == MSPRING_ERROR_MEMORY);
            if (result != MSPRING_OK)
                check_contains(mspring_network_error(network), "pairs");
            assert_true(result == MSPRING_OK || support_hash(network) == before);
        }
        watched.fail_at = 0;
        check_ok(result);
        support_steps(enough, 1, DT);
        assert_true(support_hash(network) == support_hash(enough));
        support_steps(network, 5, DT);
        support_steps(enough, 5, DT);
        assert_true(support_hash(network) == support_hash(enough));
        mspring_network_destroy(network);
        mspring_network_destroy(enough);
        check_watched_clean(&watched);
    }
}

static void wrong_room_is_refused(void **state) {
    (void)state;
    mspring_network *network = blocks(&(setting){.workers = 1, .substeps = 40});
    mspring_contact_def def = contact_of(network);
    const uint32_t capacity = def.capacity;
    def.max_capacity = capacity - 1;
    check_error(mspring_network_set_contact(network, &def), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "max_capacity");
    def.max_capacity = (1u << 26) + 1;
    check_error(mspring_network_set_contact(network, &def), MSPRING_ERROR_ARGUMENT);
    def.capacity = 0; // as much as there may be
    def.max_capacity = 7;
    check_ok(mspring_network_set_contact(network, &def));
    assert_int_equal(contact_of(network).capacity, 7);
    mspring_network_destroy(network);
}

/// Boxes that all begin in one place are refused within the room that steps may make by default, before work that
/// takes seconds.
static void a_crowd_is_refused(void **state) {
    (void)state;
    enum { BOXES = 30, SIDE = 5 };
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e4, 1e4}, .damping = {10, 10}};
    uint64_t seed = 3;
    recipe made = {0};
    for (int i = 0; i < BOXES; i++)
        recipe_lattice(&made, SIDE, SIDE, support_random_between(&seed, 0, 0.1), support_random_between(&seed, 0, 0.1), 1,
                       &stuff, &seed);
    mspring_network *network = recipe_network(&made, NULL);
    recipe_free(&made);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.3;
    check_ok(mspring_network_set_contact(network, &contact));
    const uint64_t before = support_hash(network);
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "larger max_capacity");
    assert_true(support_hash(network) == before);
    // 16 pairs for each of the 16 particles around a box, 2 for each particle, and 4096: 16 times
    const uint32_t most = 16 * (16 * 16 * BOXES + 2 * SIDE * SIDE * BOXES + 4096);
    assert_int_equal(contact_of(network).max_capacity, most);
    assert_true(contact_of(network).capacity <= most);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_do_not_depend_on_lists),
        cmocka_unit_test(a_fast_splinter_adds_its_own_pairs_only),
        cmocka_unit_test(room_that_grows_changes_no_bits),
        cmocka_unit_test(fixed_room_never_grows),
        cmocka_unit_test(a_failed_allocation_changes_nothing),
        cmocka_unit_test(wrong_room_is_refused),
        cmocka_unit_test(a_crowd_is_refused),
    };
    return cmocka_run_group_tests_name("blast", tests, NULL, NULL);
}
