/// @file test_residual.c
/// Iterations of the implicit solver end where the residual is small enough: hard scenes take more by themselves,
/// and levels and workers take the same.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stddef.h>

#include <massspring/massspring.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/// A bar of mass 1 that is held at its left end.
static recipe bar(uint32_t width, uint32_t height, double stiffness) {
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {stiffness, stiffness}};
    recipe made = {0};
    recipe_lattice(&made, width, height, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < height; row++) {
        made.particles[row * width].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

static void use(mspring_network *network, uint32_t iterations, float residual) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    solver.substeps = 1;
    solver.iterations = iterations;
    solver.residual = residual;
    check_ok(support_set_solver(network, &solver));
}

static double work_of(const mspring_network *network) {
    mspring_step_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_step_info(network, &info));
    return info.work;
}

/// Products with the matrix: a solution is 1, and each 8 products, in calm steps of 8 iterations, or as many as are
/// counted. The first iteration, of whole tiles, is not among them.
static double products_of(const mspring_network *network, double calm) {
    return 8 * (work_of(network) * (1 + (calm - 1) / 8) - 1);
}

/// Mean of the products of steps, and distance from the steps of the direct solver.
typedef struct seen {
    double products, distance;
} seen;

static seen play(const recipe *made, float residual, int steps) {
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = MSPRING_SOLVER_DIRECT;
    mspring_network *network = recipe_network(made, NULL), *exact = recipe_network(made, &def);
    seen s = {0};
    use(network, 1000, residual);
    for (int step = 0; step < steps; step++) {
        support_steps(network, 1, DT);
        support_steps(exact, 1, DT);
        s.products += products_of(network, residual > 0 ? 250 : 1000) / steps;
    }
    for (mspring_id id = 0; id < made->particle_count; id++) {
        const support_point a = support_position(network, id), b = support_position(exact, id);
        s.distance = fmax(s.distance, hypot(a.x - b.x, a.y - b.y));
    }
    mspring_network_destroy(network);
    mspring_network_destroy(exact);
    return s;
}

/// A tenth of the residual takes more products, and is nearer. In one row springs are a chain, for which conjugate
/// gradients need far more than in a bar: the residual finds that.
static void less_is_nearer(void **state) {
    (void)state;
    recipe wide = bar(60, 12, 1e7), thin = bar(60, 2, 1e9);
    const float residuals[] = {0.1f, 0.01f, 0.001f, 1e-6f};
    seen before = {0, INFINITY};
    for (size_t i = 0; i < COUNT_OF(residuals); i++) {
        const seen w = play(&wide, residuals[i], 24), t = play(&thin, residuals[i], 24);
        print_message("%g: %.1f products, %.3g mm off; thin and stiff %.1f, %.3g mm\n", (double)residuals[i],
                      w.products, 1e3 * w.distance, t.products, 1e3 * t.distance);
        assert_true(w.products > before.products && w.distance < before.distance);
        before = w;
    }
    assert_true(before.distance < 1e-4); // of a fall of 0.7 m at most, to 1e-6 of the squared residual
    recipe_free(&wide);
    recipe_free(&thin);
}

/// 0 counts them, and `iterations` is the most in any case.
static void none_counts_the_iterations(void **state) {
    (void)state;
    recipe made = bar(60, 12, 1e7);
    const struct {
        uint32_t given;
        float residual;
        uint32_t iterations;
        double calm;
    } cases[] = {{0, 0, 8, 8},        {0, 1e-12f, 30, 8}, {12, 0, 12, 12},
                 {12, 1e-12f, 12, 8}, {3, 1e-12f, 3, 3},  {0, -0.0f, 8, 8}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        mspring_network *network = recipe_network(&made, NULL);
        use(network, cases[i].given, cases[i].residual);
        mspring_settings now = support_solver(network);
        assert_int_equal(now.iterations, cases[i].iterations);
        assert_true(now.residual == cases[i].residual);
        support_steps(network, 3, DT);
        assert_true(products_of(network, cases[i].calm) == cases[i].iterations - 1);
        mspring_network_destroy(network);
    }
    mspring_network *network = recipe_network(&made, NULL);
    use(network, 0, 1);
    support_steps(network, 3, DT);
    assert_true(products_of(network, 8) == 1); // the one that finds that it is enough
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Default of a network, and of a program from before the field was there.
static void the_default_is_a_hundredth(void **state) {
    (void)state;
    recipe made = bar(6, 3, 1e7);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = MSPRING_SOLVER_IMPLICIT;
    mspring_network *network = recipe_network(&made, &def);
    assert_true(support_solver(network).residual == 0.01f && support_solver(network).iterations == 30);
    use(network, 9, 0.5f);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// The sums that decide have one order. 70 x 70 is shared among workers.
static void levels_and_workers_end_alike(void **state) {
    (void)state;
    recipe made = bar(70, 70, 1e7);
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    const float residuals[] = {0.1f, 0.01f};
    for (size_t r = 0; r < COUNT_OF(residuals); r++) {
        uint64_t hash = 0;
        double work = 0;
        for (uint32_t i = 0; i < count + 2; i++) {
            mspring_network_def def = support_def(-9.8f, 1);
            def.simd_level = levels[i < count ? i : count - 1];
            def.worker_count = i < count ? 1 : 2 + i - count;
            mspring_network *network = recipe_network(&made, &def);
            use(network, 0, residuals[r]);
            support_steps(network, 6, DT);
            if (i == 0) {
                hash = support_hash(network);
                work = work_of(network);
            }
            assert_int_equal(support_hash(network), hash);
            assert_true(work_of(network) == work);
            mspring_network_destroy(network);
        }
    }
    recipe_free(&made);
}

/// Bodies that touch are solved to their own tolerance, however large the residual of calm steps may be.
static void a_stack_lies_still(void **state) {
    (void)state;
    const float residuals[] = {0.1f, 0.01f, 0};
    for (size_t r = 0; r < COUNT_OF(residuals); r++) {
        uint64_t seed = 1;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e6, 1e6}, .damping = {1e3, 1e3}};
        recipe made = {0};
        for (int i = 0; i < 3; i++) {
            recipe_lattice(&made, 8, 4, 0, 0.3 + 3.4 * i, 1, &stuff, &seed);
        }
        mspring_network *network = recipe_network(&made, NULL);
        use(network, 0, residuals[r]);
        const double plane[] = {0, 0, 0, 1};
        mspring_floor_def floor;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        floor.planes = plane;
        floor.plane_count = 1;
        floor.friction = 0.5f;
        check_ok(mspring_network_set_floor(network, &floor));
        mspring_contact_def contact;
        check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
        contact.flags = 0;
        contact.thickness = 0.3;
        contact.friction = 0.5f;
        check_ok(mspring_network_set_contact(network, &contact));
        support_steps(network, 200, DT);
        double fastest = 0;
        for (int step = 0; step < 60; step++) {
            support_steps(network, 1, DT);
            fastest = fmax(fastest, support_largest_speed(network));
        }
        print_message("residual %g: up to %.3g m/s\n", (double)residuals[r], fastest);
        assert_true(fastest < 0.01); // a bar on the floor trembled so where contact had no tolerance of its own
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(less_is_nearer),
        cmocka_unit_test(none_counts_the_iterations),
        cmocka_unit_test(the_default_is_a_hundredth),
        cmocka_unit_test(levels_and_workers_end_alike),
        cmocka_unit_test(a_stack_lies_still),
    };
    return cmocka_run_group_tests_name("residual", tests, NULL, NULL);
}
