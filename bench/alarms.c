/// @file alarms.c
/// False alarms: a million ordinary steps of the examples' scenes with their own springs, in substeps of 0.85 of
/// the border of the shape at rest. On lattices that is above what is stable in any shape, so the guard watches
/// each of them. None may be refused.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "modes.h"

#include <massspring/massspring.h>
/// Of the border. A stretched network's is lower than that at rest: by a tenth where iron hangs by its own weight.
#define SHARE 0.85

/// Springs from which a scene counts as large; small ones take most of the steps.
enum { LARGE = 20000, STEPS_OF_SMALL = 190000, STEPS_OF_LARGE = 20000, STEPS_A_KICK = 100, SUBSTEPS = 2 };

static const bench_column columns[] = {
    {"scene", "scene", -18},    {"springs", "springs", 8},     {"steps", "steps", 8},
    {"us_of_substep", "us", 9}, {"any_shape", "any shape", 9}, {"watched", "watched", -7},
    {"refused", "refused", 8},
};
enum { COLUMN_COUNT = sizeof columns / sizeof *columns };

/* -------------------------------------------------------------------------------------------------- the scenes */

static bool image_scene(const char *file, const char *table, scene *out, scene_error *error) {
    scene_materials materials;
    char path[1024];
    snprintf(path, sizeof path, BENCH_DATA_DIR "/%s", table != NULL ? table : "");
    if (!(table != NULL ? scene_materials_read(path, &materials, error)
                        : scene_materials_builtin(&materials, error)))
        return false;
    const scene_options options = scene_options_from_file();
    snprintf(path, sizeof path, BENCH_DATA_DIR "/%s", file);
    const bool made = scene_image(path, &materials, &options, out, error);
    scene_materials_free(&materials);
    return made;
}

static bool bar(scene *out, scene_error *error) {
    return image_scene("bar_80x5.png", NULL, out, error);
}
static bool large_bar(scene *out, scene_error *error) {
    return image_scene("bar_544x68.png", NULL, out, error);
}
static bool long_bar(scene *out, scene_error *error) {
    return image_scene("bar_1800x5.png", NULL, out, error);
}
static bool ship(scene *out, scene_error *error) {
    return image_scene("ship.png", "ship_materials.csv", out, error);
}
static bool truss(scene *out, scene_error *error) {
    const scene_options options = scene_options_from_file();
    return scene_network_file(BENCH_DATA_DIR "/truss.msn", &options, out, error);
}
static bool square(scene *out, scene_error *error) {
    const scene_options options = scene_options_default();
    return scene_bar(30, 30, &options, out, error);
}
static bool rope(scene *out, scene_error *error) {
    const scene_options options = scene_options_default();
    return scene_rope(300, &options, out, error);
}
static bool graph(scene *out, scene_error *error) {
    const scene_options options = scene_options_default();
    return scene_random_graph(400, 8, 1, &options, out, error);
}

/* --------------------------------------------------------------------------------------------------- the steps */

// Set the velocity of a particle, unless it is pinned.
static bool push(mspring_network *network, mspring_id particle, float speed) {
    mspring_view view = mspring_view_default();
    if (mspring_network_get_view(network, &view) != MSPRING_OK)
        return false;
    return view.inverse_mass[view.slot_of_particle[particle]] == 0.0f ||
           mspring_network_set_velocities(network, NULL, particle, 1, &speed, &speed, 1) == MSPRING_OK;
}

// Let it fall, swing and come to rest, and push a particle now and then.
static uint32_t count_refusals(mspring_network *network, const char *name, double h, uint32_t steps) {
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    uint32_t refused = 0;
    uint64_t seed = 1;
    for (uint32_t step = 0; step < steps; step++) {
        if (step % STEPS_A_KICK == 0) {
            seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            const double speed = 0.001 / h; // a thousandth of a spring in a substep
            refused += !push(network, (mspring_id)((seed >> 33) % particles), (float)speed);
        }
        if (mspring_network_step(network, SUBSTEPS * h) != MSPRING_OK) {
            if (refused++ == 0)
                fprintf(stderr, "%s, step %u: %s\n", name, step, mspring_network_error(network));
        }
    }
    return refused;
}

static bool step_scene(const scene *made, bench_format format, uint32_t *steps, uint32_t *refused) {
    mspring_network *network = NULL;
    mspring_network_def def = mspring_network_def_default();
    def.settings.global_damping = 0.5f;
    def.settings.substeps = SUBSTEPS;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    double now = 0, any_shape = 0;
    if (mspring_network_create(made->builder, &def, &network) != MSPRING_OK ||
        mspring_network_get_stable_dt(network, &now, &any_shape) != MSPRING_OK) {
        fprintf(stderr, "%s: %s%s\n", made->name, mspring_builder_error(made->builder),
                mspring_network_error(network));
        mspring_network_destroy(network);
        return false;
    }
    const double h = SHARE * now;
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t of_scene = springs < LARGE ? STEPS_OF_SMALL : STEPS_OF_LARGE;
    const uint32_t refused_here = count_refusals(network, made->name, h, of_scene);
    mspring_network_destroy(network);
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", made->name),        bench_cell_of("%u", springs),
        bench_cell_of("%u", of_scene),          bench_cell_of("%.4g", 1e6 * h),
        bench_cell_of("%.4g", 1e6 * any_shape), bench_cell_of("%s", h > any_shape ? "yes" : "no"),
        bench_cell_of("%u", refused_here),
    };
    bench_table_row(format, columns, COLUMN_COUNT, cells);
    *steps += of_scene;
    *refused += refused_here;
    return true;
}

bool bench_run_alarms(const bench_options *options) {
    bool (*const scenes[])(scene * out, scene_error * error) = {bar,   square, rope,     graph,
                                                                truss, ship,   long_bar, large_bar};
    uint32_t steps = 0, refused = 0;
    bool ok = true;
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        scene made;
        scene_error error;
        const bool there = scenes[i](&made, &error);
        if (!there)
            bench_complain("scene", &error);
        ok = there && step_scene(&made, options->format, &steps, &refused) && ok;
        if (there)
            scene_free(&made);
    }
    bench_table_note(options->format, "%u steps, %u refused", steps, refused);
    return ok && refused == 0;
}
