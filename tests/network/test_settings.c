/// @file test_settings.c
/// Settings: read back as they were set, refused as a whole, and of no effect where nothing changes.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "allocator.h"
#include "support.h"

#define DT (1.0 / 64)

/// A rope that hangs from a pin, and comes to rest soon.
static mspring_builder *rope(void) {
    mspring_builder *builder = support_builder();
    mspring_id last = support_pinned(builder, 0, 0, 1);
    for (int i = 1; i <= 20; i++) {
        const mspring_id next = support_particle(builder, 0.1 * i, -i, 1);
        support_spring(builder, last, next, 2000, 5);
        last = next;
    }
    return builder;
}

static mspring_network_def resting_def(void) {
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.global_damping = 4;
    return def;
}

static mspring_network *make(float sleep_speed) {
    mspring_network_def def = resting_def();
    def.settings.sleep_speed = sleep_speed;
    return support_network(rope(), &def);
}

static mspring_settings others(void) {
    mspring_settings made = mspring_settings_default();
    made.guard = MSPRING_GUARD_CLAMP;
    made.substeps = 5;
    made.max_substeps = 50;
    made.most_work = 7;
    made.gravity_x = 1;
    made.gravity_y = -2;
    made.global_damping = 3;
    made.max_speed = 1e5f;
    made.sleep_speed = 0.25f;
    made.sleep_time = 2;
    made.relax_fraction = 0.5f;
    return made;
}

static void check_same(const mspring_settings *a, const mspring_settings *b) {
    assert_memory_equal(a, b, sizeof *a);
}

static void what_was_set_is_read(void **state) {
    (void)state;
    mspring_network_def def = resting_def();
    def.settings.gravity_x = 2;
    def.settings.sleep_time = 7;
    def.settings.guard = MSPRING_GUARD_RETRY;
    mspring_network *network = support_network(rope(), &def);
    mspring_settings now = support_settings(network);
    check_same(&now, &def.settings);
    const mspring_settings given = others();
    check_ok(mspring_network_set_settings(network, &given));
    now = support_settings(network);
    check_same(&now, &given);
    mspring_network_destroy(network);
}

static void snapshots_and_clones_have_them(void **state) {
    (void)state;
    mspring_network *network = make(0), *other = make(0.01f), *clone;
    mspring_settings settings = others();
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_set_settings(network, &settings));
        support_bring(network, other, i ? MSPRING_SNAPSHOT_ALL : MSPRING_SNAPSHOT_FRAME);
        check_ok(mspring_network_clone(network, NULL, &clone));
        const mspring_settings brought = support_settings(other), cloned = support_settings(clone);
        check_same(&brought, &settings);
        check_same(&cloned, &settings);
        mspring_network_destroy(clone);
        settings.sleep_speed = 0; // never, and the time is kept all the same
        settings.sleep_time = 3;
    }
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

