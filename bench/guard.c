/// @file guard.c
/// What the guard costs: steps with it, in turn with steps that only look at bounds (MSPRING_GUARD_BOUNDS), at 0.85
/// of the border, where it watches every step, and at 0.4, where there is nothing to watch; of networks that
/// tremble where they are, and of others that fly, so that it has to look at all changes of velocity. And what a
/// step costs beyond its substeps: the copy of the state that it may have to go back to, and the look at bounds.
///
/// Some networks are slower than others that are alike for as long as they exist, by a few percent or by half, as
/// it happens. So there are several pairs of them, and it is the fastest samples of all that are compared.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "machine.h"
#include "modes.h"

#include <massspring/massspring.h>
enum { PAIRS = 9, TURNS = 15 };
#define TURN_SECONDS 1e-3

static const uint32_t substeps[] = {1, 8, 40};
enum { SUBSTEPS = sizeof substeps / sizeof *substeps };

static const bench_column columns[] = {
    {"scene", "scene", -12},
    {"substeps", "substeps", 8},
    {"level", "level", -6},
    {"us_per_step", "us/step", 8},
    {"beyond_substeps", "beyond substeps", 15},
    {"slow_watched", "slow, watched", 13},
    {"fast_watched", "fast, watched", 13},
    {"fast_unwatched", "fast, unwatched", 15},
};
enum { COLUMN_COUNT = sizeof columns / sizeof *columns };

/// A network and its step.
typedef struct walker {
    mspring_network *network;
    double dt;
} walker;

static bool walk(const walker *w, uint32_t steps, scene_error *error) {
    for (uint32_t i = 0; i < steps; i++) {
        if (mspring_network_step(w->network, w->dt) != MSPRING_OK) {
            snprintf(error->text, sizeof error->text, "%.400s", mspring_network_error(w->network));
            return false;
        }
    }
    return true;
}

/// What is to be measured.
typedef struct course {
    const scene *made;
    mspring_simd level;
    uint32_t substeps;
    double share; ///< of the border
    float speed;  ///< m/s, of all particles
} course;

// A square or bar that goes along, or stays, and trembles a little.
static bool start(const course *c, mspring_guard guard, walker *out, scene_error *error) {
    mspring_network_def def = mspring_network_def_default();
    def.simd_level = c->level;
    def.settings.guard = guard;
    def.settings.substeps = c->substeps;
    def.settings.gravity_y = 0;
    double border = 0;
    uint64_t seed = 1;
    bool ok = mspring_network_create(c->made->builder, &def, &out->network) == MSPRING_OK &&
              mspring_network_get_stable_dt(out->network, &border, NULL) == MSPRING_OK;
    for (mspring_id p = 0; ok && p < mspring_network_count(out->network, MSPRING_PARTICLES); p++) {
        seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const float x = c->speed + (float)(seed >> 40) * 1e-9f, y = 0;
        ok = mspring_network_set_velocities(out->network, NULL, p, 1, &x, &y, 1) == MSPRING_OK;
    }
    out->dt = c->share * border * c->substeps;
    if (!ok)
        snprintf(error->text, sizeof error->text, "%.200s%.200s", mspring_builder_error(c->made->builder),
                 mspring_network_error(out->network));
    return ok;
}

/// The least that a step takes, s.
typedef struct least {
    double without, with;
} least;

// Take that many steps, and keep the time of one if none was shorter, s.
static bool take_turn(const walker *w, uint32_t steps, double *least_seconds, scene_error *error) {
    const double begin = bench_seconds();
    const bool ok = walk(w, steps, error);
    *least_seconds = fmin(*least_seconds, (bench_seconds() - begin) / steps);
    return ok;
}

// Steps without and with the guard, in turn, each first in every other turn.
static bool compare_pair(const walker *without, const walker *with, least *out, scene_error *error) {
    double first = INFINITY;
    bool ok = take_turn(without, 1, &first, error) && take_turn(with, 1, &first, error) &&
              take_turn(without, 10, &first, error);
    const uint32_t steps = (uint32_t)fmax(1, TURN_SECONDS / first);
    for (int i = 0; i < TURNS && ok; i++) {
        const walker *const one = i % 2 ? with : without, *const other = i % 2 ? without : with;
        ok = take_turn(one, steps, i % 2 ? &out->with : &out->without, error) &&
             take_turn(other, steps, i % 2 ? &out->without : &out->with, error);
    }
    return ok;
}

// All pairs are there at the same time, so that each lies elsewhere.
static bool compare(const course *c, least *out, scene_error *error) {
    walker bounds[PAIRS] = {{NULL, 0}}, growth[PAIRS] = {{NULL, 0}};
    bool ok = true;
    *out = (least){INFINITY, INFINITY};
    for (int i = 0; i < PAIRS && ok; i++) {
        ok = start(c, MSPRING_GUARD_BOUNDS, &bounds[i], error) &&
             start(c, MSPRING_GUARD_GROWTH, &growth[i], error) && compare_pair(&bounds[i], &growth[i], out, error);
    }
    for (int i = 0; i < PAIRS; i++) {
        mspring_network_destroy(bounds[i].network);
        mspring_network_destroy(growth[i].network);
    }
    return ok;
}

static bench_cell cost(const least *found) {
    return bench_cell_of("%.1f %%", 100 * (found->with / found->without - 1));
}

static bool measure(uint32_t width, uint32_t height, mspring_simd level, const bench_options *options,
                    scene_error *error) {
    enum { SLOW, FAST, UNWATCHED, COURSES };
    static const double shares[COURSES] = {0.85, 0.85, 0.4};
    static const float speeds[COURSES] = {0, 30, 30};
    const scene_options plain = scene_options_default();
    least found[SUBSTEPS][COURSES];
    scene made;
    if (!scene_bar(width, height, &plain, &made, error))
        return false;
    bool ok = true;
    for (int i = 0; i < SUBSTEPS * COURSES && ok; i++) {
        const int kind = i % COURSES;
        const course c = {&made, level, substeps[i / COURSES], shares[kind], speeds[kind]};
        ok = compare(&c, &found[i / COURSES][kind], error);
    }
    scene_free(&made);
    // What one substep takes more than a step of n substeps says that a substep does.
    const int last = SUBSTEPS - 1;
    const double one = ok ? found[0][SLOW].without : 0, many = ok ? found[last][SLOW].without : 0;
    const double beyond = one - (many - one) / (substeps[last] - substeps[0]);
    for (int i = 0; i < SUBSTEPS && ok; i++) {
        const double step = found[i][SLOW].without;
        const bench_cell cells[COLUMN_COUNT] = {
            bench_cell_of("%u x %u", width, height),
            bench_cell_of("%u", substeps[i]),
            bench_cell_of("%s", mspring_simd_name(level)),
            bench_cell_of("%.2f", 1e6 * step),
            bench_cell_of("%.1f %%", 100 * beyond / step),
            cost(&found[i][SLOW]),
            cost(&found[i][FAST]),
            cost(&found[i][UNWATCHED]),
        };
        bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    }
    return ok;
}

bool bench_run_guard(const bench_options *options) {
    static const uint32_t sizes[][2] = {{80, 5}, {96, 96}, {544, 68}};
    mspring_simd levels[4];
    scene_error error;
    bool ok = true;
    const int count = bench_options_levels(options, levels, &error);
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    for (int level = 0; level < count; level++) {
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            const bool measured = measure(sizes[i][0], sizes[i][1], levels[level], options, &error);
            if (!measured)
                bench_complain("guard", &error);
            ok = ok && measured;
        }
    }
    return ok;
}
