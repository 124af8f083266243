/// @file measure.h
/// Present values of springs, one by one in the order of their ids.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MEASURE_H
#define MSPRINGI_MEASURE_H

#include "store/selection.h"

/// Length and strain of the spring in a spring slot; the strain of a broken one is 0.
float mspringi_spring_slot_length(const mspring_network *network, mspringi_spring_slot spring_slot);
float mspringi_spring_slot_strain(const mspring_network *network, mspringi_spring_slot spring_slot);

/// Force along a spring: > 0 pulls its ends together.
float mspringi_spring_force(const mspring_network *network, mspring_id spring);

/// MSPRING_LENGTH or MSPRING_STRAIN of springs, `stride` floats apart. Equal to the functions above up to rounding.
void mspringi_measure(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                      float *out, size_t stride);

#endif
