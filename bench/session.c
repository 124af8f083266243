/// @file session.c
/// What a game does to its network from step to step, and what that costs: each call next to a step, in turn.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "added.h"
#include "machine.h"
#include "modes.h"
#include "session.h"
#include "wreck.h"

/// Thresholds that no strain of the bench reaches: the pass looks at every spring, and nothing breaks.
#define OUT_OF_REACH 1e6f

/* --------------------------------------------------------------------------------------------------- measuring */

static const bench_column columns[] = {
    {"scene", "scene", -12},
    {"call", "call", -28},
    {"springs", "springs", 8},
    {"substeps", "substeps", 8},
    {"level", "level", -6},
    {"us_min", "us min", 8},
    {"us_median", "us median", 9},
    {"us_per_step_min", "us/step min", 11},
    {"share_of_step", "% of step", 9},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

static void print_row(const bench_options *options, const bench_scene *subject, const bench_network *network,
                      const char *name, double least, double median, double step) {
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", subject->label),
        bench_cell_of("%s", name),
        bench_cell_of("%u", network->spring_count),
        bench_cell_of("%u", network->substeps),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(network->network))),
        bench_cell_of("%.1f", 1e6 * least),
        bench_cell_of("%.1f", 1e6 * median),
        bench_cell_of("%.1f", 1e6 * step),
        bench_cell_of("%.2f", 100.0 * least / step),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
}

/// Time a call and a step after it, repeat times. The share is that of their shortest times: calls are too short
/// for a busy machine to disturb them as often as it does steps.
static bool measure_call(const session_call *call, session *with, const bench_options *options,
                         const bench_scene *subject, uint32_t repeat, double *times, scene_error *error) {
    bench_runner runner = bench_network_runner(with->step);
    double *steps = times, *seconds = times + repeat;
    if (!runner.reset(runner.self, error) || !runner.run(runner.self, 1, error)) {
        return false;
    }
    for (uint32_t i = 0; i < repeat; i++) {
        call->prepare(with);
        double start = bench_seconds();
        mspring_result result = call->call(with);
        seconds[i] = bench_seconds() - start;
        if (result != MSPRING_OK) {
            bench_library_error(error, call->name, result, mspring_network_error(with->step->network));
            return false;
        }
        start = bench_seconds();
        if (!runner.run(runner.self, 1, error)) {
            return false;
        }
        steps[i] = bench_seconds() - start;
    }
    const double median = bench_median(seconds, repeat); // sorts
    bench_median(steps, repeat);
    print_row(options, subject, with->step, call->name, seconds[0], median, steps[0]);
    return session_restore(with) == MSPRING_OK;
}

/// Make a network in which every spring is watched.
static bool create_watched(const bench_scene *subject, mspring_simd level, bool stress, session *with,
                           bench_network *out, scene_error *error) {
    if (!bench_network_create(subject->made.builder, level, 1, 1, out, error)) {
        return false;
    }
    for (uint32_t i = 0; i < out->spring_count; i++) {
        with->values[i] = OUT_OF_REACH;
    }
    mspring_result result = mspring_network_reserve_events(out->network, SESSION_BURST);
    if (result == MSPRING_OK) {
        result =
            mspring_network_set(out->network, MSPRING_BREAK_STRAIN, NULL, 0, out->spring_count, with->values, 1);
    }
    if (result == MSPRING_OK && stress) {
        result =
            mspring_network_set(out->network, MSPRING_WARN_STRAIN, NULL, 0, out->spring_count, with->values, 1);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "watching strain", result, mspring_network_error(out->network));
        bench_network_free(out);
    }
    return result == MSPRING_OK;
}

