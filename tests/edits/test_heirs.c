/// @file test_heirs.c
/// Who is given the place of a particle that was removed inherits nothing: no motion of before, no force, no
/// contact.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

typedef struct variant {
    mspring_solver solver;
    mspring_integrator integrator;
    mspring_guard guard;
    double stiffness;
    bool has_floor;
    double tolerance; ///< m: implicit systems are summed up in the order of slots, of which there is one more
} variant;

/// A bar that is held at its left end, 10 m above the floor, and room for two particles.
static mspring_network *bar(const variant *of) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {of->stiffness, of->stiffness}};
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    for (mspring_id p = 0; p < 12; p += 4) {
        made.particles[p].flags = MSPRING_PARTICLE_PINNED;
    }
    mspring_network_def def = support_def(-9.8f, 2);
    def.settings.guard = of->guard;
    def.spare_particles = 2;
    mspring_network *network = recipe_network(&made, &def);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = of->solver;
    solver.integrator = of->integrator;
    solver.iterations = 30; // as good as exact for so few particles
    solver.substeps = 2;
    check_ok(support_set_solver(network, &solver));
    if (of->has_floor) {
        const double plane[] = {0, -10, 0, 1};
        mspring_floor_def ground;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &ground, sizeof ground));
        ground.plane_count = 1;
        ground.planes = plane;
        ground.friction = 0.5f;
        check_ok(mspring_network_set_floor(network, &ground));
    }
    recipe_free(&made);
    return network;
}

static mspring_id add(mspring_network *network, double x, double y, float vx, float vy) {
    mspring_particle_def def;
    mspring_id id = MSPRING_NONE;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    def.x = x, def.y = y, def.vx = vx, def.vy = vy;
    check_ok(mspring_network_add_particles(network, &def, 1, &id));
    return id;
}

static uint32_t loose_particles(const mspring_network *network) {
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    return plan.loose_particles;
}

static support_point floor_impulse(const mspring_network *network, mspring_id particle) {
    float x = 77, y = 77;
    check_ok(mspring_network_get_columns(network, NULL, particle, 1, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}}, 2));
    return (support_point){(double)x, (double)y};
}

static float scale_of(const mspring_network *network, mspring_id particle) {
    float scale = 77;
    check_ok(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, particle, 1, &scale, 1));
    return scale;
}

/// One comes, slides over the floor or flies, is pushed, and is removed. The next one's place is that one's if ids
/// are given back.
static mspring_id let_one_live(mspring_network *network, const variant *of) {
    const float half = 0.5f;
    assert_int_equal(loose_particles(network), 0);
    const mspring_id id = add(network, 20, -9.99, 5, -3);
    assert_int_equal(loose_particles(network), 1);
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, id, 1, &half, 1));
    support_steps(network, 10, 0.01);
    assert_int_equal(support_fallback_count(network) > 0, of->guard == MSPRING_GUARD_IMPLICIT);
    assert_int_equal(floor_impulse(network, id).y > 0, of->has_floor);
    check_ok(mspring_network_apply_force(network, id, 1000, 500));
    check_ok(mspring_network_remove_particles(network, &id, 0, 1));
    assert_true(floor_impulse(network, id).x == 0 && floor_impulse(network, id).y == 0);
    assert_true(scale_of(network, id) == 0);
    assert_int_equal(loose_particles(network), 0);
    return id;
}

