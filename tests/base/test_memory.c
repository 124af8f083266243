/// @file test_memory.c
/// Every allocation that can fail, failing: the error is MSPRING_ERROR_MEMORY, nothing leaks, and the object is as
/// it was. And no step allocates.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

enum { WIDTH = 30, HEIGHT = 12 };

/// The input of the tests, each kind of add once.
typedef struct input {
    recipe loose;
    mspring_material material;
    uint16_t cells[WIDTH * HEIGHT];
    mspring_lattice_def lattice;
    mspring_rope_def rope;
    mspring_material rope_material;
} input;

static void make_input(input *in) {
    uint64_t seed = 3;
    memset(in, 0, sizeof *in);
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {0.1, 0.2}, .damping = {0, 0.1}, .spring_flags = MSPRING_SPRING_RELATIVE};
    for (int i = 0; i < 300; i++) {
        recipe_particle(&in->loose, 100 + i % 17 * 1.37, i * 0.71, 1, 0);
    }
    recipe_random_springs(&in->loose, 400, &stuff, &seed);
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &in->material, sizeof in->material));
    in->material.stiffness = 100;
    for (size_t i = 0; i < COUNT_OF(in->cells); i++) {
        in->cells[i] = support_random(&seed) % 5 == 0 ? MSPRING_CELL_EMPTY : 0;
    }
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &in->lattice, sizeof in->lattice));
    in->lattice.width = WIDTH;
    in->lattice.height = HEIGHT;
    in->lattice.cells = in->cells;
    in->lattice.materials = &in->material;
    in->lattice.material_count = 1;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &in->rope, sizeof in->rope));
    in->rope.from = 5;
    in->rope.to = 250;
    in->rope.segment_count = 200;
    in->rope_material = mspring_material_default();
    in->rope_material.stiffness = 50;
    in->rope.material = &in->rope_material;
}

typedef struct counts {
    uint32_t particles, springs;
} counts;

static counts counts_of(const mspring_builder *builder) {
    return (counts){mspring_builder_count(builder, MSPRING_PARTICLES),
                    mspring_builder_count(builder, MSPRING_SPRINGS)};
}

/// The result of a call on a builder: if it was out of memory, the builder says so and holds what it held before.
static bool done(mspring_builder *builder, counts before, mspring_result result) {
    if (result == MSPRING_OK) {
        return true;
    }
    check_error(result, MSPRING_ERROR_MEMORY);
    check_contains(support_builder_error(builder), "memory");
    assert_int_equal(counts_of(builder).particles, before.particles);
    assert_int_equal(counts_of(builder).springs, before.springs);
    return false;
}

/// Add everything; after a failure, once more.
static void fill(mspring_builder *builder, const input *in) {
    const recipe *loose = &in->loose;
    counts before = counts_of(builder);
    if (!done(builder, before,
              mspring_builder_add_particles(builder, loose->particles, loose->particle_count, NULL))) {
        check_ok(mspring_builder_add_particles(builder, loose->particles, loose->particle_count, NULL));
    }
    before = counts_of(builder);
    if (!done(builder, before, mspring_builder_add_springs(builder, loose->springs, loose->spring_count, NULL))) {
        check_ok(mspring_builder_add_springs(builder, loose->springs, loose->spring_count, NULL));
    }
    before = counts_of(builder);
    if (!done(builder, before, mspring_builder_add_lattice(builder, &in->lattice, NULL))) {
        check_ok(mspring_builder_add_lattice(builder, &in->lattice, NULL));
    }
    before = counts_of(builder);
    if (!done(builder, before, mspring_builder_add_rope(builder, &in->rope, NULL, NULL))) {
        check_ok(mspring_builder_add_rope(builder, &in->rope, NULL, NULL));
    }
    // One by one until the arrays have to grow again.
    for (uint32_t i = 0; i < 1000; i++) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.x = i;
        particle.y = -10;
        if (!done(builder, counts_of(builder), mspring_builder_add_particles(builder, &particle, 1, NULL))) {
            check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
        }
    }
}

static uint64_t hash_after_steps(mspring_network *network) {
    support_steps(network, 3, 0.005);
    return support_hash(network);
}

/// Hash of the state if no allocation fails.
static uint64_t expected_hash(const input *in) {
    mspring_builder *builder = support_builder();
    fill(builder, in);
    mspring_network *network = support_network(builder, NULL);
    uint64_t hash = hash_after_steps(network);
    mspring_network_destroy(network);
    return hash;
}

static void builders_survive_every_failure(void **state) {
    (void)state;
    input in;
    make_input(&in);
    const uint64_t expected = expected_hash(&in);
    size_t fail_at = 0;
    bool failed = true;
    while (failed) {
        fail_at++;
        watched_allocator watched = {.fail_at = fail_at};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_builder *const untouched = (mspring_builder *)(uintptr_t)16;
        mspring_builder *builder = untouched;
        mspring_result result = mspring_builder_create(&allocator, &builder);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            assert_ptr_equal(builder, untouched);
            assert_int_equal(fail_at, 1);
            check_ok(mspring_builder_create(&allocator, &builder));
        }
        fill(builder, &in);
        failed = watched.calls >= fail_at;
        // It works as if nothing had been.
        mspring_network *network = NULL;
        check_ok(mspring_network_create(builder, NULL, &network));
        assert_int_equal(hash_after_steps(network), expected);
        mspring_network_destroy(network);
        mspring_builder_destroy(builder);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 5); // the builder itself, particles and springs, and both again as they grow
    recipe_free(&in.loose);
}

