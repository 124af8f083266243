/// @file test_tune_scene.c
/// Settings in a scene: what is switched on acts, what is told is what runs by hand give, and nothing of it touches
/// the network.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/tune/tuning.h"
#include "recipe.h"
#include "support.h"
#include "tunes.h"

static const double dt = 1.0 / 64;

/// A lattice that falls at 9 m/s onto a slope half a metre below, and breaks there at a strain of 1 %.
static mspring_network *falling_lattice(const mspring_network_def *how) {
    recipe made = tunes_bar_recipe(12, 4, TUNES_STIFFNESS, 0, 0);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].flags = 0;
        made.particles[p].vy = -9;
    }
    mspring_network *network = recipe_network(&made, how);
    const double slope[4] = {0, -2, 0.1, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = slope, floor.plane_count = 1, floor.friction = 0.3f, floor.restitution = 0.2f;
    check_ok(mspring_network_set_floor(network, &floor));
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    float *strains = malloc(count * sizeof *strains);
    for (uint32_t s = 0; s < count; s++) {
        strains[s] = 0.01f;
    }
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, count, strains, 1));
    free(strains);
    recipe_free(&made);
    return network;
}

static mspring_tune_scene short_scene(void) {
    mspring_tune_scene scene;
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_SCENE, &scene, sizeof scene));
    scene.start_count = 5;
    scene.duration = 24 * dt;
    return scene;
}

static mspring_tune_def def_of(tunes_watch *w, const mspring_tune_scene *scene, const mspring_settings *settings,
                               uint32_t count) {
    mspring_tune_def def = tunes_def(w);
    def.scene = scene;
    def.settings = settings;
    def.setting_count = count;
    def.measure = MSPRING_TUNE_BY_SCENE;
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    return def;
}

/* ------------------------------------------------------------------------------------------ what is switched on */

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ++*(uint32_t *)user;
}

static void what_is_switched_on_acts(void **state) {
    (void)state;
    uint32_t calls = 0;
    mspring_network *network = falling_lattice(NULL);
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, count_call, &calls, NULL));
    const mspring_settings setting = tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0);
    const uint64_t hash = support_hash(network);
    for (uint32_t flags = 0; flags < 8; flags++) {
        mspring_tune_scene scene = short_scene();
        scene.flags = flags;
        tunes_watch w = {.tick = 1e-3};
        const mspring_tune_def def = def_of(&w, &scene, &setting, 1);
        const tunes_table out = tunes_run(network, &def);
        const mspring_tune_row *row = &out.rows[0];
        assert_true(tunes_has(row, MSPRING_TUNE_HAS_SCENE | MSPRING_TUNE_HAS_COST | MSPRING_TUNE_PARETO));
        const bool falls_apart = flags & MSPRING_TUNE_SCENE_FLOOR && flags & MSPRING_TUNE_SCENE_BREAKING;
        assert_true(falls_apart
                        ? row->fine_mean[MSPRING_TUNE_BROKEN] > 5 && row->scene_mean[MSPRING_TUNE_BROKEN] > 5
                        : row->fine_mean[MSPRING_TUNE_BROKEN] == 0 && row->scene_mean[MSPRING_TUNE_BROKEN] == 0);
        if (!(flags & MSPRING_TUNE_SCENE_FLOOR)) { // 48 particles of 70 kg that have fallen for 24 steps
            const double energy = 0.5 * 48 * 70 * pow(9 + 9.8 * 24 * dt, 2);
            check_near(row->fine_mean[MSPRING_TUNE_ENERGY], energy, 0.01 * energy);
        }
        const uint32_t steps = 5 * 24;
        assert_int_equal(calls, flags & MSPRING_TUNE_SCENE_HOOKS ? steps * (12 + row->fine_substeps) : 0);
        assert_true(row->fine_substeps >= 24);
        calls = 0;
        assert_int_equal(support_hash(network), hash);
    }
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------- runs by hand */

/// Has each start fall at a speed of its own, whatever the kick was, and one spring break before.
static mspring_result drop(mspring_network *run, uint32_t start, void *user) {
    (void)user;
    const mspring_id spring = 7;
    const uint32_t count = mspring_network_count(run, MSPRING_PARTICLES);
    for (mspring_id p = 0; p < count; p++) {
        const float vx = 0, vy = -8 - 0.3f * (float)start;
        check_ok(mspring_network_set_velocities(run, NULL, p, 1, &vx, &vy, 1));
    }
    return mspring_network_break_springs(run, &spring, 0, 1);
}

