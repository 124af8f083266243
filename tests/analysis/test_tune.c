/// @file test_tune.c
/// What speed costs in accuracy, as the library measures it: errors against an independent reference, and costs
/// against a clock that the test turns.
///
///   test_tune         the tests
///   test_tune ship    the promise of the recommended setting, on our ship (slow)
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/tune/reference.h"
#include "analysis/tune/tuning.h"
#include "recipe.h"
#include "reference.h"
#include "scenes/scene.h"
#include "support.h"
#include "tunes.h"

/* -------------------------------------------------------------------------------------------- what is measured */

/// The network in the tests' own reference.
static reference reference_of_network(const mspring_network *network) {
    reference net = {.particle_count = mspring_network_count(network, MSPRING_PARTICLES),
                     .spring_count = mspring_network_count(network, MSPRING_SPRINGS),
                     .gravity_y = -9.8f};
    net.particles = calloc(net.particle_count, sizeof *net.particles);
    net.springs = calloc(net.spring_count, sizeof *net.springs);
    assert_true(net.particles && net.springs);
    for (mspring_id p = 0; p < net.particle_count; p++) {
        reference_particle *particle = &net.particles[p];
        float mass, scale, vx, vy;
        check_ok(mspring_network_get_positions(network, NULL, p, 1, &particle->x, &particle->y, 1));
        check_ok(mspring_network_get_velocities(network, NULL, p, 1, &vx, &vy, 1));
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, p, 1, &mass, 1));
        check_ok(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, p, 1, &scale, 1));
        particle->vx = (double)vx;
        particle->vy = (double)vy;
        particle->mass = (double)mass;
        particle->pinned = scale == 0;
    }
    for (mspring_id s = 0; s < net.spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        net.springs[s] = (reference_spring){.a = info.a,
                                            .b = info.b,
                                            .stiffness = (double)info.stiffness,
                                            .damping = (double)info.damping,
                                            .rest_length = (double)info.rest_length};
    }
    return net;
}

/// The trajectory's error share of a row, found anew: its setting runs on the network itself, beside the tests' own
/// reference with this many substeps.
static double find_share(mspring_network *network, const mspring_tune_row *row, const mspring_tune_def *def,
                         uint32_t fine_substeps) {
    const uint32_t steps = (uint32_t)(row->duration / def->dt + 0.5);
    reference net = reference_of_network(network), start = reference_of_network(network);
    double error = 0, motion = 0;
    check_ok(mspring_network_set_settings(network, &row->settings));
    for (uint32_t step = 1; step <= steps; step++) {
        support_steps(network, 1, def->dt);
        for (uint32_t i = 0; i < fine_substeps; i++) {
            reference_substep(&net, def->dt / fine_substeps);
        }
        double moved = 0;
        const bool is_moment = step == steps / 4 || step == steps / 2 || step == 3 * steps / 4 || step == steps;
        for (mspring_id p = 0; p < net.particle_count; p++) {
            const support_point at = support_position(network, p);
            if (is_moment) {
                error += pow(at.x - net.particles[p].x, 2) + pow(at.y - net.particles[p].y, 2);
            }
            moved += pow(start.particles[p].x - net.particles[p].x, 2) +
                     pow(start.particles[p].y - net.particles[p].y, 2);
        }
        motion = fmax(motion, moved);
    }
    reference_free(&net);
    reference_free(&start);
    return sqrt(error / 4 / motion);
}

