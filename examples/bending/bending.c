/// @file bending.c
/// Let a network settle under gravity and measure how far its probe comes down.
///
/// SPDX-License-Identifier: MIT
#include "bending/options.h"
#include "bending/report.h"
#include "bending/settle.h"
#include "common/check.h"
#include "common/output.h"
#include "common/progress.h"
#include "draw/film.h"
#include "draw/network_picture.h"
#include "loaders/structure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PICTURE_WIDTH = 1600, PICTURE_HEIGHT = 1200 };

// One run, from the scene to the pictures.
typedef struct bending_run {
    bending_options *options;
    scene scene;
    mspring_network *network;
    network_shape shape;
    film film;
    progress line;
    settle_result settled;
    spring_measures measures;
    char picture[OUTPUT_PATH_SIZE], svg[OUTPUT_PATH_SIZE], animation[OUTPUT_PATH_SIZE]; // "" for none
} bending_run;

static bool fail(const char *message) {
    fprintf(stderr, "bending: %s\n", message);
    return false;
}

static bool load_ship(bending_run *run, scene_error *error) {
    structure ship;
    structure_options options = structure_options_default();
    options.materials = run->options->materials;
    options.dock = true;
    if (run->options->substeps > 0)
        options.substeps = run->options->substeps;
    if (!structure_load(run->options->input, &options, &ship, error))
        return false;
    for (uint32_t i = 0; i < ship.report.ignored.entry_count; i++)
        fprintf(stderr, "bending: left out: %u %s\n", ship.report.ignored.entries[i].count,
                ship.report.ignored.entries[i].name);
    for (uint32_t i = 0; i < ship.report.notes.entry_count; i++)
        fprintf(stderr, "bending: %u %s\n", ship.report.notes.entries[i].count, ship.report.notes.entries[i].name);
    const bool ok = structure_scene(&ship, run->options->input, &run->scene, error);
    if (run->options->substeps == 0 && run->options->solver == MSPRING_SOLVER_EXPLICIT)
        run->options->substeps = ship.substeps;
    structure_free(&ship);
    return ok;
}

static bool load_scene(bending_run *run) {
    bending_options *options = run->options;
    scene_error error = {""};
    bool ok = false;
    if (structure_is_ship(options->input)) {
        ok = load_ship(run, &error);
    } else if (scene_file_is_image(options->input)) {
        scene_materials materials = {0};
        ok = options->materials ? scene_materials_read(options->materials, &materials, &error)
                                : scene_materials_builtin(&materials, &error);
        ok = ok && scene_image(options->input, &materials, &options->scene, &run->scene, &error);
        scene_materials_free(&materials);
    } else {
        ok = scene_network_file(options->input, &options->scene, &run->scene, &error);
    }
    if (options->substeps == 0)
        options->substeps = options->solver == MSPRING_SOLVER_EXPLICIT ? 30 : 1;
    return ok || fail(error.text);
}

static bool choose_solver(bending_run *run) {
    const bending_options *options = run->options;
    mspring_settings settings = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(run->network, &settings);
    settings.solver = options->solver;
    settings.substeps = options->substeps;
    settings.iterations = options->iterations;
    if (result == MSPRING_OK)
        result = mspring_network_set_settings(run->network, &settings);
    return check(result, "choose the solver", mspring_network_error(run->network));
}

static bool make_network(bending_run *run) {
    const bending_options *options = run->options;
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = options->substeps;
    def.settings.guard = MSPRING_GUARD_GROWTH; // what is too stiff is not to be measured softened
    def.settings.gravity_y = -options->gravity;
    def.simd_level = options->level;
    mspring_result result = mspring_network_create(run->scene.builder, &def, &run->network);
    if (!check(result, "make the network", mspring_builder_error(run->scene.builder)))
        return false;
    mspring_id loose = MSPRING_NONE;
    result = settle_find_loose(run->network, &loose);
    if (!check(result, "find what is loose", mspring_network_error(run->network)))
        return false;
    if (loose == MSPRING_NONE)
        return choose_solver(run);
    double x = 0;
    double y = 0;
    if (mspring_network_get_positions(run->network, NULL, loose, 1, &x, &y, 1) != MSPRING_OK)
        return false; // it is one of the network's
    fprintf(
        stderr,
        "bending: particle %u at (%g, %g) m is not joined to any pinned particle and would fall for ever: join it, "
        "pin it or remove it\n",
        loose, x, y);
    return false;
}

