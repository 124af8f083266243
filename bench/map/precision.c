/// @file precision.c
/// Families of precision: how they are drawn, and what must hold.
///
/// SPDX-License-Identifier: MIT
#include "map/precision.h"

#include <math.h>
#include <stdio.h>

#include <massspring/massspring.h>

#include "map/draw.h"
#include "map/run.h"
#include "scenes/internal.h"

/// Substeps of all kinds that a case may take.
static const double most_substeps = 1e5;

/* ---------------------------------------------------------------------------------------------------- drawing */

static map_stuff draw_explicit(map_case *drawn, uint64_t *seed) {
    drawn->index *= 8;
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->index /= 8;
    return stuff;
}

static double lightest(const map_body *body) {
    double least = INFINITY;
    for (uint32_t i = 0; i < body->particle_count; i++)
        least = fmin(least, (double)body->particles[i].mass);
    return least;
}

static void remove_damping(map_case *drawn) {
    for (uint32_t i = 0; i < drawn->body.spring_count; i++)
        drawn->body.springs[i].damping = 0;
}

/// Make the springs as stiff as makes so many explicit substeps of a second stable in any shape.
static void soften(map_case *drawn, double substeps_a_second) {
    double most = 0;
    for (uint32_t i = 0; i < drawn->body.spring_count; i++)
        most = fmax(most, (double)drawn->body.springs[i].stiffness);
    const double stiffness = 0.02 * lightest(&drawn->body) * substeps_a_second * substeps_a_second;
    for (uint32_t i = 0; i < drawn->body.spring_count; i++)
        drawn->body.springs[i].stiffness *= (float)fmin(1, stiffness / most);
}

/// A fall has 60 to 491,520 substeps a second.
void map_draw_fall(map_case *drawn, uint64_t *seed) {
    const map_stuff stuff = map_draw_begin(drawn, seed);
    if (map_one_in(seed, 4)) {
        drawn->body = (map_body){0};
        drawn->shape = MAP_LOOSE;
        map_draw_body(&drawn->body, MAP_LOOSE, &stuff, seed);
    }
    remove_damping(drawn);
    drawn->share = 0;
    drawn->dt = 1.0 / 60;
    drawn->network.settings.substeps = (uint32_t)1 << random_below(seed, 14);
    drawn->network.settings.iterations = 0;
    drawn->network.settings.gravity_y = (float)map_between(seed, -20, 20);
    drawn->network.flags = map_one_in(seed, 2) ? MSPRING_NETWORK_PRECISE : 0;
    drawn->steps = (uint32_t)fmax(1, fmin(300, most_substeps / drawn->network.settings.substeps));
    if (drawn->network.settings.solver == MSPRING_SOLVER_EXPLICIT)
        soften(drawn, drawn->network.settings.substeps / drawn->dt);
}

/// As in the family substeps: fast enough to stretch a spring by a thousandth to a fiftieth.
static void draw_vibration(map_case *drawn, const map_stuff *stuff, uint64_t *seed) {
    const double speed = stuff->spacing * sqrt(stuff->stiffness / lightest(&drawn->body));
    map_draw_velocities(drawn, speed * map_decades(seed, 1e-3, 0.02), seed);
}

void map_draw_order(map_case *drawn, uint64_t *seed) {
    const map_stuff stuff = draw_explicit(drawn, seed);
    drawn->network.flags = MSPRING_NETWORK_PRECISE;
    drawn->share = 0.4;
    drawn->network.settings.substeps = 1;
    drawn->steps = MAP_STEPS;
    remove_damping(drawn);
    draw_vibration(drawn, &stuff, seed);
    if (map_one_in(seed, 3))
        drawn->network.settings.gravity_y = -9.8f;
    if (map_one_in(seed, 2)) // of the order of the vibration's times
        drawn->network.settings.global_damping =
            (float)(sqrt(stuff.stiffness / lightest(&drawn->body)) * map_decades(seed, 1e-3, 0.03));
}

enum { PATTERNS = 7 };

/// The n-th dt of a pattern, s.
static double length_of(uint32_t pattern, uint32_t n, uint64_t *seed) {
    static const double jitters[] = {0.02, 0.1, 0.5};
    switch (pattern) {
    case 3:
        return n % 2 == 0 ? 1.0 / 60 : 1.0 / 90;
    case 4:
        return n % 10 == 9 ? 1.0 / 30 : 1.0 / 60;
    case 5:
        return n % 2 == 0 ? 1.0 / 60 : 1e-3;
    case 6:
        return n % 10 == 9 ? 1e-6 : 1.0 / 60;
    default:
        return map_between(seed, 1 - jitters[pattern], 1) / 60;
    }
}