static void trajectory_errors_are_those_of_an_independent_reference(void **state) {
    (void)state;
    const mspring_settings settings[] = {
        tunes_setting(MSPRING_SOLVER_EXPLICIT, 9, 0), tunes_setting(MSPRING_SOLVER_EXPLICIT, 18, 0),
        tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 8), tunes_setting(MSPRING_SOLVER_IMPLICIT, 2, 8)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    for (int damped = 0; damped < 2; damped++) {
        tunes_table out;
        for (uint32_t i = 0; i < COUNT_OF(settings); i++) {
            mspring_network *network = tunes_bar(TUNES_STIFFNESS, damped ? 300 : 0, 0, NULL);
            out = tunes_run(network, &def);
            assert_int_equal(out.count, COUNT_OF(settings));
            const mspring_tune_row *row = &out.rows[i];
            assert_true(tunes_has(row, MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY));
            assert_int_equal(row->settings.substeps, settings[i].substeps);
            // The tuner's reference has three substeps or more for one of an explicit row's, so it lacks a ninth of
            // its error at most; this one lacks 1/1296. Positions of 14 m are rounded to 5e-7 m in each substep.
            const double share = find_share(network, row, &def, 36 * 18), rounding = 1e-6;
            check_near(row->trajectory_share, share, share / 9 + rounding);
            mspring_network_destroy(network);
        }
        // Second order: half the substep, a quarter of the error. That of the fine run's 54 substeps is taken off
        // both: (1 - 1/36) / (1/4 - 1/36) is 4.4. Rounding adds up to an eighth to the second.
        check_near(out.rows[0].trajectory_error / out.rows[1].trajectory_error, 4, 0.6);
        // The implicit one at these substeps has nearly a quarter.
        assert_true(out.rows[2].trajectory_error / out.rows[3].trajectory_error > 2.5);
        // Implicit steps lose energy; none of these may gain any to speak of.
        assert_true(out.rows[2].energy_drift < 0);
        for (uint32_t i = 0; i < COUNT_OF(settings); i++) {
            check_near(out.rows[i].energy_drift, 0, 0.1);
        }
    }
}

/// A mass on a spring that is let go of where the spring is at ease, with this period of its swing.
static mspring_network *swinging_mass(double period) {
    const double turn = 2 * acos(-1.0) / period;
    mspring_builder *builder = support_builder();
    const mspring_id top = support_pinned(builder, 0, 0, 1), weight = support_particle(builder, 0, -20, 2);
    support_spring(builder, top, weight, (float)(2 * turn * turn), 0);
    const mspring_network_def def = support_def(-9.8f, 1);
    return support_network(builder, &def);
}

/// At the four moments it is back where it was; half a period before, it was twice as far away as where it rests.
static void who_comes_back_has_moved(void **state) {
    (void)state;
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 100, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 4, 8)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.duration = 0.25;
    def.max_error = 0.05;
    mspring_network *network = swinging_mass(def.duration / 4);
    const tunes_table out = tunes_run(network, &def);
    const double farthest = 2 * 9.8 * pow(def.duration / 4 / (2 * acos(-1.0)), 2);
    for (uint32_t i = 0; i < out.count; i++) {
        // Half a swing after the start is a step's end: the fine run's 300 substeps miss it by 1e-5.
        check_near(out.rows[i].trajectory_error / out.rows[i].trajectory_share, farthest, 0.01 * farthest);
        assert_true(out.rows[i].trajectory_share < 1);
        check_near(out.rows[i].duration, 0.25, 1e-12);
    }
    assert_true(tunes_has(&out.rows[0], MSPRING_TUNE_RECOMMENDED));
    mspring_network_destroy(network);
}

/// As long as one swing takes: to a fifth, which a few steps of a swing that is damped by the solver leave open.
static void the_motion_says_how_long(void **state) {
    (void)state;
    const mspring_settings setting = tunes_setting(MSPRING_SOLVER_EXPLICIT, 4, 0);
    tunes_watch w = {.tick = 1e-6};
    mspring_tune_def def = tunes_def(&w);
    def.settings = &setting;
    def.setting_count = 1;
    def.max_error = INFINITY;
    for (double period = 0.125; period < 12; period *= 2) {
        mspring_network *network = swinging_mass(period);
        const double expected = fmax(period, 0.25); // 16 steps at least
        const tunes_table out = tunes_run(network, &def);
        assert_true(tunes_has(&out.rows[0], MSPRING_TUNE_HAS_TRAJECTORY));
        check_near(out.rows[0].duration, expected, 0.2 * expected);
        mspring_network_destroy(network);
    }
    // What swings for longer than 1024 steps, or than there is time for, is cut short.
    mspring_network *network = swinging_mass(100);
    check_near(tunes_run(network, &def).rows[0].duration, 1024 * def.dt, 0);
    w.tick = 1e-3;
    def.budget = 0.5;
    const tunes_table out = tunes_run(network, &def);
    assert_true(tunes_has(&out.rows[0], MSPRING_TUNE_HAS_TRAJECTORY | MSPRING_TUNE_HAS_COST));
    assert_true(out.rows[0].duration >= 4 * def.dt && out.rows[0].duration < 200 * def.dt);
    mspring_network_destroy(network);
}

