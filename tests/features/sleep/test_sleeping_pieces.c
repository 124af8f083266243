/// @file test_sleeping_pieces.c
/// Wrecks of which some pieces sleep: those that share rows, blocks and vectors with them move bit by bit as if
/// nothing slept, and to them what sleeps is pinned.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/// How a network is stepped.
typedef struct way {
    mspring_simd level;
    uint32_t workers;
    mspring_solver solver;
    uint32_t substeps;
    mspring_guard guard;
} way;

static mspring_network *make(const recipe *made, const way *how) {
    mspring_network_def def = support_def(0, how->substeps);
    def.simd_level = how->level;
    def.worker_count = how->workers;
    def.settings.guard = how->guard;
    def.settings.global_damping = 6;
    def.settings.sleep_speed = 0.02f;
    def.settings.sleep_time = 0.25f;
    mspring_network *network = recipe_network(made, &def);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = how->solver;
    solver.substeps = how->substeps;
    check_ok(support_set_solver(network, &solver));
    return network;
}

/// A lattice of which most springs will break, with ropes to and fro, a graph, strands and loose particles, all of
/// them a little out of place.
static recipe scattered(uint32_t width, uint32_t height, uint64_t *seed) {
    const recipe_stuff stuff = {
        .mass = {1, 3}, .stiffness = {500, 1500}, .damping = {1, 4}, .pinned = 0.01, .holes = 0.1};
    const recipe_stuff rope = {.mass = {1, 2}, .stiffness = {500, 1500}, .damping = {1, 4}};
    recipe made = {0};
    recipe_lattice(&made, width, height, 0, 0, 1, &stuff, seed);
    const uint32_t lattice = made.particle_count;
    for (int i = 0; i < 12; i++) {
        const mspring_id a = (mspring_id)(support_random(seed) % lattice);
        const mspring_id b = (mspring_id)((a + 40) % lattice);
        recipe_rope(&made, a, b, 5, &rope, seed);
    }
    for (int i = 0; i < 10; i++) {
        const mspring_id a = recipe_particle(&made, 10.0 * i, -20, 1, 0);
        const mspring_id b = recipe_particle(&made, 10.0 * i + 8, -21, 1, 0);
        recipe_rope(&made, a, b, 8, &rope, seed);
    }
    for (int i = 0; i < 50; i++) {
        recipe_particle(&made, 3.0 * i, -30, 1, 0);
    }
    recipe_disturb(&made, 0.1, 1, seed);
    return made;
}

static void break_most(mspring_network *network, uint32_t percent, uint64_t *seed) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    mspring_id *broken = malloc(springs * sizeof *broken);
    assert_non_null(broken);
    uint32_t count = 0;
    for (mspring_id s = 0; s < springs; s++) {
        broken[count] = s;
        count += support_random(seed) % 100 < percent;
    }
    check_ok(mspring_network_break_springs(network, broken, 0, count));
    free(broken);
}

/// Both networks are in the same places, but for what sleeps in the first; that is where it was.
static void check_places(const mspring_network *asleep, const mspring_network *awake, const double *x,
                         const double *y) {
    const uint32_t count = mspring_network_count(asleep, MSPRING_PARTICLES);
    double *at[4];
    for (int i = 0; i < 4; i++) {
        at[i] = malloc(count * sizeof *at[i]);
        assert_non_null(at[i]);
    }
    check_ok(mspring_network_get_positions(asleep, NULL, 0, count, at[0], at[1], 1));
    check_ok(mspring_network_get_positions(awake, NULL, 0, count, at[2], at[3], 1));
    for (mspring_id p = 0; p < count; p++) {
        const bool still = support_sleeps(asleep, p);
        check_near(at[0][p], still ? x[p] : at[2][p], 0);
        check_near(at[1][p], still ? y[p] : at[3][p], 0);
    }
    for (int i = 0; i < 4; i++) {
        free(at[i]);
    }
}

/// Kick something, and see what moves beside a copy that is kept awake.
static uint32_t kick_and_compare(mspring_network *network, mspring_id particle) {
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    mspring_network *awake = NULL;
    check_ok(mspring_network_clone(network, NULL, &awake));
    double *x = malloc(count * sizeof *x), *y = malloc(count * sizeof *y);
    assert_true(x != NULL && y != NULL);
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    support_kick(network, particle, 3);
    support_kick(awake, particle, 3);
    uint32_t moving = 0;
    for (int i = 0; i < 12; i++) {
        check_ok(mspring_network_wake(awake));
        support_steps(network, 1, DT);
        support_steps(awake, 1, DT);
        check_places(network, awake, x, y);
    }
    for (mspring_id p = 0; p < count; p++) {
        moving += !support_sleeps(network, p);
    }
    mspring_network_destroy(awake);
    free(x);
    free(y);
    return moving;
}

