/// @file 18_jellies.c
/// A pit of jellies that a bar stirs: a collider of the host moves, soft bodies give way.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"
#include "scenes/scene.h"

#include <massspring/massspring_contact.h>
#include <math.h>
#include <stdio.h>

enum { JELLIES = 24, STEPS = 64 * 20, STIRRED = 64 * 3 };

int main(int count, char **arguments) {
    static const double bar[] = {-1, -5, 1, -5, 1, 5, -1, 5};
    const double dt = 1.0 / 64; // s
    const scene_options options = scene_options_default();
    scene jellies;
    scene_error error;
    if (!scene_jellies(JELLIES, &options, &jellies, &error)) {
        fprintf(stderr, "18_jellies: %s\n", error.text);
        return 1;
    }
    mspring_network_def settings;
    mspring_network_def_init(&settings, sizeof settings);
    settings.substeps = 20;
    mspring_network *network = NULL;
    mspring_result result = mspring_network_create(jellies.builder, &settings, &network);
    mspring_contact_def contact;
    mspring_contact_def_init(&contact, sizeof contact);
    contact.friction = 0.2f;
    result = result ? result : mspring_network_set_contact(network, &contact);
    mspring_collider_def stirrer;
    mspring_collider_def_init(&stirrer, sizeof stirrer);
    stirrer.points = bar, stirrer.point_count = 4, stirrer.flags = MSPRING_COLLIDER_CLOSED;
    stirrer.x = 28, stirrer.y = 50; // m
    mspring_id collider = MSPRING_NONE;
    result = result ? result : mspring_network_add_collider(network, &stirrer, &collider);
    show shown;
    show_begin(&shown, count, arguments, "18_jellies", "A bar stirs a pit of jellies.", network, 0.2);
    shown.film.corners = bar, shown.film.corner_count = 4;
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network)) {
        const double t = step < STIRRED ? 0 : (step - STIRRED) * dt; // s, first they fall
        const double y = 33.5 + 16.5 * cos(0.5 * fmin(t, 6.28));     // it comes down in 6.3 s
        const double x = 28 + 12 * sin(0.4 * t), angle = 0.4 * t;
        result = mspring_network_move_collider(network, collider, x, y, angle);
        result = result ? result : mspring_network_step(network, dt);
        shown.film.place[0] = x, shown.film.place[1] = y, shown.film.place[2] = angle;
    }
    const int code = show_end(&shown, result, jellies.builder, network);
    jellies.builder = NULL; // the show is over for both
    scene_free(&jellies);
    return code;
}
