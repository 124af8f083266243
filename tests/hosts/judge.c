/// @file judge.c
/// Compare everything that can be read of a network with the plain lists.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "game.h"
#include "step/finite.h"

/* ------------------------------------------------------------------------------------------------ contents */

// Ids are what they were, and lead where they led.
static void judge_contents(game *it, const place *p) {
    static uint32_t ends[MOST_SPRINGS][2];
    static float values[MOST_SPRINGS];
    const plain *list = p->plain;
    JUDGE(it, mspring_network_count(p->network, MSPRING_PARTICLES) == list->particles);
    JUDGE(it, mspring_network_count(p->network, MSPRING_SPRINGS) == list->springs);
    for (mspring_id i = 0; i < list->particles; i++)
        JUDGE(it, support_has_particle(p->network, i) == list->has_particle[i]);
    for (mspring_id i = 0; i < list->springs; i++)
        JUDGE(it, support_has_spring(p->network, i) == list->has_spring[i]);
    JUDGE(it, !support_has_particle(p->network, list->particles));
    JUDGE(it, !support_has_spring(p->network, MSPRING_NONE));
    JUDGE(it, mspring_network_get_columns(p->network, NULL, 0, list->springs, (const mspring_column[]){{MSPRING_END_A, 2, &ends[0][0]}, {MSPRING_END_B, 2, &ends[0][1]}}, 2) == MSPRING_OK);
    JUDGE(it, memcmp(ends, list->ends, list->springs * sizeof *ends) == 0);
    JUDGE(it, mspring_network_get(p->network, MSPRING_MASS, NULL, 0, list->particles, values, 1) == MSPRING_OK);
    for (mspring_id i = 0; i < list->particles; i++)
        JUDGE(it, values[i] == list->mass[i]);
    JUDGE(it, mspring_network_get(p->network, MSPRING_STIFFNESS, NULL, 0, list->springs, values, 1) == MSPRING_OK);
    for (mspring_id i = 0; i < list->springs; i++)
        JUDGE(it, values[i] == list->stiffness[i]);
}

static void judge_view(game *it, const place *p) {
    mspring_view view = {.struct_size = sizeof view};
    double x = 0, y = 0;
    JUDGE(it, mspring_network_get_view(p->network, &view) == MSPRING_OK);
    JUDGE(it, view.particle_count == p->plain->particles);
    for (mspring_id i = 0; i < view.particle_count; i++) {
        if (!p->plain->has_particle[i])
            continue;
        const uint32_t slot = view.slot_of_particle[i];
        JUDGE(it, slot < view.slot_count && view.particle_of_slot[slot] == i);
        JUDGE(it, isfinite(view.x[slot]) && isfinite(view.y[slot]) && isfinite(view.vx[slot] + view.vy[slot]));
    }
    for (uint32_t slot = 0; slot < view.slot_count; slot++)
        JUDGE(it, view.particle_of_slot[slot] == MSPRING_NONE || view.particle_of_slot[slot] < view.particle_count);
    if (view.particle_count == 0)
        return;
    JUDGE(it, mspring_network_get_positions(p->network, NULL, view.particle_count - 1, 1, &x, &y, 1) == MSPRING_OK);
    JUDGE(it, isfinite(x) && isfinite(y));
}

// Compare broken springs. Edits mark theirs immediately; breaks in steps are read after them.
static void judge_flags(game *it, const place *p) {
    static uint32_t flags[MOST_SPRINGS];
    JUDGE(it, mspring_network_get_integers(p->network, MSPRING_SPRING_FLAGS, NULL, 0, p->plain->springs, flags, 1) == MSPRING_OK);
    for (mspring_id i = 0; i < p->plain->springs; i++)
        JUDGE(it, ((flags[i] & MSPRING_SPRING_BROKEN) != 0) == p->plain->is_broken[i]);
}

void judge_place(game *it, place *p) {
    const uint32_t fails = p->memory->fails;
    p->memory->fails = 0;
    JUDGE(it, mspringi_is_finite(p->network));
    JUDGE(it, p->job || support_memory_used(p->network) == p->memory->watched.live_bytes);
    const bool is_small = p->plain->particles < 200;
    if (is_small || it->frame % 16 == 0) {
        judge_contents(it, p);
        judge_view(it, p);
        judge_flags(it, p);
    }
    // Queries have draws of their own, so that they do not change those of the game.
    draws from = {.seed = it->frame * 977u + (uint64_t)it->name * 131u + 7};
    if (is_small || it->frame % 4 == 0)
        judge_queries(it, p, &from);
    p->memory->fails = fails;
}

/* -------------------------------------------------------------------------------------------------- motion */

