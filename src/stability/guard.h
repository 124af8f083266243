/// @file guard.h
/// Finding out that a step went wrong.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GUARD_H
#define MSPRINGI_GUARD_H

#include "network/network.h"

/// Before a step in substeps of h: MSPRING_OK, or MSPRING_ERROR_UNSTABLE with a message if they are above the
/// border. Works in the backup of the state, which has to be that of the step before.
mspring_result mspringi_guard_begin(mspring_network *network, double dt, float h);

/// Judge the state that the substeps have led to.
mspring_result mspringi_guard_end(mspring_network *network, double dt, float h);

#endif
