/// @file events.h
/// Events, which the host reads between steps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EVENTS_H
#define MSPRINGI_EVENTS_H

#include "store/network.h"

/// Unread events, in a ring that the host reserves.
typedef struct mspringi_events {
    mspring_event *ring;             ///< [capacity]
    uint32_t first, count, capacity; ///< oldest event; unread events; 0: no ring
    uint64_t lost;                   ///< events without room
} mspringi_events;

/// Queue an event, or count it as lost if the queue is full. Without a queue, do nothing.
void mspringi_events_push(mspring_network *network, mspring_event event);

#endif