/// Of a network that explicit steps have moved, velocities belong to half a substep ago: they are taken on to now,
/// for the fine run and all solvers. With those of then, the explicit setting had a share of 5e-4.
static void who_moves_starts_with_velocities_of_now(void **state) {
    (void)state;
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 18, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 32, 15)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    mspring_network_def how = support_def(-9.8f, 9);
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, &how);
    support_steps(network, 20, 1.0 / 64);
    const uint64_t before = support_hash(network);
    const tunes_table out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        printf("%u substeps: %g of the motion\n", (unsigned)out.rows[i].settings.substeps, out.rows[i].trajectory_share);
        assert_true(out.rows[i].trajectory_share < 1e-4);
        assert_true(fabs(out.rows[i].energy_drift) < 1e-4);
    }
    assert_int_equal(support_hash(network), before);
    mspring_network_destroy(network);
}

static void the_fine_run_is_of_second_order(void **state) {
    (void)state;
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.global_damping = 2;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 300, 0, &def);
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    double *last[4];
    mspringi_reference r;
    for (uint32_t i = 0; i < 4; i++) {
        check_ok(mspringi_reference_create(&r, network));
        const double h = mspringi_reference_substep(&r);
        // A quarter of 1/362 s, less for the dampers.
        assert_true(h > 0.1 / 362 && h < 0.25 / 362);
        mspringi_reference_run(&r, 1.0 / 64 / 60 / (1u << i), 640u << i);
        last[i] = malloc(2 * count * sizeof *last[i]);
        assert_non_null(last[i]);
        memcpy(last[i], r.x, 2 * count * sizeof *last[i]);
        mspringi_reference_destroy(&r, network);
    }
    double change[3] = {0, 0, 0};
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t j = 0; j < 2 * count; j++) {
            change[i] += pow(last[i + 1][j] - last[i][j], 2);
        }
    }
    check_near(sqrt(change[0] / change[1]), 4, 0.4);
    check_near(sqrt(change[1] / change[2]), 4, 0.2);
    for (uint32_t i = 0; i < 4; i++) {
        free(last[i]);
    }
    mspring_network_destroy(network);
}

static void rest_is_where_settle_finds_it(void **state) {
    (void)state;
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 9, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 8)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.measure = MSPRING_TUNE_BY_REST;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    tunes_table out = tunes_run(network, &def);
    mspring_settle_result rest = {.struct_size = sizeof rest};
    check_ok(mspring_network_settle(network, NULL, &rest));
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(tunes_has(&out.rows[i], MSPRING_TUNE_HAS_REST));
        check_near(out.rows[i].bending, rest.displacement, 0);
        // Rounding: 1e-6 m at 7 m from the origin.
        assert_true(out.rows[i].rest_error > 0 && out.rows[i].rest_error < 1e-5);
        check_near(out.rows[i].rest_share, out.rows[i].rest_error / rest.displacement, 1e-12);
    }
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(tunes_has(&out.rows[i], MSPRING_TUNE_HAS_REST | MSPRING_TUNE_HAS_COST));
        assert_false(tunes_has(&out.rows[i], MSPRING_TUNE_HAS_TRAJECTORY));
    }
    def.flags = 0;
    mspring_network_destroy(network);

    // Nothing holds it: there is no rest, but a trajectory.
    recipe made = tunes_bar_recipe(14, 3, TUNES_STIFFNESS, 0, 0);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].flags = 0;
    }
    network = recipe_network(&made, NULL);
    out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(tunes_has(&out.rows[i], MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY));
        assert_false(out.rows[i].flags & (MSPRING_TUNE_HAS_REST | MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED));
        assert_true(out.rows[i].bending == 0 && out.rows[i].rest_error == 0);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void relative_springs_are_as_firm_as_their_substeps(void **state) {
    (void)state;
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 10, 0),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, 20, 0),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, 40, 0)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.measure = MSPRING_TUNE_BY_BENDING;
    mspring_network *network = tunes_bar(0.5, 0.02, MSPRING_SPRING_RELATIVE, NULL);
    tunes_table out = tunes_run(network, &def);
    for (uint32_t i = 0; i < 3; i++) {
        assert_true(tunes_has(&out.rows[i], MSPRING_TUNE_HAS_REST | MSPRING_TUNE_HAS_TRAJECTORY));
        assert_true(out.rows[i].trajectory_share < 0.1);
    }
    // A lattice bends as the square of the substep, but for what is not linear in it: 4 % at the first.
    check_near(out.rows[0].bending / out.rows[1].bending, 4, 0.2);
    check_near(out.rows[1].bending / out.rows[2].bending, 4, 0.05);
    def.max_error = 1.5 * out.rows[2].bending;
    out = tunes_run(network, &def);
    assert_true(tunes_has(&out.rows[2], MSPRING_TUNE_RECOMMENDED));
    mspring_network_destroy(network);
}

