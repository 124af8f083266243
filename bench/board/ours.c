/// @file ours.c
/// The library's solvers, and what motions of all methods share.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "board/methods.h"

static bool begin(motion *r, mspring_solver solver) {
    mspring_network_def def;
    if (mspring_network_def_init(&def, sizeof def) != MSPRING_OK)
        return false;
    def.solver = solver;
    def.substeps = r->effort;
    def.gravity_y = -(float)r->m->gravity;
    def.global_damping = (float)r->damping;
    r->own = model_network(r->m, &def);
    return r->own != NULL;
}

static bool begin_explicit(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_EXPLICIT);
}

static bool begin_implicit(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_IMPLICIT);
}

static bool begin_direct(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_DIRECT);
}

static void frame(motion *r, double dt) {
    mspring_network *network = r->own;
    if (mspring_network_step(network, dt) != MSPRING_OK)
        fprintf(stderr, "massspring-board: %s\n", mspring_network_error(network));
}

static void positions(const motion *r, double *x, double *y) {
    const mspring_network *network = r->own;
    if (mspring_network_get_positions(network, 0, r->m->particle_count, x, y, 1) != MSPRING_OK)
        fprintf(stderr, "massspring-board: %s\n", mspring_network_error(network));
}

static void end(motion *r) {
    mspring_network_destroy(r->own);
}

#define OURS .frame = frame, .positions = positions, .end = end, .effort = "substeps"

const method board_ours[3] = {
    {.name = "ours, explicit", .begin = begin_explicit, .efforts = {1, 2, 4}, .by_stability = true, OURS},
    {.name = "ours, implicit", .begin = begin_implicit, .efforts = {1, 2, 4, 8, 16}, OURS},
    {.name = "ours, direct", .begin = begin_direct, .efforts = {1, 2, 4, 8, 16}, OURS},
};

/* ------------------------------------------------------------------------------------------------------- motions
 */

bool motion_begin(motion *run, const method *by, const model *m, uint32_t effort, double damping, double dt) {
    const size_t n = m->particle_count;
    double *memory = calloc(8 * n, sizeof *memory);
    *run = (motion){.m = m, .effort = effort, .damping = damping};
    if (!memory)
        return false;
    double **arrays[] = {&run->x,     &run->y,     &run->vx,     &run->vy,
                         &run->old_x, &run->old_y, &run->goal_x, &run->goal_y};
    for (size_t i = 0; i < 8; i++)
        *arrays[i] = memory + i * n;
    for (size_t i = 0; i < n; i++) {
        run->x[i] = m->x[i];
        run->y[i] = m->y[i];
    }
    return !by->begin || by->begin(run, dt);
}

void motion_positions(const motion *run, const method *by, double *x, double *y) {
    if (by->positions) {
        by->positions(run, x, y);
        return;
    }
    for (uint32_t i = 0; i < run->m->particle_count; i++) {
        x[i] = run->x[i];
        y[i] = run->y[i];
    }
}

void motion_end(motion *run, const method *by) {
    if (by->end)
        by->end(run);
    free(run->x);
    *run = (motion){0};
}
