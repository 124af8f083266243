/// @file 16_ships.c
/// Two ships ram each other, seen from the side: hulls crumple, plates break, wrecks stay apart.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"
#include "scenes/scene.h"

#include <massspring/massspring.h>
#include <stdio.h>

enum { STEPS = 384 };

static mspring_result launch(const scene *ships, mspring_network **network) {
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 40, def.settings.gravity_y = 0; // the water bears them
    def.settings.global_damping = 0.1f;                     // 1/s
    mspring_result result = mspring_network_create(ships->builder, &def, network);
    if (result)
        return result;
    const uint32_t particles = mspring_network_count(*network, MSPRING_PARTICLES);
    const uint32_t springs = mspring_network_count(*network, MSPRING_SPRINGS);
    mspring_contact_def contact = mspring_contact_def_default();
    contact.friction = 0.4f;
    result = mspring_network_set_contact(*network, &contact);
    result = result ? result
                    : mspring_network_set(*network, MSPRING_BREAK_STRAIN, NULL, 0, springs, ships->break_strain, 1);
    return result ? result
                  : mspring_network_set_velocities(*network, NULL, 0, particles, ships->velocity,
                                                   ships->velocity + 1, 2);
}

int main(int count, char **arguments) {
    const double dt = 1.0 / 64; // s
    scene_options options = scene_options_default();
    options.damping = 4000; // N s/m
    scene ships;
    scene_error error;
    if (!scene_ships(&options, &ships, &error)) {
        fprintf(stderr, "16_ships: %s\n", error.text);
        return 1;
    }
    mspring_network *network = NULL;
    mspring_result result = launch(&ships, &network);
    show shown;
    show_begin(&shown, count, arguments, "16_ships", "Two ships ram each other.", network, 0.02);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, dt);
    const int code = show_end(&shown, result, ships.builder, network);
    ships.builder = NULL; // the show is over for both
    scene_free(&ships);
    return code;
}
