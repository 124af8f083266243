/// @file settle.h
/// Static equilibrium with a search that the library itself can stop.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SETTLE_H
#define MSPRINGI_SETTLE_H

#include <stdbool.h>

#include "base/structs.h"

/// Callback that returns false to stop a search. fn NULL: none.
typedef struct mspringi_watcher {
    bool (*fn)(void *user);
    void *user;
} mspringi_watcher;

/// mspring_network_settle() with a watcher. A stopped search ends as if there was no equilibrium.
mspring_result mspringi_settle_watched(mspring_network *network, const mspring_settle_def *def,
                                       mspring_settle_result *result, mspringi_watcher watcher);

/// False if it has refused elements of this network.
bool mspringi_can_settle(const mspring_network *network);

#endif