static void one_bad_value_refuses_all(void **state) {
    (void)state;
    const struct {
        size_t at;
        float value;
        const char *part;
    } bad[] = {
        {offsetof(mspring_settings, gravity_x), NAN, "gravity_x is nan, it must be finite"},
        {offsetof(mspring_settings, gravity_y), INFINITY, "gravity_y is inf"},
        {offsetof(mspring_settings, global_damping), -0.5f, "global_damping is -0.5, it must be 0 to 1e6 1/s"},
        {offsetof(mspring_settings, global_damping), 1.1e6f, "global_damping"},
        {offsetof(mspring_settings, global_damping), NAN, "global_damping"},
        {offsetof(mspring_settings, max_speed), 0, "max_speed is 0, it must be > 0 and at most 1e15 m/s"},
        {offsetof(mspring_settings, max_speed), 2e15f, "max_speed"},
        {offsetof(mspring_settings, sleep_speed), -1, "sleep_speed is -1, it must be 0 to 1e15 m/s"},
        {offsetof(mspring_settings, sleep_time), 1e7f, "sleep_time is 1e+07, it must be 0 to 1e6 s"},
        {offsetof(mspring_settings, relax_fraction), 1.5f, "relax_fraction is 1.5, it must be 0 to 1"},
        {offsetof(mspring_settings, relax_fraction), NAN, "relax_fraction"},
    };
    mspring_network *network = make(0);
    const mspring_settings before = support_settings(network);
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        mspring_settings settings = others();
        memcpy((char *)&settings + bad[i].at, &bad[i].value, sizeof bad[i].value);
        check_error(mspring_network_set_settings(network, &settings), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), bad[i].part);
        const mspring_settings now = support_settings(network);
        check_same(&now, &before);
    }
    mspring_settings settings = others();
    settings.guard = 77;
    check_error(mspring_network_set_settings(network, &settings), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "guard is 77");
    settings = others();
    settings.struct_size = 8;
    check_error(mspring_network_set_settings(network, &settings), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_get_settings(network, &settings), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_set_settings(network, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_settings(NULL, &settings), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_settings(NULL, &settings), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_settings(network, NULL), MSPRING_ERROR_ARGUMENT);
    const mspring_settings now = support_settings(network);
    check_same(&now, &before);
    mspring_network_destroy(network);
}

/// Settings stand at the end of a network's definition, with a size of their own that has to fit.
static void nested_settings_have_their_size(void **state) {
    (void)state;
    const uint32_t whole = sizeof(mspring_settings);
    const uint32_t sizes[] = {0, 8, whole - 4, whole + 4};
    mspring_builder *builder = rope();
    mspring_network *network = NULL;
    mspring_network_def def = resting_def();
    assert_int_equal(def.settings.struct_size, whole);
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        def.settings.struct_size = sizes[i];
        check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_STRUCT);
        check_contains(support_builder_error(builder), "settings.struct_size");
    }
    def.settings = others();
    check_ok(mspring_network_create(builder, &def, &network));
    const mspring_settings now = support_settings(network);
    check_same(&now, &def.settings);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

static void no_memory_changes_nothing(void **state) {
    (void)state;
    mspring_result result = MSPRING_ERROR_MEMORY;
    for (size_t failing = 1; result == MSPRING_ERROR_MEMORY; failing++) {
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = resting_def();
        def.settings.guard = MSPRING_GUARD_BOUNDS;
        def.allocator = &allocator;
        mspring_network *network = support_network(rope(), &def);
        const mspring_settings before = support_settings(network);
        mspring_settings settings = others();
        settings.guard = MSPRING_GUARD_IMPLICIT;
        watched.fail_at = watched.calls + failing;
        result = mspring_network_set_settings(network, &settings);
        watched.fail_at = 0;
        const mspring_settings now = support_settings(network);
        check_same(&now, result == MSPRING_OK ? &settings : &before);
        support_steps(network, 2, DT);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
        assert_true(result != MSPRING_OK || failing > 2);
    }
    check_ok(result);
}

static void the_same_settings_wake_nobody(void **state) {
    (void)state;
    mspring_network *network = make(0.01f);
    support_fall_asleep(network, DT);
    mspring_settings settings = support_settings(network);
    check_ok(mspring_network_set_settings(network, &settings));
    settings.global_damping = 2; // nor do these
    settings.max_speed = 1e5f;
    settings.guard = MSPRING_GUARD_BOUNDS;
    check_ok(mspring_network_set_settings(network, &settings));
    assert_int_equal(support_is_asleep(network), 1);
    float *const waking[] = {&settings.gravity_x, &settings.gravity_y, &settings.sleep_speed, &settings.sleep_time,
                             &settings.relax_fraction};
    for (size_t i = 0; i < COUNT_OF(waking); i++) {
        support_fall_asleep(network, DT);
        *waking[i] += 0.125f;
        check_ok(mspring_network_set_settings(network, &settings));
        assert_int_equal(support_is_asleep(network), 0);
    }
    mspring_network_destroy(network);
}

