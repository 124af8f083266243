/// @file watch.c
/// Reading a network from outside.
///
/// SPDX-License-Identifier: MIT
#include "map/watch.h"

#include <math.h>

#include <massspring/massspring.h>

#include "map/hold.h"

/* -------------------------------------------------------------------------------------------------- components */

static uint32_t root_of(const uint32_t *parents, uint32_t of) {
    while (parents[of] != of)
        of = parents[of];
    return of;
}

static void find_components(map_watch *watch) {
    uint32_t parents[MAP_PARTICLES], numbers[MAP_PARTICLES];
    for (uint32_t i = 0; i < watch->count; i++)
        parents[i] = i;
    for (uint32_t i = 0; i < watch->spring_count; i++) {
        const uint32_t a = root_of(parents, watch->springs[i].a), b = root_of(parents, watch->springs[i].b);
        parents[a > b ? a : b] = a < b ? a : b;
    }
    if (watch->what->first_count > 0) // each other's push is from within
        for (uint32_t i = 0; i < watch->count; i++)
            parents[i] = 0;
    watch->component_count = 0;
    for (uint32_t i = 0; i < watch->count; i++) {
        const uint32_t root = root_of(parents, i);
        if (root == i)
            numbers[i] = watch->component_count++;
        watch->component[i] = numbers[root];
    }
}

bool map_watch_springs(map_watch *watch) {
    watch->spring_count = 0;
    watch->shortest = INFINITY;
    for (mspring_id id = 0; id < mspring_network_count(watch->network, MSPRING_SPRINGS); id++) {
        mspring_id a, b;
        uint32_t flags;
        float stiffness, damping, rest_length;
        const mspring_column columns[] = {{MSPRING_END_A, 1, &a},
                                          {MSPRING_END_B, 1, &b},
                                          {MSPRING_SPRING_FLAGS, 1, &flags},
                                          {MSPRING_ACTIVE_STIFFNESS, 1, &stiffness},
                                          {MSPRING_ACTIVE_DAMPING, 1, &damping},
                                          {MSPRING_ACTIVE_REST_LENGTH, 1, &rest_length}};
        if (mspring_network_get_columns(watch->network, NULL, id, 1, columns, 6) != MSPRING_OK)
            return false;
        if ((flags & MSPRING_SPRING_BROKEN) != 0)
            continue;
        watch->shortest = fmin(watch->shortest, (double)rest_length);
        watch->springs[watch->spring_count++] =
            (map_spring){a, b, (double)stiffness, (double)damping, (double)rest_length};
    }
    find_components(watch);
    return true;
}

/* ------------------------------------------------------------------------------------------------------ forces */

static void add_outside_forces(map_watch *watch) {
    const map_case *what = watch->what;
    for (uint32_t i = 0; i < watch->count; i++) {
        const bool pinned = isinf(watch->mass[i]);
        watch->force_x[i] = watch->force_y[i] = 0;
        if (pinned)
            continue;
        const double weight_x = watch->mass[i] * (double)what->network.settings.gravity_x;
        const double weight_y = watch->mass[i] * (double)what->network.settings.gravity_y;
        const double held_x = (double)what->force_x[i], held_y = (double)what->force_y[i];
        const double x = watch->x[i] - what->drift_x * watch->time, y = watch->y[i] - what->drift_y * watch->time;
        watch->force_x[i] = weight_x + held_x;
        watch->force_y[i] = weight_y + held_y;
        watch->potential -= watch->force_x[i] * (x - watch->centre_x) + watch->force_y[i] * (y - watch->centre_y);
        watch->force += hypot(watch->force_x[i], watch->force_y[i]);
        watch->weight +=
            fabs(watch->force_x[i] * (x - watch->centre_x)) + fabs(watch->force_y[i] * (y - watch->centre_y));
        map_component *of = &watch->components[watch->component[i]];
        of->gravity_x += weight_x;
        of->gravity_y += weight_y;
        of->force_x += held_x;
        of->force_y += held_y;
    }
}

