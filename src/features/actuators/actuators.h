/// @file actuators.h
/// Springs whose rest lengths follow signals.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ACTUATORS_H
#define MSPRINGI_ACTUATORS_H

#include "store/network.h"

typedef struct mspringi_actuators {
    uint32_t count;
    uint32_t changes;    ///< in a step
    bool are_pending;    ///< signals came since the last step
    mspring_id *spring;  ///< [count]
    uint32_t *of_spring; ///< [springs] number of the actuator, or MSPRING_NONE
    float *nominal;      ///< [count] rest length at signal 1, m
    float *to;           ///< [count] at the end of the next step
    float *from;         ///< [count] at the beginning of the step that is being made, if signals came before it
    float *bent_from;    ///< [count] and what was in force then; where springs yield
} mspringi_actuators;

static inline uint32_t mspringi_actuator_count(const mspring_network *network) {
    return network->actuators ? network->actuators->count : 0;
}

/// The rest length of an actuator now, before any flow.
float mspringi_actuator_length(const mspring_network *network, uint32_t actuator);
/// Set it; after mspringi_rest_lengths_unshare().
void mspringi_actuator_set_length(mspring_network *network, uint32_t actuator, float length);

/// Whether rest lengths are to be set where they lie, and nobody has to be told.
static inline bool mspringi_actuators_are_plain(const mspring_network *network) {
    return network->rest_lengths.shared_count == 0 && !network->job && !network->tested.nominal && !network->metres;
}

#endif
