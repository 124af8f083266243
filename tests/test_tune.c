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
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "reference.h"
#include "scenes/scene.h"
#include "support.h"
#include "tune/reference.h"
#include "tune/tuning.h"

enum { MOST = 32 };

/// A clock that goes on by a tick whenever it is read, and what a watcher has seen.
typedef struct watch {
    double now, tick;
    double done;          ///< the last part that was told
    uint32_t told, limit; ///< how often; when to stop, 0: never
    bool went_back;
} watch;

static double read_watch(void *user) {
    watch *w = user;
    return w->now += w->tick;
}

static uint32_t tell_watch(double done, void *user) {
    watch *w = user;
    w->went_back = w->went_back || done < w->done || done > 1;
    w->done = done;
    return ++w->told != w->limit;
}

static mspring_tune_def tune_def(watch *w) {
    mspring_tune_def def;
    check_ok(mspring_tune_def_init(&def, sizeof def));
    def.clock = read_watch;
    def.user = w;
    def.budget = 1e6;
    return def;
}

static mspring_solver_def setting(mspring_solver solver, uint32_t substeps, uint32_t iterations) {
    mspring_solver_def def;
    check_ok(mspring_solver_def_init(&def, sizeof def));
    def.solver = solver;
    def.substeps = substeps;
    def.iterations = iterations;
    return def;
}

typedef struct table {
    mspring_tune_row rows[MOST];
    uint32_t count;
} table;

static void clear(table *out) {
    memset(out, 0, sizeof *out);
    for (int i = 0; i < MOST; i++) {
        out->rows[i].struct_size = sizeof out->rows[i];
    }
}

static table tune(mspring_network *network, const mspring_tune_def *def) {
    table out;
    clear(&out);
    const mspring_result result = mspring_network_tune(network, def, out.rows, MOST, &out.count);
    if (result != MSPRING_OK) {
        print_error("%s\n", mspring_network_error(network));
    }
    check_ok(result);
    return out;
}

static bool has(const mspring_tune_row *row, uint32_t flags) {
    return (row->flags & flags) == flags;
}

