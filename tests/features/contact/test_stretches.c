/// @file test_stretches.c
/// Friction and restitution by stretch of the floor: closed forms on each stretch with every solver, the same bits
/// where all stretches are alike, and what is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

enum { PARTS = 3, BEYOND = PARTS + 2 };

static const double g = 9.8;
static const float frictions[PARTS] = {0.5f, 0.0f, 0.2f}, restitutions[PARTS] = {0.25f, 0.9f, 0.5f};
static const float level[PARTS + 1] = {0, 0, 0, 0};

/// Level ground from x = 0 to 300, of 100 m stretches.
static mspring_floor_def level_def(void) {
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.heights = level;
    def.height_count = PARTS + 1;
    def.spacing = 100;
    def.height_frictions = frictions;
    def.height_restitutions = restitutions;
    def.friction = 0.7f; // of which nothing is seen
    def.restitution = 0.8f;
    return def;
}

/// The stretch of the i-th of so many places from left of the first to right of the last, and that place.
static uint32_t stretch_at(uint32_t i, double *x) {
    *x = -50.0 + 100.0 * i;
    return i == 0 ? 0 : i <= PARTS ? i - 1 : PARTS - 1;
}

static mspring_network *make(mspring_builder *builder, mspring_solver solver) {
    mspring_network_def def = support_def((float)-g, 10);
    def.settings.solver = solver;
    return support_network(builder, &def);
}

/// What slides comes to rest by the friction of the stretch that it is on, beyond both ends by that of the
/// outermost.
static void each_stretch_has_its_friction(void **state) {
    (void)state;
    const double dt = 0.01, seconds = 0.5, speed = 4;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        for (int sprung = 0; sprung < 2; sprung++) {
            mspring_builder *builder = support_builder();
            for (uint32_t i = 0; i < BEYOND; i++) {
                double x;
                stretch_at(i, &x);
                const mspring_id a = support_particle(builder, x, 0, 2), b = support_particle(builder, x + 1, 0, 2);
                if (sprung) {
                    support_spring(builder, a, b, 1000, 10);
                }
            }
            mspring_network *network = make(builder, solver);
            const mspring_floor_def def = level_def();
            check_ok(mspring_network_set_floor(network, &def));
            for (mspring_id p = 0; p < 2 * BEYOND; p++) {
                const float vx = (float)speed, vy = 0;
                check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
            }
            support_steps(network, (uint32_t)lround(seconds / dt), dt);
            for (mspring_id p = 0; p < 2 * BEYOND; p++) {
                double x;
                const double rate = (double)frictions[stretch_at(p / 2, &x)] * g;
                // Implicit substeps take the first one for a blow, which brakes by twice what one of them does.
                check_near(support_velocity(network, p).x, speed - rate * seconds, 2 * rate * dt / 10 + 1e-3);
                check_near(support_position(network, p).x, x + p % 2 + (speed - 0.5 * rate * seconds) * seconds,
                           0.005);
            }
            mspring_network_destroy(network);
        }
    }
}

/// Loose particles bounce by the restitution of the stretch that they fall on, with every solver.
static void each_stretch_has_its_restitution(void **state) {
    (void)state;
    const double dt = 0.01, height = 1.25;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_builder *builder = support_builder();
        for (uint32_t i = 0; i < BEYOND; i++) {
            double x;
            stretch_at(i, &x);
            support_particle(builder, x, height, 2);
        }
        support_spring(builder, support_particle(builder, 0, 900, 1), support_particle(builder, 1, 900, 1), 1, 0);
        mspring_network *network = make(builder, solver);
        const mspring_floor_def def = level_def();
        check_ok(mspring_network_set_floor(network, &def));
        const double falls = sqrt(2 * height / g), speed = g * falls;
        const double steps = ceil(falls / dt) + 5, after = steps * dt - falls;
        support_steps(network, (uint32_t)steps, dt);
        for (mspring_id p = 0; p < BEYOND; p++) {
            double x;
            const double up = speed * (double)restitutions[stretch_at(p, &x)];
            check_near(support_position(network, p).y, up * after - 0.5 * g * after * after, 0.005);
            check_near(support_position(network, p).x, x, 0);
        }
        mspring_network_destroy(network);
    }
}

