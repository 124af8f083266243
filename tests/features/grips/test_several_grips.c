/// @file test_several_grips.c
/// Two to five grips on one particle, bounded and unbounded: they take energy and give none, and stay within
/// bounds.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "support.h"

enum { MOST_GRIPS = 5, MOST_PARTICLES = 8, STEPS = 96 };
#define DT (1.0 / 64)

typedef struct hand {
    mspring_network *network;
    uint32_t count;
    mspring_id ids[MOST_GRIPS];
    mspring_grip_def grips[MOST_GRIPS];
    double step_x, step_y; ///< way of all targets in a step, m
} hand;

static double decades(uint64_t *seed, double low, double high) {
    return low * pow(high / low, support_random_between(seed, 0, 1));
}

/// A particle, in half of the trials with springs to others.
static mspring_network *held_network(uint32_t trial, uint64_t *seed) {
    mspring_builder *builder = support_builder();
    const uint32_t count = 2 + (uint32_t)support_random_between(seed, 0, MOST_PARTICLES - 2);
    const double mass = decades(seed, 1e-2, 1e2);
    mspring_network_def def = support_def(0, 1 + trial % 16);
    const double h = DT / def.settings.substeps;
    def.settings.solver = (mspring_solver)(trial % 3);
    // Explicit substeps are 20 times shorter than springs vibrate: half of h v F in the energy is far below 1 %
    // then.
    const double stiffness = trial % 3 == 0 ? mass * decades(seed, 1e-5, 1e-2) / (h * h) : decades(seed, 10, 1e7);
    for (uint32_t i = 0; i < count; i++)
        support_particle(builder, i % 3, i / 3, (float)mass);
    for (uint32_t i = 1 + trial / 3 % 2; i < count; i++)
        support_spring(builder, i - 1, i, (float)stiffness, 0);
    return support_network(builder, &def);
}

static hand random_hand(uint32_t trial, bool moves) {
    uint64_t seed = 77 + trial;
    hand h = {.network = held_network(trial, &seed), .count = 2 + trial % (MOST_GRIPS - 1)};
    for (uint32_t i = 0; i < h.count; i++) {
        mspring_grip_def *grip = &h.grips[i];
        check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, grip, sizeof *grip));
        grip->particle = 0;
        grip->x = support_random_between(&seed, -1, 1);
        grip->y = support_random_between(&seed, -1, 1);
        grip->stiffness = (float)decades(&seed, 1, 1e10);
        if (moves || support_random_between(&seed, 0, 4) < 3)
            grip->max_force = (float)decades(&seed, 1e-2, 1e5);
        if (support_random_between(&seed, 0, 3) < 1)
            grip->damping = (float)decades(&seed, 1, 1e5);
        check_ok(mspring_network_add_grip(h.network, grip, &h.ids[i]));
    }
    h.step_x = moves ? support_random_between(&seed, -0.1, 0.1) : 0;
    h.step_y = moves ? support_random_between(&seed, -0.1, 0.1) : 0;
    return h;
}

/// Kinetic, elastic, and that of the grips' springs: quadratic up to the bound, linear beyond.
static double energy(const hand *h) {
    double kinetic, elastic, potential;
    check_ok(support_get_energy(h->network, &kinetic, &elastic, &potential));
    const support_point at = support_position(h->network, 0);
    double sum = kinetic + elastic;
    for (uint32_t i = 0; i < h->count; i++) {
        const double k = (double)h->grips[i].stiffness, most = (double)h->grips[i].max_force;
        const double length = hypot(at.x - h->grips[i].x, at.y - h->grips[i].y);
        sum += k * length <= most ? 0.5 * k * length * length : most * (length - 0.5 * most / k);
    }
    return sum;
}

/// @return what targets can give at most, by all of the force on their way
static double move_targets(hand *h) {
    double work = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        h->grips[i].x += h->step_x;
        h->grips[i].y += h->step_y;
        check_ok(mspring_network_move_grip(h->network, h->ids[i], h->grips[i].x, h->grips[i].y));
        work += (double)h->grips[i].max_force * hypot(h->step_x, h->step_y);
    }
    return work;
}