/// How far off a coordinate's last place may be, m: the origin stays within 64 m, or half as far as the body is
/// large.
static double last_place(const map_watch *watch) {
    double reach = 1, left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < watch->count; i++) {
        reach = fmax(reach, fmax(fabs(watch->x[i] - watch->centre_x), fabs(watch->y[i] - watch->centre_y)));
        left = fmin(left, watch->x[i]);
        right = fmax(right, watch->x[i]);
        low = fmin(low, watch->y[i]);
        high = fmax(high, watch->y[i]);
    }
    return fmin(reach, 2 * (64 + fmax(right - left, high - low))) * 0x1p-24;
}

static void add_springs(map_watch *watch) {
    watch->last_place = last_place(watch);
    const double off = 1.5 * watch->last_place; // two ends, two coordinates
    for (uint32_t i = 0; i < watch->spring_count; i++) {
        const map_spring *s = &watch->springs[i];
        const double dx = watch->x[s->b] - watch->x[s->a], dy = watch->y[s->b] - watch->y[s->a];
        const double length = sqrt(dx * dx + dy * dy), force = s->stiffness * (length - s->rest_length);
        watch->elastic += 0.5 * force * (length - s->rest_length);
        watch->rounding += fabs(force) * off + 0.5 * s->stiffness * off * off;
        const double most = fabs(force) + s->stiffness * off; // what acts where the length is rounded
        watch->rounding_squares += most * most * off * off;
        if (!(length > 0))
            continue;
        watch->force_x[s->a] += force * dx / length;
        watch->force_y[s->a] += force * dy / length;
        watch->force_x[s->b] -= force * dx / length;
        watch->force_y[s->b] -= force * dy / length;
    }
}

/* --------------------------------------------------------------------------------------------------- momentum */

static void add_particle(map_watch *watch, uint32_t i) {
    const map_case *what = watch->what;
    const double mass = watch->mass[i], vx = (double)watch->vx[i] - what->drift_x,
                 vy = (double)watch->vy[i] - what->drift_y;
    map_component *of = &watch->components[watch->component[i]];
    of->particle_count++;
    if (isinf(mass)) {
        of->is_held = true;
        return;
    }
    if (watch->floor_x[i] != 0 || watch->floor_y[i] != 0 || what->has_wedge)
        of->is_held = true;
    of->mass += mass;
    of->x += mass * watch->x[i];
    of->y += mass * watch->y[i];
    of->px += mass * (double)watch->vx[i];
    of->py += mass * (double)watch->vy[i];
    of->momentum_scale += mass * hypot((double)watch->vx[i], (double)watch->vy[i]);
    watch->speed = fmax(watch->speed, hypot(vx, vy));
    watch->kinetic += 0.5 * mass * (vx * vx + vy * vy);
    // What leapfrog keeps: T(w) + V - h^2/8 F'M^-1 F with w = v + (lag/2) F/m, which with a lag of h is
    // T(v) + V + h/2 v.F.
    if (what->network.settings.solver == MSPRING_SOLVER_EXPLICIT) {
        const double fx = watch->force_x[i], fy = watch->force_y[i], h = watch->substep, lag = watch->lag;
        watch->shadow += 0.5 * lag * (vx * fx + vy * fy) + (lag * lag - h * h) / 8 * (fx * fx + fy * fy) / mass;
    }
}

static void add_spins(map_watch *watch) {
    for (uint32_t i = 0; i < watch->component_count; i++) {
        map_component *of = &watch->components[i];
        if (of->mass > 0) {
            of->x /= of->mass;
            of->y /= of->mass;
        }
    }
    for (uint32_t i = 0; i < watch->count; i++) {
        map_component *of = &watch->components[watch->component[i]];
        const double mass = watch->mass[i], x = watch->x[i] - of->x, y = watch->y[i] - of->y;
        if (isinf(mass))
            continue;
        const double vx = (double)watch->vx[i] - of->px / of->mass, vy = (double)watch->vy[i] - of->py / of->mass;
        of->spin += mass * (x * vy - y * vx);
        of->spin_scale += mass * hypot(x, y) * hypot(vx, vy);
        of->spin_rounding += mass * hypot(x, y) * hypot((double)watch->vx[i], (double)watch->vy[i]);
    }
}

/* ------------------------------------------------------------------------------------------------------- state */

