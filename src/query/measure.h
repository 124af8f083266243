/// @file measure.h
/// Present values of springs, one by one in the order of their ids.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MEASURE_H
#define MSPRINGI_MEASURE_H

#include "store/selection.h"
#include "store/springs.h"

/// Force along a spring: > 0 pulls its ends together.
float mspringi_spring_force(const mspring_network *network, mspring_id spring);
/// Force along a spring whose values were read, with the way from its base to its tip.
float mspringi_force_of(const mspring_network *network, mspring_id spring, const mspringi_spring_values *r,
                        double *dx, double *dy, double *length);

/// Where to write what of each spring: [stride], or NULL.
typedef struct mspringi_lengths {
    float *length, *direction_x, *direction_y, *strain;
    uint32_t length_stride, direction_x_stride, direction_y_stride, strain_stride;
} mspringi_lengths;

/// Compute lengths, directions and strains of springs. A broken spring has strain 0, a removed one 0 everywhere.
void mspringi_measure(const mspring_network *network, const mspringi_selection *at, const mspringi_lengths *to);

#endif
