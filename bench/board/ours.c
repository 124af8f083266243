/// @file ours.c
/// The library's solvers.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "board/methods.h"

static bool begin(motion *r, mspring_solver solver, uint32_t flags) {
    mspring_network_def def;
    if (mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def) != MSPRING_OK)
        return false;
    def.settings.solver = solver;
    def.flags |= flags;
    def.settings.substeps = r->effort;
    def.settings.gravity_y = -(float)r->m->gravity;
    def.settings.global_damping = (float)r->damping;
    r->own = model_network(r->m, &def);
    return r->own != NULL;
}

static bool begin_explicit(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_EXPLICIT, 0);
}

static bool begin_precise(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_EXPLICIT, MSPRING_NETWORK_PRECISE);
}

static bool begin_implicit(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_IMPLICIT, 0);
}

static bool begin_direct(motion *r, double dt) {
    (void)dt;
    return begin(r, MSPRING_SOLVER_DIRECT, 0);
}

static void frame(motion *r, double dt) {
    mspring_network *network = r->own;
    if (mspring_network_step(network, dt) != MSPRING_OK)
        fprintf(stderr, "massspring-board: %s\n", mspring_network_error(network));
}

static void state(const motion *r, model_state *to) {
    const mspring_network *network = r->own;
    const uint32_t n = r->m->particle_count;
    mspring_result result = mspring_network_get_positions(network, NULL, 0, n, to->x, to->y, 1);
    float *vx = malloc(2 * (size_t)n * sizeof *vx), *vy = vx + n;
    if (!vx)
        return;
    result = result ? result : mspring_network_get_velocities(network, NULL, 0, n, vx, vy, 1);
    for (uint32_t i = 0; i < n; i++) {
        to->vx[i] = (double)vx[i];
        to->vy[i] = (double)vy[i];
    }
    free(vx);
    if (result != MSPRING_OK)
        fprintf(stderr, "massspring-board: %s\n", mspring_network_error(network));
}

static bool cut(motion *r, const uint32_t *springs, uint32_t count, double dt) {
    (void)dt;
    return mspring_network_break_springs(r->own, springs, 0, count) == MSPRING_OK;
}

static void end(motion *r) {
    mspring_network_destroy(r->own);
}

#define OURS .frame = frame, .cut = cut, .state = state, .end = end, .effort = "substeps"

const method board_precise = {.name = "ours, explicit, precise", .begin = begin_precise, .colour = 0x16a085, OURS};

const method board_ours[3] = {
    {.name = "ours, explicit",
     .begin = begin_explicit,
     .efforts = {1, 2, 4},
     .by_stability = true,
     .colour = 0x1b3a8f,
     OURS},
    {.name = "ours, implicit", .begin = begin_implicit, .efforts = {1, 2, 4, 8, 16}, .colour = 0x2f7fd6, OURS},
    {.name = "ours, direct", .begin = begin_direct, .efforts = {1, 2, 4, 8, 16}, .colour = 0x7fb2e5, OURS},
};
