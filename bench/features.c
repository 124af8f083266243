/// @file features.c
/// Pay for what the scene has: each feature against the plain scene, measured in turn.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include <math.h>
#include <stdio.h>

#include <massspring/massspring.h>

#include "copy.h"
#include "modes.h"

typedef struct variant {
    const char *name;
    bool undamped;    ///< springs without dampers
    bool precise;     ///< low words count in the lengths of springs
    uint32_t ropes;   ///< more of them
    bool absolute;    ///< the same springs in N/m and N s/m
    bool limits;      ///< each spring stiffens beyond a strain
    bool held_forces; ///< a force on every particle in every step
    bool snapshots;   ///< one of a frame before every step
    bool hooked;
    mspring_phase hook;
    uint32_t period;    ///< of the hook; 0: 1
    float yield_strain; ///< of all springs; 0: none yields
    float blow;         ///< m/s, that the middle of the scene is struck with at the start of each sample
    uint32_t areas;     ///< of each lattice cell; sweeps have one of them, others are forces
} variant;

static const variant variants[] = {
    {.name = "plain again"},
    {.name = "no damper", .undamped = true},
    {.name = "precise", .precise = true},
    {.name = "absolute stiffness", .absolute = true},
    {.name = "empty hook before the step", .hooked = true, .hook = MSPRING_PHASE_BEFORE_STEP},
    {.name = "empty hook before substeps", .hooked = true, .hook = MSPRING_PHASE_BEFORE_SUBSTEP},
    {.name = "empty hook after substeps", .hooked = true, .hook = MSPRING_PHASE_AFTER_SUBSTEP},
    {.name = "empty hook before every 8", .hooked = true, .hook = MSPRING_PHASE_BEFORE_SUBSTEP, .period = 8},
    {.name = "empty hook after every 8", .hooked = true, .hook = MSPRING_PHASE_AFTER_SUBSTEP, .period = 8},
    {.name = "springs that could yield", .yield_strain = 10},
    {.name = "struck, and yields", .yield_strain = 0.006f, .blow = 30},
    {.name = "every spring always flows", .yield_strain = 1e-9f},
    {.name = "strain limits", .limits = true},
    {.name = "areas of cells", .areas = 1},
    {.name = "areas of cells as forces", .areas = 2},
    {.name = "force on every particle", .held_forces = true},
    {.name = "snapshot of every step", .snapshots = true},
    {.name = "4 ropes", .ropes = 4},
    {.name = "40 ropes", .ropes = 40},
    {.name = "400 ropes", .ropes = 400},
};

static const char *const default_scenes[] = {"bar_544x68", "ship", NULL};

static const bench_column columns[] = {
    {"scene", "scene", -16},
    {"feature", "feature", -26},
    {"springs", "springs", 8},
    {"substeps", "substeps", 8},
    {"level", "level", -6},
    {"us_per_step_median", "us/step median", 14},
    {"ns_per_spring_substep_median", "ns/spring", 9},
    {"step_time_ratio_median", "step/plain", 10},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

static void empty_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

static bool create_absolute(const bench_network *plain, mspring_simd level, uint32_t workers, bench_network *out,
                            scene_error *error) {
    mspring_builder *builder = NULL;
    if (!bench_copy_absolute(plain, &builder, error)) {
        return false;
    }
    bool ok = bench_network_create(builder, level, workers, plain->substeps, out, error);
    mspring_builder_destroy(builder);
    return ok;
}

/// Add a limit to each spring, soft enough to need no more substeps.
static bool add_limits(mspring_builder *builder, scene_error *error) {
    const mspring_result result = mspring_builder_add_strain_limits(
        builder, NULL, 0, mspring_builder_count(builder, MSPRING_SPRINGS), 0.1f, 1e-3f, NULL);
    if (result != MSPRING_OK) {
        bench_library_error(error, "adding strain limits", result, mspring_builder_error(builder));
    }
    return result == MSPRING_OK;
}

/// Add an area to each cell, of a stiffness that is nothing to that of springs.
static bool add_areas(bench_network *out, scene_error *error) {
    mspring_area_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def);
    def.stiffness = 1; // N/m
    if (result == MSPRING_OK) {
        result = mspring_network_add_cell_areas(out->network, &def, NULL, NULL);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "adding areas", result, mspring_network_error(out->network));
    }
    return result == MSPRING_OK;
}

/// Strike an eighth of the scene's width, in its middle.
static void strike(bench_network *network, float speed) {
    double first = network->start_x[0], last = first;
    for (uint32_t i = 0; i < network->particle_count; i++) {
        first = fmin(first, network->start_x[i]);
        last = fmax(last, network->start_x[i]);
    }
    for (uint32_t i = 0; i < network->particle_count; i++) {
        const double away = (network->start_x[i] - 0.5 * (first + last)) / (0.125 * (last - first));
        if (network->start_vx[i] != 0.0f || network->start_vy[i] != 0.0f) { /* it is not pinned */
            network->start_vy[i] += speed * (float)exp(-away * away);
        }
    }
    network->straightens = true;
}

