/// @file side_edits.c
/// What the mouse does to a network.
///
/// SPDX-License-Identifier: MIT
#include "lab/side.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

static bool accepted(lab_side *side, mspring_result result) {
    if (result != MSPRING_OK)
        snprintf(side->complaint, sizeof side->complaint, "%s", mspring_network_error(side->network));
    return result == MSPRING_OK;
}

// Lists the particles within a radius, or the nearest one. Returns how many; the list is side->held, which is free
// while nothing is held.
static uint32_t list_near(lab_side *side, double x, double y, double radius) {
    uint32_t count;
    if (mspring_network_particles_in_circle(side->network, x, y, radius, side->held, side->stage->particle_count,
                                            &count) != MSPRING_OK)
        count = 0;
    if (count == 0)
        side->held[count++] = side_nearest(side, x, y);
    return count;
}

void side_grab(lab_side *side, double x, double y, double radius) {
    side->held_count = list_near(side, x, y, radius);
    for (uint32_t i = 0; i < side->held_count; i++)
        side_position(side, side->held[i], &side->held_x[i], &side->held_y[i]);
    side->pull_x = side->pull_y = 0;
}

void side_pull(lab_side *side, double x, double y) {
    side->pull_x = x;
    side->pull_y = y;
}

void side_drop(lab_side *side) {
    side->held_count = 0;
}

bool side_pin(lab_side *side, double x, double y, double radius, bool pin) {
    side_drop(side);
    const uint32_t count = list_near(side, x, y, radius);
    const float scale = pin ? 0 : 1, still = 0;
    for (uint32_t i = 0; i < count; i++) {
        const mspring_id particle = side->held[i];
        if (!accepted(side, mspring_network_set(side->network, MSPRING_INVERSE_MASS_SCALE, NULL, particle, 1,
                                                &scale, 1)) ||
            !accepted(side, mspring_network_set_velocities(side->network, NULL, particle, 1, &still, &still, 1)))
            return false;
    }
    return true;
}

static bool break_listed(lab_side *side, const mspring_id *springs, uint32_t count) {
    return count == 0 || accepted(side, mspring_network_break_springs(side->network, springs, 0, count));
}

bool side_cut(lab_side *side, double x, double y, double x2, double y2) {
    const lab_stage *stage = side->stage;
    mspring_id *list = malloc((stage->spring_count ? stage->spring_count : 1) * sizeof *list);
    uint32_t count = 0;
    const bool ok = list &&
                    accepted(side, mspring_network_springs_across(side->network, x, y, x2, y2, MSPRING_FIND_WHOLE,
                                                                  list, NULL, stage->spring_count, &count)) &&
                    break_listed(side, list, count);
    free(list);
    return ok;
}

bool side_blast(lab_side *side, double x, double y, double radius, double speed) {
    const lab_stage *stage = side->stage;
    side_drop(side);
    // Springs near the middle break; all particles within the radius fly off, the slower the farther they are.
    mspring_id *list = malloc((stage->spring_count ? stage->spring_count : 1) * sizeof *list);
    uint32_t count = 0;
    for (uint32_t i = 0; list && i < stage->spring_count; i++) {
        double ax, ay, bx, by;
        side_position(side, stage->a[i], &ax, &ay);
        side_position(side, stage->b[i], &bx, &by);
        const double from_x = 0.5 * (ax + bx) - x, from_y = 0.5 * (ay + by) - y;
        if (from_x * from_x + from_y * from_y < 0.16 * radius * radius)
            list[count++] = i;
    }
    const bool ok = list && break_listed(side, list, count);
    free(list);
    for (mspring_id i = 0; ok && i < stage->particle_count; i++) {
        double px, py;
        side_position(side, i, &px, &py);
        const double distance = sqrt((px - x) * (px - x) + (py - y) * (py - y));
        if (distance >= radius || side_is_pinned(side, i))
            continue;
        const uint32_t slot = side->view.slot_of_particle[i];
        const double kick = distance > 0 ? speed * (1 - distance / radius) / distance : 0;
        const float vx = (float)(side->view.vx[slot] + kick * (px - x));
        const float vy = (float)(side->view.vy[slot] + kick * (py - y));
        if (!accepted(side, mspring_network_set_velocities(side->network, NULL, i, 1, &vx, &vy, 1)))
            return false;
    }
    return ok;
}

bool side_copy_state(lab_side *side, const lab_side *from) {
    const uint32_t particles = side->stage->particle_count, springs = side->stage->spring_count;
    double *x = malloc(particles * sizeof *x), *y = malloc(particles * sizeof *y);
    float *vx = malloc(particles * sizeof *vx), *vy = malloc(particles * sizeof *vy);
    mspring_id *list = malloc((springs ? springs : 1) * sizeof *list);
    bool ok = x && y && vx && vy && list;
    if (ok) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < springs; i++)
            if (from->broken[i])
                list[count++] = i;
        ok = accepted(side, mspring_network_get_positions(from->network, NULL, 0, particles, x, y, 1)) &&
             accepted(side, mspring_network_get_velocities(from->network, NULL, 0, particles, vx, vy, 1)) &&
             accepted(side, mspring_network_set_positions(side->network, NULL, 0, particles, x, y, 1)) &&
             accepted(side, mspring_network_set_velocities(side->network, NULL, 0, particles, vx, vy, 1)) &&
             break_listed(side, list, count) && side_copy_bent(side, from);
        for (uint32_t i = 0; ok && i < particles; i++) {
            const float scale = side_is_pinned(from, i) ? 0 : 1;
            if (side_is_pinned(from, i) != side_is_pinned(side, i))
                ok = accepted(
                    side, mspring_network_set(side->network, MSPRING_INVERSE_MASS_SCALE, NULL, i, 1, &scale, 1));
        }
        ok = ok && accepted(side, mspring_network_get_view(side->network, &side->view));
    }
    free(x);
    free(y);
    free(vx);
    free(vy);
    free(list);
    return ok;
}
