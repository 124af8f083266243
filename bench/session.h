/// @file session.h
/// The calls that a game makes between its steps, and what they need.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_SESSION_H
#define BENCH_SESSION_H

#include "network.h"

/// Springs broken or restored at once: those of a blast.
#define SESSION_BURST 1000u

/// A network and what the calls need.
typedef struct session {
    bench_network *step; ///< the network
    float *values;       ///< [particles or springs, whichever are more]
    float *more_values;
    float *by_spring[4]; ///< [springs] each
    double *x, *y;       ///< [particles]
    void *snapshot;      ///< [snapshot_size] or an archive, which is smaller
    size_t snapshot_size, archive_size;
    mspring_builder *builder; ///< that has read the archive
    mspring_id *list;         ///< [SESSION_BURST] springs, scattered
    uint32_t burst;           ///< of them: SESSION_BURST, or all springs if there are fewer
    uint32_t calls;           ///< so far
} session;

/// Give a session of a network what its calls need. On failure it has to be freed all the same.
bool session_create(bench_network *network, session *out, scene_error *error);
void session_free(session *unwanted);

/// Restore the scattered springs.
mspring_result session_restore(session *with);

/// A call, and what has to be so before it.
typedef struct session_call {
    const char *name;
    void (*prepare)(session *with);
    mspring_result (*call)(session *with);
} session_call;

/// Ended by one without a name.
extern const session_call session_calls[];

#endif
