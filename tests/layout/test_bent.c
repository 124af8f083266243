/// @file test_bent.c
/// Lattices that lie at an angle, are oblong or slanted, or bend: found as such, and they move as any other.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "reference.h"
#include "support.h"

static const recipe_stuff solid = {.mass = {1, 2}, .stiffness = {300, 600}, .damping = {0, 1}};

static const double degree = 0.017453292519943295;

/// Where a lattice's particle goes.
typedef struct shape {
    const char *name;
    support_point (*place)(double column, double row, double by);
    double by;
} shape;

static support_point turned(double column, double row, double degrees) {
    const double c = cos(degrees * degree), s = sin(degrees * degree);
    return (support_point){c * column - s * row, s * column + c * row};
}

static support_point oblong(double column, double row, double by) {
    return (support_point){by * column, row};
}

static support_point slanted(double column, double row, double by) {
    return (support_point){column + by * row, row};
}

/// About a centre so far below.
static support_point bent(double column, double row, double radius) {
    return (support_point){(radius + row) * sin(column / radius), (radius + row) * cos(column / radius)};
}

/// Every corner off by up to that much, the same way each time.
static support_point rough(double column, double row, double by) {
    uint64_t seed = (uint64_t)(1000 * row + column);
    support_random(&seed);
    const double dx = support_random_between(&seed, -by, by), dy = support_random_between(&seed, -by, by);
    const support_point at = turned(column, row, 33);
    return (support_point){at.x + dx, at.y + dy};
}

static const shape shapes[] = {
    {"turned by 10 degrees", turned, 10},
    {"by 20", turned, 20},
    {"by 30", turned, 30},
    {"by 45", turned, 45},
    {"by 67", turned, 67},
    {"by 90", turned, 90},
    {"by 200", turned, 200},
    {"oblong", oblong, 2.5},
    {"standing", oblong, 0.3},
    {"slanted", slanted, 0.5},
    {"slanted back", slanted, -0.5},
    {"half a ring", bent, 60 / 3.14},
    {"a bow", bent, 100},
    {"rough", rough, 0.1},
};

static recipe make(const shape *kind, uint32_t width, uint32_t height) {
    recipe made = {0};
    uint64_t seed = 7;
    recipe_lattice(&made, width, height, 0, 0, 1, &solid, &seed);
    for (uint32_t i = 0; i < made.particle_count; i++) {
        const support_point at = kind->place(made.particles[i].x, made.particles[i].y, kind->by);
        made.particles[i].x = at.x;
        made.particles[i].y = at.y;
    }
    return made;
}

static support_plan shuffled_plan_of(recipe *made) {
    uint64_t seed = 99;
    recipe_shuffle(made, &seed, NULL);
    mspring_network *network = recipe_network(made, NULL);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    mspring_network_destroy(network);
    return plan;
}

static void lattices_of_any_shape_are_found(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(shapes); i++) {
        recipe made = make(&shapes[i], 60, 12);
        const support_plan plan = shuffled_plan_of(&made);
        if (plan.lattice_count != 1 || plan.lattice_springs != made.spring_count) {
            fail_msg("%s: %u lattices with %u of %u springs", shapes[i].name, plan.lattice_count,
                     plan.lattice_springs, made.spring_count);
        }
        recipe_free(&made);
    }
}

/// Three springs meet in each: the third goes from the right below to the left above, the long diagonal is missing.
static void triangles_are_a_lattice(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 12; i++) {
        recipe made = {0};
        const uint32_t width = 40, height = 30;
        for (uint32_t p = 0; p < width * height; p++) {
            const double column = p % width, row = p / width;
            const support_point at = turned(column + 0.5 * row, 0.8660254037844386 * row, 10 * i);
            recipe_particle(&made, at.x, at.y, 1, 0);
        }
        for (uint32_t p = 0; p < width * height; p++) {
            const bool has_right = p % width + 1 < width, has_left = p % width > 0,
                       has_above = p / width + 1 < height;
            if (has_right) {
                recipe_spring(&made, p, p + 1, 100, 0, 0);
            }
            if (has_above) {
                recipe_spring(&made, p, p + width, 100, 0, 0);
            }
            if (has_above && has_left) {
                recipe_spring(&made, p, p + width - 1, 100, 0, 0);
            }
        }
        const support_plan plan = shuffled_plan_of(&made);
        assert_int_equal(plan.lattice_count, 1);
        assert_int_equal(plan.lattice_springs, made.spring_count);
        recipe_free(&made);
    }
}

