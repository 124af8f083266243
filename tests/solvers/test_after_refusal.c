/// @file test_after_refusal.c
/// After numbers overflowed in an implicit step, the next steps are those of a network that never saw it.
///
/// SPDX-License-Identifier: MIT
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

/// A small lattice and a particle on it, added later and laid out by a compaction, so that all of it is irregular.
static mspring_network *grown(mspring_guard guard, mspring_solver solver) {
    mspring_network_def def = support_def(-9.8f, 2);
    def.settings.solver =
        solver == MSPRING_SOLVER_DIRECT ? MSPRING_SOLVER_IMPLICIT : solver; // the direct one takes no springs
    def.settings.guard = guard;
    def.spare_particles = 4;
    def.spare_springs = 8;
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(NULL, &builder));
    for (mspring_id i = 0; i < 12; i++) {
        support_particle(builder, i % 4, i / 4, 1);
    }
    for (mspring_id i = 0; i < 12; i++) {
        if (i % 4 < 3) {
            support_spring(builder, i, i + 1, 1000, 0);
        }
        if (i < 8) {
            support_spring(builder, i, i + 4, 1000, 0);
        }
    }
    mspring_network *network = support_network(builder, &def);
    mspring_particle_def particle;
    mspring_spring_def spring;
    mspring_id id, ignored;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = -3;
    check_ok(mspring_network_add_particles(network, &particle, 1, &id));
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = id, spring.b = 0, spring.stiffness = 100;
    check_ok(mspring_network_add_springs(network, &spring, 1, &ignored));
    support_steps(network, 10, 1.0 / 60);
    check_ok(mspring_network_compact(network));
    mspring_settings most = support_solver(network);
    if (solver == MSPRING_SOLVER_DIRECT) {
        most.solver = solver;
        most.substeps = 2;
    }
    most.most_work = 0; // else MSPRING_GUARD_RETRY may keep more substeps after a step that fails
    check_ok(support_set_solver(network, &most));
    return network;
}

static void a_refused_step_leaves_no_trace(void **state) {
    (void)state;
    static const mspring_guard guards[] = {MSPRING_GUARD_GROWTH, MSPRING_GUARD_BOUNDS, MSPRING_GUARD_RETRY};
    static const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT,
                                             MSPRING_SOLVER_EXPLICIT};
    for (size_t i = 0; i < COUNT_OF(guards) * COUNT_OF(solvers); i++) {
        uint64_t hashes[2];
        for (int refused = 0; refused < 2; refused++) {
            mspring_network *network = grown(guards[i % COUNT_OF(guards)], solvers[i / COUNT_OF(guards)]);
            check_ok(mspring_network_apply_force(network, 2, 1e30f, 0));
            if (refused) {
                check_error(mspring_network_step(network, 1.0 / 60), MSPRING_ERROR_UNSTABLE);
            }
            check_ok(mspring_network_apply_force(network, 2, -1e30f, 0));
            support_steps(network, 5, 1.0 / 60);
            hashes[refused] = support_hash(network);
            mspring_network_destroy(network);
        }
        assert_int_equal(hashes[0], hashes[1]);
    }
}

/// The state is put back into its bounds then. A snapshot of it, loaded elsewhere, has the same future.
static void a_clamped_step_leaves_no_trace(void **state) {
    (void)state;
    static const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT,
                                             MSPRING_SOLVER_EXPLICIT};
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = grown(MSPRING_GUARD_CLAMP_BOUNDS, solvers[i]);
        mspring_network *other = grown(MSPRING_GUARD_CLAMP_BOUNDS, solvers[i]);
        check_ok(mspring_network_apply_force(network, 2, 1e30f, 0));
        check_ok(mspring_network_step(network, 1.0 / 60));
        support_bring(network, other, MSPRING_SNAPSHOT_ALL);
        support_steps(network, 5, 1.0 / 60);
        support_steps(other, 5, 1.0 / 60);
        assert_int_equal(support_hash(network), support_hash(other));
        mspring_network_destroy(network);
        mspring_network_destroy(other);
    }
}

static size_t save(const mspring_network *network, unsigned char *bytes, size_t capacity) {
    size_t size = 0;
    memset(bytes, 0, capacity);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, bytes, capacity, &size));
    return size;
}

static void move_away(mspring_network *network) {
    double x[32], y[32];
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    assert_true(count <= COUNT_OF(x));
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    for (uint32_t i = 0; i < count; i++)
        x[i] += 100;
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
}

// Ends of broken springs and added particles begin a history, also with an integrator that keeps none. So does all, if
// the host has moved it just before.
static void a_refused_step_leaves_no_trace_in_snapshots(void **state) {
    (void)state;
    static const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    static unsigned char bytes[2][1 << 16];
    for (uint32_t i = 0; i < 6 * COUNT_OF(solvers); i++) {
        size_t sizes[2];
        const bool is_moved = i >= 3 * COUNT_OF(solvers);
        const mspring_solver solver = solvers[i / 3 % COUNT_OF(solvers)];
        for (int refused = 0; refused < 2; refused++) {
            mspring_network *network = grown(MSPRING_GUARD_GROWTH, solver);
            mspring_settings def;
            check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
            def.solver = solver;
            def.integrator = (mspring_integrator)(i % 3);
            def.substeps = 1;
            check_ok(support_set_solver(network, &def));
            support_steps(network, 3, 1.0 / 60);
            check_ok(mspring_network_break_springs(network, (mspring_id[]){0, 3}, 0, 2));
            support_steps(network, 1 + i / 3 % 2, 1.0 / 60);
            if (is_moved)
                move_away(network);
            check_ok(mspring_network_apply_force(network, 2, 1e30f, 0));
            if (refused)
                check_error(mspring_network_step(network, 1.0 / 60), MSPRING_ERROR_UNSTABLE);
            check_ok(mspring_network_apply_force(network, 2, -1e30f, 0));
            support_steps(network, 5, 1.0 / 60);
            sizes[refused] = save(network, bytes[refused], sizeof bytes[0]);
            mspring_network_destroy(network);
        }
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    }
}