static void a_newcomer_inherits_nothing(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++) {
        const mspring_solver solver =
            i / 2 % 4 == 0 || i / 2 % 4 == 3 ? MSPRING_SOLVER_EXPLICIT : MSPRING_SOLVER_IMPLICIT;
        const bool falls_back = i / 2 == 3;
        const variant of = {.solver = solver,
                            .integrator = i / 2 == 1 ? MSPRING_INTEGRATOR_ALPHA : MSPRING_INTEGRATOR_BDF2,
                            .guard = falls_back ? MSPRING_GUARD_IMPLICIT : MSPRING_GUARD_GROWTH,
                            // Explicit substeps of 5 ms bear 2e4 N/m.
                            .stiffness = falls_back ? 1e6 : 100,
                            .has_floor = i % 2 != 0,
                            .tolerance = solver == MSPRING_SOLVER_EXPLICIT && !falls_back ? 0 : 1e-5};
        mspring_network *network = bar(&of), *fresh = bar(&of);
        const mspring_id gone = let_one_live(network, &of);
        assert_int_equal(let_one_live(fresh, &of), gone);
        check_ok(mspring_network_reuse_ids(network));
        const mspring_id heir = add(network, 30, 5, 0, 0), other = add(fresh, 30, 5, 0, 0);
        assert_int_equal(heir, gone);
        assert_int_not_equal(other, gone);
        assert_true(scale_of(network, heir) == 1);
        assert_true(floor_impulse(network, heir).x == 0 && floor_impulse(network, heir).y == 0);
        for (int step = 0; step < 20; step++) {
            support_steps(network, 1, 0.01);
            support_steps(fresh, 1, 0.01);
            const support_point is = support_position(network, heir), should = support_position(fresh, other);
            check_near(is.x, 30, of.tolerance);
            check_near(is.x, should.x, of.tolerance);
            check_near(is.y, should.y, of.tolerance);
        }
        assert_true(support_position(network, heir).y < 4.9);
        mspring_network_destroy(network);
        mspring_network_destroy(fresh);
    }
}

// Values for removed ones are passed over: they wake nobody, allocate nothing, and the next one has none of them.
static void a_newcomer_touches_as_by_default(void **state) {
    (void)state;
    const variant of = {.solver = MSPRING_SOLVER_EXPLICIT, .guard = MSPRING_GUARD_GROWTH, .stiffness = 100};
    const float half = 0.5f;
    const uint32_t layer = 8;
    mspring_network *network = bar(&of);
    mspring_contact_def def = mspring_contact_def_default();
    check_ok(mspring_network_set_contact(network, &def));
    const mspring_id gone = add(network, 20, 5, 0, 0);
    for (int is_gone = 0; is_gone < 2; is_gone++) {
        const size_t used = support_memory_used(network);
        check_ok(mspring_network_set(network, MSPRING_FRICTION, NULL, gone, 1, &half, 1));
        check_ok(mspring_network_set(network, MSPRING_RESTITUTION, NULL, gone, 1, &half, 1));
        check_ok(mspring_network_set_integers(network, MSPRING_LAYERS, NULL, gone, 1, &layer, 1));
        check_ok(mspring_network_set_integers(network, MSPRING_MASKS, NULL, gone, 1, &layer, 1));
        if (!is_gone)
            check_ok(mspring_network_remove_particles(network, &gone, 0, 1));
        else
            assert_int_equal(support_memory_used(network), used);
    }
    check_ok(mspring_network_reuse_ids(network));
    assert_int_equal(add(network, 30, 5, 0, 0), gone);
    float friction, restitution;
    uint32_t layers, masks;
    check_ok(mspring_network_get(network, MSPRING_FRICTION, NULL, gone, 1, &friction, 1));
    check_ok(mspring_network_get(network, MSPRING_RESTITUTION, NULL, gone, 1, &restitution, 1));
    check_ok(mspring_network_get_integers(network, MSPRING_LAYERS, NULL, gone, 1, &layers, 1));
    check_ok(mspring_network_get_integers(network, MSPRING_MASKS, NULL, gone, 1, &masks, 1));
    assert_true(friction == -1 && restitution == -1 && layers == 1 && masks == UINT32_MAX);
    mspring_network_destroy(network);
}

/// Where the guard watches changes of velocities it reckons from them what speeds can be; who comes was not among
/// those that it has seen.
static void a_newcomer_that_is_too_fast_is_found(void **state) {
    (void)state;
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {100, 100}};
    recipe made = {0};
    recipe_lattice(&made, 6, 4, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(0, 1);
    def.settings.max_speed = 100;
    def.spare_particles = 1;
    mspring_network *network = recipe_network(&made, &def);
    double now, any_shape;
    check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
    const double dt = (now + any_shape) / 2; // stable now, so it is watched
    assert_true(any_shape < 0.9 * now);
    support_steps(network, 20, dt);
    const mspring_id fast = add(network, 30, 0, 200, 0);
    check_error(mspring_network_step(network, dt), MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "particle 24");
    assert_true(fast == 24 && support_position(network, fast).x == 30);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_newcomer_inherits_nothing),
        cmocka_unit_test(a_newcomer_touches_as_by_default),
        cmocka_unit_test(a_newcomer_that_is_too_fast_is_found),
    };
    return cmocka_run_group_tests_name("heirs", tests, NULL, NULL);
}
