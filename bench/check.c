/// @file check.c
/// The naive step's correctness: it and the library must arrive at the same positions.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

#include "modes.h"

/// 100 substeps in all, ten times as long as those of a game: gravity has time to move things by most of a spacing.
#define CHECK_SUBSTEPS 4u
#define CHECK_STEPS 25u

/// Starting velocities are so many times those of the other runs (5 m/s at most) and velocities decay so fast
/// (1/s), that one per cent of error in any term shows.
#define CHECK_SPEED_FACTOR 100.0f
#define CHECK_GLOBAL_DAMPING 2.0f

/// Largest difference allowed, m: a thousandth of the spacing. Both are single precision and sum the forces of a
/// particle in another order; each substep may bring about a unit in the last place, of coordinates to 1000 m.
#define CHECK_TOLERANCE 1e-3
/// A scene must move at least so far, m, for the comparison to say anything.
#define CHECK_LEAST_MOVE 0.1

static const bench_column columns[] = {
    {"scene", "scene", -22},
    {"level", "level", -6},
    {"substeps", "substeps", 8},
    {"max_moved_m", "moved m", 10},
    {"max_difference_m", "difference m", 12},
    {"result", "result", -6},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

/// Run both and find how far a particle has moved at most, and how far the two are apart at most.
static bool compare(bench_network *network, bench_baseline *baseline, double *moved, double *difference,
                    scene_error *error) {
    bench_runner ours = bench_network_runner(network);
    bench_runner naive = bench_baseline_runner(baseline);
    if (!ours.reset(ours.self, error) || !naive.reset(naive.self, error) ||
        !ours.run(ours.self, CHECK_STEPS, error) || !naive.run(naive.self, CHECK_STEPS, error) ||
        !bench_network_check(network, error) || !bench_baseline_check(baseline, error)) {
        return false;
    }
    uint32_t count = network->particle_count;
    double *x = bench_allocate(count, sizeof *x, error);
    double *y = bench_allocate(count, sizeof *y, error);
    bool ok = x != NULL && y != NULL;
    if (ok) {
        mspring_result result = mspring_network_get_positions(network->network, NULL, 0, count, x, y, 1);
        ok = result == MSPRING_OK;
        if (!ok) {
            bench_library_error(error, "reading positions", result, "");
        }
    }
    double furthest = 0.0;
    double worst = 0.0;
    for (uint32_t i = 0; ok && i < count; i++) {
        const uint32_t place = baseline->place_of != NULL ? baseline->place_of[i] : i;
        const naive_particle *p = &baseline->network.particles[place];
        furthest = fmax(furthest, hypot(x[i] - network->start_x[i], y[i] - network->start_y[i]));
        worst = fmax(worst, hypot(x[i] - (p->x + baseline->origin_x), y[i] - (p->y + baseline->origin_y)));
    }
    free(x);
    free(y);
    *moved = furthest;
    *difference = worst;
    return ok;
}

/// Make both networks, with the state and settings that show errors best.
static bool create(const bench_scene *subject, const bench_options *options, mspring_simd level,
                   bench_network *network, bench_baseline *baseline, scene_error *error) {
    if (!bench_network_create(subject->made.builder, level, 1, CHECK_SUBSTEPS, network, error)) {
        return false;
    }
    for (uint32_t i = 0; i < network->particle_count; i++) {
        network->start_vx[i] *= CHECK_SPEED_FACTOR;
        network->start_vy[i] *= CHECK_SPEED_FACTOR;
    }
    mspring_settings settings = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(network->network, &settings);
    settings.global_damping = CHECK_GLOBAL_DAMPING;
    if (result == MSPRING_OK) {
        result = mspring_network_set_settings(network->network, &settings);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "setting global damping", result, mspring_network_error(network->network));
    }
    if (result != MSPRING_OK || !bench_baseline_create(network, baseline, error)) {
        bench_network_free(network);
        return false;
    }
    baseline->network.global_damping = CHECK_GLOBAL_DAMPING;
    if (options->sorted && !bench_baseline_sort(baseline, error)) {
        bench_baseline_free(baseline);
        bench_network_free(network);
        return false;
    }
    return true;
}

static bool check_level(const bench_scene *subject, const bench_options *options, mspring_simd level,
                        scene_error *error) {
    bench_network network;
    bench_baseline baseline;
    if (!create(subject, options, level, &network, &baseline, error)) {
        return false;
    }
    double moved = 0.0;
    double difference = 0.0;
    bool ok = compare(&network, &baseline, &moved, &difference, error);
    if (ok) {
        bool equal = difference < CHECK_TOLERANCE && moved > CHECK_LEAST_MOVE;
        const bench_cell cells[COLUMN_COUNT] = {
            bench_cell_of("%s", subject->label),
            bench_cell_of("%s", mspring_simd_name(bench_level_of(network.network))),
            bench_cell_of("%u", CHECK_SUBSTEPS * CHECK_STEPS),
            bench_cell_of("%.3g", moved),
            bench_cell_of("%.3g", difference),
            bench_cell_of("%s", equal ? "ok" : "FAILED"),
        };
        bench_table_row(options->format, columns, COLUMN_COUNT, cells);
        if (!equal) {
            snprintf(error->text, sizeof error->text,
                     "after %u substeps the library and the naive step differ by %g m (allowed: %g m), having "
                     "moved %g m (wanted: at least %g m)",
                     CHECK_SUBSTEPS * CHECK_STEPS, difference, CHECK_TOLERANCE, moved, CHECK_LEAST_MOVE);
            ok = false;
        }
    }
    bench_baseline_free(&baseline);
    bench_network_free(&network);
    return ok;
}

static bool visit(const bench_scene *subject, const bench_options *options, void *user) {
    (void)user;
    bench_options all = *options;
    all.all_levels = options->level == MSPRING_SIMD_AUTO;
    mspring_simd levels[4];
    scene_error error;
    int count = bench_options_levels(&all, levels, &error);
    bool ok = true;
    for (int i = 0; i < count; i++) {
        if (!check_level(subject, options, levels[i], &error)) {
            bench_complain(subject->label, &error);
            ok = false;
        }
    }
    return ok;
}

bool bench_run_check(const bench_options *options) {
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_scene(options, bench_catalogue_checked(), visit, NULL);
}
