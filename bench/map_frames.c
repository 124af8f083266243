/// @file map_frames.c
/// How long the worst step takes next to the median, with the default guard: drops, bombs and calm. Each scene runs
/// a few times, and a step's time is the least of them, so that what others do on the machine does not count.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/clock.h"
#include "modes.h"
#include "table.h"

#include <massspring/massspring.h>
enum { FRAMES = 240, RUNS = 3, BOMB_AT = 80 };

typedef enum happening { CALM, DROP, BOMB, HAPPENINGS } happening;

/// One scene: a lattice and how it is stepped.
typedef struct frames_scene {
    uint32_t columns, rows;
    bool is_patchy; ///< of four materials, with holes, as a ship is
    uint32_t substeps;
    double share; ///< length of a substep over what is stable now
    happening what;
} frames_scene;

static const bench_column columns[] = {
    {"lattice", "lattice", -16},       {"springs", "springs", 8},   {"happens", "what happens", -12},
    {"share", "substep / stable", 16}, {"substeps", "substeps", 8}, {"median_us", "median us", 10},
    {"worst", "worst / median", 14},   {"worst_at", "at step", 8},  {"first", "first / median", 14},
    {"rejected", "rejected", 8},
};
enum { COLUMNS = sizeof columns / sizeof *columns };

/// Patches of 12 x 9 of the four materials; one particle of ten is missing.
static uint16_t cell_of(const frames_scene *of, uint32_t column, uint32_t row) {
    const uint32_t patch = (column / 12 * 7 + row / 9 * 5) * 2654435761u, particle = column * 977 + row * 1009;
    if (!of->is_patchy)
        return 0;
    return particle * 2654435761u >> 16 < 6554 ? MSPRING_CELL_EMPTY : (uint16_t)(patch >> 30);
}

static mspring_network *make(const frames_scene *of) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_material materials[4];
    mspring_lattice_def lattice = mspring_lattice_def_default();
    mspring_network_def def = mspring_network_def_default();
    uint16_t *cells = calloc((size_t)of->columns * of->rows, sizeof *cells);
    for (uint32_t i = 0; i < 4; i++) {
        static const float masses[] = {1, 2, 1, 0.5f}, stiffnesses[] = {1e6f, 5e5f, 2e5f, 1e5f};
        materials[i] = mspring_material_default();
        materials[i].mass = masses[i];
        materials[i].stiffness = stiffnesses[i];
    }
    for (uint32_t i = 0; cells != NULL && i < of->columns * of->rows; i++)
        cells[i] = cell_of(of, i % of->columns, i / of->columns);
    lattice.width = of->columns;
    lattice.height = of->rows;
    lattice.cells = cells;
    lattice.materials = materials;
    lattice.material_count = 4;
    lattice.y = 3;
    def.settings.gravity_y = of->what == CALM ? 0 : -9.8f;
    def.settings.substeps = of->substeps;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    if (cells == NULL || mspring_builder_create(NULL, &builder) != MSPRING_OK ||
        mspring_builder_add_lattice(builder, &lattice, NULL) != MSPRING_OK ||
        mspring_network_create(builder, &def, &network) != MSPRING_OK)
        fprintf(stderr, "massspring-bench: no network: %s\n", mspring_builder_error(builder));
    mspring_builder_destroy(builder);
    free(cells);
    return network;
}

static bool prepare(const frames_scene *of, mspring_network *network, double *dt) {
    static const double plane[4] = {0, 0, 0, 1};
    mspring_floor_def floor = mspring_floor_def_default();
    double now = 0;
    floor.planes = plane;
    floor.plane_count = 1;
    const bool ok = mspring_network_set_floor(network, &floor) == MSPRING_OK &&
                    mspring_network_get_stable_dt(network, &now, NULL) == MSPRING_OK;
    *dt = of->share * now * of->substeps;
    return ok;
}

