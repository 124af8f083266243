/// @file hooks.h
/// Host functions that are called in the course of a step.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_HOOKS_H
#define MSPRINGI_HOOKS_H

#include "store/network.h"
#include "store/safe_box.h"

/// Whether any particle may come below the height of a hook with MSPRING_HOOK_BELOW in a step.
typedef enum mspringi_distance { MSPRINGI_UNKNOWN, MSPRINGI_AWAY, MSPRINGI_CLOSE } mspringi_distance;

typedef struct mspringi_hook {
    mspring_hook_def def;
    uint32_t number;
    mspringi_field held; ///< forces of a hook that is not called before every substep; else none
    mspringi_distance distance;
    mspringi_safe_box safe; ///< above its height, that all of the network was in
} mspringi_hook;

typedef struct mspringi_hooks {
    mspringi_hook *list; ///< [count]
    size_t count, capacity;
    uint32_t next_number;
    mspring_result refused; ///< in this attempt at a step, by a hook; MSPRING_OK: by none
    uint32_t refused_by;
    mspring_id hurled; ///< particle for which it is MSPRING_ERROR_UNSTABLE, if is_hurled
    bool is_hurled;
    bool ends_step; ///< a hook has refused the attempt that failed last
} mspringi_hooks;

static inline size_t mspringi_hook_count(const mspring_network *network) {
    return network->hooks ? network->hooks->count : 0;
}

/// True if a hook has refused the attempt that failed: no other one follows, whatever it refused with. Asked once.
bool mspringi_hooks_end_step(const mspring_network *network);
/// Forget all hooks of a copy, without a word to the host.
void mspringi_hooks_clear(mspring_network *network);
/// Make the hooks of a copy its own: those that cannot be retained are left out.
void mspringi_hooks_retain(mspring_network *network);

#endif
