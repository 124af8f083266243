/// @file ramps.h
/// Springs whose rest length goes from what they were restored at to their own.
///
/// A restored spring with its rest length in force at once would throw its ends together with all the energy that
/// their distance stands for. One whose rest length starts at that distance exerts nothing at first, damps in full,
/// and pulls its ends in at a pace that the host chooses.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_RAMPS_H
#define MSPRINGI_RAMPS_H

#include "store/network.h"

/// A restored spring on its way to its own rest length.
typedef struct mspringi_ramp {
    mspring_id spring;
    float to;       ///< its own rest length, m
    double from;    ///< rest length when it was restored
    double seconds; ///< that the way takes
    double passed;  ///< of these
} mspringi_ramp;

typedef struct mspringi_ramps {
    mspringi_ramp *list;
    size_t count, capacity;
    uint32_t *of_spring; ///< [spring ids] index of each spring's ramp, if that ramp is of the spring
} mspringi_ramps;

#define MSPRINGI_LONGEST_RAMP 1e6 // s

static inline size_t mspringi_ramp_count(const mspring_network *network) {
    return network->ramps ? network->ramps->count : 0;
}

/// Make room for count ramps more.
mspring_result mspringi_ramps_reserve(mspring_network *network, size_t count);

/// Add a ramp as it is; after mspringi_ramps_reserve().
void mspringi_ramp_add(mspring_network *network, const mspringi_ramp *ramp);

/// Begin a ramp of a live spring from its present length; after mspringi_ramps_reserve(). A weld has none.
void mspringi_ramp_begin(mspring_network *network, mspring_id spring, double seconds);

bool mspringi_has_ramp(const mspring_network *network, mspring_id spring);
/// End a spring's ramp, if it has one, at its own rest length.
void mspringi_ramp_drop(mspring_network *network, mspring_id spring);

/// End all ramps in this way.
void mspringi_ramps_clear(mspring_network *network);

/// Set the rest lengths of all ramps to those of dt seconds from now.
void mspringi_ramps_apply(mspring_network *network, double dt);

#endif
