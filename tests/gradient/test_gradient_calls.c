/// @file test_gradient_calls.c
/// Calls of gradients: what is refused is named, steps have the bits of plain ones, what else is done to a network is
/// noticed, memory grows as the root of the steps, and none is lost where it runs out.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring_gradient.h>

#include "support.h"

#define DT (1.0 / 64)

static mspring_builder *truss(void) {
    mspring_builder *b = support_builder();
    for (uint32_t i = 0; i < 12; i++)
        (void)(i < 2 ? support_pinned(b, i / 2, i % 2, 1) : support_particle(b, i / 2, i % 2, 1));
    for (uint32_t i = 0; i < 10; i++) {
        (void)support_spring(b, i, i + 2, 200, 1);
        if (i % 2 == 0) {
            (void)support_spring(b, i, i + 3, 200, 1);
            (void)support_spring(b, i + 1, i + 2, 200, 1);
        }
    }
    return b;
}

static mspring_network *make(mspring_solver solver) {
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.solver = solver;
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.spare_particles = 1;
    return support_network(truss(), &def);
}

static void check_refused(mspring_network *n, const char *what) {
    mspring_gradient *g = NULL;
    check_error(mspring_gradient_create(n, 10, NULL, 0, &g), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(n), what);
    assert_null(g);
    mspring_network_destroy(n);
}

static mspring_network *with_floor(float friction, float restitution, bool has_heights) {
    static const double plane[4] = {0, -1, 0, 1};
    static const float heights[2] = {-1, -1};
    mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.plane_count = !has_heights;
    floor.planes = plane;
    floor.height_count = has_heights ? 2 : 0;
    floor.heights = heights;
    floor.friction = friction;
    floor.restitution = restitution;
    check_ok(mspring_network_set_floor(n, &floor));
    return n;
}

static mspring_network *with_value(mspring_property property, float value) {
    mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
    check_ok(mspring_network_set(n, property, NULL, 3, 1, &value, 1));
    return n;
}

static mspring_network *with_flag(uint32_t flag) {
    mspring_builder *b = truss();
    (void)support_join(b, 0, 5, 0.5f, 1, flag);
    mspring_network_def def = support_def(-9.8f, 8);
    return support_network(b, &def);
}

static void MSPRING_CALL do_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

static void what_has_no_gradient_is_named(void **state) {
    (void)state;
    check_refused(make(MSPRING_SOLVER_IMPLICIT), "implicit or direct solver");
    check_refused(with_floor(0.5f, 0, false), "friction");
    check_refused(with_floor(0, 0.5f, false), "restitution");
    check_refused(with_floor(0, 0, true), "heights");
    check_refused(with_value(MSPRING_BREAK_STRAIN, 0.5f), "spring 3 has a break strain");
    check_refused(with_value(MSPRING_YIELD_STRAIN, 0.5f), "spring 3 has a yield strain");
    check_refused(with_flag(MSPRING_SPRING_RELATIVE), "relative");
    check_refused(with_flag(MSPRING_SPRING_PULL_ONLY), "one-way");
    mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
    const mspring_id spring = 3, corners[4] = {0, 2, 3, 1};
    check_ok(mspring_network_break_springs(n, &spring, 0, 1));
    support_steps(n, 10, DT);
    check_ok(mspring_network_restore_springs(n, &spring, 0, 1, 1.0));
    check_refused(n, "spring 3 has a ramp");
    n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_settings settings = support_settings(n);
    settings.sleep_speed = 0.1f;
    check_ok(mspring_network_set_settings(n, &settings));
    check_refused(n, "sleep_speed");
    n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(n, &contact));
    check_refused(n, "contact");
    n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_grip_def grip;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 4;
    grip.stiffness = 10;
    check_ok(mspring_network_add_grip(n, &grip, NULL));
    check_refused(n, "grips");
    n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_area_def area;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    check_ok(mspring_network_add_area(n, &area, corners, 4, NULL));
    check_refused(n, "areas");
    n = make(MSPRING_SOLVER_EXPLICIT);
    check_ok(support_add_hook(n, MSPRING_PHASE_BEFORE_STEP, do_nothing, NULL, NULL));
    check_refused(n, "hooks");
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    const mspring_id firsts[2] = {0, 12};
    n = support_network(truss(), &def);
    if (mspring_network_set_groups(n, firsts, 1) != MSPRING_OK)
        fail_msg("%s", mspring_network_error(n));
    check_refused(n, "groups");
    n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_particle_def particle;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    mspring_id id;
    check_ok(mspring_network_add_particles(n, &particle, 1, &id));
    check_refused(n, "particle 12 has no spring");
}

