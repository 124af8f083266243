/// @file hold.c
/// Colliders and grips of a case.
///
/// SPDX-License-Identifier: MIT
#include "map/hold.h"

#include <math.h>
#include <stdio.h>

/// Length of a wedge's sides, m.
static const double side_length = 1e4;

/// Distance of a place from both sides of the wedge, m; < 0: beyond.
static double distance(const map_case *what, double x, double y) {
    return (what->apex_x - x) * sin(what->wedge_angle) - fabs(y - what->apex_y) * cos(what->wedge_angle);
}

void map_hold_place_wedge(map_case *drawn, double gap) {
    const double least = drawn->contact.thickness + drawn->wedge_radius + gap;
    double left, bottom, right, top, more = 0;
    map_body_box(&drawn->body, &left, &bottom, &right, &top);
    drawn->apex_x = right;
    drawn->apex_y = (bottom + top) / 2;
    for (uint32_t i = 0; i < drawn->body.particle_count; i++) {
        const mspring_particle_def *at = &drawn->body.particles[i];
        more = fmax(more, least - distance(drawn, at->x, at->y));
    }
    drawn->apex_x += more / sin(drawn->wedge_angle);
}

static mspring_result add_wedge(map_watch *watch) {
    const map_case *what = watch->what;
    const double x = what->apex_x - side_length * cos(what->wedge_angle);
    const double y = side_length * sin(what->wedge_angle);
    const double points[] = {x, what->apex_y - y, what->apex_x, what->apex_y, x, what->apex_y + y};
    mspring_collider_def def = mspring_collider_def_default();
    def.points = points;
    def.point_count = 3;
    def.radius = what->wedge_radius;
    def.friction = what->contact.friction;
    return mspring_network_add_collider(watch->network, &def, &watch->wedge);
}

bool map_hold_begin(map_watch *watch) {
    const map_case *what = watch->what;
    mspring_result result = what->has_wedge ? add_wedge(watch) : MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < what->grip_count; i++)
        result = mspring_network_add_grip(watch->network, &what->grips[i], &watch->grips[i]);
    return result == MSPRING_OK;
}

mspring_result map_hold_move(const map_watch *watch) {
    const map_case *what = watch->what;
    const double x = what->drift_x * (watch->time + what->dt), y = what->drift_y * (watch->time + what->dt);
    mspring_result result = MSPRING_OK;
    if (x == 0 && y == 0)
        return result;
    if (what->has_wedge)
        result = mspring_network_move_collider(watch->network, watch->wedge, x, y, 0);
    for (uint32_t i = 0; result == MSPRING_OK && i < what->grip_count; i++)
        result =
            mspring_network_move_grip(watch->network, watch->grips[i], what->grips[i].x + x, what->grips[i].y + y);
    return result;
}

void map_hold_add_energy(map_watch *watch) {
    const map_case *what = watch->what;
    for (uint32_t i = 0; i < what->grip_count; i++) {
        const mspring_grip_def *grip = &what->grips[i];
        const double x = watch->x[grip->particle] - (grip->x + what->drift_x * watch->time);
        const double y = watch->y[grip->particle] - (grip->y + what->drift_y * watch->time);
        const double k = (double)grip->stiffness, most = (double)grip->max_force, length = hypot(x, y);
        const double force = fmin(k * length, most), off = 1.5 * watch->last_place;
        watch->elastic += k * length <= most ? 0.5 * k * length * length : most * (length - 0.5 * most / k);
        watch->rounding += force * off + 0.5 * k * off * off;
    }
    // What a linear system leaves to the others is of the size of what grips give.
    for (uint32_t i = 0; i < watch->component_count && what->grip_count > 0; i++)
        watch->components[i].is_held = true;
}

map_verdict map_hold_judge(map_judge *judge) {
    const map_watch *watch = judge->watch;
    const map_case *what = watch->what;
    for (uint32_t i = 0; what->has_wedge && i < watch->count; i++) {
        const double over =
            distance(what, watch->x[i] - what->drift_x * watch->time, watch->y[i] - what->drift_y * watch->time);
        if (over < 0) {
            snprintf(judge->text, sizeof judge->text, "particle %u is %.3g m beyond a wall", i, -over);
            return MAP_CROSSED;
        }
    }
    return MAP_HOLDS;
}
