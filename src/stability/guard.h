/// @file guard.h
/// Finding out that a step went wrong.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GUARD_H
#define MSPRINGI_GUARD_H

#include "store/network.h"
#include "store/solver.h"

/// Refuse what is no policy.
mspring_result mspringi_guard_check(mspring_guard policy, mspringi_message *message);

/// Whether a network with this policy looks at the limit.
bool mspringi_guard_checks_limit(mspring_guard policy);

/// Reserve what this policy needs, unless it is there.
mspring_result mspringi_guard_reserve(mspring_network *network, mspring_guard policy);

/// Before a step: MSPRING_OK, or MSPRING_ERROR_UNSTABLE with a message if its substeps are
/// found to be above the limit.
mspring_result mspringi_guard_begin(mspring_network *network, const mspringi_attempt *attempt);

/// Look at the slots first to end - 1, multiples of MSPRINGI_WIDTH, whose state before the step is in the backup.
/// May be called by several threads at once.
mspringi_extrema mspringi_guard_extrema(const mspring_network *network, size_t first, size_t end);
/// The same of all slots, by all workers: each is to keep what it has written in its own core's cache.
mspringi_extrema mspringi_guard_extrema_of_all(const mspring_network *network);

/// After substeps of h from what mspringi_guard_begin() saw: the same, with bounds for what was not watched.
mspringi_extrema mspringi_guard_bound(const mspring_network *network, float h, mspringi_extrema extrema);

/// Put what is out of bounds back into them: before is the state of before the step, or NULL.
void mspringi_guard_clamp_state(mspring_network *network, const mspringi_state *before);

/// The extrema of both, in whatever order they are joined.
mspringi_extrema mspringi_extrema_join(mspringi_extrema a, mspringi_extrema b);

/// Judge the state that the substeps have led to by the extrema of all slots. That of before is in the backup.
mspring_result mspringi_guard_end(mspring_network *network, const mspringi_attempt *attempt,
                                  mspringi_extrema extrema);

#endif
