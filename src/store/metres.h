/// @file metres.h
/// Springs whose limits are elongations in metres (MSPRING_SPRING_METRES).
///
/// Breaking, warning and yielding go by strains of the rest length that the host gave, for these springs, too.
/// Beside them lie the metres as they were given. They are read back, and the strains are renewed from them if the
/// rest length is set.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_METRES_H
#define MSPRINGI_METRES_H

#include "builder/builder.h"
#include "store/network.h"

/// Limits of a spring that may be in metres: MSPRING_BREAK_STRAIN to MSPRING_YIELD_STRAIN.
enum { MSPRINGI_METRES = MSPRING_YIELD_STRAIN - MSPRING_BREAK_STRAIN + 1 };

/// Limits of a spring, m; NULL if it has strains. (No break strain is 0.)
static inline float *mspringi_metres_of(const mspring_network *network, mspring_id spring) {
    float *metres = network->metres ? network->metres + (size_t)MSPRINGI_METRES * spring : NULL;
    return metres && metres[0] != 0.0f ? metres : NULL;
}

/// The limit in metres that a property is; NULL if it is none.
static inline float *mspringi_metres_at(const mspring_network *network, mspring_property property,
                                        mspring_id spring) {
    float *metres = mspringi_metres_of(network, spring);
    return metres && property >= MSPRING_BREAK_STRAIN && property <= MSPRING_YIELD_STRAIN
               ? metres + (property - MSPRING_BREAK_STRAIN)
               : NULL;
}

/// Make room if a spring has these flags.
mspring_result mspringi_metres_reserve(mspring_network *network, uint32_t flags);
/// Note the limits of a new spring; return them as strains.
mspringi_limits mspringi_metres_put(mspring_network *network, mspring_id spring, mspringi_limits limits);
/// Note a limit, if the spring has metres; return it as a strain.
float mspringi_metres_set(mspring_network *network, mspring_property property, mspring_id spring, float value);
/// Renew the strains of a spring, if it has metres: its rest length was set.
void mspringi_metres_renew(mspring_network *network, mspring_id spring);

#endif