/// Time steps with a strain pass after them against steps without: both of one substep, as the pass would drown in
/// the noise of more. Its share is that of the step with all substeps, timed in turn with the one of one.
static bool measure_strain(session *with, const bench_options *options, const bench_scene *subject,
                           mspring_simd level, bool stress, uint32_t repeat, scene_error *error) {
    bench_network watched, plain;
    if (!create_watched(subject, level, stress, with, &watched, error)) {
        return false;
    }
    if (!bench_network_create(subject->made.builder, level, 1, 1, &plain, error)) {
        bench_network_free(&watched);
        return false;
    }
    bench_runner one = bench_network_runner(&plain), runner = bench_network_runner(&watched);
    bench_runner all = bench_network_runner(with->step);
    bench_turns turns, whole;
    const bool ok = bench_turns_measure(&one, &runner, repeat, &turns, error) &&
                    bench_turns_measure(&one, &all, repeat, &whole, error);
    if (ok) {
        print_row(options, subject, with->step,
                  stress ? "strain pass, break and stress" : "strain pass, break only",
                  turns.second_min - turns.first_min, turns.second_median - turns.first_median, whole.second_min);
    }
    bench_network_free(&plain);
    bench_network_free(&watched);
    return ok;
}

/// Time steps of a network that sleeps in turn with those of one that does not.
static bool measure_sleep(session *with, const bench_options *options, const bench_scene *subject,
                          mspring_simd level, bool viewed, uint32_t repeat, scene_error *error) {
    bench_network asleep = {.substeps = with->step->substeps};
    mspring_network_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    def.simd_level = level;
    def.settings.substeps = with->step->substeps;
    def.settings.sleep_speed = OUT_OF_REACH; // at once
    def.settings.sleep_time = 0;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    if (result == MSPRING_OK) {
        result = mspring_network_create(subject->made.builder, &def, &asleep.network);
    }
    mspring_view view = mspring_view_default();
    if (result == MSPRING_OK && viewed) {
        result = mspring_network_get_view(asleep.network, &view);
    }
    if (result == MSPRING_OK) {
        result = mspring_network_step(asleep.network, BENCH_DT);
    }
    mspring_step_info info = mspring_step_info_default();
    bool ok = result == MSPRING_OK && mspring_network_get_step_info(asleep.network, &info) == MSPRING_OK &&
              info.is_asleep;
    if (!ok) {
        bench_library_error(error, "falling asleep", result, mspring_network_error(asleep.network));
    }
    const uint32_t turns = 8 * repeat; // they are short
    double *seconds = bench_allocate(turns, sizeof *seconds, error);
    for (uint32_t i = 0; ok && seconds != NULL && i < turns; i++) {
        const double start = bench_seconds();
        ok = mspring_network_step(asleep.network, BENCH_DT) == MSPRING_OK;
        seconds[i] = bench_seconds() - start;
    }
    bench_runner whole = bench_network_runner(with->step);
    bench_turns step;
    ok = ok && seconds != NULL && bench_turns_measure(&whole, &whole, 3, &step, error);
    if (ok) {
        const double median = bench_median(seconds, turns);
        print_row(options, subject, with->step, viewed ? "a step asleep, with a view" : "a step asleep", seconds[0],
                  median, step.first_min);
    }
    free(seconds);
    bench_network_free(&asleep);
    return ok;
}

/// Take steps of two networks in turn: times of the first, and behind them those of the second, each sorted.
static bool measure_steps(const bench_runner *first, const bench_runner *second, uint32_t repeat, double *times,
                          scene_error *error) {
    if (!first->reset(first->self, error) || !second->reset(second->self, error)) {
        return false;
    }
    for (uint32_t i = 0; i < 2 * repeat; i++) {
        const bench_runner *runner = i % 2 == 0 ? first : second;
        const double start = bench_thread_seconds();
        if (!runner->run(runner->self, 1, error)) {
            return false;
        }
        times[i % 2 * repeat + i / 2] = bench_thread_seconds() - start;
    }
    bench_median(times, repeat); // sorts
    bench_median(times + repeat, repeat);
    return true;
}

