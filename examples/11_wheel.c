/// @file 11_wheel.c
/// A soft wheel rolls down a hill with bumps: a disc, a floor of heights and friction.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <math.h>

#include <massspring/massspring.h>

enum { HEIGHTS = 64, STEPS = 252 };

int main(int count, char **arguments) {
    mspring_material rubber = mspring_material_default();
    rubber.spring_flags = MSPRING_SPRING_DAMPING_RATIO, rubber.damping = 0.05f;
    mspring_disc_def wheel = mspring_disc_def_default();
    wheel.material = &rubber;
    wheel.x = 1, wheel.y = 4.85, wheel.radius = 0.8, wheel.ring_count = 3; // m
    wheel.area_density = 50, wheel.young_modulus = 1.2e4f;                 // kg/m^2, N/m
    float heights[HEIGHTS];                                                // m, every 0.25 m
    for (int i = 0; i < HEIGHTS; i++)
        heights[i] = 4 - 0.05f * (float)i + 0.2f * sinf(0.5f * (float)i);
    mspring_floor_def hill = mspring_floor_def_default();
    hill.heights = heights, hill.height_count = HEIGHTS, hill.spacing = 0.25, hill.friction = 0.8f;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_builder_add_disc(builder, &wheel, NULL, NULL);
    result = result ? result : mspring_network_create(builder, NULL, &network);
    result = result ? result : mspring_network_set_floor(network, &hill);
    show shown;
    show_begin(&shown, count, arguments, "11_wheel", "A soft wheel rolls down a hill.", network, 0.1);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, 1.0 / 64);
    return show_end(&shown, result, builder, network);
}
