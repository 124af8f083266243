/// @file components.h
/// Which particles hang together by springs that are not broken.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COMPONENTS_H
#define MSPRINGI_COMPONENTS_H

#include "layout/topology.h"

/// The components as of the last update. Each is named by its lowest particle, its head, and numbered in the order
/// of the heads.
typedef struct mspringi_components {
    uint32_t *number; ///< [particles] of the component; NULL before the first update
    uint32_t *old;    ///< [particles] the numbers before, while an update is made
    mspring_id *head; ///< [particles] of each component
    mspring_id *old_head;
    uint32_t *size; ///< [particles] of each component
    uint32_t *root; ///< [slots] while an update is made, the lowest slot that a slot hangs together with
    uint32_t count; ///< 0 before the first update
    uint64_t seen, seen_growth; ///< edits.links and edits.growth that they account for
} mspringi_components;

#endif
