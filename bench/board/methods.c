/// @file methods.c
/// All methods, and what their motions share.
///
/// SPDX-License-Identifier: MIT
#include "board/methods.h"

#include <stdlib.h>
#include <string.h>

const method *const board_methods[BOARD_MOST_METHODS + 1] = {
    &board_ours[0],
    &board_ours[1],
    &board_ours[2],
    &board_naive,
    &board_pbd,
    &board_xpbd,
    &board_vbd,
    &board_projective,
#ifdef BOARD_BOX2D
    &board_box2d,
#endif
#ifdef BOARD_CHIPMUNK
    &board_chipmunk,
#endif
    NULL,
};

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
    if (!by->begin || by->begin(run, dt))
        return true;
    motion_end(run, by);
    return false;
}

void motion_state(const motion *run, const method *by, model_state *to) {
    const size_t size = run->m->particle_count * sizeof *to->x;
    if (by->state) {
        by->state(run, to);
        return;
    }
    memcpy(to->x, run->x, size);
    memcpy(to->y, run->y, size);
    memcpy(to->vx, run->vx, size);
    memcpy(to->vy, run->vy, size);
}

void motion_end(motion *run, const method *by) {
    if (by->end)
        by->end(run);
    free(run->x);
    *run = (motion){0};
}
