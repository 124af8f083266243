/// @file changed.h
/// Notification of changes of a network. changes.def lists who is told of which.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CHANGED_H
#define MSPRINGI_CHANGED_H

#include "store/network.h"

typedef enum mspringi_change {
#define CHANGE(name, listeners) MSPRINGI_CHANGED_##name,
#include "store/changes.def"
#undef CHANGE
    MSPRINGI_CHANGES
} mspringi_change;

/// Tell all listeners, once the change has been made.
void mspringi_dispatch_change(mspring_network *network, mspringi_change what, uint32_t index);

/// Allocate the log of springs that were broken or restored, if it is not there yet: before any is.
mspring_result mspringi_changed_reserve_log(mspring_network *network);

/// Tell all listeners, but of a single spring slot only during a job, which alone listens: springs are set by the
/// million.
static inline void mspringi_notify_change(mspring_network *network, mspringi_change what, uint32_t index) {
    if (what != MSPRINGI_CHANGED_PLACE || network->job)
        mspringi_dispatch_change(network, what, index);
}

/// Numbers of edits in the fingerprint of parameters, by which a snapshot tells if it fits a network. Edits of a
/// spring's values have the numbers of its parts.
typedef enum mspringi_edit {
    MSPRINGI_EDIT_PARTS = 0,
    MSPRINGI_EDIT_BREAK_STRAIN = 8,
    MSPRINGI_EDIT_STRESS_STRAIN = 9,
    MSPRINGI_EDIT_RELAX_STRAIN = 10,
    MSPRINGI_EDIT_YIELD_STRAIN = 11,
    MSPRINGI_EDIT_HARDENING = 12,
    MSPRINGI_EDIT_PLASTIC_LIMIT = 13,
    MSPRINGI_EDIT_ADDED_PARTICLE = 16,
    MSPRINGI_EDIT_ADDED_SPRING = 17,
    MSPRINGI_EDIT_ADDED_RELATIVE = 18,
    MSPRINGI_EDIT_REMOVED_PARTICLE = 20,
    MSPRINGI_EDIT_REMOVED_SPRING = 21,
    MSPRINGI_EDIT_RECYCLED = 22,
    MSPRINGI_EDIT_ADDED_AREA = 24,
    MSPRINGI_EDIT_SET_AREA = 25,
    MSPRINGI_EDIT_REMOVED_AREA = 26
} mspringi_edit;

void mspringi_fingerprint(mspring_network *network, uint32_t edit, mspring_id id);
void mspringi_fingerprint_floats(mspring_network *network, float a, float b);

#endif
