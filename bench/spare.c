/// @file spare.c
/// What a floor, spare particles and a hook that does nothing cost a step: each in turn with the same network
/// without.
///
/// Both networks of a row take the same number of steps, each in a function of its own. So under callgrind the
/// inclusive counts of step_plain() and step_other() tell the ratio of instructions:
///
///     valgrind --tool=callgrind --callgrind-out-file=out build/bench/massspring-bench --spare --family on_floor
///         --repeat 1 --level avx2
///     callgrind_annotate --inclusive=yes out | grep step_
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "machine.h"
#include "modes.h"
#include "turns.h"

#if defined(_MSC_VER)
#define BENCH_NOINLINE __declspec(noinline)
#else
#define BENCH_NOINLINE __attribute__((noinline))
#endif

#define SPARE 20000u
#define DT (1.0 / 64)

typedef enum floor_kind { NO_FLOOR, AT_ITS_FEET, FAR_BELOW } floor_kind;

/// A network, and what it has more in the second of a row's two.
typedef struct row {
    const char *name;
    uint32_t width, height, substeps, steps;
    mspring_solver solver;
    bool has_hook;
    floor_kind floor;      ///< of both
    floor_kind more_floor; ///< of the second, if there is one
    uint32_t more_spare;   ///< of the second
} row;

static const row rows[] = {
    {.name = "on_floor", .width = 6, .height = 6, .substeps = 40, .steps = 200, .more_floor = AT_ITS_FEET},
    {.name = "floor_far", .width = 6, .height = 6, .substeps = 40, .steps = 200, .more_floor = FAR_BELOW},
    {.name = "spare", .width = 72, .height = 70, .substeps = 40, .steps = 20, .more_spare = SPARE},
    {.name = "spare_hook",
     .width = 72,
     .height = 70,
     .substeps = 40,
     .steps = 20,
     .has_hook = true,
     .more_spare = SPARE},
    {.name = "spare_floor",
     .width = 72,
     .height = 70,
     .substeps = 40,
     .steps = 20,
     .floor = FAR_BELOW,
     .more_spare = SPARE},
    {.name = "spare_implicit",
     .width = 72,
     .height = 70,
     .substeps = 1,
     .steps = 20,
     .solver = MSPRING_SOLVER_IMPLICIT,
     .more_spare = SPARE},
};

static const bench_column columns[] = {
    {"row", "row", -14},          {"particles", "particles", 9},    {"substeps", "substeps", 8},
    {"level", "level", -6},       {"us_without", "us without", 10}, {"us_with", "us with", 10},
    {"ratio_median", "ratio", 7},
};
enum { COLUMN_COUNT = sizeof columns / sizeof *columns };

static void MSPRING_CALL empty_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

static mspring_result lay_floor(mspring_network *network, floor_kind kind) {
    const double plane[] = {0, kind == FAR_BELOW ? -1000 : 0, 0, 1};
    mspring_floor_def floor;
    mspring_result result = mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor);
    floor.planes = plane;
    floor.plane_count = 1;
    return kind == NO_FLOOR || result != MSPRING_OK ? result : mspring_network_set_floor(network, &floor);
}

static mspring_result describe(const row *r, mspring_builder *builder) {
    enum { MOST_CELLS = 72 * 70 };
    static const uint16_t cells[MOST_CELLS];
    mspring_material material = mspring_material_default();
    mspring_lattice_def lattice = mspring_lattice_def_default();
    material.spring_flags = MSPRING_SPRING_RELATIVE;
    material.stiffness = 0.5f;
    material.damping = 0.05f;
    lattice.width = r->width;
    lattice.height = r->height;
    lattice.cells = cells;
    lattice.materials = &material;
    return mspring_builder_add_lattice(builder, &lattice, NULL);
}

static mspring_result make(const row *r, mspring_builder *builder, mspring_simd level, bool is_second,
                           mspring_network **out) {
    mspring_network_def def = mspring_network_def_default();
    mspring_hook_def hook = mspring_hook_def_default();
    def.simd_level = level;
    def.settings.solver = r->solver;
    def.settings.substeps = r->substeps;
    def.spare_particles = is_second ? r->more_spare : 0;
    hook.phase = MSPRING_PHASE_AFTER_SUBSTEP;
    hook.fn = empty_hook;
    mspring_result result = mspring_network_create(builder, &def, out);
    if (result == MSPRING_OK) {
        result = lay_floor(*out, is_second && r->more_floor != NO_FLOOR ? r->more_floor : r->floor);
    }
    if (result == MSPRING_OK && r->has_hook) {
        result = mspring_network_add_hook(*out, &hook, NULL);
    }
    return result;
}

