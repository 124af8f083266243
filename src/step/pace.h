/// @file pace.h
/// Substeps of a step where they are left to the library: MSPRING_SUBSTEPS_AUTO and MSPRING_SUBSTEPS_EVEN.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PACE_H
#define MSPRINGI_PACE_H

#include "store/network.h"

/// Choose the substeps of a step; if may_raise, more for violent motion. With MSPRING_SUBSTEPS_EVEN, choose its
/// length (network->step_time), too. *calm: the substeps for calm motion. UNSTABLE if they are more than
/// max_substeps.
mspring_result mspringi_pace_choose(mspring_network *network, double dt, bool may_raise, uint32_t *calm);

/// Note that a step of dt has succeeded.
void mspringi_pace_note(mspring_network *network, double dt);

#endif
