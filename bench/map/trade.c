/// @file trade.c
/// The same motion with ever more substeps, next to one in double precision. In the family order the error falls
/// by 3.5 for twice the substeps, until it is four millionths of the motion (in 371 of 376 cases one). In the other
/// it grows by rounding only.
///
/// SPDX-License-Identifier: MIT
#include "map/trade.h"

#include <math.h>
#include <stdio.h>

#include "map/run.h"

static const double until = 4e-6;

enum {
    FINE = 32,     ///< substeps of the reference in a step, of fourth order
    DOUBLINGS = 10 ///< up to 1024 substeps
};

/* -------------------------------------------------------------------------------------------------- reference */

/// Positions, then velocities.
typedef struct motion {
    double x[MAP_PARTICLES], y[MAP_PARTICLES], vx[MAP_PARTICLES], vy[MAP_PARTICLES];
} motion;

/// As the library has it, 1/kg: a rounding of 6e-8 is worth 2e-6 of the motion after 40 radians.
static double inverse_mass(const map_watch *watch, uint32_t particle) {
    return (double)(float)(1 / watch->mass[particle]);
}

/// How fast all of it changes.
static void rate_of(const map_watch *watch, const motion *at, motion *rate) {
    for (uint32_t i = 0; i < watch->count; i++) {
        rate->x[i] = at->vx[i];
        rate->y[i] = at->vy[i];
        const mspring_network_def *def = &watch->what->network;
        rate->vx[i] = isinf(watch->mass[i])
                          ? 0
                          : (double)def->settings.gravity_x - (double)def->settings.global_damping * at->vx[i];
        rate->vy[i] = isinf(watch->mass[i])
                          ? 0
                          : (double)def->settings.gravity_y - (double)def->settings.global_damping * at->vy[i];
    }
    for (uint32_t i = 0; i < watch->spring_count; i++) {
        const map_spring *s = &watch->springs[i];
        const double dx = at->x[s->b] - at->x[s->a], dy = at->y[s->b] - at->y[s->a];
        const double length = sqrt(dx * dx + dy * dy);
        const double closing = ((at->vx[s->b] - at->vx[s->a]) * dx + (at->vy[s->b] - at->vy[s->a]) * dy) / length;
        const double force = (s->stiffness * (length - s->rest_length) + s->damping * closing) / length;
        const double of_a = inverse_mass(watch, s->a), of_b = inverse_mass(watch, s->b);
        rate->vx[s->a] += force * dx * of_a;
        rate->vy[s->a] += force * dy * of_a;
        rate->vx[s->b] -= force * dx * of_b;
        rate->vy[s->b] -= force * dy * of_b;
    }
}

static motion moved(const map_watch *watch, const motion *from, const motion *rate, double by) {
    motion to = *from;
    for (uint32_t i = 0; i < watch->count; i++) {
        to.x[i] += by * rate->x[i];
        to.y[i] += by * rate->y[i];
        to.vx[i] += by * rate->vx[i];
        to.vy[i] += by * rate->vy[i];
    }
    return to;
}

/// Runge and Kutta's method of fourth order.
static void take_fine_step(const map_watch *watch, motion *state, double dt) {
    const double h = dt / FINE;
    for (int k = 0; k < FINE; k++) {
        motion r1, r2, r3, r4, at;
        rate_of(watch, state, &r1);
        at = moved(watch, state, &r1, h / 2);
        rate_of(watch, &at, &r2);
        at = moved(watch, state, &r2, h / 2);
        rate_of(watch, &at, &r3);
        at = moved(watch, state, &r3, h);
        rate_of(watch, &at, &r4);
        *state = moved(watch, state, &r1, h / 6);
        *state = moved(watch, state, &r2, h / 3);
        *state = moved(watch, state, &r3, h / 3);
        *state = moved(watch, state, &r4, h / 6);
    }
}

/// Where the particles are after each step, and how far they have gone at most (root of the mean square), m.
typedef struct course {
    double x[MAP_STEPS][MAP_PARTICLES], y[MAP_STEPS][MAP_PARTICLES];
    double motion;
    double speed; ///< m/s, likewise of velocities
} course;

