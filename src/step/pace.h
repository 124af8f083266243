/// @file pace.h
/// Substeps of a step where the library counts them: MSPRING_SUBSTEPS_AUTO, MSPRING_SUBSTEPS_EVEN, substep_length.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PACE_H
#define MSPRINGI_PACE_H

#include "store/network.h"

/// Choose the substeps of a step; if may_raise, more for violent motion. With MSPRING_SUBSTEPS_EVEN, choose its
/// length (network->step_time), too. *calm: the substeps for calm motion. UNSTABLE if they are more than
/// max_substeps.
mspring_result mspringi_pace_choose(mspring_network *network, double dt, bool may_raise, uint32_t *calm);

/// With substep_length: true if a dt is too short for a substep. Then it is left to the next step. ARGUMENT if it
/// has too many.
mspring_result mspringi_pace_defer(mspring_network *network, double dt, bool *is_deferred);

/// With substep_length: set the number of substeps of a step that is not deferred, its length and its rest.
void mspringi_pace_keep_length(mspring_network *network, double dt);

/// Note that a step of dt has succeeded.
void mspringi_pace_note(mspring_network *network, double dt);

#endif
