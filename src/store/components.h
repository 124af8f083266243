/// @file components.h
/// Components: particles connected by live springs.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COMPONENTS_H
#define MSPRINGI_COMPONENTS_H

#include "layout/topology.h"

/// Components at the last update. Each is named by its lowest particle, its head, and numbered in the order of
/// heads.
typedef struct mspringi_components {
    uint32_t *number;           ///< [particles] number of each one's component; NULL before the first update
    uint32_t *old;              ///< [particles] former numbers, during an update
    mspring_id *head;           ///< [components, at most particles] head of each
    mspring_id *old_head;       ///< [components] former heads, during an update
    uint32_t *size;             ///< [components] particles of each
    uint32_t *first;            ///< [components] its first one in `particles`
    mspring_id *particles;      ///< [particles] by component
    uint32_t *root;             ///< [slots] lowest slot of each one's component, during an update
    uint32_t count;             ///< 0 before the first update
    uint64_t seen, seen_growth; ///< edits.links and edits.growth at the last update
} mspringi_components;

struct mspring_network;
/// Ids of removed particles will be given again: have them in no component any more.
void mspringi_components_forget_removed(struct mspring_network *network);

#endif
