/// @file sleep.h
/// Sleep of islands at rest, until something disturbs them.
///
///   sleep.c      falling asleep and waking
///   islands.c    islands, and blocks that are swept while some sleep
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SLEEP_H
#define MSPRINGI_SLEEP_H

#include "store/sleepers.h"

/// First sleeping slot from `slot` on that the next step wakes, as its position, velocity or mass has changed since
/// it fell asleep. The number of slots if there is none.
size_t mspringi_next_disturbed_sleeper(const mspring_network *network, size_t slot);

/// Put the marked islands to sleep in their present state, under these forces (x NULL: none).
void mspringi_sleep_fall(mspring_network *network, mspringi_field force);

/// Find the islands if edits have changed their links. They keep their time at rest and their sleep.
void mspringi_islands_find(mspring_network *network);
/// Update the blocks and strips to sweep, after islands fell asleep or woke.
void mspringi_islands_map(mspring_network *network);
/// Only update the active inverse masses of awake particles.
void mspringi_islands_update_masses(mspring_network *network);

#endif