// Nothing from outside acts: no gravity, floor, pin, grip, collider or hook, no force that was given.
static bool is_closed(const place *p) {
    mspring_settings settings = {.struct_size = sizeof settings};
    mspring_floor_def ground = {.struct_size = sizeof ground};
    mspring_grip_def grip = {.struct_size = sizeof grip};
    mspring_collider_def collider = {.struct_size = sizeof collider};
    static float scales[MOST_PARTICLES];
    if (!p->is_closed || mspring_network_count(p->network, MSPRING_GROUPS) > 0 ||
        mspring_network_get_settings(p->network, &settings) || mspring_network_get_floor(p->network, &ground))
        return false;
    if (settings.gravity_x != 0 || settings.gravity_y != 0 || settings.global_damping > 0 ||
        settings.sleep_speed > 0 || ground.plane_count + ground.height_count > 0)
        return false;
    for (int i = 0; i < MOST_HOOKS; i++)
        if (p->has_hook[i])
            return false;
    for (mspring_id i = 0; i < 200; i++)
        if (mspring_network_get_grip(p->network, i, &grip) == MSPRING_OK ||
            mspring_network_get_collider(p->network, i, &collider) == MSPRING_OK)
            return false;
    if (mspring_network_get(p->network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, p->plain->particles, scales, 1))
        return false;
    for (mspring_id i = 0; i < p->plain->particles; i++)
        if (p->plain->has_particle[i] && scales[i] != 1)
            return false;
    return true;
}

static void sum_momenta(const place *p, momenta *sum) {
    static float vx[MOST_PARTICLES], vy[MOST_PARTICLES];
    if (mspring_network_get_velocities(p->network, NULL, 0, p->plain->particles, vx, vy, 1))
        return;
    for (mspring_id i = 0; i < p->plain->particles; i++) {
        const double mass = p->plain->has_particle[i] ? (double)p->plain->mass[i] : 0;
        sum->x += mass * (double)vx[i], sum->y += mass * (double)vy[i];
        sum->mass += mass;
        sum->scale += mass * (fabs((double)vx[i]) + fabs((double)vy[i]));
    }
}

momenta judge_momenta(const place *p) {
    momenta sum = {.count = is_closed(p)};
    if (sum.count)
        sum_momenta(p, &sum);
    return sum;
}

// The impulses of springs in a step, N s, at the forces that there are now: their rounding is what may be left.
static double impulse_scale(const place *p) {
    static float forces[MOST_SPRINGS];
    double sum = 0;
    if (mspring_network_get(p->network, MSPRING_TENSION, NULL, 0, p->plain->springs, forces, 1))
        return 0;
    for (mspring_id i = 0; i < p->plain->springs; i++)
        sum += fabs((double)forces[i]) * p->dt;
    return sum;
}

void judge_step(game *it, place *p, const momenta *before) {
    mspring_step_info info = {.struct_size = sizeof info};
    mspring_settings solver = {.struct_size = sizeof solver};
    JUDGE(it, mspring_network_get_step_info(p->network, &info) == MSPRING_OK);
    JUDGE(it, mspring_network_get_settings(p->network, &solver) == MSPRING_OK);
    JUDGE(it,
          info.result == MSPRING_OK && info.step_count > 0 && info.flags == support_step_flags(p->network));
    // The bound on repeated work: 32 times most_work (direct: 53 times), one solution and the fallback on top; two
    // steps for each group.
    const double most = (solver.solver == MSPRING_SOLVER_DIRECT ? 58 : 36) * (1.0 + solver.most_work) * (1 + 2.0 * mspring_network_count(p->network, MSPRING_GROUPS)) *
                        (info.flags & MSPRING_STEP_FALLBACK ? 8 : 1);
    JUDGE(it, info.work >= 0 && (solver.most_work == 0 || info.work <= most));
    if (!before->count || info.flags & (MSPRING_STEP_PUT_BACK | MSPRING_STEP_FALLBACK))
        return;
    momenta after = {.x = 0};
    sum_momenta(p, &after);
    // A solution that is not exact, and sums of single precision: 1e-3 of all that is exchanged. Velocities of
    // linear systems come from positions.
    const double tolerance = 1e-3 * (before->scale + after.scale + impulse_scale(p)) +
                             (solver.solver == MSPRING_SOLVER_EXPLICIT ? 1e-7 : 1e-5) * after.mass;
    if (it->setup.is_verbose && (fabs(after.x - before->x) > tolerance || fabs(after.y - before->y) > tolerance))
        printf("solver %d momentum %g %g, then %g %g of %g\n", (int)solver.solver, before->x, before->y, after.x,
               after.y, after.scale);
    JUDGE(it, fabs(after.x - before->x) <= tolerance && fabs(after.y - before->y) <= tolerance);
}