static void rows_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    tunes_table first = {.count = 0};
    for (uint32_t i = 0; i <= level_count; i++) {
        mspring_network_def how = support_def(-9.8f, 1);
        how.simd_level = levels[i % level_count];
        how.worker_count = 1 + i % 3;
        mspring_network *network = tunes_bar(TUNES_STIFFNESS, 200, 0, &how);
        w.tick *= 1.7; // time must not matter, as long as there is enough
        const tunes_table out = tunes_run(network, &def);
        mspring_network_destroy(network);
        assert_true(out.count > 8);
        first = i == 0 ? out : first;
        for (uint32_t r = 0; r < out.count; r++) {
            const mspring_tune_row *a = &first.rows[r], *b = &out.rows[r];
            const uint32_t measured =
                MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY | MSPRING_TUNE_HAS_REST | MSPRING_TUNE_REJECTED;
            assert_int_equal(a->flags & measured, b->flags & measured);
            assert_memory_equal(&a->trajectory_error, &b->trajectory_error,
                                offsetof(mspring_tune_row, moving_cost) -
                                    offsetof(mspring_tune_row, trajectory_error));
        }
    }
}

/* ---------------------------------------------------------------------------------------------- what is judged */

typedef struct example_row {
    double cost, error;
    uint32_t flags, expected;
    double drift;
} example_row;

/// Have rows of these costs and errors judged.
static void judge(const example_row *examples, uint32_t count, double max_error, double max_cost) {
    mspringi_trial trials[8] = {{.time_count = 0}};
    double times[8][3];
    mspringi_tuning tuning = {.trial_count = count, .trials = trials};
    tuning.def.max_error = max_error;
    tuning.def.max_cost = max_cost;
    tuning.def.max_drift = 0.1;
    for (uint32_t i = 0; i < count; i++) {
        times[i][0] = examples[i].cost;
        times[i][1] = 10 * examples[i].cost;
        times[i][2] = 0.5 * examples[i].cost;
        trials[i].times = times[i];
        trials[i].time_count = 3;
        trials[i].row.flags = MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY | examples[i].flags;
        trials[i].row.trajectory_share = examples[i].error;
        trials[i].row.energy_drift = examples[i].drift;
    }
    mspringi_tune_rank(&tuning);
    for (uint32_t i = 0; i < count; i++) {
        const mspring_tune_row *row = &trials[i].row;
        check_near(row->min_cost, 0.5 * examples[i].cost, 0);
        check_near(row->median_cost, examples[i].cost, 0);
        assert_int_equal(row->step_count, 3);
        assert_int_equal(row->flags & (MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED), examples[i].expected);
    }
}

static void recommended_is_what_is_asked_for(void **state) {
    (void)state;
    enum { P = MSPRING_TUNE_PARETO, R = MSPRING_TUNE_RECOMMENDED, REFUSED = MSPRING_TUNE_REJECTED };
    const example_row cheapest[] = {{1, 0.1, 0, P, 0},       {2, 0.01, 0, P | R, 0}, {3, 0.02, 0, 0, 0},
                                    {0.5, 0, REFUSED, 0, 0}, {4, 0.001, 0, P, 0},    {2, 0.01, 0, P, 0}};
    judge(cheapest, COUNT_OF(cheapest), 0.01, INFINITY);
    const example_row most_accurate[] = {
        {1, 0.1, 0, P, 0}, {2, 0.01, 0, P | R, 0}, {3, 0.02, 0, 0, 0}, {4, 0.001, 0, P, 0}};
    judge(most_accurate, COUNT_OF(most_accurate), INFINITY, 3);
    const example_row none[] = {{1, 0.1, 0, P, 0}, {2, 0.01, 0, P, 0}};
    judge(none, COUNT_OF(none), 0.01, 1.5);
    const example_row both[] = {{1, 0.1, 0, P, 0}, {2, 0.01, 0, P | R, 0}, {2.5, 0.001, 0, P, 0}};
    judge(both, COUNT_OF(both), 0.05, 3);
    const example_row gains[] = {{1, 0.01, 0, P, 3.0}, {2, 0.005, 0, P | R, -3.0}};
    judge(gains, COUNT_OF(gains), 0.05, INFINITY);
    const example_row all_refused[] = {{1, 0.1, REFUSED, 0, 0}};
    judge(all_refused, COUNT_OF(all_refused), 1, 1);
}

