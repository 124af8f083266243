/// @file 01_spring.c
/// One spring: one end pinned, the other pulled out and let go, without and with a damper.
///
/// This is the shortest program that uses the library: a builder, a network, steps.
///
/// SPDX-License-Identifier: MIT
#include "common/check.h"
#include "common/output.h"
#include "draw/plot.h"

#include <massspring/massspring.h>

#include <stdio.h>
#include <stdlib.h>

static const float mass = 73.3975f;      // kg
static const float stiffness = 36700;    // N/m
static const float damping = 55.05f;     // N s/m
static const double dt = 1.0 / 64;       // s
static const double rest_length = 1;     // m
static const double pulled_length = 1.5; // m

enum { STEPS = 3 * 64 };

// Two particles and a spring. Returns NULL, with a message on stderr, if that fails: the builder keeps its first
// failure, and mspring_network_create() returns it.
static mspring_network *make_spring(float spring_damping) {
    mspring_builder *builder = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_particle_def particle = mspring_particle_def_default();
    particle.mass = mass;
    particle.flags = MSPRING_PARTICLE_PINNED;
    mspring_builder_add_particles(builder, &particle, 1, NULL);
    particle.flags = 0;
    particle.x = pulled_length;
    mspring_builder_add_particles(builder, &particle, 1, NULL);

    mspring_spring_def spring = mspring_spring_def_default();
    spring.a = 0;
    spring.b = 1;
    spring.stiffness = stiffness;
    spring.damping = spring_damping;
    spring.rest_length = (float)rest_length;
    mspring_builder_add_springs(builder, &spring, 1, NULL);

    mspring_network_def def = mspring_network_def_default();
    def.settings.gravity_y = 0;
    def.settings.substeps = 1;
    mspring_network *network = NULL;
    if (result == MSPRING_OK)
        result = mspring_network_create(builder, &def, &network);
    check(result, "make the spring", mspring_builder_error(builder));
    mspring_builder_destroy(builder);
    return network;
}

// Notes where the free end is before each step.
static bool swing(float spring_damping, double *positions) {
    mspring_network *network = make_spring(spring_damping);
    bool ok = network != NULL;
    for (int i = 0; ok && i <= STEPS; i++) {
        double y = 0;
        mspring_result result = mspring_network_get_positions(network, NULL, 1, 1, &positions[i], &y, 1);
        if (result == MSPRING_OK)
            result = mspring_network_step(network, dt);
        ok = check(result, "step", mspring_network_error(network));
    }
    mspring_network_destroy(network);
    return ok;
}

static bool draw(const double *times, const double *free_end, const double *damped_end, const char *folder) {
    const plot_curve curves[] = {
        {times, free_end, STEPS + 1, PLOT_COLOUR_1, "no damper"},
        {times, damped_end, STEPS + 1, PLOT_COLOUR_2, "55.05 N s/m"},
    };
    const plot drawn = {
        .title = "One spring, k = 36700 N/m, dt = 1/64 s",
        .x_label = "time, s",
        .y_label = "free end, m",
        .curves = curves,
        .curve_count = 2,
    };
    figure picture;
    figure_start(&picture, 900, 420, 0xffffff);
    plot_draw(&picture, &drawn);
    bool ok = output_figure(&picture, folder, "01_spring");
    figure_free(&picture);
    return ok;
}

int main(int count, char **arguments) {
    static double times[STEPS + 1], free_end[STEPS + 1], damped_end[STEPS + 1];
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "01_spring: one spring, pulled out and let go, without and with a damper.", &exit_code);
    if (!folder)
        return exit_code;
    if (!swing(0, free_end) || !swing(damping, damped_end))
        return EXIT_FAILURE;
    printf("  time   free end   with a damper\n");
    for (int i = 0; i <= STEPS; i++) {
        times[i] = i * dt;
        if (i % 12 == 0)
            printf("%6.3f s  %6.3f m        %6.3f m\n", times[i], free_end[i], damped_end[i]);
    }
    return draw(times, free_end, damped_end, folder) ? EXIT_SUCCESS : EXIT_FAILURE;
}
