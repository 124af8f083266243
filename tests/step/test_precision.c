/// @file test_precision.c
/// Positions beyond single precision: more substeps are never less accurate, slow motion never stands still, and
/// what is below a float is part of the state.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "level.h"
#include "recipe.h"
#include "support.h"

static mspring_simd level;

static mspring_network *network_of(const recipe *made, mspring_solver solver, uint32_t substeps) {
    mspring_network_def def = support_def(0, substeps);
    def.simd_level = level;
    def.settings.solver = solver;
    mspring_network *network = recipe_network(made, &def);
    level_check(network, level);
    return network;
}

/* ------------------------------------------------------------------------------------------------- oscillation */

/// Oscillators of 1 kg along a direction, at a distance from the local origin, as springs by themselves, as the
/// ends of ropes or as lattices.
typedef struct oscillation {
    double distance, period, amplitude;
    uint32_t shape; ///< 0: a spring, 1: a rope of 40, 2: a lattice of 20 x 2
} oscillation;

static const recipe_stuff weightless = {.mass = {1, 1}};

/// One particle swings between pins, so that its motion is a cosine; the rest of the shape is there to have it
/// swept by the kernels of its kind.
static recipe recipe_of(const oscillation *o) {
    recipe made = {0};
    uint64_t seed = 5;
    recipe_particle(&made, -o->distance - 100, 0, 1, MSPRING_PARTICLE_PINNED); // the other end of the scene
    mspring_id first = made.particle_count;
    if (o->shape == 2) {
        recipe_lattice(&made, 20, 2, o->distance, 0, 1, &weightless, &seed);
    } else {
        recipe_particle(&made, o->distance, 0, 1, 0);
        if (o->shape == 1) {
            const mspring_id last = recipe_particle(&made, o->distance + 40, 0, 1, 0);
            recipe_rope(&made, first, last, 40, &weightless, &seed);
        } else {
            recipe_spring(&made, first, recipe_particle(&made, o->distance + 1, 0, 1, 0), 0, 0, 0);
        }
    }
    for (mspring_id p = first; p < made.particle_count; p++) {
        made.particles[p].flags = MSPRING_PARTICLE_PINNED;
    }
    // The neighbour of the first one to the right swings about where it is, by the spring between them.
    uint32_t spring = 0;
    while (made.springs[spring].a != first && made.springs[spring].b != first) {
        spring++;
    }
    mspring_spring_def *s = &made.springs[spring];
    mspring_particle_def *swinging = &made.particles[s->a == first ? s->b : s->a];
    const double omega = 2 * 3.141592653589793 / o->period;
    s->stiffness = (float)(omega * omega);
    s->rest_length = 1;
    swinging->flags = 0;
    swinging->x = made.particles[first].x + 1 + o->amplitude;
    swinging->y = made.particles[first].y;
    return made;
}

/// How far the particle is from where it should be after a second, as a part of the amplitude.
static double error_of(const oscillation *o, mspring_solver solver, uint32_t substeps) {
    recipe made = recipe_of(o);
    mspring_id moving = 0;
    while (made.particles[moving].flags != 0) {
        moving++;
    }
    const double start = made.particles[moving].x - o->amplitude;
    mspring_network *network = network_of(&made, solver, substeps);
    support_steps(network, 64, 1.0 / 64);
    const double stiffness = (double)(float)(4 * 3.141592653589793 * 3.141592653589793 / (o->period * o->period));
    const double error = support_position(network, moving).x - (start + o->amplitude * cos(sqrt(stiffness)));
    mspring_network_destroy(network);
    recipe_free(&made);
    return fabs(error) / o->amplitude;
}

static void more_substeps_are_never_less_accurate(void **state) {
    (void)state;
    const double distances[] = {1, 16, 100, 1000}, periods[] = {0.25, 0.628, 3}, amplitudes[] = {1e-3, 1e-2, 0.2};
    for (size_t i = 0; i < COUNT_OF(distances) * COUNT_OF(periods) * COUNT_OF(amplitudes); i++) {
        const oscillation o = {.distance = distances[i % 4],
                               .period = periods[i / 4 % 3],
                               .amplitude = amplitudes[i / 12],
                               .shape = (uint32_t)(i % 3)};
        // The ends of the spring are floats when its length is taken: half a unit each, all the time.
        const double resolution = 0x1p-23 * (o.distance + 1) * 6.3 / o.period / o.amplitude + 1e-6;
        double least = INFINITY;
        for (uint32_t substeps = 4; substeps <= 2048; substeps *= 2) {
            const double error = error_of(&o, MSPRING_SOLVER_EXPLICIT, substeps);
            if (!(error <= least + resolution)) {
                print_error("%g m, %g s, %g m, shape %u, %u substeps: %g after %g\n", o.distance, o.period,
                            o.amplitude, (unsigned)o.shape, (unsigned)substeps, error, least);
            }
            assert_true(error <= least + resolution);
            least = error < least ? error : least;
        }
        // First order: the velocity is that of half a substep before, pi h / period.
        assert_true(least <= 4.0 / 64 / 2048 / o.period + resolution);
    }
}

/* ---------------------------------------------------------------------------------------------------- slowness */

