/// @file contact.c
/// What contact costs: each network with it against the same one without, in turn from the same state. Times are
/// those of the processor, so that it does not matter what else the machine does.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "modes.h"

#include <massspring/massspring.h>

#define SUBSTEPS 40
#define THICKNESS 0.5

typedef struct subject {
    const char *name;
    uint32_t columns, rows; ///< rows 0: loose particles in a box
    uint32_t bodies;        ///< bars, one above the other; 0: one that is folded
    double gap;             ///< between them, m
    double aside;           ///< share of its length that each lies aside of the one below
    bool touches_itself, on_collider;
    uint32_t settling;     ///< steps before what is measured
    uint32_t steps;        ///< that are measured
    mspring_solver solver; ///< not explicit: one substep
    uint32_t substeps;     ///< 0: SUBSTEPS
} subject;

static const subject subjects[] = {
    {"544x68, itself, nothing near", 544, 68, 1, 0, 0, true, false, 2, 10, MSPRING_SOLVER_EXPLICIT, 0},
    {"544x68, folded onto itself", 544, 68, 0, THICKNESS + 0.06, 0, true, false, 64, 4, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 544x68, far apart", 544, 68, 2, 50, 0, false, false, 2, 8, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 544x68, a tenth touches", 544, 68, 2, THICKNESS, 0.8, false, false, 32, 8, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 544x68, one on the other", 544, 68, 2, THICKNESS, 0, false, false, 32, 4, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 80x5, near each other", 80, 5, 2, THICKNESS + 0.2, 0, false, false, 0, 8, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 80x5, dropped by 1 m", 80, 5, 2, THICKNESS + 1.0, 0, false, false, 0, 60, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 80x5, at rest", 80, 5, 2, THICKNESS, 0, false, false, 300, 60, MSPRING_SOLVER_EXPLICIT, 0},
    {"two 80x5, at rest, implicit", 80, 5, 2, THICKNESS, 0, false, false, 300, 60, MSPRING_SOLVER_IMPLICIT, 0},
    {"two 80x5, at rest, direct", 80, 5, 2, THICKNESS, 0, false, false, 300, 60, MSPRING_SOLVER_DIRECT, 0},
    {"544x68 high above a collider", 544, 68, 1, 50, 0, false, true, 2, 8, MSPRING_SOLVER_EXPLICIT, 0},
    {"80x5, at rest on a collider", 80, 5, 1, THICKNESS, 0, false, true, 300, 60, MSPRING_SOLVER_EXPLICIT, 0},
    {"10,000 loose, settling", 10000, 0, 1, 0, 0, false, false, 64, 4, MSPRING_SOLVER_EXPLICIT, 0},
    {"the same in 8 substeps", 10000, 0, 1, 0, 0, false, false, 64, 4, MSPRING_SOLVER_EXPLICIT, 8},
    {"the same in 4 substeps", 10000, 0, 1, 0, 0, false, false, 64, 4, MSPRING_SOLVER_EXPLICIT, 4},
};

static const bench_column columns[] = {
    {"case", "case", -30},
    {"springs", "springs", 8},
    {"outline_points", "points", 8},
    {"touching", "touching", 8},
    {"contact_kb", "kB", 8},
    {"us_per_step_without", "us/step without", 16},
    {"us_per_step_with", "us/step with", 14},
    {"step_time_ratio_median", "with/without", 12},
};
#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

/// A network and the state that it starts from.
typedef struct player {
    mspring_network *network;
    void *start;
    size_t size;
} player;

static bool reset(player *p, scene_error *error) {
    const mspring_result result = mspring_network_load(p->network, p->start, p->size);
    if (result != MSPRING_OK)
        bench_library_error(error, "going back to the start", result, mspring_network_error(p->network));
    return result == MSPRING_OK;
}

static bool run(player *p, uint32_t steps, scene_error *error) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; i < steps && result == MSPRING_OK; i++)
        result = mspring_network_step(p->network, BENCH_DT);
    if (result != MSPRING_OK)
        bench_library_error(error, "stepping the network", result, mspring_network_error(p->network));
    return result == MSPRING_OK;
}

