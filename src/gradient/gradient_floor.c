/// Half-planes without friction and restitution, a substep back.
///
/// A particle that a substep would take below a plane lands on it. With n the normal and d > 0 its distance before,
/// n.v' = -d / h, so that x' is on the plane. If it is on the plane or below (d <= 0), it is put onto the plane,
/// and n.v' is at least 0. Motion along the plane does not change (features/contact/floor_bounce.c).
#include "gradient/gradient.h"

// Rounding error of a position without its low word, m.
static double floor_slop(double x, double y) {
    return 0x1p-21 * (fabs(x) + fabs(y)) + 1e-12;
}

static double floor_distance(const mspring_gradient *g, uint32_t plane, const mspringi_moment *at, double x,
                             double y) {
    const double *p = g->planes[plane];
    return p[0] * (at->origin_x + x) + p[1] * (at->origin_y + y) - p[2];
}

// True if a free particle is on a plane or below one.
static bool is_on_floor(const mspring_gradient *g, const mspringi_moment *at, uint32_t slot) {
    const double x = at->x[slot], y = at->y[slot], slop = floor_slop(x, y);
    bool is_on = false;
    for (uint32_t i = 0; i < g->plane_count; ++i)
        is_on = is_on || floor_distance(g, i, at, x, y) <= slop;
    return is_on && g->adjoint.inverse_mass[slot] > 0.0;
}

// Velocity after springs and forces, before the floor acts.
static void free_velocity(const mspring_gradient *g, const mspringi_moment *before, const mspringi_times *t,
                          const double host[2], uint32_t slot, double v[2]) {
    const mspring_settings *settings = &g->clone->settings;
    const double mass = g->adjoint.inverse_mass[slot];
    v[0] = (1.0 - t->loss) * before->vx[slot] + t->gravity_kick * (double)settings->gravity_x +
           t->kick * mass * (g->spring_force[0].x[slot] + g->spring_force[1].x[slot] + host[0]);
    v[1] = (1.0 - t->loss) * before->vy[slot] + t->gravity_kick * (double)settings->gravity_y +
           t->kick * mass * (g->spring_force[0].y[slot] + g->spring_force[1].y[slot] + host[1]);
}

// A landing: side of the plane before it, and whether the particle already moved away.
typedef struct floor_landing {
    uint32_t plane;
    bool was_above, rises;
} floor_landing;

// Let the planes act on a particle, in their order. Return the number that did.
static uint32_t land(const mspring_gradient *g, const mspringi_moment *before, double h, uint32_t slot, double v[2],
                     floor_landing *landings) {
    double x = before->x[slot], y = before->y[slot];
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->plane_count; ++i) {
        const double *n = g->planes[i], distance = floor_distance(g, i, before, x, y);
        const double speed = n[0] * v[0] + n[1] * v[1], depth = fmin(distance, 0.0);
        if (!(distance + h * speed < 0.0))
            continue;
        const double wanted = fmax((depth - distance) / h, speed);
        landings[count++] = (floor_landing){i, distance > 0.0, !(distance > 0.0) && speed > 0.0};
        v[0] += (wanted - speed) * n[0];
        v[1] += (wanted - speed) * n[1];
        x -= depth * n[0];
        y -= depth * n[1];
    }
    return count;
}

// Take the derivatives by position and velocity after a landing back to those before it. Those by the position
// before the substep go to `by_position`, those by the velocity before the floor acted to `velocity`. These include
// h X, so `position` becomes 0.
static void land_back(mspring_gradient *g, double h, uint32_t slot, const floor_landing *landings, uint32_t count) {
    mspringi_adjoint *a = &g->adjoint;
    double px = a->position.x[slot], py = a->position.y[slot];
    double vx = a->velocity.x[slot] + h * px, vy = a->velocity.y[slot] + h * py;
    for (uint32_t i = count; i > 0; --i) {
        const floor_landing *l = &landings[i - 1];
        const double *n = g->planes[l->plane], speed = n[0] * vx + n[1] * vy, place = n[0] * px + n[1] * py;
        const double taken = l->rises ? 0.0 : speed, added = l->was_above ? -speed / h : -place;
        vx -= taken * n[0];
        vy -= taken * n[1];
        px += added * n[0];
        py += added * n[1];
    }
    a->velocity.x[slot] = vx - h * px;
    a->velocity.y[slot] = vy - h * py;
    a->position.x[slot] = px;
    a->position.y[slot] = py;
}

static void host_force(const mspring_gradient *g, const float *forces, uint32_t slot, double force[2]) {
    force[0] = force[1] = 0.0;
    for (uint32_t i = 0; forces && i < g->forced_count; ++i)
        if (g->forced_slot[i] == slot) {
            force[0] = (double)forces[2 * i];
            force[1] = (double)forces[2 * i + 1];
        }
}

// True if the velocity agrees with the network's up to rounding of positions, divided by h, and of velocities.
static bool is_as_computed(const mspringi_moment *before, const mspringi_moment *after, double h, uint32_t slot,
                           const double v[2], const double before_floor[2]) {
    const double slop = floor_slop(before->x[slot], before->y[slot]);
    const double size = fabs(before_floor[0]) + fabs(before_floor[1]) + fabs(v[0]) + fabs(v[1]);
    const double most = 2.0 * slop / h + 1e-4 * size;
    return fabs(v[0] - after->vx[slot]) <= most && fabs(v[1] - after->vy[slot]) <= most;
}

uint32_t mspringi_gradient_floor(mspring_gradient *g, const mspringi_moment *before, const mspringi_moment *after,
                                 const mspringi_times *times, const float *forces) {
    bool has_forces = false;
    for (uint32_t slot = 0; slot < g->slots; ++slot) {
        // It lands where it is on the floor after the substep. If it was below, it is put onto the floor and may
        // rise.
        if (!is_on_floor(g, after, slot) && !is_on_floor(g, before, slot))
            continue;
        if (!has_forces) {
            for (int end = 0; end < 2; ++end) {
                memset(g->spring_force[end].x, 0, g->lanes * sizeof(double));
                memset(g->spring_force[end].y, 0, g->lanes * sizeof(double));
            }
            mspringi_octets_forces(g, before);
            has_forces = true;
        }
        floor_landing landings[MSPRING_MAX_PLANES];
        double v[2], host[2];
        host_force(g, forces, slot, host);
        free_velocity(g, before, times, host, slot, v);
        const double before_floor[2] = {v[0], v[1]};
        const uint32_t count = land(g, before, times->h, slot, v, landings);
        if (count > 0 && !is_as_computed(before, after, times->h, slot, v, before_floor))
            return slot;
        if (count > 0)
            land_back(g, times->h, slot, landings, count);
    }
    return MSPRING_NONE;
}