// Which files to write.
static bool choose_files(bending_run *run) {
    const bending_options *options = run->options;
    const char *folder = options->folder;
    if (folder && (!output_make_folder(folder) || !output_path(run->picture, folder, run->scene.name, ".png") ||
                   !output_path(run->svg, folder, run->scene.name, ".svg") ||
                   !output_path(run->animation, folder, run->scene.name, "_animation.png")))
        return false;
    const char *const given[] = {options->picture, options->svg, options->animation};
    char *const chosen[] = {run->picture, run->svg, run->animation};
    for (int i = 0; i < 3; i++) {
        if (!given[i])
            continue;
        const size_t size = strlen(given[i]) + 1;
        if (size > OUTPUT_PATH_SIZE)
            return fail("the path of a picture is too long: choose a shorter one");
        memcpy(chosen[i], given[i], size);
    }
    if (options->at_once) // there is no way down to be shown
        run->animation[0] = '\0';
    draw_error error;
    if ((run->picture[0] || run->svg[0] || run->animation[0]) &&
        !network_shape_make(&run->shape, run->network, run->scene.probe, &error))
        return fail(error.text);
    if (run->animation[0] && !film_start(&run->film, &run->shape, &error))
        return fail(error.text);
    return true;
}

static void after_step(mspring_network *network, const settle_progress *at, void *user) {
    bending_run *run = user;
    if (!at->measuring && run->film.x)
        film_step(&run->film, network);
    if (!progress_due(&run->line))
        return;
    char text[128];
    snprintf(text, sizeof text, "%-8s step %llu, %.1f s simulated, %s down %.6g m, moving at %.3g m/s",
             at->measuring ? "swinging" : "settling", (unsigned long long)at->step,
             (double)at->step * run->options->dt, run->scene.probe == MSPRING_NONE ? "mean" : "probe", at->drop,
             at->rms_speed);
    progress_write(&run->line, text);
}

static bool fail_unstable(const bending_run *run) {
    const spring_measures *measures = &run->measures;
    char what[64];
    snprintf(what, sizeof what, "make step %llu", (unsigned long long)run->settled.steps + 1);
    check(run->settled.result, what, mspring_network_error(run->network));
    if (run->options->solver != MSPRING_SOLVER_EXPLICIT)
        return false;
    // The limit grows with the square of the number of substeps; half of it leaves room for damping.
    double wanted = ceil(run->options->substeps * sqrt(measures->most_fraction / 0.5));
    if (measures->most_fraction > 0.5 && wanted <= 1e6)
        fprintf(stderr,
                "bending: the stiffness is up to %.3g of what %u substeps of a step of %g s bear: try --substeps "
                "%.0f\n",
                measures->most_fraction, run->options->substeps, run->options->dt, wanted);
    return false;
}

