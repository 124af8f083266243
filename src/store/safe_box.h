/// @file safe_box.h
/// Safe box: a box around particles, with no surface near.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SAFE_BOX_H
#define MSPRINGI_SAFE_BOX_H

#include <math.h>

#include "kernels/kernels.h"

typedef struct mspringi_safe_box {
    mspringi_bounds box;
    float coordinate;          ///< particles whose coordinates are below this in size are in the box, m
    double reach;              ///< m; no surface is nearer to the box than half of it; 0: there is no such box
    double origin_x, origin_y; ///< local origin of the box, m
} mspringi_safe_box;

#endif
