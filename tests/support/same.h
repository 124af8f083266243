/// @file same.h
/// Whether a scene has the same bits at all levels, with several workers, in a clone and after snapshots.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_SAME_H
#define TEST_SAME_H

#include "support.h"

/// A network, made anew from a definition, and what the host does with it for some steps.
typedef struct same_scene {
    mspring_network *(*make)(mspring_network_def def);
    void (*go_on)(mspring_network *network);
} same_scene;

/// Each level of this machine, with one and with three workers, has the same bits.
void same_at_all_levels(const same_scene *scene, mspring_network_def def);

/// So have a clone, and a network that was only just made and got a snapshot; and the clone once more after a
/// frame. Another layout of the clone has other bits, but each particle's height is within tolerance, m.
/// @return the network, for more checks
mspring_network *same_in_copies(const same_scene *scene, mspring_network_def def, double tolerance);

#endif
