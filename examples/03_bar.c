/// @file 03_bar.c
/// The bending bar: rubber with one substep in a step, iron with thirty.
///
/// How stiff a spring may be depends on the length of a substep. Thirty substeps bear springs that are 900 times
/// as stiff.
///
/// SPDX-License-Identifier: MIT
#include "common/check.h"
#include "common/output.h"
#include "draw/film.h"
#include "scenes/scene.h"

#include <stdio.h>
#include <stdlib.h>

static const double dt = 1.0 / 64; // s

enum { COLUMNS = 80, ROWS = 5, SECONDS = 6, STEPS = SECONDS * 64 };

// A bar and how it is stepped.
typedef struct bar {
    const char *name, *title;
    float stiffness, damping;
    uint32_t substeps;
} bar;

static mspring_result run(mspring_network *network, mspring_id probe, film *filmed, double *lowest) {
    mspring_result result = MSPRING_OK;
    *lowest = ROWS - 1;
    for (int i = 0; result == MSPRING_OK && i <= STEPS; i++) {
        double x = 0, y = 0;
        film_step(filmed, network);
        result = mspring_network_get_positions(network, NULL, probe, 1, &x, &y, 1);
        if (result == MSPRING_OK)
            result = mspring_network_step(network, dt);
        *lowest = y < *lowest ? y : *lowest;
    }
    return result;
}

static bool draw_end(const network_shape *shape, const film *filmed, const char *title, const char *folder,
                     const char *name) {
    const double *x = film_last_x(filmed);
    const double *y = film_last_y(filmed);
    world_box box = world_box_add(network_shape_bounds(shape), x, y, shape->particle_count);
    network_view view = network_view_fit(shape, box, 1200, 900, network_strain_limit(shape, x, y));
    figure picture;
    figure_start(&picture, view.width, view.height, 0xffffff);
    network_picture_draw(&picture, shape, &view, x, y, title);
    bool ok = output_figure(&picture, folder, name);
    figure_free(&picture);
    return ok;
}

static bool film_bar(const bar *filmed_bar, mspring_network *network, mspring_id probe, const char *folder,
                     double *lowest) {
    char path[OUTPUT_PATH_SIZE];
    draw_error error = {""};
    network_shape shape = {0};
    film filmed = {0};
    bool ok = output_path(path, folder, filmed_bar->name, "_animation.png") &&
              network_shape_make(&shape, network, probe, &error) && film_start(&filmed, &shape, &error);
    if (ok) {
        const mspring_result result = run(network, probe, &filmed, lowest);
        ok = check(result, "step", mspring_network_error(network));
    }
    ok = ok && film_write(&filmed, path, filmed_bar->title, &error);
    if (ok)
        printf("written %s\n", path);
    else if (error.text[0])
        fprintf(stderr, "%s\n", error.text);
    ok = ok && draw_end(&shape, &filmed, filmed_bar->title, folder, filmed_bar->name);
    film_free(&filmed);
    network_shape_free(&shape);
    return ok;
}

static bool bend(const bar *bent, const char *folder, double *lowest) {
    scene_options options = scene_options_default();
    scene_error error = {""};
    scene made;
    options.stiffness = bent->stiffness;
    options.damping = bent->damping;
    if (!scene_bar(COLUMNS, ROWS, &options, &made, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return false;
    }
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = bent->substeps;
    mspring_network *network = NULL;
    const mspring_result result = mspring_network_create(made.builder, &def, &network);
    const bool ok = check(result, "make the bar", mspring_builder_error(made.builder)) &&
                    film_bar(bent, network, made.probe, folder, lowest);
    mspring_network_destroy(network);
    scene_free(&made);
    return ok;
}

int main(int count, char **arguments) {
    static const bar bars[] = {
        {"03_bar_rubber", "k = 36700 N/m, 1 substep", 36700, 55.05f, 1},
        {"03_bar_iron", "k = 6.76e7 N/m, 30 substeps", SCENE_IRON_STIFFNESS, 0, 30},
    };
    double lowest[2];
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "03_bar: a bar pinned at one end falls, once of rubber and once of iron.", &exit_code);
    if (!folder)
        return exit_code;
    for (int i = 0; i < 2; i++)
        if (!bend(&bars[i], folder, &lowest[i]))
            return EXIT_FAILURE;
    printf("bar of %d x %d particles, %d s\n", COLUMNS, ROWS, SECONDS);
    printf("%12s %10s %32s\n", "k, N/m", "substeps", "the free end comes down by, m");
    for (int i = 0; i < 2; i++)
        printf("%12.4g %10u %32.1f\n", bars[i].stiffness, bars[i].substeps, ROWS - 1 - lowest[i]);
    return EXIT_SUCCESS;
}
