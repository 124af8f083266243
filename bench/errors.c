/// @file errors.c
/// Error against time of stiff structures at 10^7 to 10^10 N/m, by implicit, direct and explicit settings: the
/// distance from a fine run over a second, as a share of the motion, and what a step of 1/64 s takes.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include <massspring/massspring.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modes.h"
#include "scenes/scene.h"

static const bench_column columns[] = {
    {"scene", "scene", -12},        {"particles", "particles", 9},   {"stiffness", "N/m", 8},
    {"solver", "solver", -8},       {"substeps", "substeps", 8},     {"residual", "residual", 8},
    {"us_per_step", "us/step", 10}, {"error_percent", "error %", 9},
};

enum { COLUMNS = sizeof columns / sizeof *columns, MOST_CELLS = 544 * 68, MASTS = 4, SETTINGS = 8 };

/// Cells of a lattice that are empty.
typedef bool (*hole_fn)(uint32_t column, uint32_t row);

static bool no_hole(uint32_t column, uint32_t row) {
    (void)column;
    (void)row;
    return false;
}

/// A tenth of the inner cells.
static bool torn_hole(uint32_t column, uint32_t row) {
    const uint32_t mixed = (column * 2654435761u ^ row * 40503u) * 2246822519u;
    return column > 1 && (mixed >> 16) % 10 == 0;
}

/// Add a lattice of 73.4 kg particles with its left column pinned or not.
static mspring_result add_lattice(mspring_builder *builder, uint32_t width, uint32_t height, double x, double y,
                                  float stiffness, bool is_held, hole_fn is_hole, mspring_id *ids) {
    static uint16_t cells[MOST_CELLS];
    mspring_material materials[2];
    mspring_lattice_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def);
    for (int i = 0; i < 2 && result == MSPRING_OK; i++) {
        result = mspring_init(MSPRING_STRUCT_MATERIAL, &materials[i], sizeof materials[i]);
        materials[i].mass = 73.4f;
        materials[i].stiffness = stiffness;
    }
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (uint32_t i = 0; i < width * height; i++) {
        const bool is_empty = is_hole(i % width, i / width);
        cells[i] = (uint16_t)(is_empty ? MSPRING_CELL_EMPTY : is_held && i % width == 0);
    }
    def.width = width;
    def.height = height;
    def.x = x;
    def.y = y;
    def.cells = cells;
    def.materials = materials;
    def.material_count = 2;
    return result == MSPRING_OK ? mspring_builder_add_lattice(builder, &def, ids) : result;
}

static mspring_result add_rope(mspring_builder *builder, mspring_id from, mspring_id to, uint32_t segments,
                               float stiffness) {
    mspring_material line = mspring_material_default();
    line.mass = 7.34f;
    line.stiffness = stiffness;
    mspring_rope_def def = mspring_rope_def_default();
    def.from = from;
    def.to = to;
    def.segment_count = segments;
    def.material = &line;
    return mspring_builder_add_rope(builder, &def, NULL, NULL);
}

static mspring_result add_spring(mspring_builder *builder, mspring_id a, mspring_id b, float stiffness) {
    mspring_spring_def def = mspring_spring_def_default();
    def.a = a;
    def.b = b;
    def.stiffness = stiffness;
    return mspring_builder_add_springs(builder, &def, 1, NULL);
}

/// A hull of 120 x 10 with four masts of 2 x 24; lines join their tops, and each top with the deck.
static mspring_result add_rigged_hull(mspring_builder *builder, float k) {
    static mspring_id hull[120 * 10], mast[2 * 24];
    mspring_id last = MSPRING_NONE;
    mspring_result result = add_lattice(builder, 120, 10, 0, 0, k, true, no_hole, hull);
    for (uint32_t i = 0; i < MASTS && result == MSPRING_OK; i++) {
        const uint32_t column = 15 + 30 * i;
        result = add_lattice(builder, 2, 24, column, 10, k, false, no_hole, mast);
        for (uint32_t j = 0; j < 4 && result == MSPRING_OK; j++)
            result = add_spring(builder, hull[column + j % 2], mast[46 + j / 2], k);
        if (result == MSPRING_OK)
            result = add_rope(builder, mast[0], hull[column + (i < MASTS - 1 ? 12 : -12)], 26, k);
        if (result == MSPRING_OK && i > 0)
            result = add_rope(builder, last, mast[0], 30, k);
        last = mast[1];
    }
    return result;
}

/// A deck of 121 x 2, pinned at one end, hung every eighth column from a cable of 15 springs.
static mspring_result add_bridge(mspring_builder *builder, float k) {
    static mspring_id deck[121 * 2];
    mspring_id last = MSPRING_NONE;
    mspring_result result = add_lattice(builder, 121, 2, 0, 0, k, true, no_hole, deck);
    for (uint32_t i = 0; i <= 15 && result == MSPRING_OK; i++) {
        mspring_particle_def def;
        mspring_id knot = MSPRING_NONE;
        const double at = (double)i - 7.5;
        result = mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def);
        def.x = 8.0 * i;
        def.y = 5 + 0.35 * at * at;
        def.mass = 73.4f;
        def.flags = i == 0 || i == 15 ? MSPRING_PARTICLE_PINNED : 0;
        if (result == MSPRING_OK)
            result = mspring_builder_add_particles(builder, &def, 1, &knot);
        if (result == MSPRING_OK)
            result = add_rope(builder, knot, deck[8 * i], 6, k);
        if (result == MSPRING_OK && i > 0)
            result = add_rope(builder, last, knot, 8, k);
        last = knot;
    }
    return result;
}