/// Change a network's layout by a job on this thread, a function a frame, and say how long all of it took and its
/// longest frame: a function, the first with the begin, the last with the finish.
static bool change_layout(mspring_network *network, mspring_layout layout, double *all, double *longest,
                          scene_error *error) {
    mspring_job *job = NULL;
    uint32_t left = 1;
    double start = bench_thread_seconds();
    mspring_result result = mspring_job_begin(network, layout, &job);
    *all = *longest = 0;
    while (result == MSPRING_OK) {
        const bool is_last = left == 0;
        result = is_last ? mspring_job_finish(network, job) : mspring_job_run(job, 1, &left);
        const double now = bench_thread_seconds(), seconds = now - start;
        start = now;
        *all += seconds;
        *longest = seconds > *longest ? seconds : *longest;
        if (is_last) {
            break;
        }
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "compacting", result, mspring_network_error(network));
    }
    mspring_job_destroy(job);
    return result == MSPRING_OK;
}

/// Compactions that are timed: the first of a process is slower, as it is given its memory by the system.
#define COMPACTIONS 5u

/// Compact a network several times.
/// @param all      [COMPACTIONS] how long each took, sorted
/// @param longest  [COMPACTIONS] and its longest frame, likewise
/// @param back     likewise of the way back; may be NULL
static bool compact_again(mspring_network *network, double *all, double *longest, double *back,
                          scene_error *error) {
    for (uint32_t i = 0; i < COMPACTIONS; i++) {
        double whole[2];
        if (!change_layout(network, MSPRING_LAYOUT_WHOLE, &whole[0], &whole[1], error) ||
            !change_layout(network, MSPRING_LAYOUT_COMPACT, &all[i], &longest[i], error)) {
            return false;
        }
        if (back) {
            back[i] = whole[1];
        }
    }
    bench_median(all, COMPACTIONS); // sorts
    bench_median(longest, COMPACTIONS);
    if (back) {
        bench_median(back, COMPACTIONS);
    }
    return true;
}

static void print_compaction(session *with, const bench_options *options, const bench_scene *subject,
                             const double *all, const double *longest, double step) {
    const uint32_t middle = COMPACTIONS / 2;
    print_row(options, subject, with->step, "  to compact it", all[0], all[middle], step);
    print_row(options, subject, with->step, "  the longest frame of that", longest[0], longest[middle], step);
}

/// Time the compaction of a wreck and the way back with another solver.
static bool compact_solver(session *with, const bench_options *options, const bench_scene *subject,
                           const bench_network *wreck, mspring_solver solver, double step, scene_error *error) {
    const char *const name = solver == MSPRING_SOLVER_DIRECT ? "direct" : "implicit";
    double all[COMPACTIONS], longest[COMPACTIONS], back[COMPACTIONS];
    char text[64];
    mspring_settings settings = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(wreck->network, &settings);
    settings.solver = solver;
    settings.substeps = MSPRING_SUBSTEPS_AUTO;
    if (result == MSPRING_OK) {
        result = mspring_network_set_settings(wreck->network, &settings);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "changing the solver", result, mspring_network_error(wreck->network));
        return false;
    }
    if (!compact_again(wreck->network, all, longest, back, error)) {
        return false;
    }
    snprintf(text, sizeof text, "  with the %s solver", name);
    print_row(options, subject, with->step, text, all[0], all[COMPACTIONS / 2], step);
    print_row(options, subject, with->step, "  the longest frame of that", longest[0], longest[COMPACTIONS / 2],
              step);
    print_row(options, subject, with->step, "  and of the way back", back[0], back[COMPACTIONS / 2], step);
    return true;
}