/// The lowest body's bottom row is pinned where others lie on it.
static mspring_result add_bars(mspring_builder *builder, const subject *s) {
    uint16_t *cells = calloc((size_t)s->columns * s->rows, sizeof *cells);
    mspring_material iron[2];
    mspring_lattice_def bar;
    mspring_result result = cells ? MSPRING_OK : MSPRING_ERROR_MEMORY;
    for (int i = 0; i < 2 && result == MSPRING_OK; i++) {
        result = mspring_init(MSPRING_STRUCT_MATERIAL, &iron[i], sizeof iron[i]);
        iron[i].mass = SCENE_IRON_MASS;
        iron[i].stiffness = SCENE_IRON_STIFFNESS;
        iron[i].damping = 2000.0f;
    }
    iron[1].particle_flags = MSPRING_PARTICLE_PINNED;
    if (result == MSPRING_OK)
        result = mspring_init(MSPRING_STRUCT_LATTICE_DEF, &bar, sizeof bar);
    for (uint32_t body = 0; body < s->bodies && result == MSPRING_OK; body++) {
        for (uint32_t i = 0; i < s->columns; i++)
            cells[(s->rows - 1) * s->columns + i] = body == 0 && s->bodies > 1;
        bar.width = s->columns;
        bar.height = s->rows;
        bar.cells = cells;
        bar.materials = iron;
        bar.material_count = 2;
        bar.x = body * s->aside * s->columns + 0.37 * body;
        bar.y = body * (s->rows - 1 + s->gap);
        result = mspring_builder_add_lattice(builder, &bar, NULL);
    }
    free(cells);
    return result;
}

/// Two arms, half of the bar each, are joined at one end. The upper one comes to lie on the other.
static mspring_result add_folded_bar(mspring_builder *builder, const subject *s) {
    static const int32_t steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    const uint32_t width = s->columns / 2, height = 2 * s->rows;
    mspring_particle_def particle;
    mspring_spring_def spring;
    mspring_result result = mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle);
    if (result == MSPRING_OK)
        result = mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring);
    particle.mass = SCENE_IRON_MASS;
    spring.stiffness = SCENE_IRON_STIFFNESS;
    spring.damping = 2000.0f;
    for (uint32_t i = 0; i < width * height && result == MSPRING_OK; i++) {
        particle.x = i % width;
        particle.y = i / width - (i / width < s->rows ? 0 : 1 - s->gap);
        particle.flags = i < width ? MSPRING_PARTICLE_PINNED : 0;
        result = mspring_builder_add_particles(builder, &particle, 1, NULL);
    }
    for (uint32_t i = 0; i < width * height; i++)
        for (int k = 0; k < 4 && result == MSPRING_OK; k++) {
            const uint32_t row = i / width, column = i % width + (uint32_t)steps[k][0],
                           to = row + (uint32_t)steps[k][1];
            const bool is_cut = row + 1 == s->rows && to == s->rows && width - 1 - i % width >= s->rows;
            spring.a = i;
            spring.b = to * width + column;
            if (column < width && to < height && !is_cut)
                result = mspring_builder_add_springs(builder, &spring, 1, NULL);
        }
    return result;
}

static mspring_result add_loose(mspring_builder *builder, uint32_t count) {
    mspring_particle_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def);
    def.mass = SCENE_IRON_MASS;
    for (uint32_t i = 0; i < count && result == MSPRING_OK; i++) {
        def.x = -29 + 0.6 * (i % 98) + 0.01 * (i % 7);
        def.y = 0.3 + 0.6 * (i / 98);
        result = mspring_builder_add_particles(builder, &def, 1, NULL);
    }
    return result;
}

static mspring_result put_into_box(mspring_network *network) {
    static const double planes[3][4] = {{0, 0, 0, 1}, {-31, 0, 1, 0}, {31, 0, -1, 0}};
    mspring_floor_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def);
    def.planes = planes[0];
    def.plane_count = 3;
    return result == MSPRING_OK ? mspring_network_set_floor(network, &def) : result;
}

static mspring_result set_contact(mspring_network *network, const subject *s) {
    mspring_contact_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def);
    def.flags = s->touches_itself ? MSPRING_CONTACT_SELF : 0;
    def.thickness = THICKNESS;
    def.friction = 0.5f;
    return result == MSPRING_OK ? mspring_network_set_contact(network, &def) : result;
}

// A long, flat box, below the body by the gap.
static mspring_result put_onto_collider(mspring_network *network, const subject *s) {
    mspring_collider_def def;
    const mspring_result result = mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def);
    def.kind = MSPRING_COLLIDER_BOX;
    def.width = 2 * s->columns;
    def.height = 2;
    def.x = s->columns / 2;
    def.y = -1 - s->gap;
    def.friction = 0.5f;
    return result == MSPRING_OK ? mspring_network_add_collider(network, &def, NULL) : result;
}