static uint32_t count_broken(const mspring_network *network) {
    uint32_t broken = 0;
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        broken += (info.flags & MSPRING_SPRING_BROKEN) != 0;
    }
    return broken;
}

/// Mean and standard deviation of the three quantities, by runs of a network's clones.
static void run_by_hand(const mspring_network *network, const mspring_settings *solver, uint32_t starts,
                        uint32_t steps, double mean[3], double spread[3]) {
    double of[64][3];
    for (uint32_t start = 0; start < starts; start++) {
        mspring_network *run = NULL;
        check_ok(mspring_network_clone(network, NULL, &run));
        check_ok(drop(run, start, NULL));
        check_ok(support_set_solver(run, solver));
        support_steps(run, steps, dt);
        double kinetic, elastic, left, low, right, high;
        check_ok(support_get_energy(run, &kinetic, &elastic, NULL));
        check_ok(support_get_bounds(run, &left, &low, &right, &high));
        of[start][MSPRING_TUNE_BROKEN] = count_broken(run) - 1;
        of[start][MSPRING_TUNE_ENERGY] = kinetic + elastic;
        of[start][MSPRING_TUNE_EXTENT] = fmax(right - left, high - low);
        mspring_network_destroy(run);
    }
    for (int q = 0; q < 3; q++) {
        double squares = 0;
        mean[q] = 0;
        for (uint32_t start = 0; start < starts; start++) {
            mean[q] += of[start][q] / starts;
        }
        for (uint32_t start = 0; start < starts; start++) {
            squares += pow(of[start][q] - mean[q], 2) / (starts - 1);
        }
        spread[q] = sqrt(squares);
    }
}

static void rows_tell_what_runs_by_hand_give(void **state) {
    (void)state;
    mspring_network *network = falling_lattice(NULL);
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 8),
                                           tunes_setting(MSPRING_SOLVER_DIRECT, 2, 0)};
    mspring_tune_scene scene = short_scene();
    scene.prepare = drop;
    tunes_watch w = {.tick = 1e-3};
    const mspring_tune_def def = def_of(&w, &scene, settings, COUNT_OF(settings));
    const tunes_table out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        const mspring_tune_row *row = &out.rows[i];
        assert_true(tunes_has(row, MSPRING_TUNE_HAS_SCENE));
        assert_false(row->flags & (MSPRING_TUNE_HAS_TRAJECTORY | MSPRING_TUNE_HAS_REST));
        assert_int_equal(row->scene_starts, scene.start_count);
        const mspring_settings fine = tunes_setting(MSPRING_SOLVER_EXPLICIT, row->fine_substeps, 0);
        double mean[3], spread[3], fine_mean[3], fine_spread[3], distance = 0;
        run_by_hand(network, &settings[i], scene.start_count, 24, mean, spread);
        run_by_hand(network, &fine, scene.start_count, 24, fine_mean, fine_spread);
        for (int q = 0; q < 3; q++) { // but for the order of sums
            check_near(row->scene_mean[q], mean[q], 1e-12 * mean[q]);
            check_near(row->scene_spread[q], spread[q], 1e-9 * mean[q]);
            check_near(row->fine_mean[q], fine_mean[q], 1e-12 * fine_mean[q]);
            check_near(row->fine_spread[q], fine_spread[q], 1e-9 * fine_mean[q]);
            double unit = fmax(fine_spread[q], 0.05 * fine_mean[q]);
            unit = q == MSPRING_TUNE_BROKEN ? fmax(unit, 1) : unit;
            distance = fmax(distance, fabs(mean[q] - fine_mean[q]) / unit);
        }
        check_near(row->scene_distance, distance, 1e-9 * distance);
        check_near(row->scene_cost, w.tick, 1e-9);
    }
    mspring_network_destroy(network);
}

/// The starts differ, all but the first, and the pinned particles' do not.
static mspring_result note_velocities(mspring_network *run, uint32_t start, void *user) {
    (void)user;
    for (mspring_id p = 0; p < mspring_network_count(run, MSPRING_PARTICLES); p++) {
        float vx, vy, scale;
        check_ok(mspring_network_get_velocities(run, NULL, p, 1, &vx, &vy, 1));
        check_ok(mspring_network_get(run, MSPRING_INVERSE_MASS_SCALE, NULL, p, 1, &scale, 1));
        if (start == 0 || scale == 0) {
            assert_true(vx == 0 && vy == 0);
        } else {
            assert_true((vx != 0 || vy != 0) && fabsf(vx) <= 0.25f && fabsf(vy) <= 0.25f);
        }
    }
    return MSPRING_OK;
}