static bool settle(bending_run *run) {
    settle_request request = {
        .dt = run->options->dt,
        .most_steps = run->options->steps,
        .probe = run->scene.probe,
        .after_step = after_step,
        .user = run,
    };
    progress_start(&run->line);
    const double substep = run->options->dt / run->options->substeps;
    run->settled = run->options->at_once ? settle_at_once(run->network, &request, substep)
                                         : settle_network(run->network, &request);
    progress_clear(&run->line);
    if (!report_measure(run->network, &run->scene, substep, &run->measures))
        return fail("out of memory: take a smaller network");
    switch (run->settled.end) {
    case SETTLE_AT_REST:
        return true;
    case SETTLE_UNSTABLE:
        return fail_unstable(run);
    case SETTLE_NOT_FOUND:
        return check(run->settled.result, "settle", mspring_network_error(run->network));
    case SETTLE_OUT_OF_STEPS:
        fprintf(stderr, "bending: not at rest after %llu steps (the %s is %.6g m down): allow more with --steps\n",
                (unsigned long long)run->settled.steps, run->scene.probe == MSPRING_NONE ? "mean" : "probe",
                run->settled.drop);
        return false;
    case SETTLE_NO_MEMORY:
        return fail("out of memory: take a smaller network, or fewer steps");
    }
    return false;
}

static bool draw_network(const bending_run *run, const char *title, const double *x, const double *y,
                         draw_error *error) {
    world_box box = world_box_add(network_shape_bounds(&run->shape), x, y, run->shape.particle_count);
    network_view view =
        network_view_fit(&run->shape, box, PICTURE_WIDTH, PICTURE_HEIGHT, network_strain_limit(&run->shape, x, y));
    figure drawing;
    figure_start(&drawing, view.width, view.height, 0xffffff);
    network_picture_draw(&drawing, &run->shape, &view, x, y, title);
    bool ok = (!run->picture[0] || figure_write_png(&drawing, run->picture, error)) &&
              (!run->svg[0] || figure_write_svg(&drawing, run->svg, error));
    figure_free(&drawing);
    return ok;
}

static bool draw_final(const bending_run *run, const char *title, draw_error *error) {
    uint32_t count = run->shape.particle_count;
    double *x = malloc(count * sizeof *x);
    double *y = malloc(count * sizeof *y);
    bool ok = false;
    if (!x || !y)
        snprintf(error->text, sizeof error->text, "out of memory for a picture of %u particles", count);
    else if (mspring_network_get_positions(run->network, NULL, 0, count, x, y, 1) == MSPRING_OK)
        ok = draw_network(run, title, x, y, error);
    free(x);
    free(y);
    return ok;
}

static bool write_pictures(bending_run *run) {
    char title[160];
    draw_error error = {""};
    snprintf(title, sizeof title, "%s: %s %.4g m", run->scene.name,
             run->scene.probe == MSPRING_NONE ? "mean displacement" : "bending", run->settled.drop);
    if ((run->picture[0] || run->svg[0]) && !draw_final(run, title, &error))
        return fail(error.text);
    if (run->animation[0] && !film_write(&run->film, run->animation, title, &error))
        return fail(error.text);
    if (run->options->csv)
        return true;
    const char *const written[] = {run->picture, run->svg, run->animation};
    for (int i = 0; i < 3; i++)
        if (written[i][0])
            printf("  written       %s\n", written[i]);
    return true;
}

static void print_report(const bending_run *run) {
    if (run->options->csv_header)
        report_print_csv_header();
    if (run->options->csv)
        report_print_csv(run->network, &run->scene, run->options, &run->settled, &run->measures);
    else if (run->settled.end == SETTLE_AT_REST)
        report_print_table(run->network, &run->scene, run->options, &run->settled, &run->measures);
}

static bool run_all(bending_run *run) {
    if (!load_scene(run) || !make_network(run) || !choose_files(run))
        return false;
    bool settled = settle(run);
    print_report(run);
    return settled && write_pictures(run);
}

int main(int count, char **arguments) {
    bending_options options;
    switch (options_read(count, arguments, &options)) {
    case OPTIONS_OK:
        break;
    case OPTIONS_HELP:
        return EXIT_SUCCESS;
    case OPTIONS_WRONG:
        return 2;
    }
    bending_run run = {.options = &options};
    bool ok = run_all(&run);
    film_free(&run.film);
    network_shape_free(&run.shape);
    mspring_network_destroy(run.network);
    scene_free(&run.scene);
    if (fflush(stdout) != 0)
        ok = fail("cannot write the results: is the disk full?");
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
