/// @file guard.h
/// Detection of unstable steps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GUARD_H
#define MSPRINGI_GUARD_H

#include "store/attempt.h"

/// Return an error for an unknown policy.
mspring_result mspringi_guard_check(mspring_guard policy, mspringi_message *message);

/// True if this policy checks the stability limit.
bool mspringi_guard_checks_limit(mspring_guard policy);

/// Reserve memory for this policy, unless it is reserved.
mspring_result mspringi_guard_reserve(mspring_network *network, mspring_guard policy);

/// Check the substep before a step: MSPRING_ERROR_UNSTABLE, with a message, if it exceeds the limit.
mspring_result mspringi_guard_begin(mspring_network *network, const mspringi_attempt *attempt);

/// Extrema of the slots first to end - 1, multiples of MSPRINGI_WIDTH. The backup has the state before the step.
/// Thread-safe.
mspringi_extrema mspringi_guard_extrema(const mspring_network *network, size_t first, size_t end);
/// Extrema of all slots, by all workers: each reads the slots that it wrote, from its own cache.
mspringi_extrema mspringi_guard_extrema_of_all(const mspring_network *network);

/// Fill in bounds for the extrema that were not watched in substeps of h since mspringi_guard_begin().
mspringi_extrema mspringi_guard_bound(const mspring_network *network, float h, mspringi_extrema extrema);

/// Extrema of both sets of slots. The order of joining does not matter.
mspringi_extrema mspringi_extrema_join(mspringi_extrema a, mspringi_extrema b);

/// Check the state after the substeps by the extrema of all slots, and if their solver had the work that it needed.
/// The backup has the state before the step.
mspring_result mspringi_guard_end(mspring_network *network, const mspringi_attempt *attempt,
                                  mspringi_extrema extrema);

#endif
