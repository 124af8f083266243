/// @file selection.h
/// Particles or springs of an edit: a range of ids, or a list of them.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SELECTION_H
#define MSPRINGI_SELECTION_H

#include "base/cpu.h"
#include "store/network.h"

/// Kind of ids.
typedef enum mspringi_kind { MSPRINGI_PARTICLES, MSPRINGI_SPRINGS } mspringi_kind;

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

/// Select the ids of an edit. Check that it may be made now, that its ids exist, and that its values (two arrays,
/// or one twice) are not NULL. A range may contain removed ids: the edit skips them.
mspring_result mspringi_select_range(mspring_network *network, mspringi_kind kind, mspring_id first, uint32_t count,
                                     const void *values, const void *more, mspringi_selection *selection);
/// Select one particle or spring. *id must live as long as the selection.
mspring_result mspringi_select_one(mspring_network *network, mspringi_kind kind, const mspring_id *id,
                                   mspringi_selection *selection);
mspring_result mspringi_select_list(mspring_network *network, mspringi_kind kind, const mspring_id *list,
                                    uint32_t count, const void *values, const void *more,
                                    mspringi_selection *selection);

/// Select the ids of a read-only call; several may run at once. Its values have a stride of at least 1.
mspring_result mspringi_look_up_range(const mspring_network *network, mspringi_kind kind, mspring_id first,
                                      uint32_t count, const void *values, const void *more, uint32_t stride,
                                      mspringi_selection *selection);
mspring_result mspringi_look_up_list(const mspring_network *network, mspringi_kind kind, const mspring_id *list,
                                     uint32_t count, const void *values, const void *more, uint32_t stride,
                                     mspringi_selection *selection);

#endif