// A substep is a ten-thousandth of what moves a position of 1 km in single precision.
static void slow_motion_does_not_stand_still(void **state) {
    (void)state;
    const double far = 1000;
    recipe made = {0};
    uint64_t seed = 1;
    recipe_particle(&made, -far, 0, 1, MSPRING_PARTICLE_PINNED);
    recipe_particle(&made, far, 0, 1, 0); // loose
    recipe_lattice(&made, 5, 5, far, 10, 1, &weightless, &seed);
    const mspring_id last = recipe_particle(&made, far, 60, 1, MSPRING_PARTICLE_PINNED); // moves by its velocity
    recipe_rope(&made, 2, last, 30, &weightless, &seed);
    const float vx = 1e-6f, vy = -3e-6f;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network *network = network_of(&made, solver, 512);
        support_point before[64];
        for (mspring_id p = 0; p < made.particle_count; p++) {
            before[p] = support_position(network, p);
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
        }
        support_steps(network, 64, 1.0 / 64);
        for (mspring_id p = 0; p < made.particle_count; p++) {
            const support_point after = support_position(network, p);
            // Each of 32768 substeps rounds at 2^-48 of 1 km.
            check_near(after.x - before[p].x, (double)vx, 32768 * far * 0x1p-48);
            check_near(after.y - before[p].y, (double)vy, 32768 * far * 0x1p-48);
        }
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------ part of state */

static void positions_are_read_as_they_were_set(void **state) {
    (void)state;
    recipe made = {0};
    uint64_t seed = 3;
    recipe_lattice(&made, 10, 3, 0, 0, 1, &weightless, &seed);
    mspring_network *network = network_of(&made, MSPRING_SOLVER_EXPLICIT, 1);
    double x[30], y[30], read_x[30], read_y[30];
    for (int i = 0; i < 30; i++) {
        x[i] = support_random_between(&seed, -1e3, 1e3);
        y[i] = support_random_between(&seed, -1e3, 1e3);
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, 30, x, y, 1));
    check_ok(mspring_network_get_positions(network, NULL, 0, 30, read_x, read_y, 1));
    for (int i = 0; i < 30; i++) {
        check_near(read_x[i], x[i], 2e3 * 0x1p-48); // two words of 24 bits each
        check_near(read_y[i], y[i], 2e3 * 0x1p-48);
    }
    const uint64_t hash = support_hash(network);
    check_ok(mspring_network_set_positions(network, NULL, 0, 30, read_x, read_y, 1));
    assert_int_equal(support_hash(network), hash);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A network that has moved, so that its positions have low words.
static mspring_network *moved(recipe *made) {
    uint64_t seed = 9;
    const recipe_stuff stuff = {.mass = {1, 3}, .stiffness = {100, 200}};
    recipe_lattice(made, 20, 6, 300, -200, 1, &stuff, &seed);
    recipe_rope(made, 3, 70, 30, &stuff, &seed);
    recipe_random_springs(made, 20, &stuff, &seed);
    recipe_disturb(made, 0.1, 1, &seed);
    mspring_network *network = network_of(made, MSPRING_SOLVER_EXPLICIT, 3);
    support_steps(network, 5, 1.0 / 64);
    return network;
}

static void solvers_hand_positions_on(void **state) {
    (void)state;
    recipe made = {0};
    mspring_network *network = moved(&made);
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    const uint64_t hash = support_hash(network);
    for (int i = 0; i < 2; i++) {
        def.solver = MSPRING_SOLVER_IMPLICIT;
        check_ok(support_set_solver(network, &def));
        assert_int_equal(support_hash(network), hash);
        def.solver = MSPRING_SOLVER_EXPLICIT;
        def.substeps = 3;
        check_ok(support_set_solver(network, &def));
        assert_int_equal(support_hash(network), hash);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void a_refused_step_takes_low_words_back(void **state) {
    (void)state;
    recipe made = {0};
    mspring_network *network = moved(&made);
    const uint64_t hash = support_hash(network);
    const double before = support_position(network, 7).x;
    check_error(mspring_network_step(network, 1e4), MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_hash(network), hash);
    assert_true(support_position(network, 7).x == before);
    mspring_network_destroy(network);
    recipe_free(&made);
}

// The local origin moves along by whole metres.
static void a_moving_origin_rounds_nothing(void **state) {
    (void)state;
    recipe made = {0};
    uint64_t seed = 4;
    recipe_lattice(&made, 8, 8, 1.0 / 3, 1.0 / 7, 1, &weightless, &seed);
    mspring_network *network = network_of(&made, MSPRING_SOLVER_EXPLICIT, 64);
    support_point before[64];
    const float vx = 128, vy = -32;
    for (mspring_id p = 0; p < 64; p++) {
        before[p] = support_position(network, p);
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
    }
    support_steps(network, 640, 1.0 / 64);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    assert_true(view.origin_x > 1000);
    for (mspring_id p = 0; p < 64; p++) {
        // Each of 40960 substeps rounds at 2^-48 of at most 200 m, the way to where the origin moves along.
        check_near(support_position(network, p).x, before[p].x + 1280, 40960 * 200 * 0x1p-48);
        check_near(support_position(network, p).y, before[p].y - 320, 40960 * 200 * 0x1p-48);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(int argc, char **argv) {
    level = level_from_arguments(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(more_substeps_are_never_less_accurate), cmocka_unit_test(slow_motion_does_not_stand_still),
        cmocka_unit_test(positions_are_read_as_they_were_set),   cmocka_unit_test(solvers_hand_positions_on),
        cmocka_unit_test(a_refused_step_takes_low_words_back),   cmocka_unit_test(a_moving_origin_rounds_nothing),
    };
    return cmocka_run_group_tests_name("precision", tests, NULL, NULL);
}
