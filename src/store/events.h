/// @file events.h
/// What happened, for the host to read between steps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EVENTS_H
#define MSPRINGI_EVENTS_H

#include "store/network.h"

/// The events that the host has not read yet: a ring, which there is if the host has asked for one.
typedef struct mspringi_events {
    mspring_event *ring; ///< [capacity]
    uint32_t first, count, capacity;
    uint64_t lost;
} mspringi_events;

/// Queue an event, or count it as lost if the queue is full. Without a queue, do nothing.
void mspringi_events_push(mspring_network *network, mspring_event event);

#endif
