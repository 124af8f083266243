/// @file sleep.h
/// A network that lies still is left alone until something happens to it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SLEEP_H
#define MSPRINGI_SLEEP_H

#include "network/network.h"

/// Allocate what a network that may sleep needs, unless it is there.
mspring_result mspringi_sleep_reserve(mspring_network *network);
void mspringi_sleep_free(const mspringi_sleep *sleep, mspringi_memory *memory);

/// It sleeps no more.
void mspringi_wake(mspring_network *network);

/// Whether something that is asleep has been changed since: its state, masses or springs.
bool mspringi_sleep_is_disturbed(const mspring_network *network);

/// Before a step: wake it if it has been disturbed, or if the step would change its springs.
void mspringi_sleep_begin(mspring_network *network, double dt);
/// Whether a step has nothing to do at all: asleep, with no hook to call and no force to compare.
bool mspringi_sleep_is_idle(const mspring_network *network);
/// In a step, once the forces from outside are known: wake it if they are others than when it fell asleep.
void mspringi_sleep_feel(mspring_network *network, mspringi_field force);
/// After a step: wake it if a hook has moved something, or see whether it falls asleep.
void mspringi_sleep_end(mspring_network *network, double dt);

/// Have it sleep as it is now, under these forces (x NULL: none).
void mspringi_sleep_fall(mspring_network *network, mspringi_field force);

#endif