/// Two functions, for what counts by function; each has a counter, so that no compiler makes one of them.
static volatile uint32_t plain_steps, other_steps;

static BENCH_NOINLINE mspring_result step_plain(mspring_network *network) {
    plain_steps++;
    return mspring_network_step(network, DT);
}

static BENCH_NOINLINE mspring_result step_other(mspring_network *network) {
    other_steps++;
    return mspring_network_step(network, DT);
}

/// A snapshot of each network at its start, and seconds for a step in each sample.
typedef struct sampler {
    mspring_network *network;
    void *start;
    size_t size;
} sampler;

static bool begin(sampler *s) {
    if (mspring_network_get_snapshot_size(s->network, MSPRING_SNAPSHOT_ALL, &s->size) != MSPRING_OK) {
        return false;
    }
    s->start = malloc(s->size);
    return s->start &&
           mspring_network_save(s->network, MSPRING_SNAPSHOT_ALL, s->start, s->size, NULL) == MSPRING_OK;
}

static bool sample(const sampler *s, uint32_t steps, mspring_result (*step)(mspring_network *), double *seconds) {
    mspring_result result = mspring_network_load(s->network, s->start, s->size);
    const double from = bench_seconds();
    for (uint32_t i = 0; result == MSPRING_OK && i < steps; i++) {
        result = step(s->network);
    }
    *seconds = (bench_seconds() - from) / steps;
    return result == MSPRING_OK;
}

static bool measure(const row *r, const bench_options *options, sampler two[2]) {
    enum { MOST = 1000 };
    static double plain[MOST], other[MOST], ratios[MOST];
    const uint32_t repeat = options->repeat == 0 ? 21 : options->repeat < MOST ? options->repeat : MOST;
    for (uint32_t i = 0; i < repeat; i++) {
        if (!sample(&two[0], r->steps, step_plain, &plain[i]) ||
            !sample(&two[1], r->steps, step_other, &other[i])) {
            return false;
        }
        ratios[i] = other[i] / plain[i];
    }
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", r->name),
        bench_cell_of("%u", r->width * r->height),
        bench_cell_of("%u", r->substeps),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(two[0].network))),
        bench_cell_of("%.2f", 1e6 * bench_median(plain, repeat)),
        bench_cell_of("%.2f", 1e6 * bench_median(other, repeat)),
        bench_cell_of("%.3f", bench_median(ratios, repeat)),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    return true;
}

static bool run_row(const row *r, const bench_options *options, mspring_simd level) {
    sampler two[2] = {{NULL, NULL, 0}, {NULL, NULL, 0}};
    mspring_builder *builder = NULL;
    bool ok = mspring_builder_create(NULL, &builder) == MSPRING_OK && describe(r, builder) == MSPRING_OK;
    for (int i = 0; i < 2 && ok; i++) {
        ok = make(r, builder, level, i == 1, &two[i].network) == MSPRING_OK && begin(&two[i]);
    }
    ok = ok && measure(r, options, two);
    if (!ok) {
        fprintf(stderr, "massspring-bench: %s: %s%s%s\n", r->name, mspring_builder_error(builder),
                mspring_network_error(two[0].network), mspring_network_error(two[1].network));
    }
    for (int i = 0; i < 2; i++) {
        mspring_network_destroy(two[i].network);
        free(two[i].start);
    }
    mspring_builder_destroy(builder);
    return ok;
}

bool bench_run_spare(const bench_options *options) {
    mspring_simd levels[4];
    scene_error error;
    const int count = bench_options_levels(options, levels, &error);
    bool ok = count > 0;
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    for (int level = 0; level < count; level++) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            if (!options->family || strcmp(options->family, rows[i].name) == 0) {
                ok = run_row(&rows[i], options, levels[level]) && ok;
            }
        }
    }
    return ok;
}
