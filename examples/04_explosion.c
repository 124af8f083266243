/// @file 04_explosion.c
/// Springs too stiff for the step make a bar explode; a shorter step cures it.
///
/// SPDX-License-Identifier: MIT
#include "common/check.h"
#include "common/output.h"
#include "draw/network_picture.h"
#include "draw/plot.h"
#include "scenes/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 80, ROWS = 5, PARTICLES = COLUMNS * ROWS, MOST_FRAMES = 2000 };

// Frames in which the bar still fits a picture are drawn: the last one before it is this many metres tall.
static const double drawn_height = 120;

typedef struct experiment {
    float stiffness; // N/m
    double dt;       // s
    const char *name;
} experiment;

// What was seen of it.
typedef struct observation {
    double times[MOST_FRAMES], speeds[MOST_FRAMES]; // of the fastest particle, m/s
    size_t count;
    double x[PARTICLES], y[PARTICLES]; // the last positions that still fit a picture
    bool unstable;
    char message[256];
} observation;

static mspring_result keep_positions(const mspring_network *network, observation *seen) {
    mspring_body body = mspring_body_default();
    const mspring_result result = mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &body);
    if (result || body.max_y - body.min_y > drawn_height || body.max_x - body.min_x > 2 * drawn_height)
        return result;
    return mspring_network_get_positions(network, NULL, 0, PARTICLES, seen->x, seen->y, 1);
}

// Steps until the library rejects a step, or for MOST_FRAMES.
static mspring_result observe(mspring_network *network, double dt, observation *seen) {
    mspring_result result = MSPRING_OK;
    mspring_energy energy = mspring_energy_default();
    while (result == MSPRING_OK && seen->count < MOST_FRAMES) {
        result = mspring_network_step(network, dt);
        if (result == MSPRING_ERROR_UNSTABLE) {
            seen->unstable = true;
            snprintf(seen->message, sizeof seen->message, "%s: %s", mspring_result_string(result),
                     mspring_network_error(network));
            return MSPRING_OK;
        }
        if (result == MSPRING_OK)
            result = mspring_network_get_energy(network, &energy);
        if (result == MSPRING_OK)
            result = keep_positions(network, seen);
        seen->speeds[seen->count] = energy.largest_speed;
        seen->times[seen->count] = (double)(seen->count + 1) * dt;
        seen->count++;
    }
    return result;
}

static bool draw_bar(const network_shape *shape, const observation *seen, const char *folder, const char *name) {
    char title[128];
    world_box box = world_box_add(network_shape_bounds(shape), seen->x, seen->y, PARTICLES);
    // An explosion's strains have no scale of their own.
    double limit = fmin(network_strain_limit(shape, seen->x, seen->y), 1);
    network_view view = network_view_fit(shape, box, 1200, 900, limit);
    figure picture;
    figure_start(&picture, view.width, view.height, 0xffffff);
    snprintf(title, sizeof title, "%s after %zu steps", seen->unstable ? "explodes: rejected" : "stable",
             seen->count);
    network_picture_draw(&picture, shape, &view, seen->x, seen->y, title);
    bool ok = output_figure(&picture, folder, name);
    figure_free(&picture);
    return ok;
}

static bool run(const experiment *tried, observation *seen, const char *folder) {
    scene_options options = scene_options_default();
    scene_error error = {""};
    draw_error drawing_error = {""};
    scene bar;
    options.stiffness = tried->stiffness;
    options.damping = 55.05f;
    if (!scene_bar(COLUMNS, ROWS, &options, &bar, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return false;
    }
    mspring_network *network = NULL;
    network_shape shape = {0};
    mspring_network_def def = mspring_network_def_default();
    // The guard would reject the first step that is too long, and there would be nothing to see.
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.settings.substeps = 1;
    mspring_result result = mspring_network_create(bar.builder, &def, &network);
    bool ok = check(result, "make the bar", mspring_builder_error(bar.builder));
    if (ok && !(ok = network_shape_make(&shape, network, MSPRING_NONE, &drawing_error)))
        fprintf(stderr, "%s\n", drawing_error.text);
    if (ok) {
        result = observe(network, tried->dt, seen);
        ok = check(result, "step", mspring_network_error(network));
    }
    ok = ok && draw_bar(&shape, seen, folder, tried->name);
    network_shape_free(&shape);
    mspring_network_destroy(network);
    scene_free(&bar);
    return ok;
}

static bool draw_speeds(const observation *exploding, const observation *cured, const char *folder) {
    const plot_curve curves[] = {
        {exploding->times, exploding->speeds, exploding->count, PLOT_COLOUR_2, "k = 139000, dt = 1/64 s"},
        {cured->times, cured->speeds, cured->count, PLOT_COLOUR_1, "k = 229376, dt = 0.006198 s"},
    };
    const plot drawn = {
        .title = "A bar that explodes, and its cure",
        .x_label = "time, s",
        .y_label = "fastest particle, m/s",
        .curves = curves,
        .curve_count = 2,
        .log_y = true,
    };
    figure picture;
    figure_start(&picture, 900, 420, 0xffffff);
    plot_draw(&picture, &drawn);
    bool ok = output_figure(&picture, folder, "04_explosion_speed");
    figure_free(&picture);
    return ok;
}

static void print_speeds(const experiment *tried, const observation *seen) {
    printf("\nk = %g N/m, dt = %g s\n", tried->stiffness, tried->dt);
    size_t every = seen->count / 10 ? seen->count / 10 : 1;
    for (size_t i = every - 1; i < seen->count; i += every)
        printf("  step %5zu   fastest particle %12.4g m/s\n", i + 1, seen->speeds[i]);
    if (seen->unstable)
        printf("  step %5zu   rejected: %s\n", seen->count + 1, seen->message);
    else
        printf("  stable for %zu steps\n", seen->count);
}

int main(int count, char **arguments) {
    static const experiment exploding = {139000, 1.0 / 64, "04_explosion"};
    static const experiment cure = {229376, 0.006198, "04_cure"};
    static observation exploding_seen, cure_seen;
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "04_explosion: springs too stiff for the step, and a step short enough.", &exit_code);
    if (!folder)
        return exit_code;
    if (!run(&exploding, &exploding_seen, folder) || !run(&cure, &cure_seen, folder) ||
        !draw_speeds(&exploding_seen, &cure_seen, folder))
        return EXIT_FAILURE;
    print_speeds(&exploding, &exploding_seen);
    print_speeds(&cure, &cure_seen);
    return EXIT_SUCCESS;
}
