/// @file ladder.h
/// The attempts at a step, from the one that the host's settings ask for to the last resort of the guard.
///
///   - an assumption of a stage failed: the same without it, at most once for each stage; its work does not count;
///   - it lacked room (LIMIT): the same with more, if the host allows it; its work does not count;
///   - groups failed: with these held, then with doubtful ones released;
///   - unstable, with MSPRING_GUARD_CLAMP or _IMPLICIT; overflowed, with _CLAMP_BOUNDS: one of the fallback;
///   - unstable, with MSPRING_GUARD_RETRY: twice the substeps, within max_substeps and most_work;
///   - anything else: none.
///
/// Work is counted from what was computed, never from time: an explicit substep 1, a clamped one 3, an implicit or
/// direct one 1 for each 8 products and for each pass of the active set. Their own repetitions within a substep are
/// bounded by attempt->most_work, too (solvers/implicit/work.c). An attempt that leaves some of these undone
/// stands, and is flagged; with MSPRING_GUARD_GROWTH and _RETRY it is unstable. Contact counts comparisons besides,
/// against a limit of its own (features/contact/contact_stage.c): beyond that the step fails with LIMIT.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LADDER_H
#define MSPRINGI_LADDER_H

#include "store/attempt.h"
#include "store/stages.h"

/* ladder.c: which attempt follows. step/step.c calls first, then make and next until next is false, then accept. */

/// Prepare the first attempt at a step of dt. If it cannot be made, its result is an error.
void mspringi_attempt_first(mspring_network *network, double dt, const mspringi_stages *stages,
                            mspringi_attempt *first);

/// Prepare the attempt that follows one that was made. False: none follows, and its result is that of the step.
bool mspringi_attempt_next(mspring_network *network, mspringi_attempt *attempt);

/// Accept the last attempt, which succeeded.
void mspringi_attempt_accept(mspring_network *network, const mspringi_attempt *attempt);

/* attempt.c: one attempt */

/// Make a prepared attempt; one with an error stays as it is. Unless it succeeds, the state is that before the
/// step.
void mspringi_attempt_make(mspring_network *network, mspringi_attempt *attempt);

/// Undo an attempt that succeeded.
void mspringi_attempt_take_back(mspring_network *network, const mspringi_attempt *attempt);

#endif