/// Both start where the one with contact is after it has settled.
static mspring_result make_players(const subject *s, mspring_simd level, player *without, player *with) {
    mspring_builder *builder = NULL;
    mspring_network_def def;
    mspring_result result = mspring_builder_create(NULL, &builder);
    if (result == MSPRING_OK)
        result = s->rows == 0     ? add_loose(builder, s->columns)
                 : s->bodies == 0 ? add_folded_bar(builder, s)
                                  : add_bars(builder, s);
    if (result == MSPRING_OK)
        result = mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    def.simd_level = level;
    def.settings.solver = s->solver;
    def.settings.substeps = s->solver != MSPRING_SOLVER_EXPLICIT ? 1 : s->substeps > 0 ? s->substeps : SUBSTEPS;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    def.settings.global_damping = BENCH_GLOBAL_DAMPING;
    def.settings.gravity_y = s->gap > 0 || s->rows == 0 ? -9.8f : 0;
    player *const both[] = {without, with};
    for (int i = 0; i < 2 && result == MSPRING_OK; i++)
        result = mspring_network_create(builder, &def, &both[i]->network);
    mspring_builder_destroy(builder);
    if (result == MSPRING_OK)
        result = set_contact(with->network, s);
    if (result == MSPRING_OK && s->on_collider)
        result = put_onto_collider(with->network, s);
    for (int i = 0; i < 2 && result == MSPRING_OK && s->rows == 0; i++)
        result = put_into_box(both[i]->network);
    for (uint32_t i = 0; i < s->settling && result == MSPRING_OK; i++)
        result = mspring_network_step(with->network, BENCH_DT);
    if (result == MSPRING_OK)
        result = mspring_network_get_snapshot_size(with->network, MSPRING_SNAPSHOT_FRAME, &with->size);
    if (result == MSPRING_OK && !(with->start = malloc(with->size)))
        result = MSPRING_ERROR_MEMORY;
    if (result == MSPRING_OK)
        result = mspring_network_save(with->network, MSPRING_SNAPSHOT_FRAME, with->start, with->size, NULL);
    without->start = with->start;
    without->size = with->size;
    return result;
}

/// The processor's seconds for the steps from the start.
static bool time_steps(player *p, uint32_t steps, double *seconds, scene_error *error) {
    if (!reset(p, error) || !run(p, 1, error))
        return false;
    const clock_t before = clock();
    const bool ok = run(p, steps, error);
    *seconds = (double)(clock() - before) / CLOCKS_PER_SEC / steps;
    return ok;
}

/// Both in turn, so many times; medians.
static bool compare(player *without, player *with, uint32_t steps, uint32_t repeat, bench_turns *out,
                    scene_error *error) {
    static double first[BENCH_MAX_REPEAT], second[BENCH_MAX_REPEAT], ratio[BENCH_MAX_REPEAT];
    for (uint32_t i = 0; i < repeat; i++) {
        if (!time_steps(without, steps, &first[i], error) || !time_steps(with, steps, &second[i], error))
            return false;
        ratio[i] = second[i] / first[i];
    }
    out->first_median = bench_median(first, repeat);
    out->second_median = bench_median(second, repeat);
    out->ratio_median = bench_median(ratio, repeat);
    return true;
}

/// With the colliders.
static size_t memory_of_contact(const player *without, const player *with) {
    return bench_memory_of(with->network) - bench_memory_of(without->network);
}

static bool measure(const subject *s, const bench_options *options, mspring_simd level) {
    player without = {0}, with = {0};
    scene_error error;
    mspring_contact_info info = mspring_contact_info_default();
    bench_turns turns;
    mspring_result result = make_players(s, level, &without, &with);
    if (result != MSPRING_OK)
        bench_library_error(&error, "making the networks", result,
                            with.network ? mspring_network_error(with.network) : "");
    bool ok = result == MSPRING_OK &&
              compare(&without, &with, s->steps, options->repeat > 0 ? options->repeat : 11, &turns, &error);
    ok = ok && mspring_network_get_contact_info(with.network, &info) == MSPRING_OK;
    if (ok) {
        const bench_cell cells[COLUMN_COUNT] = {
            bench_cell_of("%s", s->name),
            bench_cell_of("%u", mspring_network_count(with.network, MSPRING_SPRINGS)),
            bench_cell_of("%u", info.points),
            bench_cell_of("%u", info.touching),
            bench_cell_of("%.0f", 1e-3 * (double)memory_of_contact(&without, &with)),
            bench_cell_of("%.1f", 1e6 * turns.first_median),
            bench_cell_of("%.1f", 1e6 * turns.second_median),
            bench_cell_of("%.3f", turns.ratio_median),
        };
        bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    } else {
        bench_complain(s->name, &error);
    }
    mspring_network_destroy(without.network);
    mspring_network_destroy(with.network);
    free(with.start);
    return ok;
}

bool bench_run_contact(const bench_options *options) {
    mspring_simd levels[4];
    scene_error error;
    bool ok = true;
    const int count = bench_options_levels(options, levels, &error);
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    for (int level = 0; level < count; level++)
        for (size_t i = 0; i < sizeof subjects / sizeof *subjects; i++)
            ok &= measure(&subjects[i], options, levels[level]);
    return ok;
}