/// A network may begin to sleep, and cease to, at any time: then it is as one that was made so.
static void sleep_can_be_switched(void **state) {
    (void)state;
    mspring_network *switched = make(0), *made = make(0.01f), *never = make(0);
    support_steps(switched, 10, DT);
    support_steps(made, 10, DT);
    support_steps(never, 10, DT);
    mspring_settings settings = support_settings(switched);
    settings.sleep_speed = 0.01f;
    check_ok(mspring_network_set_settings(switched, &settings));
    check_ok(mspring_network_wake(made));
    int steps = 10;
    for (; !support_is_asleep(made) && steps < 100 * 64; steps++) {
        support_steps(switched, 1, DT);
        support_steps(made, 1, DT);
        support_steps(never, 1, DT);
        assert_int_equal(support_hash(switched), support_hash(made));
    }
    assert_int_equal(support_is_asleep(made), 1);
    assert_int_equal(support_is_asleep(switched), 1);

    settings.sleep_speed = 0;
    check_ok(mspring_network_set_settings(switched, &settings));
    for (int i = 0; i < 200; i++) {
        support_steps(switched, 1, DT);
        assert_int_equal(support_is_asleep(switched), 0);
    }
    assert_int_equal(support_is_asleep(never), 0);
    mspring_network_destroy(switched);
    mspring_network_destroy(made);
    mspring_network_destroy(never);
}

static mspring_network *hooked;
static void read_and_try_to_set(const mspring_hook_args *args, void *user) {
    mspring_settings settings = support_settings(hooked);
    (void)args;
    *(mspring_result *)user = mspring_network_set_settings(hooked, &settings);
}

static void hooks_may_only_read_them(void **state) {
    (void)state;
    mspring_result result = MSPRING_OK;
    hooked = make(0);
    check_ok(support_add_hook(hooked, MSPRING_PHASE_BEFORE_STEP, read_and_try_to_set, &result, NULL));
    support_steps(hooked, 1, DT);
    assert_int_equal(result, MSPRING_ERROR_BUSY);
    mspring_network_destroy(hooked);
}

/* ------------------------------------------------------------------------------------------- solver and floor */

/// What was set is read. Setting that again changes no bit, and wakes nobody.
static void the_solver_is_read_and_set_again(void **state) {
    (void)state;
    const mspring_settings solvers[] = {
        {.solver = MSPRING_SOLVER_EXPLICIT, .substeps = 8, .max_substeps = 77},
        {.solver = MSPRING_SOLVER_EXPLICIT, .substeps = MSPRING_SUBSTEPS_AUTO, .max_substeps = 500},
        {.solver = MSPRING_SOLVER_IMPLICIT,
         .substeps = 2,
         .max_substeps = 9,
         .integrator = MSPRING_INTEGRATOR_BDF2,
         .iterations = 12,
         .tile_size = 16,
         .coarse_period = 3},
        {.solver = MSPRING_SOLVER_IMPLICIT, .substeps = MSPRING_SUBSTEPS_AUTO, .max_substeps = 1},
        {.solver = MSPRING_SOLVER_IMPLICIT, .substeps = 1, .max_substeps = 1, .residual = 0.125f},
        {.solver = MSPRING_SOLVER_DIRECT,
         .substeps = 1,
         .max_substeps = 1000,
         .integrator = MSPRING_INTEGRATOR_EULER},
    };
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make(0.01f), *twin = make(0.01f);
        mspring_settings def = solvers[i];
        def.struct_size = sizeof def;
        const bool is_implicit = def.solver == MSPRING_SOLVER_IMPLICIT;
        check_ok(support_set_solver(network, &def));
        check_ok(support_set_solver(twin, &def));
        for (int step = 0; step < 100; step++) {
            const mspring_settings now = support_solver(network);
            assert_int_equal(now.solver, def.solver);
            assert_int_equal(now.substeps, def.substeps);
            assert_int_equal(now.max_substeps, def.max_substeps);
            assert_int_equal(now.integrator, def.integrator);
            assert_int_equal(now.iterations, def.iterations > 0    ? def.iterations
                                             : !is_implicit        ? now.iterations
                                             : def.residual > 0.0f ? 30u
                                                                   : 8u);
            assert_true(!is_implicit || now.residual == def.residual);
            assert_int_equal(now.tile_size, def.tile_size);
            assert_true(now.coarse_period == def.coarse_period || def.coarse_period == 0);
            check_ok(support_set_solver(network, step % 2 ? &now : &def));
            support_steps(network, 1, DT);
            support_steps(twin, 1, DT);
            assert_int_equal(support_hash(network), support_hash(twin));
        }
        support_fall_asleep(network, DT);
        check_ok(support_set_solver(network, &def));
        assert_int_equal(support_is_asleep(network), 1);
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
    }
}

