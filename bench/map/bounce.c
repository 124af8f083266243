/// @file bounce.c
/// Judging the bounces of loose particles. Energy that appears is seen by the judge of energy; here it is seen that
/// none is lost where restitution is 1, and as much as it says where it is less.
///
/// SPDX-License-Identifier: MIT
#include "map/bounce.h"

#include <math.h>
#include <stdio.h>

/// Tolerated change of how high a particle bounces.
static const double kept = 0.01;

/// Energy of one particle: of its motion across a level floor alone where there is friction, J / kg.
static double energy_of(const map_watch *watch, uint32_t i, bool across_only) {
    const double gravity = (double)watch->what->network.settings.gravity_y;
    double vx = (double)watch->vx[i], vy = (double)watch->vy[i];
    vy += 0.5 * watch->lag * gravity; // explicit substeps leave the velocity of half a substep ago
    return 0.5 * ((across_only ? 0 : vx * vx) + vy * vy) - gravity * watch->y[i];
}

static bool is_level(const map_case *what) {
    return what->floor.plane_count == 1 && what->planes[0][2] == 0;
}

static bool is_judged(const map_case *what) {
    return what->shape == MAP_LOOSE && what->has_floor && what->network.settings.global_damping == 0;
}

/// Whether energy is kept: all of it or, with friction on a level floor, that of the motion across it.
static bool is_perfect(const map_case *what) {
    return what->floor.restitution == 1.0f && (what->floor.friction == 0 || is_level(what));
}

/// What of gravity acts across the one plane that there is, m/s^2.
static double gravity_across(const map_case *what) {
    return -(double)what->network.settings.gravity_y / hypot(what->planes[0][2], what->planes[0][3]);
}

/// Speed at which a particle meets the one plane that there is, m/s: bounces without friction keep it.
static double speed_across(const map_watch *watch, uint32_t i, double height) {
    const double *plane = watch->what->planes[0];
    if (watch->what->floor.plane_count != 1)
        return 0;
    const double across =
        ((double)watch->vx[i] * plane[2] + (double)watch->vy[i] * plane[3]) / hypot(plane[2], plane[3]);
    return sqrt(across * across + 2 * gravity_across(watch->what) * fmax(height, 0));
}

void map_bounce_begin(map_judge *judge) {
    const map_case *what = judge->watch->what;
    for (uint32_t i = 0; is_judged(what) && i < judge->watch->count; i++) {
        const double height = map_height_over_floor(what, judge->watch->x[i], judge->watch->y[i]);
        judge->particle_start[i] = energy_of(judge->watch, i, !is_perfect(what) || what->floor.friction > 0);
        judge->particle_fallen[i] = energy_of(judge->watch, i, false) +
                                    (double)what->network.settings.gravity_y * (judge->watch->y[i] - height);
        judge->particle_across[i] = speed_across(judge->watch, i, height);
    }
}

/// Height of the parabola's top over the floor at a time, of one that falls onto a level floor, m.
static double top_at(const map_judge *judge, uint32_t i, double time) {
    const map_case *what = judge->watch->what;
    const double gravity = -(double)what->network.settings.gravity_y, e = (double)what->floor.restitution;
    double speed = sqrt(2 * judge->particle_start[i]); // of the first impact
    time -= ((double)what->body.particles[i].vy + speed) / gravity;
    while (time > 0 && speed > 0) {
        speed *= e;
        time -= 2 * speed / gravity;
        if (speed < 1e-3)
            speed = 0;
    }
    return speed * speed / (2 * gravity);
}

// Where friction and restitution are less than perfect only level floors have a closed form: in each bounce the
// speed across is that before times the restitution.
static map_verdict judge_level(map_judge *judge, uint32_t i) {
    const map_watch *watch = judge->watch;
    // Times of bounces may be off by a hundredth, and speeds below about 0.02 m/s end them.
    const double within = 0.01 * watch->time + watch->substep,
                 gravity = -(double)watch->what->network.settings.gravity_y;
    const double most = top_at(judge, i, watch->time - within), least = top_at(judge, i, watch->time + within);
    const double top = energy_of(watch, i, true) / gravity;
    // At rest an explicit substep leaves no velocity rather than that of half a substep ago.
    const double room = 1e-3 + watch->substep * watch->substep * gravity / 8;
    if (top <= (1 + kept) * most + room && top >= (1 - kept) * least - room)
        return MAP_HOLDS;
    snprintf(judge->text, sizeof judge->text,
             "particle %u rises to %.4g m after %.4g s, between %.4g and %.4g m it should", i, top, watch->time,
             least, most);
    return MAP_BOUNCED;
}

// A bounce that is shorter than a substep is none, nor is the ninth in one. Where surfaces meet, or rise to both
// sides, bounces of any speed come to such ones. On one plane the motion across it tells, whatever that along it
// is.
static bool may_rest(const map_judge *judge, uint32_t i) {
    const map_case *what = judge->watch->what;
    return what->floor.height_count > 0 || what->floor.plane_count > 1 ||
           judge->particle_across[i] <= 1.05 * 0.5 * judge->watch->substep * gravity_across(what);
}

map_verdict map_bounce_judge(map_judge *judge) {
    const map_watch *watch = judge->watch;
    const map_case *what = watch->what;
    if (!is_judged(what))
        return MAP_HOLDS;
    const bool perfect = is_perfect(what);
    for (uint32_t i = 0; i < watch->count; i++) {
        if (!perfect && is_level(what)) {
            const map_verdict verdict = judge_level(judge, i);
            if (verdict != MAP_HOLDS)
                return verdict;
        }
        if (!perfect)
            continue;
        const double start = judge->particle_start[i], now = energy_of(watch, i, what->floor.friction > 0);
        // What it has over the lowest place where it was.
        judge->particle_fallen[i] =
            fmax(judge->particle_fallen[i], start + (double)what->network.settings.gravity_y * watch->y[i]);
        // At rest across a surface an explicit substep leaves no velocity rather than that of half a substep ago.
        const double at_rest = 0.5 * watch->substep * (double)what->network.settings.gravity_y;
        const double room = what->network.settings.solver == MSPRING_SOLVER_EXPLICIT ? 0.5 * at_rest * at_rest : 0;
        if (fabs(now - start) > kept * judge->particle_fallen[i] + room) {
            snprintf(judge->text, sizeof judge->text, "particle %u has %.4g J/kg after %.4g s, at the start %.4g",
                     i, now, watch->time, start);
            return now < start && may_rest(judge, i) ? MAP_RESTED : MAP_BOUNCED;
        }
    }
    return MAP_HOLDS;
}