/// Make the network of a variant of the plain scene.
static bool create_variant(const variant *kind, const bench_scene *subject, const bench_options *options,
                           const bench_network *plain, mspring_simd level, bench_network *out, scene_error *error) {
    const uint32_t workers = options->workers;
    bool ok;
    if (kind->absolute) {
        ok = create_absolute(plain, level, workers, out, error);
    } else if (kind->undamped || kind->ropes > 0 || kind->limits) {
        bench_scene_settings settings = options->settings;
        settings.damping = kind->undamped ? 0.0f : settings.damping;
        settings.ropes += kind->ropes;
        bench_scene other;
        if (!bench_scene_make(&subject->source, &settings, &other, error)) {
            return false;
        }
        ok = (!kind->limits || add_limits(other.made.builder, error)) &&
             bench_network_create(other.made.builder, level, workers, plain->substeps, out, error);
        bench_scene_free(&other);
    } else {
        ok = bench_network_create_with(subject->made.builder, level, workers, plain->substeps,
                                       kind->precise ? MSPRING_NETWORK_PRECISE : 0, out, error);
    }
    if (!ok) {
        return false;
    }
    if (kind->held_forces && !bench_network_hold_forces(out, error)) {
        bench_network_free(out);
        return false;
    }
    if (kind->yield_strain > 0) {
        const mspring_result result = mspring_network_set(out->network, MSPRING_YIELD_STRAIN, NULL, 0,
                                                          out->spring_count, &kind->yield_strain, 0);
        if (result != MSPRING_OK) {
            bench_library_error(error, "letting springs yield", result, mspring_network_error(out->network));
            bench_network_free(out);
            return false;
        }
    }
    if (kind->blow > 0) {
        strike(out, kind->blow);
    }
    for (uint32_t i = 0; i < kind->areas; i++) {
        if (!add_areas(out, error)) {
            bench_network_free(out);
            return false;
        }
    }
    out->saves_frames = kind->snapshots;
    if (kind->hooked) {
        mspring_hook_def def;
        mspring_result result = mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def);
        def.phase = kind->hook;
        def.period = kind->period > 0 ? kind->period : 1;
        def.fn = empty_hook;
        if (result == MSPRING_OK) {
            result = mspring_network_add_hook(out->network, &def, NULL);
        }
        if (result != MSPRING_OK) {
            bench_library_error(error, "adding a hook", result, mspring_network_error(out->network));
            bench_network_free(out);
            return false;
        }
    }
    return true;
}

static void print_row(const bench_options *options, const bench_scene *subject, const char *feature,
                      const bench_network *network, double seconds, double ratio) {
    double springs = (double)network->spring_count * network->substeps;
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", subject->label),
        bench_cell_of("%s", feature),
        bench_cell_of("%u", network->spring_count),
        bench_cell_of("%u", network->substeps),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(network->network))),
        bench_cell_of("%.3f", 1e6 * seconds),
        bench_cell_of("%.4f", 1e9 * seconds / springs),
        bench_cell_of("%.3f", ratio),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
}

/// Measure one variant in turn with the plain scene, and print it; with the first one the plain scene as well.
static bool measure_variant(const variant *kind, const bench_scene *subject, const bench_options *options,
                            bench_network *plain, mspring_simd level, scene_error *error) {
    uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(plain->spring_count);
    bench_network other;
    if (!create_variant(kind, subject, options, plain, level, &other, error)) {
        return false;
    }
    bench_runner plain_runner = bench_network_runner(plain);
    bench_runner runner = bench_network_runner(&other);
    bench_turns turns;
    bool ok = bench_turns_measure(&plain_runner, &runner, repeat, &turns, error) &&
              bench_network_check(plain, error) && bench_network_check(&other, error);
    if (ok) {
        if (kind == variants) {
            print_row(options, subject, "plain", plain, turns.first_median, 1.0);
        }
        print_row(options, subject, kind->name, &other, turns.second_median, turns.ratio_median);
    }
    bench_network_free(&other);
    return ok;
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    bench_network plain;
    scene_error error;
    if (!bench_network_create(subject->made.builder, level, options->workers, substeps, &plain, &error)) {
        bench_complain(subject->label, &error);
        return false;
    }
    bench_runner runner = bench_network_runner(&plain);
    bool ok = runner.run(&plain, 1, &error); /* relative springs have their stiffness after a step */
    if (!ok) {
        bench_complain(subject->label, &error);
    }
    bool all = ok;
    for (size_t i = 0; ok && i < sizeof variants / sizeof *variants; i++) {
        if (!measure_variant(&variants[i], subject, options, &plain, level, &error)) {
            char about[160];
            snprintf(about, sizeof about, "%s, %s", subject->label, variants[i].name);
            bench_complain(about, &error);
            all = false;
        }
    }
    bench_network_free(&plain);
    return all;
}

bool bench_run_features(const bench_options *options) {
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}