/// A pair of particles with a spring bounces in explicit substeps by the stretch, too, and slower ones bounce less.
static void bodies_bounce_by_stretch(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < BEYOND; i++) {
        double x;
        stretch_at(i, &x);
        const mspring_id a = support_particle(builder, x, 0.5, 1), b = support_particle(builder, x + 1, 0.5, 1);
        support_spring(builder, a, b, 1000, 0);
    }
    mspring_network_def network_def = support_def((float)-g, 40);
    mspring_network *network = support_network(builder, &network_def);
    const mspring_floor_def def = level_def();
    check_ok(mspring_network_set_floor(network, &def));
    const double falls = sqrt(2 * 0.5 / g);
    support_steps(network, 40, 0.01);
    for (mspring_id p = 0; p < 2 * BEYOND; p++) {
        double x;
        const double e = (double)restitutions[stretch_at(p / 2, &x)], after = 0.4 - falls;
        check_near(support_velocity(network, p).y, e > 0.5 ? e * g * falls - g * after : 0,
                   e > 0.5 ? 0.05 : 1.5); // the others bounced twice
    }
    mspring_network_destroy(network);
}

/// Ground and a wall.
static void each_plane_has_its_own(void **state) {
    (void)state;
    const double planes[2][4] = {{0, 0, 0, 1}, {10, 0, -1, 0}};
    const float friction[2] = {0.3f, 0}, restitution[2] = {0, 1};
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1); // slides on the ground
    support_particle(builder, 9, 5, 1); // is thrown back by the wall
    mspring_network *network = make(builder, MSPRING_SOLVER_EXPLICIT);
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = planes[0];
    def.plane_count = 2;
    def.plane_frictions = friction;
    def.plane_restitutions = restitution;
    check_ok(mspring_network_set_floor(network, &def));
    const float vx[2] = {3, 4}, vy[2] = {0, 0};
    check_ok(mspring_network_set_velocities(network, NULL, 0, 2, vx, vy, 1));
    support_steps(network, 50, 0.01);
    check_near(support_velocity(network, 0).x, 3 - 0.3 * g * 0.5, 0.01);
    check_near(support_velocity(network, 1).x, -4, 1e-5);
    mspring_network_destroy(network);
}

/* ---------------------------------------------------------------------------------------------------------- bits
 */

enum { KNOTS = 40 };

/// A body and loose particles that fall onto rough ground beside a wall, by stretch or all alike.
static uint64_t fall(const mspring_network_def *network_def, const float *own, const float *other) {
    static float heights[KNOTS];
    uint64_t seed = 7;
    const double wall[4] = {-8, 0, 1, 0.2};
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {4000, 5000}, .damping = {1, 2}};
    recipe made = {0};
    recipe_lattice(&made, 40, 8, -5, 2, 0.5, &stuff, &seed);
    for (uint32_t i = 0; i < 40; i++) {
        recipe_particle(&made, -6.5 + 0.5 * i, 1.3 + 0.01 * i, 1, 0);
    }
    for (uint32_t i = 0; i < KNOTS; i++) {
        heights[i] = (float)support_random_between(&seed, -0.5, 0.5);
    }
    mspring_network *network = recipe_network(&made, network_def);
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = wall;
    def.plane_count = 1;
    def.heights = heights;
    def.height_count = KNOTS;
    def.heights_x = -10;
    def.spacing = 0.8;
    def.friction = 0.4f;
    def.restitution = 0.3f;
    def.height_frictions = def.plane_frictions = own;
    def.height_restitutions = def.plane_restitutions = other;
    check_ok(mspring_network_set_floor(network, &def));
    support_steps(network, 60, 1.0 / 64);
    uint64_t hash = 0;
    check_ok(mspring_network_get_state_hash(network, &hash));
    mspring_network_destroy(network);
    recipe_free(&made);
    return hash;
}

/// Where all stretches are alike the bits are those of the one value; where they are not they are others, but the
/// same at every level and for any number of workers.
static void bits_do_not_depend_on_how_it_is_said(void **state) {
    (void)state;
    float alike[2][KNOTS], own[2][KNOTS];
    uint64_t seed = 3;
    for (uint32_t i = 0; i < KNOTS; i++) {
        alike[0][i] = 0.4f;
        alike[1][i] = 0.3f;
        own[0][i] = (float)support_random_between(&seed, 0, 1);
        own[1][i] = (float)support_random_between(&seed, 0, 1);
    }
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network_def def = support_def((float)-g, solver == MSPRING_SOLVER_EXPLICIT ? 20 : 2);
        def.settings.solver = solver;
        const uint64_t plain = fall(&def, NULL, NULL), rough = fall(&def, own[0], own[1]);
        assert_true(fall(&def, alike[0], alike[1]) == plain);
        assert_true(fall(&def, alike[0], NULL) == plain);
        assert_true(rough != plain);
        for (int at = MSPRING_SIMD_SCALAR; at <= MSPRING_SIMD_AVX512; at++) {
            def.simd_level = (mspring_simd)at;
            def.worker_count = (uint32_t)(at % 3 + 1);
            assert_true(fall(&def, own[0], own[1]) == rough);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- definitions
 */

static mspring_network *one_particle(void) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 5, 1);
    return make(builder, MSPRING_SOLVER_EXPLICIT);
}