/// Time steps of a wreck in turn with those of the whole: as it is after the breaks, and compact; and the
/// compaction.
static bool measure_wreck(session *with, const bench_options *options, const bench_scene *subject,
                          mspring_simd level, bench_wreck kind, uint32_t repeat, double *times,
                          scene_error *error) {
    char text[64];
    bench_network wreck;
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, &wreck, error)) {
        return false;
    }
    bench_runner whole = bench_network_runner(with->step), broken = bench_network_runner(&wreck);
    double seconds[COMPACTIONS], pieces[COMPACTIONS], *const of_wreck = times + repeat;
    bool ok = bench_wreck_make(&wreck, kind, error) && measure_steps(&whole, &broken, repeat, times, error);
    if (ok) {
        snprintf(text, sizeof text, "%s", bench_wreck_name(kind));
        print_row(options, subject, with->step, text, of_wreck[0], of_wreck[repeat / 2], times[0]);
    }
    ok = ok && compact_again(wreck.network, seconds, pieces, NULL, error) &&
         measure_steps(&whole, &broken, repeat, times, error);
    if (ok) {
        snprintf(text, sizeof text, "%s, compact", bench_wreck_name(kind));
        print_row(options, subject, with->step, text, of_wreck[0], of_wreck[repeat / 2], times[0]);
        print_compaction(with, options, subject, seconds, pieces, times[0]);
        ok = compact_solver(with, options, subject, &wreck, MSPRING_SOLVER_IMPLICIT, times[0], error) &&
             compact_solver(with, options, subject, &wreck, MSPRING_SOLVER_DIRECT, times[0], error);
    }
    bench_network_free(&wreck);
    return ok;
}

/// Parts that a network is cut into, of which one stays awake.
#define PARTS 10

/// Make a network of parts; one that may sleep has one part awake.
static bool make_parts(session *with, const bench_scene *subject, mspring_simd level, bool sleeps, bool implicit,
                       bool is_compact, bench_network *parts, scene_error *error) {
    mspring_network_def def;
    mspring_id first;
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, parts, error)) {
        return false;
    }
    mspring_network_destroy(parts->network);
    parts->network = NULL;
    const float pinned = 0.0f, none = 0.0f, slowly = 1e-4f;
    mspring_result result = mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    def.simd_level = level;
    def.settings.sleep_speed = sleeps ? OUT_OF_REACH : 0.0f; // what is awake is so by a pin that moves
    def.settings.sleep_time = 0;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    def.settings.solver = implicit ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_EXPLICIT;
    def.settings.substeps = implicit ? 1 : with->step->substeps;
    if (result == MSPRING_OK) {
        result = mspring_network_create(subject->made.builder, &def, &parts->network);
    }
    if (result == MSPRING_OK && !bench_wreck_slice(parts, PARTS, &first, error)) {
        return false;
    }
    if (result == MSPRING_OK && is_compact) {
        result = mspring_network_compact(parts->network);
    }
    if (result == MSPRING_OK) {
        result = mspring_network_set(parts->network, MSPRING_INVERSE_MASS_SCALE, NULL, first, 1, &pinned, 1);
    }
    if (result == MSPRING_OK) {
        result = mspring_network_set_velocities(parts->network, NULL, first, 1, &none, &slowly, 1);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "making parts", result, mspring_network_error(parts->network));
    }
    return result == MSPRING_OK;
}

/// Time steps of a network in ten parts of which nine sleep in turn with those of one of which none does.
static bool measure_parts(session *with, const bench_options *options, const bench_scene *subject,
                          mspring_simd level, bool implicit, bool is_compact, uint32_t repeat, double *times,
                          scene_error *error) {
    bench_network all[2] = {{0}, {0}};
    bool ok = make_parts(with, subject, level, false, implicit, is_compact, &all[0], error) &&
              make_parts(with, subject, level, true, implicit, is_compact, &all[1], error);
    for (uint32_t i = 0; ok && i < 2 * repeat + 2; i++) {
        const double start = bench_thread_seconds();
        mspring_result result = mspring_network_step(all[i % 2].network, BENCH_DT);
        const double seconds = bench_thread_seconds() - start;
        if (result != MSPRING_OK) {
            bench_library_error(error, "stepping parts", result, mspring_network_error(all[i % 2].network));
            ok = false;
        } else if (i >= 2) { // in the first all fall asleep that do
            times[i % 2 * repeat + (i - 2) / 2] = seconds;
        }
    }
    if (ok) {
        char text[64];
        bench_median(times, repeat);
        const double median = bench_median(times + repeat, repeat);
        snprintf(text, sizeof text, "nine tenths asleep%s%s", implicit ? ", implicit" : "",
                 is_compact ? "" : ", not compact");
        print_row(options, subject, with->step, text, times[repeat], median, times[0]);
    }
    bench_network_free(&all[0]);
    bench_network_free(&all[1]);
    return ok;
}