void map_draw_uneven(map_case *drawn, uint64_t *seed) {
    (void)draw_explicit(drawn, seed);
    drawn->share = 0;
    drawn->dt = 1.0 / 60;
    drawn->steps = 3600;
    drawn->pattern = random_below(seed, PATTERNS);
    remove_damping(drawn);
    // With few substeps in a step, no number makes two lengths close.
    const bool is_auto = drawn->shape == MAP_LATTICE && map_one_in(seed, 2);
    soften(drawn, 60 * map_decades(seed, is_auto ? 5 : 1, 20));
    drawn->network.settings.substeps = is_auto ? MSPRING_SUBSTEPS_AUTO : MSPRING_SUBSTEPS_EVEN;
    map_draw_velocities(drawn, map_decades(seed, 0.01, 0.5), seed);
}

void map_draw_burst(map_case *drawn, uint64_t *seed) {
    (void)draw_explicit(drawn, seed);
    drawn->share = 0;
    drawn->dt = 1.0 / 60;
    drawn->steps = 300;
    remove_damping(drawn);
    soften(drawn, 60 * map_decades(seed, 8, 40));
    drawn->network.settings.substeps = MSPRING_SUBSTEPS_AUTO;
    drawn->way = map_decades(seed, 0.02, 2);
    map_draw_velocities(drawn, 1, seed); // times way over the substep, once that is known
}

void map_draw_rest(map_case *drawn, uint64_t *seed) {
    map_stuff stuff = draw_explicit(drawn, seed);
    drawn->network.flags = MSPRING_NETWORK_PRECISE;
    drawn->share = map_between(seed, 0.5, 0.95);
    drawn->network.settings.substeps = 64;
    drawn->steps = (uint32_t)(most_substeps / drawn->network.settings.substeps);
    remove_damping(drawn);
    stuff.stiffness = fmin(stuff.stiffness, 1e9);
    draw_vibration(drawn, &stuff, seed);
    if (map_one_in(seed, 2) && drawn->body.particle_count < MAP_PARTICLES) { // the local origin is half way
        mspring_particle_def *far = &drawn->body.particles[drawn->body.particle_count++];
        *far = drawn->body.particles[0];
        far->x += 600;
        far->vx = far->vy = 0;
        far->flags = MSPRING_PARTICLE_PINNED;
    }
}

/* ---------------------------------------------------------------------------------------------------- judging */

/// Mean velocity and place of a body, both upwards.
typedef struct body_motion {
    double speed, height, largest;
} body_motion;

static bool read_motion(const map_case *what, mspring_network *network, body_motion *read) {
    double x[MAP_PARTICLES], y[MAP_PARTICLES], mass = 0;
    float vx[MAP_PARTICLES], vy[MAP_PARTICLES];
    const uint32_t count = what->body.particle_count;
    *read = (body_motion){0, 0, 0};
    if (mspring_network_get_positions(network, NULL, 0, count, x, y, 1) != MSPRING_OK ||
        mspring_network_get_velocities(network, NULL, 0, count, vx, vy, 1) != MSPRING_OK)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const double m = (double)what->body.particles[i].mass;
        mass += m;
        read->speed += m * (double)vy[i];
        read->height += m * y[i];
        read->largest = fmax(read->largest, fmax(fabs(x[i]), fabs(y[i])));
    }
    read->speed /= mass;
    read->height /= mass;
    return true;
}

/// Explicit velocities are half a substep older than positions. PRECISE keeps what a substep adds. Otherwise each
/// may round the speed, and the coordinate, by half a last place, always the same way, but that explicit steps
/// dither: 5e-5 at most.
static map_verdict run_fall(const map_case *what, mspring_network *network, char text[MAP_TEXT]) {
    const bool is_explicit = what->network.settings.solver == MSPRING_SOLVER_EXPLICIT;
    const double g = (double)what->network.settings.gravity_y, h = what->dt / what->network.settings.substeps;
    body_motion start, now;
    bool ok = read_motion(what, network, &start);
    for (uint32_t step = 1; ok && step <= what->steps; step++) {
        ok = mspring_network_step(network, what->dt) == MSPRING_OK && read_motion(what, network, &now);
        const double t = step * what->dt, count = (double)step * what->network.settings.substeps;
        const double way = g * t * t / 2, speed = g * (is_explicit ? t - h / 2 : t);
        const bool is_precise = what->network.flags != 0;
        const double rounded = is_precise ? 0 : fmin(count * 0x1p-24, is_explicit ? 5e-5 : 1);
        const double part = (is_explicit ? 1e-6 : 2e-6) + rounded;
        const double places = (is_precise ? 2 : count) * now.largest * 0x1p-24;
        // The implicit solver's first substep falls by g h^2, not by half of it.
        const double order = is_explicit ? 0 : fabs(g) * h * t;
        if (ok && (fabs(now.speed - speed) > part * fabs(speed) ||
                   fabs(now.height - start.height - way) > part * fabs(way) + places + order)) {
            snprintf(text, MAP_TEXT, "after %.4g s (%.0f substeps) speed %.9g m/s of %.9g, way %.9g m of %.9g", t,
                     count, now.speed, speed, now.height - start.height, way);
            return MAP_FELL;
        }
    }
    if (!ok)
        snprintf(text, MAP_TEXT, "%s", mspring_network_error(network));
    return ok ? MAP_HOLDS : MAP_REJECTED;
}