/// The sample ship with all of its springs as stiff, undamped.
static mspring_result make_ship(mspring_builder **builder, float k) {
    scene_options options = scene_options_from_file();
    scene_materials materials;
    scene_error error;
    scene made;
    options.stiffness = k;
    bool ok = scene_materials_read(BENCH_DATA_DIR "/ship_materials.csv", &materials, &error);
    if (ok) {
        ok = scene_image(BENCH_DATA_DIR "/ship.png", &materials, &options, &made, &error);
        scene_materials_free(&materials);
    }
    if (!ok) {
        fprintf(stderr, "massspring-bench: %s\n", error.text);
        return MSPRING_ERROR_ARGUMENT;
    }
    *builder = made.builder;
    made.builder = NULL;
    scene_free(&made);
    return MSPRING_OK;
}

static const char *const names[] = {"hull", "hull_lines", "bridge", "bar_544x68", "torn", "ship"};

static mspring_result add_lattices(mspring_builder *builder, int number, float k) {
    switch (number) {
    case 0:
        return add_lattice(builder, 120, 10, 0, 0, k, true, no_hole, NULL);
    case 1:
        return add_rigged_hull(builder, k);
    case 2:
        return add_bridge(builder, k);
    case 3:
        return add_lattice(builder, 544, 68, 0, 0, k, true, no_hole, NULL);
    default:
        return add_lattice(builder, 120, 24, 0, 0, k, true, torn_hole, NULL);
    }
}

static mspring_result make_scene(mspring_builder **builder, int number, float k) {
    if (number == 5)
        return make_ship(builder, k);
    const mspring_result result = mspring_builder_create(NULL, builder);
    return result == MSPRING_OK ? add_lattices(*builder, number, k) : result;
}

/// One and two substeps with residuals of 0.1, 0.03 and 0.01, then the direct and the explicit solver.
static uint32_t list_settings(mspring_network *network, mspring_settings settings[SETTINGS]) {
    static const float residuals[] = {0.1f, 0.03f, 0.01f};
    uint32_t count = 0, stable = 0;
    for (uint32_t i = 0; i < 7; i++) {
        mspring_settings *def = &settings[count++];
        *def = mspring_settings_default();
        def->solver = i < 6 ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_DIRECT;
        def->substeps = i < 6 ? 1 + i / 3 : 1;
        def->residual = residuals[i % 3];
    }
    if (mspring_network_suggest_substeps(network, 1.0 / 64, 0.9, &stable) == MSPRING_OK) {
        settings[count] = mspring_settings_default();
        settings[count++].substeps = stable;
    }
    return count;
}

static bool measure(const bench_options *options, int number, float k) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_tune_def def;
    mspring_settings settings[SETTINGS];
    mspring_tune_row rows[SETTINGS];
    uint32_t count = 0;
    mspring_result result = make_scene(&builder, number, k);
    if (result == MSPRING_OK)
        result = mspring_network_create(builder, NULL, &network);
    if (result == MSPRING_OK)
        result = mspring_init(MSPRING_STRUCT_TUNE_DEF, &def, sizeof def);
    if (result == MSPRING_OK) {
        def.dt = 1.0 / 64;
        def.duration = 1;
        def.budget = 300;
        def.flags = MSPRING_TUNE_NOTHING_ELSE;
        def.settings = settings;
        def.setting_count = list_settings(network, settings);
        for (int i = 0; i < SETTINGS; i++)
            rows[i].struct_size = sizeof rows[i];
        result = mspring_network_tune(network, &def, rows, SETTINGS, &count);
    }
    for (uint32_t i = 0; i < count; i++) {
        const mspring_tune_row *r = &rows[i];
        static const char *const solvers[] = {"explicit", "implicit", "direct"};
        const bench_cell cells[COLUMNS] = {
            bench_cell_of("%s", names[number]),
            bench_cell_of("%u", mspring_network_count(network, MSPRING_PARTICLES)),
            bench_cell_of("%.0e", (double)k),
            bench_cell_of("%s", solvers[r->settings.solver]),
            bench_cell_of("%u", r->settings.substeps),
            bench_cell_of("%g", r->settings.solver == MSPRING_SOLVER_IMPLICIT ? (double)r->settings.residual : 0.0),
            bench_cell_of("%.1f", 1e6 * r->min_cost),
            r->flags & MSPRING_TUNE_HAS_TRAJECTORY ? bench_cell_of("%.4f", 100 * r->trajectory_share)
                                                   : bench_cell_of("none"),
        };
        bench_table_row(options->format, columns, COLUMNS, cells);
    }
    if (result != MSPRING_OK)
        fprintf(stderr, "massspring-bench: %s: %s\n", names[number],
                network ? mspring_network_error(network) : mspring_builder_error(builder));
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return result == MSPRING_OK;
}

bool bench_run_errors(const bench_options *options) {
    bool ok = true;
    bench_table_head(options->format, columns, COLUMNS);
    for (int number = 0; number < (int)(sizeof names / sizeof *names); number++) {
        if (options->family != NULL && strcmp(options->family, names[number]) != 0)
            continue;
        for (float k = 1e7f; k < 2e10f; k *= 10)
            ok = measure(options, number, k) && ok;
    }
    return ok;
}