/// All of a ring but where it closes, which is three springs to a row.
static void rings_are_lattices_that_are_closed_once(void **state) {
    (void)state;
    const uint32_t around[] = {60, 100, 300}, rows[] = {6, 8, 12};
    for (size_t k = 0; k < COUNT_OF(around); k++) {
        recipe made = {0};
        const uint32_t columns = around[k], height = rows[k];
        for (uint32_t p = 0; p < columns * height; p++) {
            const double radius = columns / 6.283185307 + p / columns - height / 2.0;
            const support_point at = turned(0, radius, 360.0 * (p % columns) / columns);
            recipe_particle(&made, at.x, at.y, 1, 0);
        }
        for (uint32_t row = 0; row < height; row++) {
            for (uint32_t column = 0; column < columns; column++) {
                const uint32_t here = row * columns + column, next = row * columns + (column + 1) % columns;
                recipe_spring(&made, here, next, 100, 0, 0);
                if (row + 1 < height) {
                    recipe_spring(&made, here, here + columns, 100, 0, 0);
                    recipe_spring(&made, here, next + columns, 100, 0, 0);
                    recipe_spring(&made, next, here + columns, 100, 0, 0);
                }
            }
        }
        const support_plan plan = shuffled_plan_of(&made);
        assert_int_equal(plan.lattice_count, 1);
        assert_in_range(plan.irregular_springs, 1, 3 * height);
        recipe_free(&made);
    }
}

/// A tenth of a millimetre: positions up to 60 m are exact to 4 um in single precision, and a hundred substeps add
/// up some of that.
static void they_move_as_the_reference(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(shapes); i++) {
        recipe made = make(&shapes[i], 60, 5);
        uint64_t seed = 5;
        recipe_disturb(&made, 0.02, 0.5, &seed);
        reference exact = reference_of(&made, 0, -9.8, 0.2);
        mspring_network_def def = support_def(-9.8f, 4);
        def.settings.global_damping = 0.2f;
        mspring_network *network = recipe_network(&made, &def);
        for (int substep = 0; substep < 100; substep++) {
            reference_substep(&exact, 1.0 / 256);
        }
        support_steps(network, 25, 4.0 / 256);
        for (mspring_id id = 0; id < made.particle_count; id++) {
            const support_point p = support_position(network, id);
            check_near(p.x, exact.particles[id].x, 1e-4);
            check_near(p.y, exact.particles[id].y, 1e-4);
        }
        mspring_network_destroy(network);
        reference_free(&exact);
        recipe_free(&made);
    }
}

static mspring_network *hanging(double degrees, mspring_solver which) {
    const shape kind = {"", turned, degrees};
    recipe made = make(&kind, 24, 6);
    for (uint32_t row = 0; row < 6; row++) {
        made.particles[24 * row].flags = MSPRING_PARTICLE_PINNED;
    }
    const support_point down = turned(0, -9.8, degrees);
    mspring_network_def def = support_def((float)down.y, 20);
    def.settings.gravity_x = (float)down.x;
    mspring_network *network = recipe_network(&made, &def);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = which;
    solver.substeps = which == MSPRING_SOLVER_EXPLICIT ? 20 : 1;
    solver.iterations = which == MSPRING_SOLVER_IMPLICIT ? 40 : 0;
    check_ok(support_set_solver(network, &solver));
    support_steps(network, 32, 1.0 / 64);
    recipe_free(&made);
    return network;
}

/// A bar that hangs out from a wall, and the same with everything turned, with all solvers: a millimetre of the
/// metres that it sags.
static void turned_ones_move_the_same(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    for (size_t k = 0; k < COUNT_OF(solvers); k++) {
        mspring_network *upright = hanging(0, solvers[k]);
        for (int degrees = 30; degrees < 360; degrees += 50) {
            mspring_network *other = hanging(degrees, solvers[k]);
            double sag = 0;
            for (mspring_id id = 0; id < 24 * 6; id++) {
                const support_point p = support_position(upright, id), q = support_position(other, id);
                const support_point expected = turned(p.x, p.y, degrees);
                check_near(q.x, expected.x, 1e-3);
                check_near(q.y, expected.y, 1e-3);
                sag = fmax(sag, id / 24 - p.y);
            }
            assert_true(sag > 1);
            mspring_network_destroy(other);
        }
        mspring_network_destroy(upright);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lattices_of_any_shape_are_found),
        cmocka_unit_test(triangles_are_a_lattice),
        cmocka_unit_test(rings_are_lattices_that_are_closed_once),
        cmocka_unit_test(they_move_as_the_reference),
        cmocka_unit_test(turned_ones_move_the_same),
    };
    return cmocka_run_group_tests_name("bent", tests, NULL, NULL);
}