/// A bar that is pinned at its left end. Stiffness in N/m or, if relative, a fraction.
static recipe bar_recipe(uint32_t width, uint32_t height, double stiffness, double damping, uint32_t flags) {
    recipe made = {0};
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {70, 70},
                                .stiffness = {stiffness, stiffness},
                                .damping = {damping, damping},
                                .spring_flags = flags};
    const mspring_id first = recipe_lattice(&made, width, height, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < height; row++) {
        made.particles[first + row * width].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

static mspring_network *bar(double stiffness, double damping, uint32_t flags, const mspring_network_def *def) {
    recipe made = bar_recipe(14, 3, stiffness, damping, flags);
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    return network;
}

/// Stable with 8 explicit substeps of 1/64 s: omega_max = sqrt(8 k / m), 2 / omega_max = 1/362 s.
static const double bar_stiffness = 4.6e6;

/* -------------------------------------------------------------------------------------------- what is measured */

/// The network in the tests' own reference.
static reference reference_of_network(const mspring_network *network) {
    reference net = {.particle_count = mspring_network_particle_count(network),
                     .spring_count = mspring_network_spring_count(network),
                     .gravity_y = -9.8f};
    net.particles = calloc(net.particle_count, sizeof *net.particles);
    net.springs = calloc(net.spring_count, sizeof *net.springs);
    assert_true(net.particles && net.springs);
    for (mspring_id p = 0; p < net.particle_count; p++) {
        reference_particle *particle = &net.particles[p];
        float mass, scale, vx, vy;
        check_ok(mspring_network_get_positions(network, p, 1, &particle->x, &particle->y));
        check_ok(mspring_network_get_velocities(network, p, 1, &vx, &vy));
        check_ok(mspring_network_get_masses(network, p, 1, &mass));
        check_ok(mspring_network_get_inverse_mass_scales(network, p, 1, &scale));
        particle->vx = (double)vx;
        particle->vy = (double)vy;
        particle->mass = (double)mass;
        particle->pinned = scale == 0;
    }
    for (mspring_id s = 0; s < net.spring_count; s++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        check_ok(mspring_network_get_spring(network, s, &info));
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
    const uint32_t steps = (uint32_t)(def->duration / def->dt + 0.5);
    mspring_solver_def solver;
    reference net = reference_of_network(network), start = reference_of_network(network);
    double error = 0, motion = 0;
    check_ok(mspring_tune_row_solver(row, &solver));
    check_ok(mspring_network_set_solver(network, &solver));
    for (uint32_t step = 1; step <= steps; step++) {
        support_steps(network, 1, def->dt);
        for (uint32_t i = 0; i < fine_substeps; i++) {
            reference_substep(&net, def->dt / fine_substeps);
        }
        if (step * 4 % steps != 0) {
            continue;
        }
        for (mspring_id p = 0; p < net.particle_count; p++) {
            const support_point at = support_position(network, p);
            error += pow(at.x - net.particles[p].x, 2) + pow(at.y - net.particles[p].y, 2);
            motion += pow(start.particles[p].x - net.particles[p].x, 2) +
                      pow(start.particles[p].y - net.particles[p].y, 2);
        }
    }
    reference_free(&net);
    reference_free(&start);
    return sqrt(error / motion);
}

static void trajectory_errors_are_those_of_an_independent_reference(void **state) {
    (void)state;
    const mspring_solver_def settings[] = {
        setting(MSPRING_SOLVER_EXPLICIT, 9, 0), setting(MSPRING_SOLVER_EXPLICIT, 18, 0),
        setting(MSPRING_SOLVER_IMPLICIT, 1, 8), setting(MSPRING_SOLVER_IMPLICIT, 2, 8)};
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    for (int damped = 0; damped < 2; damped++) {
        table out;
        for (uint32_t i = 0; i < COUNT_OF(settings); i++) {
            mspring_network *network = bar(bar_stiffness, damped ? 300 : 0, 0, NULL);
            out = tune(network, &def);
            assert_int_equal(out.count, COUNT_OF(settings));
            const mspring_tune_row *row = &out.rows[i];
            assert_true(has(row, MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY));
            assert_int_equal(row->substeps, settings[i].substeps);
            // The references are first and second order, with 36 and more substeps for one of the row's: 3 % of its
            // error at most.
            const double share = find_share(network, row, &def, 36 * 18);
            check_near(row->trajectory_share, share, 0.05 * share);
            mspring_network_destroy(network);
        }
        // Order one and two: half the substep, half and (at these substeps nearly) a quarter of the error.
        check_near(out.rows[0].trajectory_error / out.rows[1].trajectory_error, 2, 0.3);
        assert_true(out.rows[2].trajectory_error / out.rows[3].trajectory_error > 2.5);
        // Implicit steps lose energy; none of these may gain any to speak of.
        assert_true(out.rows[2].energy_drift < 0);
        for (uint32_t i = 0; i < COUNT_OF(settings); i++) {
            check_near(out.rows[i].energy_drift, 0, 0.1);
        }
    }
}

static void the_fine_run_is_of_second_order(void **state) {
    (void)state;
    mspring_network_def def = support_def(-9.8f, 1);
    def.global_damping = 2;
    mspring_network *network = bar(bar_stiffness, 300, 0, &def);
    const uint32_t count = mspring_network_particle_count(network);
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
    const mspring_solver_def settings[] = {setting(MSPRING_SOLVER_EXPLICIT, 9, 0),
                                           setting(MSPRING_SOLVER_IMPLICIT, 1, 8)};
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.measure = MSPRING_TUNE_BY_REST;
    mspring_network *network = bar(bar_stiffness, 0, 0, NULL);
    table out = tune(network, &def);
    mspring_settle_result rest = {.struct_size = sizeof rest};
    check_ok(mspring_network_settle(network, NULL, &rest));
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(has(&out.rows[i], MSPRING_TUNE_HAS_REST));
        check_near(out.rows[i].bending, rest.displacement, 0);
        // Rounding: 1e-6 m at 7 m from the origin.
        assert_true(out.rows[i].rest_error > 0 && out.rows[i].rest_error < 1e-5);
        check_near(out.rows[i].rest_share, out.rows[i].rest_error / rest.displacement, 1e-12);
    }
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    out = tune(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(has(&out.rows[i], MSPRING_TUNE_HAS_REST | MSPRING_TUNE_HAS_COST));
        assert_false(has(&out.rows[i], MSPRING_TUNE_HAS_TRAJECTORY));
    }
    def.flags = 0;
    mspring_network_destroy(network);

    // Nothing holds it: there is no rest, but a trajectory.
    recipe made = bar_recipe(14, 3, bar_stiffness, 0, 0);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].flags = 0;
    }
    network = recipe_network(&made, NULL);
    out = tune(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(has(&out.rows[i], MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY));
        assert_false(out.rows[i].flags & (MSPRING_TUNE_HAS_REST | MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED));
        assert_true(out.rows[i].bending == 0 && out.rows[i].rest_error == 0);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void relative_springs_are_as_firm_as_their_substeps(void **state) {
    (void)state;
    const mspring_solver_def settings[] = {setting(MSPRING_SOLVER_EXPLICIT, 10, 0),
                                           setting(MSPRING_SOLVER_EXPLICIT, 20, 0),
                                           setting(MSPRING_SOLVER_EXPLICIT, 40, 0)};
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.measure = MSPRING_TUNE_BY_BENDING;
    mspring_network *network = bar(0.5, 0.02, MSPRING_SPRING_RELATIVE, NULL);
    table out = tune(network, &def);
    for (uint32_t i = 0; i < 3; i++) {
        assert_true(has(&out.rows[i], MSPRING_TUNE_HAS_REST | MSPRING_TUNE_HAS_TRAJECTORY));
        assert_true(out.rows[i].trajectory_share < 0.1);
    }
    // A lattice bends as the square of the substep, but for what is not linear in it: 4 % at the first.
    check_near(out.rows[0].bending / out.rows[1].bending, 4, 0.2);
    check_near(out.rows[1].bending / out.rows[2].bending, 4, 0.05);
    def.max_error = 1.5 * out.rows[2].bending;
    out = tune(network, &def);
    assert_true(has(&out.rows[2], MSPRING_TUNE_RECOMMENDED));
    mspring_network_destroy(network);
}

static void rows_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    table first = {.count = 0};
    for (uint32_t i = 0; i <= level_count; i++) {
        mspring_network_def how = support_def(-9.8f, 1);
        how.simd_level = levels[i % level_count];
        how.worker_count = 1 + i % 3;
        mspring_network *network = bar(bar_stiffness, 200, 0, &how);
        w.tick *= 1.7; // time must not matter, as long as there is enough
        const table out = tune(network, &def);
        mspring_network_destroy(network);
        assert_true(out.count > 8);
        first = i == 0 ? out : first;
        for (uint32_t r = 0; r < out.count; r++) {
            const mspring_tune_row *a = &first.rows[r], *b = &out.rows[r];
            const uint32_t measured =
                MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY | MSPRING_TUNE_HAS_REST | MSPRING_TUNE_REFUSED;
            assert_int_equal(a->flags & measured, b->flags & measured);
            assert_memory_equal(&a->trajectory_error, &b->trajectory_error,
                                sizeof *a - offsetof(mspring_tune_row, trajectory_error));
        }
    }
}