static void starts_are_kicked(void **state) {
    (void)state;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    const mspring_settings setting = tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0);
    mspring_tune_scene scene = short_scene();
    scene.prepare = note_velocities;
    scene.kick = 0.25;
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = def_of(&w, &scene, &setting, 1);
    const tunes_table out = tunes_run(network, &def);
    assert_true(out.rows[0].fine_spread[MSPRING_TUNE_ENERGY] > 0);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------ everywhere, and in time */

static void scenes_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 4)};
    const mspring_tune_scene scene = short_scene();
    tunes_table first = {.count = 0};
    for (uint32_t i = 0; i <= level_count; i++) {
        mspring_network_def how = support_def(-9.8f, 1);
        how.simd_level = levels[i % level_count];
        how.worker_count = 1 + i % 3;
        tunes_watch w = {.tick = 1e-3 * (1 + i)};
        const mspring_tune_def def = def_of(&w, &scene, settings, COUNT_OF(settings));
        mspring_network *network = falling_lattice(&how);
        const tunes_table out = tunes_run(network, &def);
        mspring_network_destroy(network);
        first = i == 0 ? out : first;
        for (uint32_t r = 0; r < out.count; r++) {
            assert_memory_equal(&first.rows[r].scene_distance, &out.rows[r].scene_distance,
                                sizeof out.rows[r] - offsetof(mspring_tune_row, scene_distance));
        }
    }
}

static void the_budget_is_heeded(void **state) {
    (void)state;
    mspring_network *network = falling_lattice(NULL);
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, 20, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 4)};
    const mspring_tune_scene scene = short_scene();
    uint32_t few = 0;
    for (double budget = 0.001; budget < 4; budget *= 1.3) {
        tunes_watch w = {.tick = 0.001};
        mspring_tune_def def = def_of(&w, &scene, settings, COUNT_OF(settings));
        def.budget = budget;
        def.progress = tunes_tell;
        const tunes_table out = tunes_run(network, &def);
        assert_true(w.now <= budget + 0.005 && !w.went_back);
        for (uint32_t i = 0; i < out.count; i++) {
            const mspring_tune_row *row = &out.rows[i];
            assert_int_equal(tunes_has(row, MSPRING_TUNE_HAS_SCENE), row->scene_starts >= 4);
            assert_true(row->scene_starts >= 4 || (row->scene_starts == 0 && row->scene_distance == 0));
            few += row->scene_starts == 4;
            assert_int_equal(row->scene_starts, w.done > 0.999 ? 5 : row->scene_starts);
        }
    }
    assert_true(few > 0);
    mspring_network_destroy(network);
}

/// With everything else: other errors are measured as if there was no scene.
static void a_scene_leaves_the_rest_as_it_is(void **state) {
    (void)state;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, 3, 0)}; // unstable
    const mspring_tune_scene scene = short_scene();
    for (mspring_tune_measure measure = 0; measure <= MSPRING_TUNE_BY_SCENE; measure++) {
        tunes_watch w = {.tick = 1e-5};
        mspring_tune_def def = def_of(&w, &scene, settings, COUNT_OF(settings));
        def.flags = 0;
        def.measure = measure;
        const tunes_table with = tunes_run(network, &def);
        assert_true(
            tunes_has(&with.rows[0], MSPRING_TUNE_HAS_SCENE | MSPRING_TUNE_HAS_TRAJECTORY | MSPRING_TUNE_HAS_REST));
        assert_int_equal(with.rows[1].flags, MSPRING_TUNE_REJECTED);
        def.scene = NULL;
        def.measure = MSPRING_TUNE_BY_TRAJECTORY;
        const tunes_table without = tunes_run(network, &def);
        assert_memory_equal(&with.rows[0].trajectory_error, &without.rows[0].trajectory_error,
                            offsetof(mspring_tune_row, moving_cost) - offsetof(mspring_tune_row, trajectory_error));
    }
    mspring_network_destroy(network);
}

static uint32_t runs_prepared;

static mspring_result count_run(mspring_network *run, uint32_t start, void *user) {
    (void)run;
    (void)user;
    runs_prepared += 1 + start;
    return MSPRING_OK;
}

