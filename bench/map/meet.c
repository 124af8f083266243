/// @file meet.c
/// Two bodies in one network, and whether they stay two.
///
/// SPDX-License-Identifier: MIT
#include "map/meet.h"

#include <math.h>
#include <stdio.h>

#include <massspring/massspring.h>

/// A quarter of the spacing, of which the thickness is 0.4.
static const double deepest_share = 0.25 / 0.4;

void map_add_body(map_case *drawn, const map_body *second, double gap) {
    map_body *body = &drawn->body;
    double left, bottom, right, top, low, unused;
    map_body_box(body, &left, &bottom, &right, &top);
    map_body_box(second, &low, &unused, &unused, &unused);
    const uint32_t first = drawn->first_count = body->particle_count;
    for (uint32_t i = 0; i < second->particle_count; i++) {
        mspring_particle_def *def = &body->particles[body->particle_count++];
        *def = second->particles[i];
        def->x += right + gap - low;
    }
    for (uint32_t i = 0; i < second->spring_count; i++) {
        mspring_spring_def *def = &body->springs[body->spring_count++];
        *def = second->springs[i];
        def->a += first;
        def->b += first;
    }
}

/// Twice the area of the triangle from a spring to a particle, > 0 on its left.
static double side_of(const map_watch *watch, const map_spring *spring, mspring_id p) {
    const double x = watch->x[spring->b] - watch->x[spring->a], y = watch->y[spring->b] - watch->y[spring->a];
    return x * (watch->y[p] - watch->y[spring->a]) - y * (watch->x[p] - watch->x[spring->a]);
}

static bool cross(const map_watch *watch, const map_spring *one, const map_spring *other) {
    return side_of(watch, one, other->a) * side_of(watch, one, other->b) < 0 &&
           side_of(watch, other, one->a) * side_of(watch, other, one->b) < 0;
}

map_verdict map_meet_judge(map_judge *judge) {
    const map_watch *watch = judge->watch;
    const uint32_t first = watch->what->first_count;
    if (first == 0)
        return MAP_HOLDS;
    if (watch->deepest > deepest_share * watch->what->contact.thickness) {
        snprintf(judge->text, sizeof judge->text, "overlap of %.3g m at a thickness of %.3g m", watch->deepest,
                 watch->what->contact.thickness);
        return MAP_CROSSED;
    }
    for (uint32_t i = 0; i < watch->spring_count; i++)
        for (uint32_t j = 0; j < watch->spring_count && watch->springs[i].a < first; j++)
            if (watch->springs[j].a >= first && cross(watch, &watch->springs[i], &watch->springs[j])) {
                snprintf(judge->text, sizeof judge->text, "springs of two bodies cross: %u-%u and %u-%u",
                         watch->springs[i].a, watch->springs[i].b, watch->springs[j].a, watch->springs[j].b);
                return MAP_CROSSED;
            }
    return MAP_HOLDS;
}