static bool read_state(map_watch *watch) {
    if (mspring_network_get_positions(watch->network, NULL, 0, watch->count, watch->x, watch->y, 1) != MSPRING_OK ||
        mspring_network_get_velocities(watch->network, NULL, 0, watch->count, watch->vx, watch->vy, 1) !=
            MSPRING_OK ||
        mspring_network_get_columns(watch->network, NULL, 0, watch->count,
                                    (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, watch->floor_x},
                                                             {MSPRING_FLOOR_IMPULSE_Y, 1, watch->floor_y}},
                                    2) != MSPRING_OK)
        return false;
    bool all = true;
    mspring_contact_info contact = mspring_contact_info_default();
    if (mspring_network_get_contact_info(watch->network, &contact) != MSPRING_OK)
        return false;
    watch->deepest = contact.deepest;
    for (uint32_t i = 0; i < watch->count; i++)
        all = all && isfinite(watch->x[i]) && isfinite(watch->y[i]) && isfinite(watch->vx[i]) &&
              isfinite(watch->vy[i]);
    return all;
}

bool map_watch_read(map_watch *watch) {
    static const map_component none = {0};
    if (!read_state(watch))
        return false;
    watch->kinetic = watch->elastic = watch->potential = watch->shadow = watch->weight = watch->force = 0;
    watch->rounding = watch->rounding_squares = watch->speed = 0;
    for (uint32_t i = 0; i < watch->component_count; i++)
        watch->components[i] = none;
    add_outside_forces(watch);
    add_springs(watch);
    map_hold_add_energy(watch);
    for (uint32_t i = 0; i < watch->count; i++)
        add_particle(watch, i);
    add_spins(watch);
    // Of laws the library knows the energy; its tests see to it that forces are its slope.
    watch->shadow = watch->what->laws != 0 || watch->what->grip_count > 0 ? 0 : watch->shadow;
    if (watch->what->laws == 0)
        return true;
    mspring_energy energy = mspring_energy_default();
    const bool ok = mspring_network_get_energy(watch->network, &energy) == MSPRING_OK;
    watch->elastic = energy.elastic;
    return ok;
}

double map_watch_energy(const map_watch *watch) {
    return watch->kinetic + watch->elastic + watch->potential + watch->shadow;
}

bool map_watch_begin(map_watch *watch, const map_case *what, mspring_network *network, double substep) {
    double left, bottom, right, top;
    watch->what = what;
    watch->network = network;
    watch->count = what->body.particle_count;
    watch->substep = substep;
    watch->time = watch->lag = 0;
    map_body_box(&what->body, &left, &bottom, &right, &top);
    watch->centre_x = (left + right) / 2;
    watch->centre_y = (bottom + top) / 2;
    for (uint32_t i = 0; i < watch->count; i++) {
        const mspring_particle_def *def = &what->body.particles[i];
        watch->mass[i] = (def->flags & MSPRING_PARTICLE_PINNED) != 0 ? INFINITY : (double)def->mass;
    }
    return map_hold_begin(watch) && map_watch_springs(watch) && map_watch_read(watch);
}

/* ------------------------------------------------------------------------------------------------------- floor */

static double height_over_heights(const map_case *what, double x, double y) {
    const mspring_floor_def *floor = &what->floor;
    const double place = (x - floor->heights_x) / floor->spacing;
    const uint32_t last = floor->height_count - 1;
    if (!(place > 0))
        return y - (double)what->heights[0];
    if (place >= last)
        return y - (double)what->heights[last];
    const uint32_t part = (uint32_t)place;
    const double low = (double)what->heights[part], rise = (double)what->heights[part + 1] - low;
    const double over = y - (low + (place - part) * rise);
    return over * floor->spacing / hypot(floor->spacing, rise); // across the slope
}

double map_height_over_floor(const map_case *what, double x, double y) {
    double least = INFINITY;
    if (!what->has_floor)
        return least;
    for (uint32_t i = 0; i < what->floor.plane_count; i++) {
        const double *plane = what->planes[i];
        least = fmin(least, ((x - plane[0]) * plane[2] + (y - plane[1]) * plane[3]) / hypot(plane[2], plane[3]));
    }
    if (what->floor.height_count > 0)
        least = fmin(least, height_over_heights(what, x, y));
    return least;
}