static void what_was_set_can_be_read(void **state) {
    (void)state;
    mspring_network *network = one_particle();
    const double plane[4] = {0, -1, 0, 1};
    const float own = 0.125f;
    mspring_floor_def def = level_def(), had = {.struct_size = sizeof had};
    def.planes = plane;
    def.plane_count = 1;
    def.plane_restitutions = &own;
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_get_floor(network, &had));
    assert_null(had.plane_frictions);
    assert_true(*had.plane_restitutions == own);
    assert_memory_equal(had.height_frictions, frictions, sizeof frictions);
    assert_memory_equal(had.height_restitutions, restitutions, sizeof restitutions);
    // Once more is no other one; with an array less it is.
    mspring_floor_def again = {.struct_size = sizeof again};
    check_ok(mspring_network_set_floor(network, &had));
    check_ok(mspring_network_get_floor(network, &again));
    assert_true(again.height_frictions == had.height_frictions);
    def.height_frictions = NULL;
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_get_floor(network, &again));
    assert_null(again.height_frictions);
    assert_memory_equal(again.height_restitutions, restitutions, sizeof restitutions);
    mspring_network *clone;
    check_ok(mspring_network_clone(network, NULL, &clone));
    mspring_network_destroy(network);
    check_ok(mspring_network_get_floor(clone, &again));
    assert_memory_equal(again.height_restitutions, restitutions, sizeof restitutions);
    assert_true(*again.plane_restitutions == own);
    mspring_network_destroy(clone);
}

static void the_first_bad_one_is_named(void **state) {
    (void)state;
    const double planes[2][4] = {{0, -1, 0, 1}, {-5, 0, 1, 0}};
    const struct {
        size_t at;
        uint32_t index;
        float value;
        const char *part;
    } bad[] = {
        {offsetof(mspring_floor_def, plane_frictions), 1, -1e-9f, "plane_frictions[1]"},
        {offsetof(mspring_floor_def, plane_restitutions), 0, 1.01f, "plane_restitutions[0]"},
        {offsetof(mspring_floor_def, height_frictions), 2, NAN, "height_frictions[2]"},
        {offsetof(mspring_floor_def, height_frictions), 0, 1.01e6f, "height_frictions[0]"},
        {offsetof(mspring_floor_def, height_restitutions), 1, INFINITY, "height_restitutions[1]"},
    };
    mspring_network *network = one_particle();
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        float values[PARTS] = {0.5f, 0.5f, 0.5f};
        const float *const given = values;
        mspring_floor_def def = level_def(), had = {.struct_size = sizeof had};
        def.planes = planes[0];
        def.plane_count = 2;
        values[bad[i].index] = bad[i].value;
        memcpy((char *)&def + bad[i].at, &given, sizeof given);
        check_error(mspring_network_set_floor(network, &def), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), bad[i].part);
        check_ok(mspring_network_get_floor(network, &had));
        assert_int_equal(had.height_count, 0);
        values[bad[i].index] = 0.5f;
        check_ok(mspring_network_set_floor(network, &def));
        check_ok(mspring_network_set_floor(network, NULL));
    }
    mspring_network_destroy(network);
}

static void without_memory_nothing_changes(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    const double plane[4] = {0, -1, 0, 1};
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 5, 1);
    mspring_network_def network_def = support_def(-9.8f, 1);
    network_def.allocator = &allocator;
    mspring_network *network = support_network(builder, &network_def);
    mspring_floor_def def = level_def(), had = {.struct_size = sizeof had};
    def.planes = plane;
    def.plane_count = 1;
    def.plane_frictions = def.plane_restitutions = frictions;
    size_t failures = 0;
    for (mspring_result result = MSPRING_ERROR_MEMORY; result != MSPRING_OK; failures++) {
        watched.fail_at = watched.calls + failures + 1;
        result = mspring_network_set_floor(network, &def);
        check_ok(mspring_network_get_floor(network, &had));
        assert_true((had.height_count > 0) == (result == MSPRING_OK));
    }
    assert_true(failures > 8);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_stretch_has_its_friction),
        cmocka_unit_test(each_stretch_has_its_restitution),
        cmocka_unit_test(bodies_bounce_by_stretch),
        cmocka_unit_test(each_plane_has_its_own),
        cmocka_unit_test(bits_do_not_depend_on_how_it_is_said),
        cmocka_unit_test(what_was_set_can_be_read),
        cmocka_unit_test(the_first_bad_one_is_named),
        cmocka_unit_test(without_memory_nothing_changes),
    };
    return cmocka_run_group_tests_name("stretches", tests, NULL, NULL);
}
