/// @file safe_box.h
/// A box that no surface is near.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SAFE_BOX_H
#define MSPRINGI_SAFE_BOX_H

#include <math.h>

#include "kernels/kernels.h"

typedef struct mspringi_safe_box {
    mspringi_bounds box;
    float coordinate;          ///< coordinates of less than this size are in the box
    double reach;              ///< half as far from the box there is no surface; 0: there is no such box
    double origin_x, origin_y; ///< that it is relative to
} mspringi_safe_box;

#endif
