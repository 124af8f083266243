/// @file measures.h
/// What the board measures of a method at one effort.
///
/// SPDX-License-Identifier: MIT
#ifndef BOARD_MEASURES_H
#define BOARD_MEASURES_H

#include "board/methods.h"
#include "board/stages.h"

/// Frames of 1/64 s in a second, and in all.
enum { SECOND = 64, FRAMES = 10 * SECOND };
#define FRAME_TIME (1.0 / SECOND) ///< s

/// What all methods are measured against.
typedef struct reference {
    double *shape_x, *shape_y; ///< [particle_count] from the start to rest, m
    model_state after[2];      ///< 1 s and 10 s
    double distance[2];        ///< by how much it has moved
    double swing[FRAMES];      ///< along the shape: 0 at the start, 1 at rest
    double sag;                ///< of the probe at rest, m
    double rise;               ///< work of gravity on the way to rest, J
} reference;

bool reference_find(const stage *on, const model *m, reference *made);
void reference_free(reference *unwanted);

/// Of one method at one effort; NaN: not measured, as it would take too long.
typedef struct result {
    uint32_t effort;
    double us, most_us; ///< of a frame: least and most of the repeats
    double error[2];    ///< after 1 s and 10 s, as a share of how far the network has moved
    double period;      ///< of the slow swing over that of the reference, less 1
    double swing;       ///< how far it swings after 7.5 to 10 s, over the same of the reference
    double soft;        ///< sag at rest over that of the springs as given, less 1
} result;

result measure(const stage *on, const method *by, const model *m, const reference *exact, uint32_t effort);

/// The least number of substeps that symplectic Euler is stable with, and a tenth more.
uint32_t least_substeps(const model *m);

#endif
