/// @file 18_jellies.c
/// A pit of jellies that a bar stirs: a collider of the host moves, soft bodies give way. Each triangle of a jelly
/// has an area, so none stays inside out.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"
#include "scenes/scene.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>

enum { JELLIES = 24, STEPS = 64 * 20, STIRRED = 64 * 3 };

// Rings of a jelly, around a particle, and the particles of all: those of ring r begin with 1 + 3 r (r - 1).
enum { RINGS = 3, PARTICLES = 1 + 3 * RINGS * (RINGS + 1) };

static mspring_id vertex(uint32_t ring, uint32_t number) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + number % (6 * ring);
}

// Give an area to each triangle between two rings of a jelly: those with a side outside, and those with one inside.
static mspring_result add_areas(mspring_network *network, mspring_id jelly, const mspring_area_def *area) {
    mspring_result result = MSPRING_OK;
    for (uint32_t ring = 1; ring <= RINGS; ring++)
        for (uint32_t i = 0; !result && i < 6 * ring; i++) {
            const uint32_t inner = i / ring * (ring - 1) + i % ring;
            const mspring_id next = jelly + vertex(ring, i + 1), in = jelly + vertex(ring - 1, inner);
            const mspring_id outside[] = {jelly + vertex(ring, i), next, in};
            const mspring_id inside[] = {in, next, jelly + vertex(ring - 1, inner + 1)};
            result = mspring_network_add_area(network, area, outside, 3, NULL);
            if (!result && i % ring < ring - 1)
                result = mspring_network_add_area(network, area, inside, 3, NULL);
        }
    return result;
}

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
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 20;
    mspring_network *network = NULL;
    mspring_result result = mspring_network_create(jellies.builder, &def, &network);
    mspring_area_def area = mspring_area_def_default();
    area.stiffness = 4e5f; // N/m, half of the springs'
    const uint32_t particles = result ? 0 : mspring_network_count(network, MSPRING_PARTICLES);
    for (uint32_t i = 1; !result && i <= JELLIES; i++) // the pit is made first
        result = add_areas(network, particles - i * PARTICLES, &area);
    mspring_contact_def contact = mspring_contact_def_default();
    contact.friction = 0.2f;
    result = result ? result : mspring_network_set_contact(network, &contact);
    mspring_collider_def stirrer = mspring_collider_def_default();
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
