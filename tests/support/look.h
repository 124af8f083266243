/// @file look.h
/// All that a network can be asked of its particles and springs, to compare two networks, or one with what it was.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_LOOK_H
#define TEST_LOOK_H

#include "support.h"

/// In the order of ids.
typedef struct look {
    uint64_t hash;
    double energy[3], momentum[3];
    support_spring_info *springs;
    float *by_spring[4], *scale;
    uint32_t *component, component_count;
} look;

look look_at(mspring_network *network);

/// Both are of this network, or of another with as many particles and springs, and equal. They are freed.
void check_same_look(look a, look b, const mspring_network *network);

/// Memory full of zeros; fails the test if there is none.
void *look_array(size_t count, size_t size);

#endif
