/// @file pace.h
/// Substeps of a step where they are left to the library: MSPRING_SUBSTEPS_AUTO and MSPRING_SUBSTEPS_EVEN.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PACE_H
#define MSPRINGI_PACE_H

#include "store/network.h"

/// Choose the substeps of a step, more for violent motion if they may be raised, and with MSPRING_SUBSTEPS_EVEN its
/// time. calm: those that they are in calm motion. UNSTABLE if they are over max_substeps.
mspring_result mspringi_pace_choose(mspring_network *network, double dt, bool may_raise, uint32_t *calm);

/// Note that a step of dt has succeeded.
void mspringi_pace_note(mspring_network *network, double dt);

#endif
