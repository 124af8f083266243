/// @file settle.h
/// Static equilibrium, for those inside the library who may want to stop the search.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SETTLE_H
#define MSPRINGI_SETTLE_H

#include <stdbool.h>

#include <massspring/massspring_tools.h>

/// Whether a search goes on. fn NULL: it does.
typedef struct mspringi_watcher {
    bool (*fn)(void *user);
    void *user;
} mspringi_watcher;

/// mspring_network_settle(), which ends as if there was no equilibrium when the watcher has had enough.
mspring_result mspringi_settle_watched(mspring_network *network, const mspring_settle_def *def,
                                       mspring_settle_result *result, mspringi_watcher watcher);

#endif
