/// @file test_common_motion.c
/// Contact in any frame and of any number: what all have in common changes nothing, a single edge stops what comes from
/// any side, and elastic crowds gain no energy.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

static void touch(mspring_network *network, double thickness, float restitution, float friction) {
    mspring_contact_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
    def.thickness = thickness;
    def.restitution = restitution;
    def.friction = friction;
    check_ok(mspring_network_set_contact(network, &def));
}

/* ------------------------------------------------------------------------------------------- a common velocity */

enum { BODIES = 6, SIDE = 4, PARTICLES = BODIES * SIDE * SIDE };

/// Blocks that fly together from all sides, and away from each other again, in a frame that flies along.
static void crash(double vx, double vy, support_point *places) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {3e3, 3e3}, .damping = {5, 5}};
    recipe made = {0};
    for (int i = 0; i < BODIES; i++) {
        const double angle = 6.2831853 * i / BODIES;
        const uint32_t first = made.particle_count;
        recipe_lattice(&made, SIDE, SIDE, 12 * cos(angle), 12 * sin(angle), 1, &stuff, &seed);
        for (uint32_t p = first; p < made.particle_count; p++) {
            made.particles[p].vx = (float)(vx - 4 * cos(angle));
            made.particles[p].vy = (float)(vy - 4 * sin(angle));
        }
    }
    const mspring_network_def def = support_def(0, 8);
    mspring_network *network = recipe_network(&made, &def);
    touch(network, 0.3, 0.5f, 0);
    const int steps = 160;
    support_steps(network, steps, DT);
    for (mspring_id p = 0; p < PARTICLES; p++) {
        places[p] = support_position(network, p);
        places[p].x -= vx * steps * DT;
        places[p].y -= vy * steps * DT;
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void a_common_velocity_changes_nothing(void **state) {
    (void)state;
    static const double frames[][2] = {{200, 0}, {0, 200}, {-150, 90}};
    support_point at_rest[PARTICLES], along[PARTICLES];
    crash(0, 0, at_rest);
    for (size_t i = 0; i < COUNT_OF(frames); i++) {
        double most = 0;
        crash(frames[i][0], frames[i][1], along);
        for (int p = 0; p < PARTICLES; p++)
            most = fmax(most, hypot(along[p].x - at_rest[p].x, along[p].y - at_rest[p].y));
        print_message("%.4f m\n", most);
        assert_true(most < 0.1); // they have gone 10 m
    }
}

/* ------------------------------------------------------------------------------------------------ a single edge */

/// A particle that flies at a rod at any angle, at up to seven lengths in a step, does not get past it.
static void one_edge_stops_what_comes(void **state) {
    (void)state;
    uint64_t seed = 3;
    for (int trial = 0; trial < 60; trial++) {
        const double angle = support_random_between(&seed, 0, 6.28),
                     speed = pow(10, support_random_between(&seed, 0, 2.6));
        const double nx = -sin(angle), ny = cos(angle), share = support_random_between(&seed, 0.2, 0.8);
        mspring_builder *builder = support_builder();
        const double way = 3.3 * speed * DT + 0.5;
        const mspring_id bullet =
            support_particle(builder, share * cos(angle) + way * nx, share * sin(angle) + way * ny, 1);
        const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_pinned(builder, cos(angle), sin(angle), 1);
        (void)support_spring(builder, a, b, 1000, 0);
        const mspring_network_def def = support_def(0, 4);
        mspring_network *network = support_network(builder, &def);
        touch(network, 0.1, 0, 0);
        const float vx = (float)(-speed * nx), vy = (float)(-speed * ny);
        check_ok(mspring_network_set_velocities(network, NULL, bullet, 1, &vx, &vy, 1));
        support_steps(network, 6, DT);
        const support_point at = support_position(network, bullet);
        assert_true(at.x * nx + at.y * ny > 0);
        mspring_network_destroy(network);
    }
}

/// Nor does a force that sets in where all is at rest, and would bring a block up to 100 m far in a step; also where
/// others touch already, so that contact has something to do from the first. (Particle 4 is an inner one.)
static void forces_from_rest_stop_at_a_wall(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < 3 * 2 * 12; trial++) {
        const mspring_solver solver = (mspring_solver)(trial % 3);
        const uint32_t strength = trial / 6;
        uint64_t seed = trial;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2e3, 2e3}, .damping = {5, 5}};
        recipe made = {0};
        recipe_lattice(&made, 3, 3, 0, 0, 1, &stuff, &seed);
        const mspring_id wall = recipe_particle(&made, 2.5 + 0.0125 * trial, -30, 1, MSPRING_PARTICLE_PINNED);
        for (int i = 1; i <= 60; i++) {
            const mspring_id next = recipe_particle(&made, 2.5 + 0.0125 * trial, i - 30, 1, MSPRING_PARTICLE_PINNED);
            recipe_spring(&made, next - 1, next, 1e3, 0, 0);
        }
        if (trial / 3 % 2 == 1) {
            (void)recipe_particle(&made, -20, 0, 1, 0);
            (void)recipe_particle(&made, -20.08, 0, 1, MSPRING_PARTICLE_PINNED);
        }
        mspring_network_def def = support_def(0, solver == MSPRING_SOLVER_EXPLICIT ? 4 : 1);
        def.settings.solver = solver;
        def.settings.guard = MSPRING_GUARD_CLAMP;
        mspring_network *network = recipe_network(&made, &def);
        touch(network, 0.1, 0, 0);
        support_steps(network, 1, DT);
        for (mspring_id p = 0; p < wall; p++)
            check_ok(mspring_network_apply_force(network, p, (float)(200 * pow(2, strength)), 0));
        for (int step = 0; step < 4; step++) {
            support_steps(network, 1, DT);
            for (mspring_id p = 0; p < wall; p++)
                assert_true(p == 4 || support_position(network, p).x < made.particles[wall].x);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Nor if it throws a particle at the wall aslant, past others of its edges.
static void forces_aslant_stop_at_a_wall(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < 3 * 60; trial++) {
        uint64_t seed = trial;
        recipe made = {0};
        const double distance = support_random_between(&seed, 1, 10), angle = support_random_between(&seed, -1, 1);
        const double force = 200 * pow(2, support_random_between(&seed, 0, 11));
        const float x = (float)(force * cos(angle)), y = (float)(force * sin(angle));
        recipe_particle(&made, 0, 0, 1, 0);
        recipe_particle(&made, distance, -30, 1, MSPRING_PARTICLE_PINNED);
        for (int i = 1; i <= 60; i++) {
            const mspring_id next = recipe_particle(&made, distance, i - 30, 1, MSPRING_PARTICLE_PINNED);
            recipe_spring(&made, next - 1, next, 1e3, 0, 0);
        }
        mspring_network_def def = support_def(0, 1);
        def.settings.solver = (mspring_solver)(trial % 3);
        mspring_network *network = recipe_network(&made, &def);
        touch(network, 0.1, 0, 0);
        check_ok(mspring_network_apply_force(network, 0, x, y));
        support_steps(network, 1, DT);
        const support_point at = support_position(network, 0);
        assert_true(at.x < distance || fabs(at.y) > 29);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* ----------------------------------------------------------------------------------------------- elastic crowds */

/// Particles of 1 to 100 kg and small bodies that bounce off each other, many at a time.
static void elastic_crowds_gain_nothing(void **state) {
    (void)state;
    for (uint64_t trial = 1; trial <= 18; trial++) {
        uint64_t seed = trial;
        recipe made = {0};
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e4, 1e4}};
        for (int i = 0; i < 64; i++) {
            const double x = i % 8 * 0.5, y = i / 8 * 0.5;
            if (i % 9 == 0 && trial % 6 == 0) {
                recipe_lattice(&made, 2, 2, x, y, 0.2, &stuff, &seed);
            } else
                recipe_particle(&made, x, y, pow(10, support_random_between(&seed, 0, 2)), 0);
        }
        for (uint32_t p = 0; p < made.particle_count; p++) {
            made.particles[p].vx = (float)(5 * (1.75 - made.particles[p].x));
            made.particles[p].vy = (float)(5 * (1.75 - made.particles[p].y));
        }
        mspring_network_def def = support_def(0, 8);
        mspring_network *network = recipe_network(&made, &def);
        touch(network, 0.15, 1, 0.5f * (float)(trial % 3));
        const double had = support_energy_of_motion(network);
        double most = 0;
        for (int step = 0; step < 60; step++) {
            support_steps(network, 1, DT);
            most = fmax(most, support_energy_of_motion(network));
        }
        print_message("%.6f of the energy\n", most / had);
        assert_true(most <= (trial % 6 ? 1 + 1e-5 : 1.005) * had);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_common_velocity_changes_nothing),
        cmocka_unit_test(one_edge_stops_what_comes),
        cmocka_unit_test(forces_from_rest_stop_at_a_wall),
        cmocka_unit_test(forces_aslant_stop_at_a_wall),
        cmocka_unit_test(elastic_crowds_gain_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
