/// @file springs.h
/// What springs are like, wherever they lie.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SPRINGS_H
#define MSPRINGI_SPRINGS_H

#include "network.h"

/// What a spring is like, and the slots that it joins.
typedef struct mspringi_spring_values {
    float rest_length, stiffness, damping;
    uint32_t base, tip;
} mspringi_spring_values;
mspringi_spring_values mspringi_spring_get(const mspring_network *network, mspring_id spring);
/// Set rest length, stiffness and damping, wherever the spring has records.
void mspringi_spring_set(mspring_network *network, mspring_id spring, const mspringi_spring_values *values);

/// Derive stiffness and damping of the relative springs for a substep; 0: as before the first one, both 0.
void mspringi_derive_relative(mspring_network *network, float h);

#endif
