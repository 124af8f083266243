/// @file solver.h
/// What a solver is told of the step that it makes.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SOLVER_H
#define MSPRINGI_SOLVER_H

#include <stdint.h>

/// One try at a step. It travels through the step's stages; what the network says of substeps is a setting.
typedef struct mspringi_attempt {
    double dt; ///< s
    float h;   ///< length of a substep, s
    uint32_t substeps;
} mspringi_attempt;

#endif