/// Add springs, and take them out again but for the last time: how long adding takes.
static bool add(mspring_network *network, const mspring_spring_def *springs, mspring_id *ids, uint32_t count,
                uint32_t repeat, double *seconds, scene_error *error) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < repeat; i++) {
        const double start = bench_thread_seconds();
        result = mspring_network_add_springs(network, springs, count, ids);
        seconds[i] = bench_thread_seconds() - start;
        if (result == MSPRING_OK && i + 1 < repeat) {
            result = mspring_network_remove_springs(network, ids, 0, count);
        }
        if (result == MSPRING_OK) {
            result = mspring_network_reuse_ids(network);
        }
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "adding springs", result, mspring_network_error(network));
    }
    return result == MSPRING_OK;
}

/// Time adding springs: the call, the compaction that takes them into the plan, and steps in turn with those of the
/// network without them, before and after that.
static bool measure_added(session *with, const bench_options *options, const bench_scene *subject,
                          mspring_simd level, uint32_t count, uint32_t repeat, double *times, scene_error *error) {
    enum { CALLS = 7 };
    double made[CALLS], all[COMPACTIONS], longest[COMPACTIONS], *const of_added = times + repeat;
    char text[64];
    bench_network added;
    mspring_spring_def *springs = bench_allocate(count, sizeof *springs, error);
    mspring_id *ids = bench_allocate(count, sizeof *ids, error);
    bool ok = springs != NULL && ids != NULL &&
              bench_added_create(subject->made.builder, level, 1, with->step->substeps, 0, count, &added, error);
    if (!ok) {
        free(springs);
        free(ids);
        return false;
    }
    bench_runner before = bench_network_runner(with->step), after = bench_network_runner(&added);
    ok = bench_added_list(&added, count, springs, error) && after.run(after.self, 1, error) &&
         add(added.network, springs, ids, count, CALLS, made, error) &&
         measure_steps(&before, &after, repeat, times, error);
    if (ok) {
        const double median = bench_median(made, CALLS); // sorts
        snprintf(text, sizeof text, "add %u springs", count);
        print_row(options, subject, with->step, text, made[0], median, times[0]);
        print_row(options, subject, with->step, "  a step with these", of_added[0], of_added[repeat / 2], times[0]);
    }
    ok = ok && compact_again(added.network, all, longest, NULL, error) &&
         measure_steps(&before, &after, repeat, times, error);
    if (ok) {
        print_row(options, subject, with->step, "  a step with these, compact", of_added[0], of_added[repeat / 2],
                  times[0]);
        print_compaction(with, options, subject, all, longest, times[0]);
    }
    bench_network_free(&added);
    free(springs);
    free(ids);
    return ok;
}

/// Bubbles and debris at once.
#define LOOSE 16384u

/// Where loose particles are.
typedef enum ground { WITHOUT_FLOOR, ALL_ON_FLOOR, ONE_ON_FLOOR, GROUNDS } ground;

