/// @file 02_square.c
/// A square of particles, one corner pulled out and let go: it wobbles, for ever or, with dampers, for a while.
///
/// SPDX-License-Identifier: MIT
#include "common/check.h"
#include "common/output.h"
#include "draw/film.h"
#include "draw/plot.h"

#include <massspring/massspring.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double dt = 1.0 / 64;   // s
static const float damping = 55.05f; // N s/m

enum { SIDE = 4, CORNER = SIDE - 1, OPPOSITE = (SIDE - 1) * SIDE, STEPS = 4 * 64, FILM_STEPS = 64 };

// A lattice is the short way to particles on a grid with springs between all neighbours.
static mspring_network *make_square(float spring_damping) {
    mspring_builder *builder = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_material material = mspring_material_default();
    material.mass = 73.3975f;
    material.stiffness = 36700;
    material.damping = spring_damping;

    mspring_lattice_def lattice = mspring_lattice_def_default();
    lattice.width = lattice.height = SIDE;
    lattice.materials = &material;
    mspring_builder_add_lattice(builder, &lattice, NULL);

    mspring_network_def def = mspring_network_def_default();
    def.settings.gravity_y = 0;
    def.settings.substeps = 1;
    mspring_network *network = NULL;
    if (result == MSPRING_OK)
        result = mspring_network_create(builder, &def, &network);
    check(result, "make the square", mspring_builder_error(builder));
    mspring_builder_destroy(builder);
    return network;
}

// From the corner at the top right to the one at the bottom left.
static mspring_result measure_diagonal(const mspring_network *network, double *length) {
    double x[SIDE * SIDE], y[SIDE * SIDE];
    const mspring_result result = mspring_network_get_positions(network, NULL, 0, SIDE * SIDE, x, y, 1);
    if (result == MSPRING_OK)
        *length = hypot(x[CORNER] - x[OPPOSITE], y[CORNER] - y[OPPOSITE]);
    return result;
}

static mspring_result wobble(mspring_network *network, film *filmed, double *diagonals) {
    const double pulled_to = SIDE - 1 + 0.6;
    mspring_result result = mspring_network_set_positions(network, NULL, CORNER, 1, &pulled_to, &pulled_to, 1);
    for (int i = 0; result == MSPRING_OK && i <= STEPS; i++) {
        if (i <= FILM_STEPS)
            film_step(filmed, network);
        result = measure_diagonal(network, &diagonals[i]);
        if (result == MSPRING_OK)
            result = mspring_network_step(network, dt);
    }
    return result;
}

static bool film_square(float spring_damping, const char *folder, const char *name, double *diagonals) {
    char path[OUTPUT_PATH_SIZE];
    draw_error error = {""};
    network_shape shape = {0};
    film filmed = {0};
    mspring_network *network = make_square(spring_damping);
    bool ok = network && output_path(path, folder, name, ".png");
    ok = ok && network_shape_make(&shape, network, MSPRING_NONE, &error) && film_start(&filmed, &shape, &error);
    if (ok) {
        const mspring_result result = wobble(network, &filmed, diagonals);
        ok = check(result, "step", mspring_network_error(network));
    }
    ok = ok && film_write(&filmed, path, spring_damping > 0 ? "with dampers" : "without dampers", &error);
    if (ok)
        printf("written %s\n", path);
    else if (error.text[0])
        fprintf(stderr, "%s\n", error.text);
    film_free(&filmed);
    network_shape_free(&shape);
    mspring_network_destroy(network);
    return ok;
}

static bool draw(const double *times, const double *undamped, const double *damped, const char *folder) {
    const plot_curve curves[] = {
        {times, undamped, STEPS + 1, PLOT_COLOUR_1, "no dampers"},
        {times, damped, STEPS + 1, PLOT_COLOUR_2, "55.05 N s/m"},
    };
    const plot drawn = {
        .title = "A square of 4 x 4 particles, k = 36700 N/m, dt = 1/64 s",
        .x_label = "time, s",
        .y_label = "diagonal, m",
        .curves = curves,
        .curve_count = 2,
    };
    figure picture;
    figure_start(&picture, 900, 420, 0xffffff);
    plot_draw(&picture, &drawn);
    bool ok = output_figure(&picture, folder, "02_square");
    figure_free(&picture);
    return ok;
}

int main(int count, char **arguments) {
    static double times[STEPS + 1], undamped[STEPS + 1], damped[STEPS + 1];
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "02_square: a square whose corner is pulled out wobbles, without and with dampers.",
        &exit_code);
    if (!folder)
        return exit_code;
    if (!film_square(0, folder, "02_square_undamped", undamped) ||
        !film_square(damping, folder, "02_square_damped", damped))
        return EXIT_FAILURE;
    printf("  time     diagonal   with dampers\n");
    for (int i = 0; i <= STEPS; i++) {
        times[i] = i * dt;
        if (i % 16 == 0)
            printf("%6.3f s   %6.3f m      %6.3f m\n", times[i], undamped[i], damped[i]);
    }
    return draw(times, undamped, damped, folder) ? EXIT_SUCCESS : EXIT_FAILURE;
}