static void failed_networks_leave_nothing_behind(void **state) {
    (void)state;
    input in;
    make_input(&in);
    const uint64_t expected = expected_hash(&in);
    watched_allocator of_builder = {0};
    mspring_allocator builders = watched_interface(&of_builder);
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(&builders, &builder));
    fill(builder, &in);
    const counts before = counts_of(builder);
    const size_t builder_blocks = of_builder.live;

    // One allocator for both, and different ones: what is needed for a while may come from either.
    mspring_result result = MSPRING_ERROR_MEMORY;
    size_t fail_at = 0;
    while (result != MSPRING_OK) {
        fail_at++;
        watched_allocator of_network = {.fail_at = fail_at};
        mspring_allocator networks = watched_interface(&of_network);
        mspring_network_def def = support_def(-9.8f, 1);
        def.allocator = &networks;
        mspring_network *const untouched = (mspring_network *)(uintptr_t)16;
        mspring_network *network = untouched;
        result = mspring_network_create(builder, &def, &network);
        assert_int_equal(of_builder.live, builder_blocks);
        if (result == MSPRING_OK) {
            assert_true(of_network.calls < fail_at);
            assert_int_equal(hash_after_steps(network), expected);
            assert_true(support_memory_used(network) > 0);
            mspring_network_destroy(network);
        } else {
            assert_ptr_equal(network, untouched);
            assert_true(done(builder, before, result) == false);
        }
        check_watched_clean(&of_network);
    }
    assert_true(fail_at > 10);
    mspring_builder_destroy(builder);
    check_watched_clean(&of_builder);
    recipe_free(&in.loose);
}

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ++*(int *)user;
}

/// Make a network that takes its memory from watched, from now on failing at the n-th allocation.
static mspring_network *watched_network(const recipe *made, watched_allocator *watched, size_t fail_at) {
    mspring_allocator allocator = watched_interface(watched);
    mspring_network_def def = support_def(-9.8f, 2);
    def.allocator = &allocator; // copied: it need not live on
    mspring_network *network = recipe_network(made, &def);
    if (fail_at > 0) {
        watched->fail_at = watched->calls + fail_at;
    }
    return network;
}

static recipe small_recipe(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 90}, .damping = {0, 1}, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 20, 5, 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, 0, 80, 12, &stuff, &seed);
    return made;
}

static void adding_hooks_survives_every_failure(void **state) {
    (void)state;
    recipe made = small_recipe();
    bool failed = true;
    for (size_t fail_at = 1; failed; fail_at++) {
        watched_allocator watched = {0};
        mspring_network *network = watched_network(&made, &watched, fail_at);
        int calls = 0, added = 0;
        failed = false;
        for (int i = 0; i < 300; i++) {
            uint32_t number = 4711;
            mspring_result result = support_add_hook(network, (mspring_phase)(i % 3), count_call, &calls, &number);
            if (result == MSPRING_OK) {
                added++;
            } else {
                check_error(result, MSPRING_ERROR_MEMORY);
                check_contains(mspring_network_error(network), "memory");
                assert_int_equal(number, 4711);
                failed = true;
            }
        }
        assert_int_equal(added, failed ? 299 : 300);
        check_ok(mspring_network_step(network, 0.01));
        assert_true(calls >= added); // each once or twice, and not the one that could not be added
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    recipe_free(&made);
}

static void first_force_survives_failure(void **state) {
    (void)state;
    recipe made = small_recipe();
    bool failed = true;
    size_t fail_at = 1;
    for (; failed; fail_at++) {
        watched_allocator watched = {0}, unwatched = {0};
        mspring_network *network = watched_network(&made, &watched, fail_at);
        mspring_network *twin = watched_network(&made, &unwatched, 0);
        mspring_result result = mspring_network_apply_force(network, 7, 30, 40);
        failed = result != MSPRING_OK;
        if (failed) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
        } else {
            check_ok(mspring_network_apply_force(twin, 7, 30, 40));
        }
        support_steps(network, 2, 0.01);
        support_steps(twin, 2, 0.01);
        assert_int_equal(support_hash(network), support_hash(twin));
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        check_watched_clean(&watched);
        check_watched_clean(&unwatched);
    }
    assert_true(fail_at > 2); // the first force does allocate
    recipe_free(&made);
}