// Two towers of which one falls onto the other. What overflowed left a reach without end, and a list without pairs.
static mspring_network *towers(mspring_guard guard) {
    mspring_network_def def = support_def(-9.8f, 8);
    mspring_contact_def contact;
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(NULL, &builder));
    def.settings.guard = guard;
    for (mspring_id i = 0; i < 8; i++)
        support_particle(builder, 0.3 * (i / 4) + i % 2, 1.3 * (i / 4) + i % 4 / 2, 1);
    for (mspring_id i = 0; i < 8; i++)
        for (mspring_id j = i + 1; j < 8 && j / 4 == i / 4; j++)
            support_spring(builder, i, j, 300, 1);
    support_pinned(builder, 0.5, -1, 1);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.1;
    check_ok(mspring_network_set_contact(network, &contact));
    support_steps(network, 20, 1.0 / 60);
    return network;
}

static void a_refused_step_leaves_no_trace_in_contact(void **state) {
    (void)state;
    static const mspring_guard guards[] = {MSPRING_GUARD_GROWTH, MSPRING_GUARD_BOUNDS};
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        uint64_t hashes[2];
        for (int refused = 0; refused < 2; refused++) {
            mspring_network *network = towers(guards[i]);
            check_ok(mspring_network_apply_force(network, 4, -1e37f, -3e38f));
            if (refused)
                check_error(mspring_network_step(network, 1.0 / 60), MSPRING_ERROR_UNSTABLE);
            check_ok(mspring_network_apply_force(network, 4, 1e37f, 3e38f));
            support_steps(network, 30, 1.0 / 60);
            hashes[refused] = support_hash(network);
            mspring_network_destroy(network);
        }
        assert_int_equal(hashes[0], hashes[1]);
    }
}

/// Nor does it where workers share the strips of a lattice and copy each other's borders.
static void workers_take_back_their_borders(void **state) {
    (void)state;
    enum { WIDTH = 130, HEIGHT = 90 };
    const uint64_t seeds[] = {1, 2, 3, 4};
    uint64_t hashes[1 + COUNT_OF(seeds)];
    for (size_t trial = 0; trial < COUNT_OF(hashes); trial++) {
        mspring_network_def def = support_def(-9.8f, 24);
        def.settings.guard = MSPRING_GUARD_GROWTH;
        def.worker_count = 3;
        recipe made = {0};
        uint64_t seed = 9;
        const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1e4, 2e4}};
        recipe_lattice(&made, WIDTH, HEIGHT, 0, 0, 1, &stuff, &seed);
        mspring_network *network = recipe_network(&made, &def);
        support_steps(network, 3, 1.0 / 60);
        if (trial > 0) {
            seed = seeds[trial - 1];
            const mspring_id struck = (mspring_id)(support_random(&seed) % made.particle_count);
            check_ok(mspring_network_apply_force(network, struck, 3e38f, 3e38f));
            check_error(mspring_network_step(network, 1.0 / 60), MSPRING_ERROR_UNSTABLE);
            check_ok(mspring_network_apply_force(network, struck, -3e38f, -3e38f));
        }
        support_steps(network, 3, 1.0 / 60);
        hashes[trial] = support_hash(network);
        assert_int_equal(hashes[trial], hashes[0]);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Every allocation that fails fails the choice of a solver, which is made as if nothing had happened by the next one.
static void no_memory_is_told(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        size_t needed = 0;
        for (size_t nth = 0; nth <= needed; nth++) {
            watched_allocator watched = {0};
            const mspring_allocator allocator = watched_interface(&watched);
            mspring_builder *builder = support_builder();
            for (mspring_id i = 0; i < 5; i++) // two of them loose
                support_particle(builder, i, 0, 1);
            support_spring(builder, 0, 1, 1000, 0);
            support_spring(builder, 1, 2, 1000, 0);
            mspring_network_def def = support_def(-9.8f, 1);
            def.allocator = &allocator;
            mspring_network *network = support_network(builder, &def);
            mspring_settings chosen = support_solver(network);
            chosen.solver = solver;
            chosen.integrator = MSPRING_INTEGRATOR_BDF2;
            const size_t before = watched.calls;
            watched.fail_at = nth > 0 ? before + nth : 0;
            check_error(mspring_network_set_settings(network, &chosen), nth > 0 ? MSPRING_ERROR_MEMORY : MSPRING_OK);
            needed = nth > 0 ? needed : watched.calls - before;
            watched.fail_at = 0;
            check_ok(mspring_network_set_settings(network, &chosen));
            support_steps(network, 2, 0.01);
            mspring_network_destroy(network);
            check_watched_clean(&watched);
        }
        assert_true(needed > 10);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refused_step_leaves_no_trace),
        cmocka_unit_test(a_clamped_step_leaves_no_trace),
        cmocka_unit_test(a_refused_step_leaves_no_trace_in_snapshots),
        cmocka_unit_test(a_refused_step_leaves_no_trace_in_contact),
        cmocka_unit_test(workers_take_back_their_borders),
        cmocka_unit_test(no_memory_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