/* ------------------------------------------------------------------------------------------------- what is judged
 */

typedef struct example_row {
    double cost, error;
    uint32_t flags, expected;
} example_row;

/// Have rows of these costs and errors judged.
static void judge(const example_row *examples, uint32_t count, double max_error, double max_cost) {
    mspringi_trial trials[8] = {{.time_count = 0}};
    double times[8][3];
    mspringi_tuning tuning = {.trial_count = count, .trials = trials};
    tuning.def.max_error = max_error;
    tuning.def.max_cost = max_cost;
    for (uint32_t i = 0; i < count; i++) {
        times[i][0] = examples[i].cost;
        times[i][1] = 10 * examples[i].cost;
        times[i][2] = 0.5 * examples[i].cost;
        trials[i].times = times[i];
        trials[i].time_count = 3;
        trials[i].row.flags = MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY | examples[i].flags;
        trials[i].row.trajectory_share = examples[i].error;
    }
    mspringi_tune_judge(&tuning);
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
    enum { P = MSPRING_TUNE_PARETO, R = MSPRING_TUNE_RECOMMENDED, REFUSED = MSPRING_TUNE_REFUSED };
    const example_row cheapest[] = {{1, 0.1, 0, P},       {2, 0.01, 0, P | R}, {3, 0.02, 0, 0},
                                    {0.5, 0, REFUSED, 0}, {4, 0.001, 0, P},    {2, 0.01, 0, P}};
    judge(cheapest, COUNT_OF(cheapest), 0.01, INFINITY);
    const example_row most_accurate[] = {{1, 0.1, 0, P}, {2, 0.01, 0, P | R}, {3, 0.02, 0, 0}, {4, 0.001, 0, P}};
    judge(most_accurate, COUNT_OF(most_accurate), INFINITY, 3);
    const example_row none[] = {{1, 0.1, 0, P}, {2, 0.01, 0, P}};
    judge(none, COUNT_OF(none), 0.01, 1.5);
    const example_row both[] = {{1, 0.1, 0, P}, {2, 0.01, 0, P | R}, {2.5, 0.001, 0, P}};
    judge(both, COUNT_OF(both), 0.05, 3);
    const example_row all_refused[] = {{1, 0.1, REFUSED, 0}};
    judge(all_refused, COUNT_OF(all_refused), 1, 1);
}