static double mean_distance(const map_watch *watch, const double *x, const double *y, const double *from_x,
                            const double *from_y) {
    double sum = 0;
    uint32_t free_count = 0;
    for (uint32_t i = 0; i < watch->count; i++) {
        if (isinf(watch->mass[i]))
            continue;
        sum += (x[i] - from_x[i]) * (x[i] - from_x[i]) + (y[i] - from_y[i]) * (y[i] - from_y[i]);
        free_count++;
    }
    return free_count > 0 ? sqrt(sum / free_count) : 0;
}

static void find_course(const map_watch *watch, course *found) {
    static const double still[MAP_PARTICLES] = {0};
    motion state;
    for (uint32_t i = 0; i < watch->count; i++) {
        state.x[i] = watch->x[i];
        state.y[i] = watch->y[i];
        state.vx[i] = (double)watch->vx[i];
        state.vy[i] = (double)watch->vy[i];
    }
    found->motion = found->speed = 0;
    for (uint32_t step = 0; step < watch->what->steps; step++) {
        take_fine_step(watch, &state, (double)(float)watch->what->dt); // substeps are floats
        for (uint32_t i = 0; i < watch->count; i++) {
            found->x[step][i] = state.x[i];
            found->y[step][i] = state.y[i];
        }
        found->motion = fmax(found->motion, mean_distance(watch, state.x, state.y, watch->x, watch->y));
        found->speed = fmax(found->speed, mean_distance(watch, state.vx, state.vy, still, still));
    }
}

/* ---------------------------------------------------------------------------------------------------- judging */

/// Error of a run with so many substeps, m; NAN if a step was rejected.
static double error_of(const map_case *what, const map_watch *watch, const course *right) {
    char text[MAP_TEXT];
    double x[MAP_PARTICLES], y[MAP_PARTICLES], sum = 0;
    mspring_network *network = map_make_network(what, text);
    bool ok = network != NULL;
    for (uint32_t step = 0; step < what->steps && ok; step++) {
        ok = mspring_network_step(network, what->dt) == MSPRING_OK &&
             mspring_network_get_positions(network, NULL, 0, watch->count, x, y, 1) == MSPRING_OK;
        if (ok) {
            const double off = mean_distance(watch, x, y, right->x[step], right->y[step]);
            sum += off * off;
        }
    }
    mspring_network_destroy(network);
    return ok ? sqrt(sum / what->steps) : NAN;
}

map_verdict map_run_trade(const map_case *what, mspring_network *first, char text[MAP_TEXT]) {
    map_watch watch;
    course right;
    map_case run = *what;
    double last = INFINITY;
    if (!map_watch_begin(&watch, what, first, what->dt))
        return MAP_REJECTED;
    find_course(&watch, &right);
    const double least = 1e-6 * right.motion + 4 * watch.last_place, time = what->steps * what->dt;
    for (int doubling = 0; doubling <= DOUBLINGS; doubling++) {
        run.network.settings.substeps = (uint32_t)1 << doubling;
        const double error = error_of(&run, &watch, &right);
        if (!(error >= 0)) {
            snprintf(text, MAP_TEXT, "a step of %u substeps was rejected", run.network.settings.substeps);
            return MAP_REJECTED;
        }
        // From where a substep is a tenth of what is stable: before, the fastest modes are right by chance only.
        // Velocities are rounded in each substep: what that comes to grows as a random walk, and in each the same
        // way of what gravity adds, up to all of it.
        const double count = (double)what->steps * run.network.settings.substeps,
                     gravity = (double)what->network.settings.gravity_y;
        const double walk = 8 * sqrt(count) * 0x1p-24 * right.speed * time;
        const double steady = fmin(count * 0x1p-25 * right.speed, fabs(gravity) * time) * time / 2;
        if (doubling > 2 && error > 1.05 * last && error > least + walk + steady) {
            snprintf(text, MAP_TEXT,
                     "%u substeps: error %.4g m, with half as many %.4g m, the motion is %.4g m, last place %.2g m",
                     run.network.settings.substeps, error, last, right.motion, watch.last_place);
            return MAP_WORSE;
        }
        if (what->family == MAP_ORDER && doubling > 2 && error > last / 3.5 && error > until * right.motion) {
            snprintf(text, MAP_TEXT, "%u substeps: error %.4g m, with half as many %.4g m, the motion is %.4g m",
                     run.network.settings.substeps, error, last, right.motion);
            return MAP_WORSE;
        }
        last = error;
    }
    return MAP_HOLDS;
}