/// Throw what is near the middle outwards, at 30 m/s.
static bool explode(const frames_scene *of, mspring_network *network) {
    bool ok = true;
    mspring_id id = 0;
    for (uint32_t row = 0; row < of->rows; row++) {
        for (uint32_t column = 0; column < of->columns; column++) {
            if (cell_of(of, column, row) == MSPRING_CELL_EMPTY)
                continue;
            const double x = column - of->columns / 2.0, y = of->rows / 2.0 - row, far = hypot(x, y);
            const float vx = (float)(30 * x / (far + 1)), vy = (float)(30 * y / (far + 1));
            if (far < 6)
                ok = ok && mspring_network_set_velocities(network, NULL, id, 1, &vx, &vy, 1) == MSPRING_OK;
            id++;
        }
    }
    return ok;
}

/// What the runs of a scene gave.
typedef struct taken {
    double least[FRAMES]; ///< s of each step
    uint32_t springs, rejected;
} taken;

/// Take the steps of one run, and keep the least time of each.
static bool take(const frames_scene *of, taken *out) {
    double dt = 0;
    mspring_network *network = make(of);
    bool ok = network != NULL && prepare(of, network, &dt);
    out->rejected = 0;
    out->springs = ok ? mspring_network_count(network, MSPRING_SPRINGS) : 0;
    for (int frame = 0; ok && frame < FRAMES; frame++) {
        if (of->what == BOMB && frame == BOMB_AT)
            ok = explode(of, network);
        const double start = clock_processor_seconds();
        out->rejected += mspring_network_step(network, dt) != MSPRING_OK;
        out->least[frame] = fmin(out->least[frame], clock_processor_seconds() - start);
    }
    mspring_network_destroy(network);
    return ok;
}

static int compare(const void *a, const void *b) {
    const double first = *(const double *)a, second = *(const double *)b;
    return first < second ? -1 : first > second;
}

/// @return whether no step takes more than twice the median, and the first at most three times
static bool measure(const bench_options *options, const frames_scene *of) {
    static const char *const names[HAPPENINGS] = {"calm", "drop", "bomb"};
    taken got;
    double sorted[FRAMES], *const least = got.least;
    uint32_t worst = 1;
    for (int frame = 0; frame < FRAMES; frame++)
        least[frame] = INFINITY;
    for (int run = 0; run < RUNS; run++)
        if (!take(of, &got))
            return false;
    for (int frame = 0; frame < FRAMES; frame++) {
        sorted[frame] = least[frame];
        worst = frame > 0 && least[frame] > least[worst] ? (uint32_t)frame : worst;
    }
    qsort(sorted, FRAMES, sizeof *sorted, compare);
    const double median = sorted[FRAMES / 2];
    const bench_cell cells[COLUMNS] = {
        bench_cell_of("%u x %u%s", of->columns, of->rows, of->is_patchy ? " patchy" : ""),
        bench_cell_of("%u", got.springs),
        bench_cell_of("%s", names[of->what]),
        bench_cell_of("%.2f", of->share),
        bench_cell_of("%u", of->substeps),
        bench_cell_of("%.1f", 1e6 * median),
        bench_cell_of("%.2f", least[worst] / median),
        bench_cell_of("%u", worst),
        bench_cell_of("%.2f", least[0] / median),
        bench_cell_of("%u", got.rejected)};
    bench_table_row(options->format, columns, COLUMNS, cells);
    return least[worst] <= 2 * median && least[0] <= 3 * median;
}

bool bench_run_frames(const bench_options *options) {
    static const frames_scene sizes[] = {
        {.columns = 96, .rows = 56},
        {.columns = 544, .rows = 68},
        {.columns = 200, .rows = 200},
        {.columns = 200, .rows = 200, .is_patchy = true},
    };
    static const double shares[] = {0.5, 0.72, 0.95};
    bool ok = true;
    bench_table_machine(options->format);
    bench_table_note(options->format, "The worst step should take at most twice the median, the first three times; "
                                      "times are processor time");
    bench_table_head(options->format, columns, COLUMNS);
    for (size_t size = 0; size < sizeof sizes / sizeof *sizes; size++)
        for (int share = 0; share < 3; share++)
            for (int what = 0; what < HAPPENINGS; what++)
                for (uint32_t substeps = 8; substeps <= 40; substeps += 32) {
                    frames_scene next = sizes[size];
                    next.substeps = substeps;
                    next.share = shares[share];
                    next.what = (happening)what;
                    ok = measure(options, &next) && ok;
                }
    return ok;
}
