/// @file ladder.h
/// The attempts at a step, from the one that the host's settings ask for to the last resort of the guard.
///
///   - a stage counted on what did not hold: the same without that, at most once for each stage, and not counted;
///   - groups went wrong: with these held, then with doubtful ones released;
///   - unstable, with MSPRING_GUARD_CLAMP or _IMPLICIT; overflowed, with _CLAMP_BOUNDS: one of the fallback;
///   - unstable, with MSPRING_GUARD_RETRY: twice the substeps, while max_substeps and most_work last;
///   - anything else: none.
///
/// Work is counted from what was computed, never from time: an explicit substep 1, a clamped one 3, an implicit or
/// direct one 1 for each 8 products and for each pass of the active set. Their own repetitions within a substep are
/// bounded by attempt->most_work, too (solvers/implicit/work.c).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LADDER_H
#define MSPRINGI_LADDER_H

#include "store/attempt.h"
#include "store/stages.h"

/// First attempt at a step of dt. Its result says if it can be made.
void mspringi_attempt_first(mspring_network *network, double dt, const mspringi_stages *stages,
                            mspringi_attempt *first);

/// Make an attempt whose result is MSPRING_OK so far. Unless it succeeds, the state is that of before.
void mspringi_attempt_make(mspring_network *network, mspringi_attempt *attempt);

/// Turn an attempt that was made into the one that follows. False: none does, and its result is that of the step.
bool mspringi_attempt_next(mspring_network *network, mspringi_attempt *attempt);

/// Undo an attempt that succeeded.
void mspringi_attempt_take_back(mspring_network *network, const mspringi_attempt *attempt);

/// Accept the last attempt, which succeeded.
void mspringi_attempt_accept(mspring_network *network, const mspringi_attempt *attempt);

#endif