static void settings_that_are_unstable_are_marked(void **state) {
    (void)state;
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 3, 0),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, MSPRING_SUBSTEPS_AUTO, 0)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.max_error = 1;
    mspring_network_def stands_in = support_def(-9.8f, 1);
    stands_in.settings.guard = MSPRING_GUARD_IMPLICIT; // not while settings are measured
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, &stands_in);
    const tunes_table out = tunes_run(network, &def);
    assert_int_equal(out.rows[0].flags, MSPRING_TUNE_REJECTED);
    assert_true(out.rows[0].trajectory_share == 0 && out.rows[0].median_cost == 0);
    assert_true(
        tunes_has(&out.rows[1], MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED | MSPRING_TUNE_HAS_TRAJECTORY));
    assert_int_equal(out.rows[1].setting, 1);
    assert_in_range(out.rows[1].settings.substeps, 6, 12); // what AUTO chose
    mspring_network_destroy(network);
}

static void usual_settings_are_tried_where_none_are_given(void **state) {
    (void)state;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    mspring_settings settings[TUNES_MOST];
    uint32_t count = 0, least = 0;
    for (int i = 0; i < TUNES_MOST; i++)
        settings[i].struct_size = sizeof settings[i];
    check_ok(mspring_tune_settings(network, 1.0 / 64, NULL, 0, &count));
    assert_in_range(count, 8, TUNES_MOST);
    check_error(mspring_tune_settings(network, 1.0 / 64, settings, count - 1, &count), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "room for");
    check_ok(mspring_tune_settings(network, 1.0 / 64, settings, TUNES_MOST, &count));
    check_ok(mspring_network_suggest_substeps(network, 1.0 / 64, 0.9, &least));
    assert_int_equal(settings[0].substeps, least);
    uint32_t implicit = 0, bdf2 = 0, coarse = 0, fine = 0;
    for (uint32_t i = 0; i < count; i++) {
        check_ok(support_set_solver(network, &settings[i]));
        support_steps(network, 1, 1.0 / 64);
        implicit += settings[i].solver == MSPRING_SOLVER_IMPLICIT;
        bdf2 += settings[i].integrator == MSPRING_INTEGRATOR_BDF2;
        coarse += settings[i].residual == 0.1f;
        fine += settings[i].residual == 0.01f;
    }
    assert_int_equal(coarse, 4); // both integrators, one and two substeps
    assert_true(fine >= coarse);
    assert_in_range(bdf2, 4, count - 4);
    assert_in_range(implicit, 4, count - 3);
    check_error(mspring_tune_settings(NULL, 1.0 / 64, settings, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_settings(network, 0, settings, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_settings(network, 1.0 / 64, NULL, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_settings(network, 1.0 / 64, settings, TUNES_MOST, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
    // Springs that no explicit number of substeps up to 1000 bears.
    network = tunes_bar(1e13, 0, 0, NULL);
    check_ok(mspring_tune_settings(network, 1.0 / 64, settings, TUNES_MOST, &count));
    assert_true(count > 4);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_not_equal(settings[i].solver, MSPRING_SOLVER_EXPLICIT);
    }
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------------- its time */

static void costs_are_what_the_clock_says(void **state) {
    (void)state;
    tunes_watch w = {.tick = 0.25};
    mspring_tune_def def = tunes_def(&w);
    def.progress = tunes_tell;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    const tunes_table out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        check_near(out.rows[i].min_cost, 0.25, 0);
        check_near(out.rows[i].median_cost, 0.25, 0);
        assert_true(out.rows[i].step_count >= 36); // 4 and twice 16
        check_near(out.rows[i].moving_cost, 0.25, 0);
        check_near(out.rows[i].resting_cost, 0.25, 0);
    }
    assert_true(w.told > 100 && !w.went_back);
    assert_true(w.done > 0.9);
    mspring_network_destroy(network);
}

static void the_budget_and_the_watcher_are_heeded(void **state) {
    (void)state;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    const uint64_t hash = support_hash(network);
    uint32_t first_count = 0;
    for (double budget = 0.0005; budget < 8; budget *= 3) {
        tunes_watch w = {.tick = 0.001};
        mspring_tune_def def = tunes_def(&w);
        def.budget = budget;
        const tunes_table out = tunes_run(network, &def);
        // Looks at the clock: one at the beginning, one when it is over, and two around the step before.
        assert_true(w.now <= budget + 0.005);
        uint32_t whole = 0, costs = 0;
        for (uint32_t i = 0; i < out.count; i++) {
            const mspring_tune_row *row = &out.rows[i];
            costs += tunes_has(row, MSPRING_TUNE_HAS_COST);
            whole += tunes_has(row, MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY);
            assert_true(tunes_has(row, MSPRING_TUNE_HAS_TRAJECTORY) || row->trajectory_error == 0);
            assert_true(tunes_has(row, MSPRING_TUNE_HAS_COST) || row->step_count == 0);
        }
        first_count = first_count == 0 ? out.count : first_count;
        assert_int_equal(out.count, first_count);
        assert_true(budget > 0.001 || costs == 0);
        assert_true(whole == 0 || costs == out.count); // first all costs
    }
    for (uint32_t limit = 1; limit < 1000; limit = limit * 2 + 1) {
        tunes_watch w = {.tick = 0.001, .limit = limit};
        mspring_tune_def def = tunes_def(&w);
        def.progress = tunes_tell;
        (void)tunes_run(network, &def);
        assert_true(w.told <= limit && !w.went_back);
    }
    assert_int_equal(support_hash(network), hash);
    mspring_network_destroy(network);
}

static void the_systems_clock_does(void **state) {
    (void)state;
    mspring_tune_def def;
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &def, sizeof def));
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    const tunes_table out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(out.rows[i].min_cost >= 0 && out.rows[i].min_cost <= out.rows[i].median_cost);
    }
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------------- our ship */

#if defined(TUNE_IMAGES)

/// Recommended is what keeps its promise: the error of its run, against a reference of the tests' own, is within a
/// factor of 1.5 of what was told.
static void the_ship_keeps_the_promise(void **state) {
    (void)state;
    scene ship;
    scene_error error = {""};
    scene_materials materials = {0};
    const scene_options options = scene_options_from_file();
    if (!scene_materials_read(TUNE_IMAGES "/ship_materials.csv", &materials, &error) ||
        !scene_image(TUNE_IMAGES "/ship.png", &materials, &options, &ship, &error)) {
        fail_msg("%s", error.text);
    }
    mspring_network *network = NULL;
    check_ok(mspring_network_create(ship.builder, NULL, &network));
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 26, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 8)};
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.duration = 4 * def.dt;
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    def.max_error = INFINITY;
    const tunes_table out = tunes_run(network, &def);
    const mspring_tune_row *recommended = NULL;
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(tunes_has(&out.rows[i], MSPRING_TUNE_HAS_TRAJECTORY));
        recommended = tunes_has(&out.rows[i], MSPRING_TUNE_RECOMMENDED) ? &out.rows[i] : recommended;
    }
    assert_non_null(recommended);
    const double promised = recommended->trajectory_share, share = find_share(network, recommended, &def, 160);
    print_message("promised %g, found %g\n", promised, share);
    assert_true(share < 1.5 * promised && promised < 1.5 * share);
    mspring_network_destroy(network);
    scene_free(&ship);
    scene_materials_free(&materials);
}

