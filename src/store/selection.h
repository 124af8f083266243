/// @file selection.h
/// Things that a call is about, such as particles or springs: a range of ids, or a list of them.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SELECTION_H
#define MSPRINGI_SELECTION_H

#include "base/cpu.h"
#include "store/network.h"

typedef struct mspringi_selection {
    const mspring_id *list; ///< [count], or NULL for first, first + 1 ...
    mspring_id first;
    uint32_t count;
} mspringi_selection;

static inline mspring_id mspringi_selected(const mspringi_selection *selection, uint32_t i) {
    return selection->list ? selection->list[i] : selection->first + i;
}

/// Distance of prefetching in a selection: neighbours by id may lie anywhere in the rows, and a step leaves little
/// of the state in the near caches.
#define MSPRINGI_AHEAD 32u

/// Slot of the particle that a loop over a selection reaches MSPRINGI_AHEAD later, or of its last.
static inline uint32_t mspringi_slot_ahead(const mspring_network *network, const mspringi_selection *selection,
                                           uint32_t i) {
    const uint32_t left = selection->count - 1 - i;
    return network->topology
        .slot_of_particle[mspringi_selected(selection, i + (left < MSPRINGI_AHEAD ? left : MSPRINGI_AHEAD))];
}

/// Select the things of an edit: ids[first ...], or first ... if ids is NULL. Check that it may be made now, and
/// that its ids exist. A range may contain removed ids: the edit skips them. Count may be MSPRING_ALL for a range.
mspring_result mspringi_select(mspring_network *network, mspring_kind kind, const mspring_id *ids, mspring_id first,
                               uint32_t count, mspringi_selection *selection);
/// The same for an edit with values: two arrays, or one twice, not NULL. MSPRING_ALL needs the stride 0.
mspring_result mspringi_select_for(mspring_network *network, mspring_kind kind, const mspring_id *ids,
                                   mspring_id first, uint32_t count, const void *values, const void *more,
                                   uint32_t stride, mspringi_selection *selection);
/// Select one particle or spring. *id must live as long as the selection.
mspring_result mspringi_select_one(mspring_network *network, mspring_kind kind, const mspring_id *id,
                                   mspringi_selection *selection);

/// Select the things of a call that reads; several may run at once. Values have a stride of at least 1.
mspring_result mspringi_look_up(const mspring_network *network, mspring_kind kind, const mspring_id *ids,
                                mspring_id first, uint32_t count, mspringi_selection *selection);
/// The same for a call on another object, which gets the message.
mspring_result mspringi_look_up_with(mspringi_message *message, const mspring_network *network, mspring_kind kind,
                                     const mspring_id *ids, mspring_id first, uint32_t count,
                                     mspringi_selection *selection);
mspring_result mspringi_look_up_for(const mspring_network *network, mspring_kind kind, const mspring_id *ids,
                                    mspring_id first, uint32_t count, const void *values, const void *more,
                                    uint32_t stride, mspringi_selection *selection);

#endif