/// Time steps with many loose particles more in turn with steps without.
static bool measure_loose(const session *with, const bench_options *options, const bench_scene *subject,
                          mspring_simd level, ground on, uint32_t repeat, double *times, scene_error *error) {
    static const char *const names[GROUNDS] = {"  in a step", "  all of them on a floor",
                                               "  high above one more on it"};
    const bool floored = on != WITHOUT_FLOOR;
    double seconds = 0;
    mspring_body all = mspring_body_default();
    bench_network loose, plain;
    mspring_floor_def def;
    if (!bench_added_create(subject->made.builder, level, 1, with->step->substeps, LOOSE + 1, 0, &loose, error)) {
        return false;
    }
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, &plain, error)) {
        bench_network_free(&loose);
        return false;
    }
    mspring_result result = mspring_network_get_body(plain.network, NULL, 0, MSPRING_ALL, &all);
    const double plane[4] = {0, all.min_y - 100.0, 0, 1};
    if (result == MSPRING_OK) {
        result = mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def);
    }
    def.planes = plane;
    def.plane_count = 1;
    def.friction = 0.5f;
    if (result == MSPRING_OK && floored) {
        result = mspring_network_set_floor(loose.network, &def);
    }
    if (result == MSPRING_OK && floored) {
        result = mspring_network_set_floor(plain.network, &def);
    }
    bool ok = result == MSPRING_OK;
    if (!ok) {
        bench_library_error(error, "a floor below loose particles", result, mspring_network_error(loose.network));
    }
    bench_runner first = bench_network_runner(&plain), second = bench_network_runner(&loose);
    ok = ok && (on != ONE_ON_FLOOR || bench_added_loose(&loose, 1, plane[1], &seconds, error)) &&
         bench_added_loose(&loose, LOOSE, plane[1] + (on == ONE_ON_FLOOR ? 1000.0 : 0.0), &seconds, error) &&
         measure_steps(&first, &second, repeat, times, error);
    if (ok && !floored) {
        print_row(options, subject, with->step, "add 16,384 loose particles", seconds, seconds, times[0]);
    }
    if (ok) {
        print_row(options, subject, with->step, names[on], times[repeat] - times[0],
                  times[repeat + repeat / 2] - times[repeat / 2], times[0]);
    }
    bench_network_free(&plain);
    bench_network_free(&loose);
    return ok;
}

/// Time steps with a floor against steps without, the same network falling in both.
/// @param drop  m from the lowest particle down to the floor
static bool measure_floor(session *with, const bench_options *options, const bench_scene *subject,
                          mspring_simd level, const char *name, double drop, uint32_t repeat, scene_error *error) {
    bench_network floored, plain;
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, &floored, error)) {
        return false;
    }
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, &plain, error)) {
        bench_network_free(&floored);
        return false;
    }
    mspring_body all = mspring_body_default();
    mspring_floor_def def;
    mspring_result result = mspring_network_get_body(plain.network, NULL, 0, MSPRING_ALL, &all);
    const double plane[4] = {0, all.min_y - drop, 0, 1};
    if (result == MSPRING_OK) {
        result = mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def);
    }
    def.planes = plane;
    def.plane_count = 1;
    def.friction = 0.5f;
    if (result == MSPRING_OK) {
        result = mspring_network_set_floor(floored.network, &def);
    }
    bool ok = result == MSPRING_OK;
    if (!ok) {
        bench_library_error(error, "a floor", result, mspring_network_error(floored.network));
    }
    bench_runner first = bench_network_runner(&plain), second = bench_network_runner(&floored);
    bench_turns turns;
    ok = ok && bench_turns_measure(&first, &second, repeat, &turns, error);
    if (ok) {
        print_row(options, subject, with->step, name, turns.second_min - turns.first_min,
                  turns.second_median - turns.first_median, turns.first_min);
    }
    bench_network_free(&plain);
    bench_network_free(&floored);
    return ok;
}

static void empty_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// Push up what is below a sea floor of the host.
static void sea_floor(const mspring_hook_args *args, void *user) {
    const double *height = user;
    const float local = (float)(*height - args->origin_y);
    for (uint32_t i = args->first_slot; i < args->first_slot + args->slot_count; i++) {
        const bool is_below = args->y[i] < local;
        args->vy[i] = is_below && args->vy[i] < 0 ? 0 : args->vy[i];
    }
}

