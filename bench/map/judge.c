/// @file judge.c
/// Judging a network after each step.
///
/// SPDX-License-Identifier: MIT
#include "map/judge.h"

#include <math.h>
#include <stdio.h>

#include "map/bounce.h"
#include "map/hold.h"
#include "map/meet.h"

const char *map_verdict_name(map_verdict verdict) {
    static const char *const names[MAP_VERDICTS] = {"holds",    "guarded",  "violent",  "rested",  "not finite",
                                                    "rejected", "energy",   "momentum", "angular", "floor",
                                                    "bounce",   "substeps", "crossed",  "fall"};
    return names[verdict];
}

/* -------------------------------------------------------------------------------------------------- the start */

static double time_of_velocities(const map_watch *watch) {
    return watch->time - 0.5 * watch->lag;
}

static void start_flight(map_judge *judge, uint32_t number) {
    const map_component *of = &judge->watch->components[number];
    judge->flights[number] = (map_flight){
        time_of_velocities(judge->watch), of->px, of->py, of->spin, of->momentum_scale, of->spin_scale};
}

void map_judge_begin(map_judge *judge, const map_watch *watch) {
    static const map_judge none = {0};
    *judge = none;
    judge->watch = watch;
    judge->start = map_watch_energy(watch);
    judge->motion = watch->kinetic + watch->elastic;
    judge->potential = watch->potential;
    judge->rounding = watch->rounding;
    for (uint32_t i = 0; i < watch->component_count; i++) {
        start_flight(judge, i);
        judge->momentum_scale += watch->components[i].momentum_scale;
    }
    map_bounce_begin(judge);
}

void map_judge_broken(map_judge *judge, double elastic_before) {
    // What explicit substeps keep is another sum from now on.
    if (judge->watch->what->network.settings.solver == MSPRING_SOLVER_EXPLICIT)
        judge->start = map_watch_energy(judge->watch);
    else
        judge->start -= elastic_before - judge->watch->elastic;
    for (uint32_t i = 0; i < judge->watch->component_count; i++)
        start_flight(judge, i);
}

/* ------------------------------------------------------------------------------------------------------ energy */

// What loose particles show too much after explicit substeps: those that lie on a floor have no velocity across it,
// and those that global damping stops have none, but not that of half a substep ago, with which w would be 0.
static double shown_at_rest(const map_watch *watch) {
    const map_case *what = watch->what;
    const double speed = 0.5 * watch->substep *
                         hypot((double)what->network.settings.gravity_x, (double)what->network.settings.gravity_y);
    double sum = 0;
    for (uint32_t i = 0; i < watch->count && what->network.settings.solver == MSPRING_SOLVER_EXPLICIT; i++)
        if ((watch->floor_x[i] != 0 || watch->floor_y[i] != 0 || what->network.settings.global_damping > 0) &&
            watch->components[watch->component[i]].particle_count == 1 && !isinf(watch->mass[i]))
            sum += 0.5 * watch->mass[i] * speed * speed;
    return sum;
}

// Energy of overlaps pushed apart: with the implicit and the direct solver the lighter of two bodies keeps the speed
// (massspring/contact.h).
static double pushed_apart(const map_watch *watch) {
    const mspring_contact_def *contact = &watch->what->contact;
    const double speed = contact->push_speed < 0 ? fmin(0.5 * contact->thickness, 3) : (double)contact->push_speed;
    double first = 0, second = 0;
    for (uint32_t i = 0; i < watch->count; i++)
        *(i < watch->what->first_count ? &first : &second) += isinf(watch->mass[i]) ? 0 : watch->mass[i];
    return watch->deepest > 0.01 * contact->thickness ? fmin(first, second) * speed * speed : 0;
}

// Kinetic, elastic and potential energy never rise above the least so far with the implicit and the direct solver,
// and what explicit substeps keep never above that at the start. Where gravity, held forces and pinned particles
// that all move alike do work, it is in the potential, or there is none in the frame chosen. The parts that may be
// gained: see STABILITY.md.
static map_verdict judge_energy(map_judge *judge, uint32_t substeps) {
    const map_watch *watch = judge->watch;
    const bool is_explicit = watch->what->network.settings.solver == MSPRING_SOLVER_EXPLICIT;
    judge->fallen = fmax(judge->fallen, judge->potential - watch->potential);
    judge->rounding_squares += is_explicit ? substeps * watch->rounding_squares : 0;
    const double energy = map_watch_energy(watch), gain = energy - judge->start;
    const double could = judge->motion + judge->fallen;
    // Rounded positions heat: what they stir adds up, mostly upwards. Near the border what rounding stirs in the
    // fastest motion swings up to so much more.
    const double swing = 1 / (1 - watch->what->share * watch->what->share);
    const double rounding = 3e-6 * watch->weight + 4 * watch->last_place * watch->force + watch->rounding +
                            judge->rounding + 12 * swing * sqrt(judge->rounding_squares) + shown_at_rest(watch);
    judge->could = could;
    judge->since += substeps;
    judge->quickest = fmax(judge->quickest, watch->speed * watch->substep / watch->shortest);
    judge->growth = fmax(judge->growth, (gain - rounding) / fmax(could, rounding));
    // The library lets each of up to 32 pieces of a substep gain 1e-6 with the implicit and the direct solver.
    // With laws and grips the sum that explicit substeps keep is not known: kinetic and elastic energy swing by the
    // share.
    const bool swings = watch->what->laws != 0 || watch->what->grip_count > 0;
    // Grips act on where the substep would have led without them: of first order, with every solver.
    const double part = is_explicit && swings         ? 1.5 * watch->what->share
                        : is_explicit                 ? 1e-2
                        : watch->what->grip_count > 0 ? 2e-2
                                                      : fmin(1e-2, 1e-3 + 3.2e-5 * (double)judge->since);
    judge->pushed = is_explicit ? 0 : fmax(judge->pushed, pushed_apart(watch));
    if (gain - rounding - judge->pushed > part * could) {
        snprintf(judge->text, sizeof judge->text,
                 "%.4g J more than there were, where %.4g J could move and %.2g J are rounding; ways of %.2g of a "
                 "spring",
                 gain, could, rounding, judge->quickest);
        return MAP_GAINED;
    }
    if (!is_explicit && energy < judge->start) {
        judge->start = energy;
        judge->rounding = watch->rounding;
        judge->pushed = pushed_apart(watch);
        judge->since = 0;
    }
    return MAP_HOLDS;
}