static void check_change_to(mspring_solver kind) {
    recipe made = small_recipe();
    size_t fail_at = 0;
    for (mspring_result result = MSPRING_ERROR_MEMORY; result != MSPRING_OK;) {
        watched_allocator watched = {0}, unwatched = {0};
        mspring_network *network = watched_network(&made, &watched, 0);
        mspring_network *twin = watched_network(&made, &unwatched, 0);
        mspring_settings solver;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
        solver.solver = MSPRING_SOLVER_IMPLICIT;
        check_ok(support_set_solver(network, &solver));
        check_ok(support_set_solver(twin, &solver));
        support_steps(network, 3, 0.01);
        support_steps(twin, 3, 0.01);
        const size_t used = support_memory_used(network);
        solver.solver = kind;
        solver.integrator = MSPRING_INTEGRATOR_BDF2;
        watched.fail_at = watched.calls + ++fail_at;
        result = support_set_solver(network, &solver);
        watched.fail_at = 0;
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_int_equal(support_memory_used(network), used);
            support_steps(network, 5, 0.01);
            support_steps(twin, 5, 0.01);
            assert_int_equal(support_hash(network), support_hash(twin));
        }
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        check_watched_clean(&watched);
        check_watched_clean(&unwatched);
    }
    assert_true(fail_at > 20);
    recipe_free(&made);
}

static void changing_the_solver_survives_every_failure(void **state) {
    (void)state;
    check_change_to(MSPRING_SOLVER_IMPLICIT);
    check_change_to(MSPRING_SOLVER_DIRECT);
}

static void no_step_allocates(void **state) {
    (void)state;
    recipe made = small_recipe();
    watched_allocator watched = {0};
    mspring_network *network = watched_network(&made, &watched, 0);
    const size_t calls = watched.calls, used = support_memory_used(network);
    assert_true(used > 0 && used <= watched.live_bytes);
    support_steps(network, 10, 0.01);
    assert_int_equal(watched.calls, calls);

    int hook_calls = 0;
    for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
        check_ok(support_add_hook(network, phase, count_call, &hook_calls, NULL));
    }
    check_ok(mspring_network_apply_force(network, 3, 1, 1));
    const size_t calls_now = watched.calls;
    assert_true(support_memory_used(network) >= used);
    float f[10] = {0};
    double x[10], y[10];
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    for (int step = 0; step < 10; step++) {
        solver.substeps = 1 + step;
        check_ok(support_set_solver(network, &solver));
        check_ok(support_set_gravity(network, 0, (float)-step));
        check_ok(support_set_global_damping(network, 0.1f));
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 10, f, f, 1));
        check_ok(mspring_network_get_positions(network, NULL, 0, 10, x, y, 1));
        check_ok(mspring_network_set_positions(network, NULL, 0, 10, x, y, 1));
        check_ok(mspring_network_set_velocities(network, NULL, 0, 10, f, f, 1));
        support_steps(network, 1, 0.01);
        (void)support_hash(network);
    }
    assert_int_equal(watched.calls, calls_now);
    assert_true(hook_calls > 0);
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    check_ok(support_set_solver(network, &solver));
    const size_t calls_implicit = watched.calls;
    for (uint32_t step = 0; step < 10; step++) {
        solver.iterations = step;
        check_ok(support_set_solver(network, &solver));
        support_steps(network, 1, 0.01);
    }
    assert_int_equal(watched.calls, calls_implicit);
    solver.solver = MSPRING_SOLVER_DIRECT;
    check_ok(support_set_solver(network, &solver));
    const size_t calls_direct = watched.calls;
    for (uint32_t step = 0; step < 10; step++) {
        // Soft and stiff: in single and in double precision.
        const float stiffness = step % 2 == 0 ? 100.0f : 1e12f;
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, 1, &stiffness, 1));
        check_ok(support_set_solver(network, &solver));
        support_steps(network, 1, 0.01);
    }
    assert_int_equal(watched.calls, calls_direct);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&made);
}

static void stable_dt_survives_every_failure(void **state) {
    (void)state;
    input in;
    make_input(&in);
    for (uint32_t i = 0; i < in.loose.spring_count; i++) {
        in.loose.springs[i].flags = 0;
    }
    watched_allocator watched = {0};
    mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 2);
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&in.loose, &def);
    double expected = 0, now = -1;
    check_ok(mspring_network_get_stable_dt(network, &expected, NULL));
    const uint64_t hash = support_hash(network);
    const size_t live = watched.live, first = watched.calls;
    size_t fail_at = 0;
    for (mspring_result result = MSPRING_ERROR_MEMORY; result != MSPRING_OK;) {
        watched.fail_at = first + ++fail_at;
        watched.calls = first;
        result = mspring_network_get_stable_dt(network, &now, NULL);
        assert_int_equal(watched.live, live);
        assert_int_equal(support_hash(network), hash);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_true(now == -1);
        }
    }
    assert_true(fail_at == 3 && now == expected); // two allocations
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&in.loose);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(builders_survive_every_failure),
        cmocka_unit_test(failed_networks_leave_nothing_behind),
        cmocka_unit_test(adding_hooks_survives_every_failure),
        cmocka_unit_test(first_force_survives_failure),
        cmocka_unit_test(stable_dt_survives_every_failure),
        cmocka_unit_test(changing_the_solver_survives_every_failure),
        cmocka_unit_test(no_step_allocates),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