/// Time steps with a hook in every substep against steps without. One that is empty: what one substep's call costs,
/// with which substeps are swept one by one. A sea floor 1 km below, with a reach or called for all: what a step
/// costs.
static bool measure_hook(session *with, const bench_options *options, const bench_scene *subject,
                         mspring_simd level, bool is_empty, uint32_t flags, uint32_t repeat, scene_error *error) {
    mspring_body all = mspring_body_default();
    bench_network hooked, plain;
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, &hooked, error)) {
        return false;
    }
    if (!bench_network_create(subject->made.builder, level, 1, with->step->substeps, &plain, error)) {
        bench_network_free(&hooked);
        return false;
    }
    mspring_hook_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def);
    def.phase = MSPRING_PHASE_AFTER_SUBSTEP;
    def.fn = is_empty ? empty_hook : sea_floor;
    if (result == MSPRING_OK) {
        result = mspring_network_get_body(plain.network, NULL, 0, MSPRING_ALL, &all);
    }
    if (result == MSPRING_OK) {
        def.flags = flags;
        def.below_y = all.min_y - 1000.0;
        def.user = &def.below_y;
        result = mspring_network_add_hook(hooked.network, &def, NULL);
    }
    bool ok = result == MSPRING_OK;
    if (!ok) {
        bench_library_error(error, "adding a hook", result, mspring_network_error(hooked.network));
    }
    bench_runner first = bench_network_runner(&plain), second = bench_network_runner(&hooked);
    bench_turns turns;
    ok = ok && bench_turns_measure(&first, &second, repeat, &turns, error);
    if (ok) {
        const double substeps = is_empty ? with->step->substeps : 1.0;
        const char *name = is_empty ? "an empty hook, one substep"
                           : flags  ? "  the same, with a reach"
                                    : "a hook 1 km below";
        print_row(options, subject, with->step, name, (turns.second_min - turns.first_min) / substeps,
                  (turns.second_median - turns.first_median) / substeps, turns.first_min);
    }
    bench_network_free(&plain);
    bench_network_free(&hooked);
    return ok;
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(springs);
    bench_network network;
    session with = {0};
    scene_error error;
    if (!bench_network_create(subject->made.builder, level, 1, substeps, &network, &error)) {
        bench_complain(subject->label, &error);
        return false;
    }
    double *times = bench_allocate(2 * (size_t)repeat, sizeof *times, &error);
    bool ok = session_create(&network, &with, &error) && times != NULL;
    // Before the calls: a network that has been edited is not the plain one any more.
    for (int stress = 0; ok && stress < 2; stress++) {
        ok = measure_strain(&with, options, subject, level, stress == 1, repeat, &error);
    }
    ok = ok && measure_floor(&with, options, subject, level, "floor, out of reach", 1e7, repeat, &error);
    ok = ok && measure_floor(&with, options, subject, level, "floor, lowest rows on it", -0.5, repeat, &error);
    ok = ok && measure_hook(&with, options, subject, level, true, 0, repeat, &error);
    ok = ok && measure_hook(&with, options, subject, level, false, 0, repeat, &error);
    ok = ok && measure_hook(&with, options, subject, level, false, MSPRING_HOOK_BELOW, repeat, &error);
    for (const session_call *call = session_calls; ok && call->name != NULL; call++) {
        ok = measure_call(call, &with, options, subject, repeat, times, &error);
    }
    for (int viewed = 0; ok && viewed < 2; viewed++) {
        ok = measure_sleep(&with, options, subject, level, viewed == 1, repeat, &error);
    }
    for (int way = 0; ok && way < 4; way++) {
        ok = measure_parts(&with, options, subject, level, way / 2 == 1, way % 2 == 1, repeat, times, &error);
    }
    for (bench_wreck kind = 0; ok && kind < BENCH_WRECKS; kind++) {
        ok = measure_wreck(&with, options, subject, level, kind, repeat, times, &error);
    }
    for (ground on = WITHOUT_FLOOR; ok && on < GROUNDS; on++) {
        ok = measure_loose(&with, options, subject, level, on, repeat, times, &error);
    }
    for (uint32_t count = 100; ok && count <= springs / 10; count *= 10) {
        ok = measure_added(&with, options, subject, level, count, repeat, times, &error);
    }
    if (!ok) {
        bench_complain(subject->label, &error);
    }
    free(times);
    session_free(&with);
    bench_network_free(&network);
    return ok;
}

bool bench_run_session(const bench_options *options) {
    static const char *const default_scenes[] = {"ship", NULL};
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}