/* ---------------------------------------------------------------------------------------------------- momentum */

/// Tolerated change of momentum and angular momentum: a thousandth of the sums of their parts.
static const double kept = 1e-3;

static map_verdict judge_flight(map_judge *judge, uint32_t number) {
    const map_watch *watch = judge->watch;
    const map_component *of = &watch->components[number];
    const map_flight *from = &judge->flights[number];
    const double time = time_of_velocities(watch) - from->time, random = sqrt((double)judge->substeps) * 0x1p-24;
    const double push_x = (of->gravity_x + of->force_x) * time, push_y = (of->gravity_y + of->force_y) * time;
    const double off = hypot(of->px - from->px - push_x, of->py - from->py - push_y);
    const double scale = fmax(from->momentum_scale, of->momentum_scale) + hypot(push_x, push_y);
    // Velocities that grow by the same amount in each substep, as gravity has them, are rounded the same way each
    // time: by half a last place in all substeps, or by all of that amount where it is less. A millionth of what
    // all components have: implicit solvers find the velocities of all together.
    const double steady = fmin((double)judge->substeps * 0x1p-25 * scale, hypot(push_x, push_y));
    if (off > kept * scale + 20 * random * scale + steady + 1e-6 * judge->momentum_scale) {
        snprintf(judge->text, sizeof judge->text, "momentum is off by %.4g kg m/s of %.4g", off, scale);
        return MAP_MOMENTUM;
    }
    if (watch->what->has_forces)
        return MAP_HOLDS;
    const double turned = fabs(of->spin - from->spin), spin_scale = fmax(from->spin_scale, fabs(of->spin));
    const double steady_turn =
        push_x != 0 || push_y != 0 ? (double)judge->substeps * 0x1p-25 * of->spin_rounding : 0;
    if (turned >
        kept * from->spin_scale + 20 * random * of->spin_rounding + steady_turn + 10 * sqrt(judge->angle_squares)) {
        snprintf(judge->text, sizeof judge->text,
                 "angular momentum went from %.5g to %.5g kg m^2/s, its parts come to %.4g", from->spin, of->spin,
                 spin_scale);
        return MAP_TURNED;
    }
    return MAP_HOLDS;
}

static map_verdict judge_flights(map_judge *judge) {
    const map_watch *watch = judge->watch;
    const mspring_network_def *def = &watch->what->network;
    // Springs pull along lengths that are rounded, the same way all through a step.
    judge->angle_squares += watch->what->dt * watch->what->dt * watch->rounding_squares;
    for (uint32_t i = 0; i < watch->component_count; i++) {
        // What sleeps is stopped, and global damping stops all that moves.
        if (watch->components[i].is_held || def->settings.sleep_speed > 0 || def->settings.global_damping > 0) {
            start_flight(judge, i);
            continue;
        }
        const map_verdict verdict = judge_flight(judge, i);
        if (verdict != MAP_HOLDS)
            return verdict;
    }
    return MAP_HOLDS;
}

/* ------------------------------------------------------------------------------------------------------- floor */

static map_verdict judge_floor(map_judge *judge) {
    const map_watch *watch = judge->watch;
    for (uint32_t i = 0; i < watch->count && watch->what->has_floor; i++) {
        const double height = map_height_over_floor(watch->what, watch->x[i], watch->y[i]);
        // A millionth of the distance from the local origin, which may be 64 m off.
        const double distance = fmax(fabs(watch->x[i] - watch->centre_x), fabs(watch->y[i] - watch->centre_y));
        if (!isinf(watch->mass[i]) && height < -1e-6 * (64 + distance)) {
            snprintf(judge->text, sizeof judge->text, "particle %u is %.3g m below the floor", i, -height);
            return MAP_SUNK;
        }
    }
    return MAP_HOLDS;
}

map_verdict map_judge_step(map_judge *judge, uint32_t substeps) {
    judge->substeps += substeps;
    map_verdict verdict = judge_floor(judge);
    if (verdict == MAP_HOLDS)
        verdict = judge_energy(judge, substeps);
    if (verdict == MAP_HOLDS)
        verdict = judge_flights(judge);
    if (verdict == MAP_HOLDS)
        verdict = map_bounce_judge(judge);
    if (verdict == MAP_HOLDS)
        verdict = map_meet_judge(judge);
    if (verdict == MAP_HOLDS)
        verdict = map_hold_judge(judge);
    return verdict;
}