static void settings_that_are_unstable_are_marked(void **state) {
    (void)state;
    const mspring_solver_def settings[] = {setting(MSPRING_SOLVER_EXPLICIT, 3, 0),
                                           setting(MSPRING_SOLVER_EXPLICIT, MSPRING_SUBSTEPS_AUTO, 0)};
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.max_error = 1;
    mspring_network_def stands_in = support_def(-9.8f, 1);
    stands_in.guard = MSPRING_GUARD_IMPLICIT; // not while settings are measured
    mspring_network *network = bar(bar_stiffness, 0, 0, &stands_in);
    const table out = tune(network, &def);
    assert_int_equal(out.rows[0].flags, MSPRING_TUNE_REFUSED);
    assert_true(out.rows[0].trajectory_share == 0 && out.rows[0].median_cost == 0);
    assert_true(has(&out.rows[1], MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED | MSPRING_TUNE_HAS_TRAJECTORY));
    assert_int_equal(out.rows[1].setting, 1);
    assert_in_range(out.rows[1].substeps, 6, 12); // what AUTO chose
    mspring_network_destroy(network);
}

static void usual_settings_are_tried_where_none_are_given(void **state) {
    (void)state;
    mspring_network *network = bar(bar_stiffness, 0, 0, NULL);
    mspring_solver_def settings[MOST];
    uint32_t count = 0, least = 0;
    check_ok(mspring_tune_settings(network, 1.0 / 64, NULL, 0, &count));
    assert_in_range(count, 8, MOST);
    check_error(mspring_tune_settings(network, 1.0 / 64, settings, count - 1, &count), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "room for");
    check_ok(mspring_tune_settings(network, 1.0 / 64, settings, MOST, &count));
    check_ok(mspring_network_suggest_substeps(network, 1.0 / 64, 0.9, &least));
    assert_int_equal(settings[0].substeps, least);
    uint32_t implicit = 0;
    for (uint32_t i = 0; i < count; i++) {
        check_ok(mspring_network_set_solver(network, &settings[i]));
        support_steps(network, 1, 1.0 / 64);
        implicit += settings[i].solver == MSPRING_SOLVER_IMPLICIT;
    }
    assert_in_range(implicit, 4, count - 3);
    check_error(mspring_tune_settings(NULL, 1.0 / 64, settings, MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_settings(network, 0, settings, MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_settings(network, 1.0 / 64, NULL, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_settings(network, 1.0 / 64, settings, MOST, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
    // Springs that no explicit number of substeps up to 1000 bears.
    network = bar(1e13, 0, 0, NULL);
    check_ok(mspring_tune_settings(network, 1.0 / 64, settings, MOST, &count));
    assert_true(count > 4);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_not_equal(settings[i].solver, MSPRING_SOLVER_EXPLICIT);
    }
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------------- its time */

static void costs_are_what_the_clock_says(void **state) {
    (void)state;
    watch w = {.tick = 0.25};
    mspring_tune_def def = tune_def(&w);
    def.progress = tell_watch;
    mspring_network *network = bar(bar_stiffness, 0, 0, NULL);
    const table out = tune(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        check_near(out.rows[i].min_cost, 0.25, 0);
        check_near(out.rows[i].median_cost, 0.25, 0);
        assert_true(out.rows[i].step_count >= 36); // 4 and twice 16
    }
    assert_true(w.told > 100 && !w.went_back);
    assert_true(w.done > 0.9);
    mspring_network_destroy(network);
}

static void the_budget_and_the_watcher_are_heeded(void **state) {
    (void)state;
    mspring_network *network = bar(bar_stiffness, 0, 0, NULL);
    const uint64_t hash = support_hash(network);
    uint32_t first_count = 0;
    for (double budget = 0.0005; budget < 8; budget *= 3) {
        watch w = {.tick = 0.001};
        mspring_tune_def def = tune_def(&w);
        def.budget = budget;
        const table out = tune(network, &def);
        // Looks at the clock: one at the beginning, one when it is over, and two around the step before.
        assert_true(w.now <= budget + 0.005);
        uint32_t whole = 0, costs = 0;
        for (uint32_t i = 0; i < out.count; i++) {
            const mspring_tune_row *row = &out.rows[i];
            costs += has(row, MSPRING_TUNE_HAS_COST);
            whole += has(row, MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_TRAJECTORY);
            assert_true(has(row, MSPRING_TUNE_HAS_TRAJECTORY) || row->trajectory_error == 0);
            assert_true(has(row, MSPRING_TUNE_HAS_COST) || row->step_count == 0);
        }
        first_count = first_count == 0 ? out.count : first_count;
        assert_int_equal(out.count, first_count);
        assert_true(budget > 0.001 || costs == 0);
        assert_true(whole == 0 || costs == out.count); // first all costs
    }
    for (uint32_t limit = 1; limit < 1000; limit = limit * 2 + 1) {
        watch w = {.tick = 0.001, .limit = limit};
        mspring_tune_def def = tune_def(&w);
        def.progress = tell_watch;
        (void)tune(network, &def);
        assert_true(w.told <= limit && !w.went_back);
    }
    assert_int_equal(support_hash(network), hash);
    mspring_network_destroy(network);
}

static void the_systems_clock_does(void **state) {
    (void)state;
    mspring_tune_def def;
    check_ok(mspring_tune_def_init(&def, sizeof def));
    mspring_network *network = bar(bar_stiffness, 0, 0, NULL);
    const table out = tune(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(out.rows[i].min_cost >= 0 && out.rows[i].min_cost <= out.rows[i].median_cost);
    }
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------- what is left as it was
 */

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ++*(uint32_t *)user;
}

static void nothing_happens_to_the_network(void **state) {
    (void)state;
    uint32_t calls = 0;
    mspring_network *network = bar(bar_stiffness, 100, 0, NULL), *untouched = bar(bar_stiffness, 100, 0, NULL);
    mspring_network *const both[] = {network, untouched};
    const mspring_id first = 20;
    float strains[512];
    for (uint32_t i = 0; i < COUNT_OF(strains); i++) {
        strains[i] = 1e-5f; // which gravity is enough for
    }
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(support_add_hook(both[i], MSPRING_PHASE_AFTER_SUBSTEP, count_call, &calls, NULL));
        check_ok(mspring_network_reserve_events(both[i], 100));
        check_ok(mspring_network_break_springs(both[i], &first, 1));
        check_ok(mspring_network_restore_springs(both[i], &first, 1, 0.1));
        check_ok(mspring_network_set_break_strains(both[i], 0, mspring_network_spring_count(both[i]), strains));
        check_ok(mspring_network_apply_force(both[i], 17, 1000, 500));
    }
    const size_t used = mspring_network_memory_used(network);
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    const table out = tune(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        // Had springs broken, it would have fallen.
        assert_true(out.rows[i].trajectory_share < 0.5 && out.rows[i].rest_share < 0.01);
    }
    assert_int_equal(calls, 0);
    assert_int_equal(mspring_network_memory_used(network), used);
    assert_string_equal(mspring_network_error(network), "");
    mspring_solver_def solver = setting(MSPRING_SOLVER_EXPLICIT, 12, 0);
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(mspring_network_set_solver(both[i], &solver));
        support_steps(both[i], 5, 1.0 / 64);
    }
    assert_int_equal(support_hash(network), support_hash(untouched));
    mspring_network_destroy(network);
    mspring_network_destroy(untouched);
}

static void networks_that_may_sleep_stay_awake(void **state) {
    (void)state;
    mspring_network_def how = support_def(-9.8f, 12);
    how.sleep_speed = 1e6f; // it sleeps whatever it does
    how.sleep_time = 0;
    mspring_network *network = bar(bar_stiffness, 0, 0, &how), *awake = bar(bar_stiffness, 0, 0, NULL);
    support_steps(network, 1, 1e-6);
    assert_true(mspring_network_is_asleep(network));
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    const table out = tune(network, &def), expected = tune(awake, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        // A millionth of a second has passed.
        check_near(out.rows[i].trajectory_share, expected.rows[i].trajectory_share,
                   0.01 * expected.rows[i].trajectory_share);
    }
    assert_true(mspring_network_is_asleep(network));
    mspring_network_destroy(network);
    mspring_network_destroy(awake);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    const mspring_solver_def settings[] = {setting(MSPRING_SOLVER_EXPLICIT, 9, 0),
                                           setting(MSPRING_SOLVER_IMPLICIT, 1, 2)};
    size_t failures = 0;
    for (size_t fail_at = 1;; fail_at++) {
        watched_allocator watched = {.fail_at = 0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def how = support_def(-9.8f, 1);
        how.allocator = &allocator;
        recipe made = bar_recipe(5, 2, bar_stiffness, 100, 0);
        mspring_network *network = recipe_network(&made, &how);
        recipe_free(&made);
        const size_t live = watched.live;
        const uint64_t hash = support_hash(network);
        watch w = {.tick = 1e-3};
        mspring_tune_def def = tune_def(&w);
        def.settings = settings;
        def.setting_count = COUNT_OF(settings);
        def.duration = 4 * def.dt;
        table out, untouched;
        clear(&out);
        clear(&untouched);
        watched.fail_at = watched.calls + fail_at;
        const mspring_result result = mspring_network_tune(network, &def, out.rows, MOST, &out.count);
        assert_int_equal(watched.live, live);
        assert_int_equal(support_hash(network), hash);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_memory_equal(&out, &untouched, sizeof out);
            failures++;
        }
        mspring_network_destroy(network);
        check_watched_clean(&watched);
        if (result == MSPRING_OK) {
            break;
        }
    }
    assert_true(failures > 100);
}

static mspring_result in_hook_result;

static void tune_in_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    table out;
    clear(&out);
    in_hook_result = mspring_network_tune(user, NULL, out.rows, MOST, &out.count);
}

static void bad_calls_are_refused(void **state) {
    (void)state;
    mspring_network *network = bar(bar_stiffness, 0, 0, NULL);
    watch w = {.tick = 1e-3};
    table out;
    uint32_t count = 77;
    clear(&out);
    const mspring_tune_def good = tune_def(&w);
    check_error(mspring_tune_def_init(NULL, sizeof good), MSPRING_ERROR_ARGUMENT);
    mspring_tune_def def;
    check_error(mspring_tune_def_init(&def, sizeof def + 8), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_tune(NULL, &good, out.rows, MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_tune(network, &good, NULL, MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_tune(network, &good, out.rows, MOST, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_tune(network, &good, out.rows, 2, &count), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "room for 2 rows");
    out.rows[3].struct_size = 8;
    check_error(mspring_network_tune(network, &good, out.rows, MOST, &count), MSPRING_ERROR_STRUCT);
    clear(&out);

    const mspring_solver_def settings[] = {setting(MSPRING_SOLVER_EXPLICIT, 1, 0),
                                           setting(MSPRING_SOLVER_EXPLICIT, 0, 0)};
    for (int bad = 0; bad < 16; bad++) {
        def = good;
        switch (bad) {
        case 0:
            def.dt = 0;
            break;
        case 1:
            def.dt = NAN;
            break;
        case 2:
            def.duration = -1;
            break;
        case 3:
            def.duration = 1e9;
            break;
        case 4:
            def.budget = 0;
            break;
        case 5:
            def.budget = NAN;
            break;
        case 6:
            def.max_error = 0;
            break;
        case 7:
            def.max_cost = NAN;
            break;
        case 8:
            def.measure = 3;
            break;
        case 9:
            def.measure = -1;
            break;
        case 10:
            def.settings = settings;
            break;
        case 11:
            def.setting_count = 3;
            break;
        case 12:
            def.settings = settings;
            def.setting_count = 1001;
            break;
        case 13:
            def.dt = 1e-300; // no float
            def.duration = 1e-299;
            break;
        case 14:
            def.flags = 2;
            break;
        default:
            def.settings = settings;
            def.setting_count = 2;
        }
        check_error(mspring_network_tune(network, &def, out.rows, MOST, &count), MSPRING_ERROR_ARGUMENT);
        assert_true(strlen(mspring_network_error(network)) > 10);
    }
    check_contains(mspring_network_error(network), "setting 1: substeps");
    def = good;
    def.struct_size -= 8;
    check_error(mspring_network_tune(network, &def, out.rows, MOST, &count), MSPRING_ERROR_STRUCT);
    mspring_solver_def solver;
    check_error(mspring_tune_row_solver(NULL, &solver), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_tune_row_solver(&out.rows[0], NULL), MSPRING_ERROR_ARGUMENT);
    out.rows[0].struct_size = 3;
    check_error(mspring_tune_row_solver(&out.rows[0], &solver), MSPRING_ERROR_STRUCT);
    assert_int_equal(count, 77);

    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, tune_in_hook, network, NULL));
    solver = setting(MSPRING_SOLVER_EXPLICIT, 12, 0);
    check_ok(mspring_network_set_solver(network, &solver));
    support_steps(network, 1, 1.0 / 64);
    check_error(in_hook_result, MSPRING_ERROR_BUSY);
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
    const mspring_solver_def settings[] = {setting(MSPRING_SOLVER_EXPLICIT, 26, 0),
                                           setting(MSPRING_SOLVER_IMPLICIT, 1, 8)};
    watch w = {.tick = 1e-3};
    mspring_tune_def def = tune_def(&w);
    def.settings = settings;
    def.setting_count = COUNT_OF(settings);
    def.duration = 4 * def.dt;
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    def.max_error = INFINITY;
    const table out = tune(network, &def);
    const mspring_tune_row *recommended = NULL;
    for (uint32_t i = 0; i < out.count; i++) {
        assert_true(has(&out.rows[i], MSPRING_TUNE_HAS_TRAJECTORY));
        recommended = has(&out.rows[i], MSPRING_TUNE_RECOMMENDED) ? &out.rows[i] : recommended;
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
        cmocka_unit_test(nothing_happens_to_the_network),
        cmocka_unit_test(networks_that_may_sleep_stay_awake),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(bad_calls_are_refused),
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
