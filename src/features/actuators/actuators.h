/// @file actuators.h
/// Springs whose rest lengths follow signals.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ACTUATORS_H
#define MSPRINGI_ACTUATORS_H

#include "store/network.h"

/// The rest length of an actuator now, before any flow.
float mspringi_actuator_length(const mspring_network *network, uint32_t actuator);
/// Set it; after mspringi_rest_lengths_unshare().
void mspringi_actuator_set_length(mspring_network *network, uint32_t actuator, float length);

/// Whether rest lengths are to be set where they lie, and nobody has to be told.
static inline bool mspringi_actuators_are_plain(const mspring_network *network) {
    return network->rest_lengths.shared_count == 0 && !network->job && !network->plastic.nominal;
}

#endif