/// A setting that is rejected takes no more time, and none at all is left to be compared with a fine run.
static void who_is_rejected_is_out(void **state) {
    (void)state;
    mspring_network *network = falling_lattice(NULL);
    const mspring_settings setting = tunes_setting(MSPRING_SOLVER_EXPLICIT, 3, 0);
    mspring_tune_scene scene = short_scene();
    scene.prepare = count_run;
    tunes_watch w = {.tick = 1e-3};
    const mspring_tune_def def = def_of(&w, &scene, &setting, 1);
    runs_prepared = 0;
    const tunes_table out = tunes_run(network, &def);
    assert_true(tunes_has(&out.rows[0], MSPRING_TUNE_REJECTED));
    assert_false(tunes_has(&out.rows[0], MSPRING_TUNE_HAS_SCENE));
    assert_true(runs_prepared <= 2); // the first fine run, and the one that was rejected
    mspring_network_destroy(network);
}

/// Hooks that keep something for each worker, and work side by side.
static void sum_up(const mspring_hook_args *args, void *user) {
    (void)user;
    ++*(uint32_t *)args->storage;
}

static void hooks_have_their_storage(void **state) {
    (void)state;
    uint32_t storage[3][16] = {{0}};
    mspring_network_def how = support_def(-9.8f, 1);
    how.worker_count = 3;
    mspring_network *network = falling_lattice(&how);
    mspring_hook_def hook;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
    hook.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
    hook.fn = sum_up;
    hook.flags = MSPRING_HOOK_CONCURRENT;
    hook.storage = storage, hook.storage_stride = sizeof storage[0], hook.range_slots = 16;
    check_ok(mspring_network_add_hook(network, &hook, NULL));
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 4)};
    mspring_tune_scene scene = short_scene();
    scene.flags |= MSPRING_TUNE_SCENE_HOOKS;
    tunes_watch w = {.tick = 1e-3};
    const mspring_tune_def def = def_of(&w, &scene, settings, COUNT_OF(settings));
    const tunes_table out = tunes_run(network, &def);
    assert_true(tunes_has(&out.rows[0], MSPRING_TUNE_HAS_SCENE) && tunes_has(&out.rows[1], MSPRING_TUNE_HAS_SCENE));
    // Each substep of each run calls it at least once.
    assert_true(storage[0][0] + storage[1][0] + storage[2][0] >= 5 * 24 * (12 + out.rows[0].fine_substeps + 1));
    mspring_network_destroy(network);
}

static void judged_by_the_scene(void **state) {
    (void)state;
    const struct {
        double cost, distance, most;
        uint32_t expected;
    } rows[] = {{1, 5, 0, MSPRING_TUNE_PARETO},
                {2, 0.8, 0, MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED},
                {3, 0.9, 0, 0},
                {4, 0.1, 0, MSPRING_TUNE_PARETO}};
    mspringi_trial trials[COUNT_OF(rows)] = {{.time_count = 0}};
    mspringi_tuning tuning = {.trial_count = COUNT_OF(rows), .trials = trials};
    tuning.def.max_error = 1e-9; // of trajectories
    tuning.def.max_cost = 3.5;
    tuning.def.measure = MSPRING_TUNE_BY_SCENE;
    tuning.scene.max_distance = 1;
    for (uint32_t i = 0; i < COUNT_OF(rows); i++) {
        trials[i].row.flags = MSPRING_TUNE_HAS_COST | MSPRING_TUNE_HAS_SCENE;
        trials[i].row.scene_cost = rows[i].cost;
        trials[i].row.scene_distance = rows[i].distance;
    }
    mspringi_tune_rank(&tuning);
    for (uint32_t i = 0; i < COUNT_OF(rows); i++) {
        assert_int_equal(trials[i].row.flags & (MSPRING_TUNE_PARETO | MSPRING_TUNE_RECOMMENDED), rows[i].expected);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_switched_on_acts), cmocka_unit_test(rows_tell_what_runs_by_hand_give),
        cmocka_unit_test(starts_are_kicked),        cmocka_unit_test(scenes_are_the_same_everywhere),
        cmocka_unit_test(the_budget_is_heeded),     cmocka_unit_test(a_scene_leaves_the_rest_as_it_is),
        cmocka_unit_test(judged_by_the_scene),      cmocka_unit_test(who_is_rejected_is_out),
        cmocka_unit_test(hooks_have_their_storage),
    };
    return cmocka_run_group_tests_name("tune_scene", tests, NULL, NULL);
}