static void the_floor_is_read_and_set_again(void **state) {
    (void)state;
    const double planes[2][4] = {{0, -15, 0.1, 3}, {-30, 0, 2, 0}};
    const float heights[] = {0, 1, -0.5f, 2};
    mspring_network *network = make(0.01f), *twin = make(0.01f), *clone = NULL;
    mspring_floor_def now = {.struct_size = sizeof now}, def;
    check_ok(mspring_network_get_floor(network, &now));
    assert_int_equal(now.plane_count + now.height_count, 0);
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = planes[0];
    def.plane_count = 2;
    def.heights = heights;
    def.height_count = 4;
    def.heights_x = -5;
    def.heights_y = -18;
    def.spacing = 7;
    def.friction = 0.3f;
    def.restitution = 0.1f;
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_set_floor(twin, &def));
    for (int step = 0; step < 200; step++) {
        check_ok(mspring_network_get_floor(network, &now));
        assert_memory_equal(now.planes, planes, sizeof planes);
        assert_memory_equal(now.heights, heights, sizeof heights);
        check_near(now.friction, 0.3f, 0);
        check_ok(mspring_network_set_floor(network, &now));
        support_steps(network, 1, DT);
        support_steps(twin, 1, DT);
        assert_int_equal(support_hash(network), support_hash(twin));
    }
    support_fall_asleep(network, DT);
    check_ok(mspring_network_set_floor(network, &def));
    assert_int_equal(support_is_asleep(network), 1);
    check_ok(mspring_network_get_floor(network, &now));
    now.friction = 0.5f; // with the network's own heights
    check_ok(mspring_network_set_floor(network, &now));
    assert_int_equal(support_is_asleep(network), 0);
    check_ok(mspring_network_clone(network, NULL, &clone));
    mspring_network_destroy(network);
    check_ok(mspring_network_get_floor(clone, &now));
    assert_memory_equal(now.heights, heights, sizeof heights);
    assert_memory_equal(now.planes, planes, sizeof planes);
    check_ok(mspring_network_set_floor(clone, NULL));
    check_ok(mspring_network_get_floor(clone, &now));
    assert_null(now.planes);
    mspring_network_destroy(clone);
    mspring_network_destroy(twin);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_set_is_read),
        cmocka_unit_test(snapshots_and_clones_have_them),
        cmocka_unit_test(one_bad_value_refuses_all),
        cmocka_unit_test(nested_settings_have_their_size),
        cmocka_unit_test(no_memory_changes_nothing),
        cmocka_unit_test(the_same_settings_wake_nobody),
        cmocka_unit_test(sleep_can_be_switched),
        cmocka_unit_test(hooks_may_only_read_them),
        cmocka_unit_test(the_solver_is_read_and_set_again),
        cmocka_unit_test(the_floor_is_read_and_set_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