static void go(mspring_gradient *g, uint32_t steps) {
    for (uint32_t i = 0; i < steps; i++)
        check_ok(mspring_gradient_step(g, DT, NULL, NULL));
}

static void a_network_has_the_bits_of_plain_steps(void **state) {
    (void)state;
    mspring_network *a = make(MSPRING_SOLVER_EXPLICIT), *b = make(MSPRING_SOLVER_EXPLICIT);
    mspring_gradient *g = NULL;
    const double seed[2] = {1, 2};
    check_ok(mspring_gradient_create(a, 50, NULL, 0, &g));
    go(g, 50);
    support_steps(b, 50, DT);
    assert_int_equal(support_hash(a), support_hash(b));
    check_ok(mspring_gradient_add_seeds(g, NULL, 11, 1, seed, NULL));
    check_ok(mspring_gradient_reverse(g, 50));
    assert_int_equal(support_hash(a), support_hash(b));
    check_error(mspring_gradient_step(g, DT, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_reverse(g, 1), MSPRING_ERROR_ARGUMENT);
    mspring_gradient_destroy(g);
    support_steps(a, 5, DT);
    support_steps(b, 5, DT);
    assert_int_equal(support_hash(a), support_hash(b));
    mspring_network_destroy(a);
    mspring_network_destroy(b);
}

// Edits between steps are an error when these are taken back. Forces and settings are, unless they come where a frame
// holds them: then the derivatives are right.
/// A step that fails, here too long for the stiffness, leaves no force behind: the next attempt gives its own.
static void a_step_may_be_tried_again(void **state) {
    (void)state;
    const mspring_id pushed[] = {11, 6};
    const float forces[][2] = {{3, -40}, {-7.5f, 0.1f}};
    mspring_network *n = make(MSPRING_SOLVER_EXPLICIT), *plain = make(MSPRING_SOLVER_EXPLICIT);
    mspring_gradient *g = NULL;
    const double seed[2] = {1, 0};
    double by_force[4];
    uint64_t hash = 0, expected = 0;
    check_ok(mspring_gradient_create(n, 4, pushed, 2, &g));
    check_ok(mspring_gradient_step(g, DT, NULL, forces[0]));
    check_error(mspring_gradient_step(g, 4, NULL, forces[0]), MSPRING_ERROR_UNSTABLE);
    assert_true(strlen(mspring_gradient_error(g)) > 0);
    check_ok(mspring_gradient_step(g, DT, NULL, forces[0]));
    for (int step = 0; step < 2; step++) {
        check_ok(mspring_network_apply_forces(plain, MSPRING_PUSH_STEP, pushed, 0, 2, forces[0], forces[0] + 1, 2));
        support_steps(plain, 1, DT);
    }
    check_ok(mspring_network_get_state_hash(n, &hash));
    check_ok(mspring_network_get_state_hash(plain, &expected));
    assert_int_equal(hash, expected);
    check_ok(mspring_gradient_add_seeds(g, pushed, 0, 1, seed, NULL));
    check_ok(mspring_gradient_reverse(g, 2));
    check_ok(mspring_gradient_get_forces(g, 1, by_force));
    assert_true(fabs(by_force[0]) > 0);
    mspring_gradient_destroy(g);
    mspring_network_destroy(n);
    mspring_network_destroy(plain);
}

static void what_is_done_between_steps_is_noticed(void **state) {
    (void)state;
    for (int kind = 0; kind < 6; kind++) {
        mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
        mspring_gradient *g = NULL;
        const float value = 190, speed = 1;
        const double x = 5.2, y = 1;
        check_ok(mspring_gradient_create(n, 20, NULL, 0, &g));
        go(g, 7);
        if (kind == 0)
            check_ok(mspring_network_set(n, MSPRING_STIFFNESS, NULL, 4, 1, &value, 1));
        else if (kind == 1)
            check_ok(mspring_network_set_velocities(n, NULL, 8, 1, &speed, &speed, 1));
        else if (kind == 2)
            check_ok(mspring_network_set_positions(n, NULL, 11, 1, &x, &y, 1));
        else if (kind == 3)
            check_ok(mspring_network_apply_force(n, 9, 1, 1));
        else if (kind == 4)
            check_ok(mspring_network_step(n, DT));
        else
            check_ok(support_set_gravity(n, 0, -5));
        go(g, 7);
        const mspring_result result = mspring_gradient_reverse(g, 14);
        assert_true(result == MSPRING_OK ? kind == 3 || kind == 5 : mspring_gradient_error(g)[0] != 0);
        mspring_gradient_destroy(g);
        mspring_network_destroy(n);
    }
}

static void arguments_are_checked(void **state) {
    (void)state;
    mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_gradient *g = NULL;
    const mspring_id twice[2] = {3, 3}, none = 99;
    double value, seed[2] = {NAN, 0};
    check_error(mspring_gradient_create(n, 0, NULL, 0, &g), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_create(n, 1, NULL, 1, &g), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_create(n, 1, twice, 2, &g), MSPRING_ERROR_DUPLICATE);
    check_error(mspring_gradient_create(n, 1, &none, 1, &g), MSPRING_ERROR_ID);
    check_error(mspring_gradient_create(NULL, 1, NULL, 0, &g), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_gradient_create(n, 1, NULL, 0, &g));
    check_error(mspring_gradient_step(g, -1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_gradient_error(g), "dt");
    go(g, 1);
    check_error(mspring_gradient_step(g, DT, NULL, NULL), MSPRING_ERROR_LIMIT);
    check_error(mspring_gradient_add_seeds(g, NULL, 0, 1, seed, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_add_seeds(g, &none, 0, 1, seed, NULL), MSPRING_ERROR_ID);
    check_error(mspring_gradient_get(g, MSPRING_GRADIENT_X, NULL, 12, 1, &value, 1), MSPRING_ERROR_ID);
    check_error(mspring_gradient_get(g, (mspring_gradient_of)7, NULL, 0, 1, &value, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get_forces(g, 1, &value), MSPRING_ERROR_ID);
    check_error(mspring_gradient_reverse(g, 2), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_gradient_reverse(g, 1));
    mspring_gradient_destroy(g);
    mspring_gradient_destroy(NULL);
    mspring_network_destroy(n);
}

/// Each argument alone is wrong, the others are fine.
static void each_argument_is_checked(void **state) {
    (void)state;
    mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
    mspring_gradient *g = NULL;
    const mspring_id forced = 3, far = 12;
    double value, pair[2] = {1, 2};
    check_error(mspring_gradient_create(n, 2, NULL, 0, NULL), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_gradient_create(n, 2, &forced, 1, &g));
    go(g, 2);
    for (int i = 0; i < 4; i++) { // a number that is not finite, at each place
        double at[2] = {0, 0}, by[2] = {0, 0};
        (i < 2 ? at : by)[i % 2] = i % 2 ? INFINITY : NAN;
        check_error(mspring_gradient_add_seeds(g, NULL, 11, 1, at, by), MSPRING_ERROR_ARGUMENT);
    }
    check_error(mspring_gradient_add_seeds(g, NULL, 12, 1, pair, NULL), MSPRING_ERROR_ID);
    check_error(mspring_gradient_add_seeds(g, &far, 0, 1, NULL, pair), MSPRING_ERROR_ID);
    check_error(mspring_gradient_add_seeds(NULL, NULL, 0, 1, pair, NULL), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_gradient_add_seeds(g, NULL, 11, 1, pair, NULL));
    check_ok(mspring_gradient_add_seeds(g, NULL, 11, 1, NULL, pair));
    check_ok(mspring_gradient_reverse(g, 2));
    check_error(mspring_gradient_get(NULL, MSPRING_GRADIENT_X, NULL, 0, 1, &value, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get(g, MSPRING_GRADIENT_X, NULL, 0, 1, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get(g, MSPRING_GRADIENT_X, NULL, 0, 1, &value, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get(g, (mspring_gradient_of)-1, NULL, 0, 1, &value, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get(g, MSPRING_GRADIENT_X, &far, 0, 1, &value, 1), MSPRING_ERROR_ID);
    check_ok(mspring_gradient_get(g, MSPRING_GRADIENT_X, &forced, 0, 1, &value, 1));
    check_ok(mspring_gradient_get(g, MSPRING_GRADIENT_X, NULL, 0, 0, NULL, 1));
    check_error(mspring_gradient_get_forces(NULL, 0, pair), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get_forces(g, 0, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get_forces(g, 2, pair), MSPRING_ERROR_ID);
    check_error(mspring_gradient_get_signals(NULL, 0, &value), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gradient_get_signals(g, 2, &value), MSPRING_ERROR_ID);
    check_ok(mspring_gradient_get_signals(g, 1, NULL)); // there are none
    check_ok(mspring_gradient_get_forces(g, 1, pair));
    mspring_gradient_destroy(g);
    mspring_network_destroy(n);
}

/* ------------------------------------------------------------------------------------------------------------ memory */

/// What an allocator has given out, and when it ends.
typedef struct pool {
    size_t used, most;
    long calls, fails_at;
} pool;

static void *MSPRING_CALL take(size_t size, size_t alignment, void *user) {
    pool *p = user;
    if (p->fails_at >= 0 && p->calls++ >= p->fails_at)
        return NULL;
    (void)alignment;
    p->used += size;
    p->most = p->used > p->most ? p->used : p->most;
    return support_aligned_alloc(size);
}

static void MSPRING_CALL give(void *memory, size_t size, void *user) {
    ((pool *)user)->used -= size;
    support_aligned_free(memory);
}

static mspring_network *make_in(pool *p) {
    mspring_allocator allocator;
    check_ok(mspring_init(MSPRING_STRUCT_ALLOCATOR, &allocator, sizeof allocator));
    allocator.alloc = take;
    allocator.free = give;
    allocator.user = p;
    mspring_network_def def = support_def(-9.8f, 8);
    def.allocator = &allocator;
    return support_network(truss(), &def);
}

static size_t memory_of(uint32_t steps) {
    pool p = {.fails_at = -1};
    mspring_network *n = make_in(&p);
    mspring_gradient *g = NULL;
    const size_t before = p.used;
    check_ok(mspring_gradient_create(n, steps, NULL, 0, &g));
    const size_t made = p.used;
    go(g, steps);
    check_ok(mspring_gradient_reverse(g, steps));
    const size_t most = p.most - made;
    mspring_gradient_destroy(g);
    assert_int_equal(p.used, before);
    mspring_network_destroy(n);
    assert_int_equal(p.used, 0);
    return most;
}

// Sixteen times the steps take four times the frames and moments.
static void memory_grows_as_the_root(void **state) {
    (void)state;
    const size_t few = memory_of(200), many = memory_of(3200);
    print_message("frames and tape: %zu bytes for 200 steps, %zu for 3200\n", few, many);
    assert_true((double)many < 5.0 * (double)few);
}

static void nothing_is_lost_without_memory(void **state) {
    (void)state;
    for (long fails_at = 0; fails_at < 400; fails_at++) {
        pool p = {.fails_at = -1};
        mspring_network *n = make_in(&p);
        mspring_gradient *g = NULL;
        p.calls = 0;
        p.fails_at = fails_at;
        mspring_result result = mspring_gradient_create(n, 9, NULL, 0, &g);
        for (int i = 0; i < 9 && result == MSPRING_OK; i++)
            result = mspring_gradient_step(g, DT, NULL, NULL);
        if (result == MSPRING_OK)
            result = mspring_gradient_reverse(g, 9);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_MEMORY);
        mspring_gradient_destroy(g);
        mspring_network_destroy(n);
        assert_int_equal(p.used, 0);
        if (result == MSPRING_OK)
            return;
    }
    fail_msg("it takes over 400 allocations");
}

// All instruction sets give the same derivatives, bit for bit.
static void derivatives_have_the_same_bits_at_all_levels(void **state) {
    (void)state;
    static const char *const levels[] = {"sse2", "avx2", "avx512"};
    double first[21], values[21];
    for (size_t i = 0; i < COUNT_OF(levels); i++) {
        support_set_variable("MSPRING_SIMD", levels[i]);
        mspring_network *n = make(MSPRING_SOLVER_EXPLICIT);
        mspring_gradient *g = NULL;
        const double seed[2] = {0.3, -0.7};
        check_ok(mspring_gradient_create(n, 30, NULL, 0, &g));
        go(g, 30);
        check_ok(mspring_gradient_add_seeds(g, NULL, 10, 1, seed, seed));
        check_ok(mspring_gradient_reverse(g, 30));
        check_ok(mspring_gradient_get(g, MSPRING_GRADIENT_STIFFNESS, NULL, 0, 20, i == 0 ? first : values, 1));
        check_ok(mspring_gradient_get(g, MSPRING_GRADIENT_VX, NULL, 5, 1, i == 0 ? first + 20 : values + 20, 1));
        if (i > 0)
            assert_memory_equal(values, first, sizeof first);
        mspring_gradient_destroy(g);
        mspring_network_destroy(n);
    }
    support_set_variable("MSPRING_SIMD", NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_has_no_gradient_is_named),         cmocka_unit_test(a_network_has_the_bits_of_plain_steps),
        cmocka_unit_test(a_step_may_be_tried_again),
        cmocka_unit_test(what_is_done_between_steps_is_noticed), cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(each_argument_is_checked),
        cmocka_unit_test(memory_grows_as_the_root),              cmocka_unit_test(nothing_is_lost_without_memory),
        cmocka_unit_test(derivatives_have_the_same_bits_at_all_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