static void check_bounds(const hand *h) {
    for (uint32_t i = 0; i < h->count; i++) {
        double x, y;
        check_ok(mspring_network_get_grip_impulse(h->network, h->ids[i], &x, &y));
        // The length of a substep is a float, so their sum is DT but for 6e-8.
        assert_true(hypot(x, y) <= (double)h->grips[i].max_force * DT * (1 + 1e-7));
    }
}

static void run(uint32_t trial, bool moves) {
    hand h = random_hand(trial, moves);
    double most = energy(&h);
    for (uint32_t step = 0; step < STEPS; step++) {
        most += moves ? move_targets(&h) : 0;
        check_ok(mspring_network_step(h.network, DT));
        const double now = energy(&h);
        if (!(now <= 1.02 * most)) // 1 % is what explicit substeps waver by
            fail_msg("trial %u, step %u: energy %g J, at most %g J was there or given", trial, step, now, most);
        check_bounds(&h);
    }
    mspring_network_destroy(h.network);
}

static void grips_that_stand_give_no_energy(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < ROUNDS(300); trial++)
        run(trial, false);
}

static void grips_that_move_give_no_more_than_their_force_can(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < ROUNDS(300); trial++)
        run(1000 + trial, true);
}

/// Energy in the frame of targets that move by step_x, step_y in dt seconds.
static double energy_beside(const hand *h, double dt) {
    const uint32_t count = mspring_network_count(h->network, MSPRING_PARTICLES);
    const double ux = h->step_x / dt, uy = h->step_y / dt;
    float masses[MOST_PARTICLES], vx[MOST_PARTICLES], vy[MOST_PARTICLES];
    check_ok(mspring_network_get(h->network, MSPRING_MASS, NULL, 0, count, masses, 1));
    check_ok(mspring_network_get_velocities(h->network, NULL, 0, count, vx, vy, 1));
    double sum = energy(h);
    for (uint32_t i = 0; i < count; i++)
        sum += (double)masses[i] * (0.5 * (ux * ux + uy * uy) - (ux * (double)vx[i] + uy * (double)vy[i]));
    return sum;
}

/// Targets that move alike do no work in their own frame, also where steps are so long that a stiff body stays where it
/// is. Only the last places of targets differ.
static void targets_that_move_alike_give_no_energy_in_their_frame(void **state) {
    (void)state;
    const double dt = 0.25;
    for (uint32_t trial = 0; trial < ROUNDS(120); trial++) {
        uint64_t seed = 5000 + trial;
        const mspring_solver solver = trial % 2 == 0 ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_DIRECT;
        hand h = random_hand(3 * trial + 1, true);
        mspring_settings settings = {.struct_size = sizeof settings};
        check_ok(mspring_network_get_settings(h.network, &settings));
        settings.solver = solver;
        settings.substeps = 1;
        check_ok(mspring_network_set_settings(h.network, &settings));
        const float stiffness = (float)decades(&seed, 1e7, 1e11);
        const uint32_t springs = mspring_network_count(h.network, MSPRING_SPRINGS);
        check_ok(mspring_network_set(h.network, MSPRING_STIFFNESS, NULL, 0, springs, &stiffness, 0));
        h.step_x *= 30;
        h.step_y *= 30;
        const double first = energy_beside(&h, dt);
        double least = first;
        for (uint32_t step = 0; step < 24; step++) {
            (void)move_targets(&h);
            check_ok(mspring_network_step(h.network, dt));
            const double now = energy_beside(&h, dt);
            // Grips act on where a substep would have led without them, which is of first order.
            if (!(now <= least + 0.02 * first))
                fail_msg("trial %u, step %u: energy %g J after %g J, %g J at first", trial, step, now, least, first);
            least = now < least ? now : least;
        }
        mspring_network_destroy(h.network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(grips_that_stand_give_no_energy),
                                       cmocka_unit_test(targets_that_move_alike_give_no_energy_in_their_frame),
                                       cmocka_unit_test(grips_that_move_give_no_more_than_their_force_can)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