/// Whatever shares rows, blocks and vectors with what sleeps moves bit by bit as if that were awake.
static void what_is_awake_moves_as_if_nothing_slept(void **state) {
    (void)state;
    uint64_t seed = 7;
    recipe made = scattered(70, 20, &seed);
    const way how = {MSPRING_SIMD_AUTO, 1, MSPRING_SOLVER_EXPLICIT, 5, MSPRING_GUARD_GROWTH};
    for (uint32_t percent = 40; percent <= 80; percent += 20) {
        mspring_network *network = make(&made, &how);
        break_most(network, percent, &seed);
        for (int compact = 0; compact < 2; compact++) {
            if (compact) {
                check_ok(mspring_network_compact(network));
            }
            uint32_t some = 0;
            for (int i = 0; i < 8; i++) {
                support_fall_asleep(network, DT);
                const uint32_t moving =
                    kick_and_compare(network, (mspring_id)(support_random(&seed) %
                                                           mspring_network_count(network, MSPRING_PARTICLES)));
                some += moving > 0 && moving < mspring_network_count(network, MSPRING_PARTICLES);
            }
            assert_true(some > 0);
        }
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// A session of falling asleep, kicks, breaking, restoring, compacting; what of it can be seen.
static uint64_t session(const recipe *made, const way *how, uint32_t kicks) {
    uint64_t seed = 11, print = 0;
    mspring_network *network = make(made, how);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    break_most(network, 60, &seed);
    for (uint32_t i = 0; i < kicks; i++) {
        for (int frame = 0; frame < 40; frame++) {
            support_steps(network, 1, DT);
        }
        support_kick(network, (mspring_id)(support_random(&seed) % particles), 2);
        const mspring_id spring = (mspring_id)(support_random(&seed) % springs);
        if (i % 3 == 1) {
            check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        } else if (i % 3 == 2) {
            check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0.2));
        }
        if (i == kicks / 2) {
            check_ok(mspring_network_compact(network));
        }
        for (mspring_id p = 0; p < particles; p++) {
            print = print * 3 + support_sleeps(network, p);
        }
        print = print * 31 + support_hash(network);
    }
    mspring_network_destroy(network);
    return print;
}

static void bits_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    uint64_t seed = 9;
    // Large enough for workers to share it: 400000 springs times substeps, 4096 slots.
    recipe made = scattered(180, 30, &seed);
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
        const uint32_t substeps = solver == MSPRING_SOLVER_EXPLICIT ? 20 : 1;
        const way first = {MSPRING_SIMD_SCALAR, 1, solver, substeps, MSPRING_GUARD_GROWTH};
        const uint64_t expected = session(&made, &first, 6);
        for (uint32_t i = 1; i < level_count; i++) {
            const way how = {levels[i], 1, solver, substeps, MSPRING_GUARD_GROWTH};
            assert_int_equal(session(&made, &how, 6), expected);
        }
        const way shared = {MSPRING_SIMD_AUTO, 3, solver, substeps, MSPRING_GUARD_GROWTH};
        assert_int_equal(session(&made, &shared, 6), expected);
    }
    recipe_free(&made);
}

enum { COLUMNS = 40, ROWS = 100, CUT = 30, SECOND_CUT = 70 };

/// A lattice that is cut into three, one above the other, each with a rope that hangs on it.
static mspring_network *make_three(const way *how) {
    uint64_t seed = 13;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1000, 1000}, .damping = {3, 3}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 15; row < ROWS; row += 35) {
        const mspring_id end = recipe_particle(&made, 48, row, 1, 0);
        recipe_rope(&made, row * COLUMNS + COLUMNS - 1, end, 8, &stuff, &seed);
    }
    mspring_id broken[10 * COLUMNS];
    uint32_t count = 0;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        const uint32_t a = made.springs[s].a / COLUMNS, b = made.springs[s].b / COLUMNS, low = a < b ? a : b;
        if (made.springs[s].b < ROWS * COLUMNS && a != b && (low + 1 == CUT || low + 1 == SECOND_CUT)) {
            broken[count++] = s;
        }
    }
    mspring_network *network = make(&made, how);
    check_ok(mspring_network_break_springs(network, broken, 0, count));
    recipe_free(&made);
    support_fall_asleep(network, DT);
    return network;
}

/// What sleeps is to the others as if it were pinned, bit by bit, though whole rows of it are left out.
static void to_others_sleepers_are_pinned(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        const way how = {MSPRING_SIMD_AUTO, 1, solver, solver == MSPRING_SOLVER_EXPLICIT ? 8 : 1,
                         MSPRING_GUARD_GROWTH};
        mspring_network *network = make_three(&how), *pinned = NULL;
        check_ok(mspring_network_clone(network, NULL, &pinned));
        check_ok(mspring_network_wake(pinned));
        const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
        const float none = 0;
        for (mspring_id p = 0; p < particles; p++) {
            const double y = support_position(network, p).y;
            if (y > CUT - 0.5 && y < SECOND_CUT - 0.5) {
                check_ok(mspring_network_set(pinned, MSPRING_INVERSE_MASS_SCALE, NULL, p, 1, &none, 1));
            }
        }
        mspring_network *const both[] = {network, pinned};
        for (int i = 0; i < 2; i++) {
            for (uint32_t column = 3; column < 20; column++) {
                support_kick(both[i], 5 * COLUMNS + column, 5);
                support_kick(both[i], (CUT - 1) * COLUMNS + column, -3);
                support_kick(both[i], SECOND_CUT * COLUMNS + column, 4);
            }
        }
        for (int frame = 0; frame < 10; frame++) {
            support_steps(network, 1, DT);
            check_ok(mspring_network_wake(pinned));
            support_steps(pinned, 1, DT);
            assert_int_equal(support_hash(network), support_hash(pinned));
        }
        assert_int_equal(support_sleeps(network, 50 * COLUMNS), 1);
        assert_int_equal(support_sleeps(network, 10 * COLUMNS) + support_sleeps(network, 90 * COLUMNS), 0);
        mspring_network_destroy(network);
        mspring_network_destroy(pinned);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_awake_moves_as_if_nothing_slept),
        cmocka_unit_test(bits_are_the_same_everywhere),
        cmocka_unit_test(to_others_sleepers_are_pinned),
    };
    return cmocka_run_group_tests_name("sleeping_pieces", tests, NULL, NULL);
}