#endif

int main(int count, char **arguments) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trajectory_errors_are_those_of_an_independent_reference),
        cmocka_unit_test(who_comes_back_has_moved),
        cmocka_unit_test(the_motion_says_how_long),
        cmocka_unit_test(who_moves_starts_with_velocities_of_now),
        cmocka_unit_test(the_fine_run_is_of_second_order),
        cmocka_unit_test(rest_is_where_settle_finds_it),
        cmocka_unit_test(relative_springs_are_as_firm_as_their_substeps),
        cmocka_unit_test(rows_are_the_same_everywhere),
        cmocka_unit_test(recommended_is_what_is_asked_for),
        cmocka_unit_test(settings_that_are_unstable_are_marked),
        cmocka_unit_test(usual_settings_are_tried_where_none_are_given),
        cmocka_unit_test(costs_are_what_the_clock_says),
        cmocka_unit_test(the_budget_and_the_watcher_are_heeded),
        cmocka_unit_test(the_systems_clock_does),
    };
    if (count == 2 && strcmp(arguments[1], "ship") == 0) {
#if defined(TUNE_IMAGES)
        const struct CMUnitTest slow[] = {cmocka_unit_test(the_ship_keeps_the_promise)};
        return cmocka_run_group_tests(slow, NULL, NULL);
#else
        return 77;
#endif
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