static double energy_of(const mspring_network *network) {
    mspring_energy energy = mspring_energy_default();
    return mspring_network_get_energy(network, &energy) == MSPRING_OK ? energy.kinetic + energy.elastic : NAN;
}

/// Largest energy over that at first; NAN if a step was rejected, INFINITY if one had fewer substeps than it needs.
static double growth_in(const map_case *what, mspring_network *network, bool is_even) {
    const double first = energy_of(network);
    double most = first, time = 0;
    uint64_t seed = what->index;
    for (uint32_t n = 0; n < what->steps && time < 60; n++) {
        const double dt = what->family == MAP_UNEVEN && !is_even ? length_of(what->pattern, n, &seed) : what->dt;
        mspring_step_info info = mspring_step_info_default();
        if (mspring_network_step(network, dt) != MSPRING_OK ||
            mspring_network_get_step_info(network, &info) != MSPRING_OK)
            return NAN;
        if ((info.flags & MSPRING_STEP_FEWER) != 0)
            return INFINITY;
        time += dt;
        most = fmax(most, energy_of(network));
    }
    return first > 0 ? most / first : 1;
}

static bool blow_up(const map_case *what, mspring_network *network, double speed) {
    float vx[MAP_PARTICLES], vy[MAP_PARTICLES];
    for (uint32_t i = 0; i < what->body.particle_count; i++) {
        vx[i] = (float)(speed * (double)what->body.particles[i].vx);
        vy[i] = (float)(speed * (double)what->body.particles[i].vy);
    }
    return mspring_network_set_velocities(network, NULL, 0, what->body.particle_count, vx, vy, 1) == MSPRING_OK;
}

/// Growth that leapfrog's swings about the true energy account for. What folds swings most.
static double may_grow(const map_case *what, char text[MAP_TEXT]) {
    if (what->family == MAP_REST)
        return 2;
    if (what->family == MAP_BURST)
        return what->shape == MAP_ROPE || what->shape == MAP_MESH ? 40 : 5;
    if (what->network.settings.substeps == MSPRING_SUBSTEPS_AUTO)
        return 3;
    mspring_network *even = map_make_network(what, text);
    const double growth = even ? growth_in(what, even, true) : NAN;
    mspring_network_destroy(even);
    return 1.5 * growth;
}

static map_verdict run_energy(const map_case *what, mspring_network *network, char text[MAP_TEXT]) {
    double any = 0, spacing = INFINITY;
    if (mspring_network_get_stable_dt(network, NULL, &any) != MSPRING_OK)
        return MAP_REJECTED;
    for (uint32_t i = 0; i < what->body.spring_count; i++) {
        const mspring_particle_def *a = &what->body.particles[what->body.springs[i].a],
                                   *b = &what->body.particles[what->body.springs[i].b];
        spacing = fmin(spacing, hypot(a->x - b->x, a->y - b->y));
    }
    if (what->family == MAP_BURST && any < INFINITY && !blow_up(what, network, what->way * spacing / any))
        return MAP_REJECTED;
    const double growth = growth_in(what, network, false), most = may_grow(what, text);
    if (growth <= most)
        return MAP_HOLDS;
    snprintf(text, MAP_TEXT, "%.4g times the energy, at most %.4g it should be", growth, most);
    return growth < INFINITY ? MAP_GAINED : growth == INFINITY ? MAP_VIOLENT : MAP_REJECTED;
}

map_verdict map_run_precision(const map_case *what, mspring_network *network, char text[MAP_TEXT]) {
    return what->family == MAP_FALL ? run_fall(what, network, text) : run_energy(what, network, text);
}
