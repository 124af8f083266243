/// @file events.h
/// What happened, for the host to read between steps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EVENTS_H
#define MSPRINGI_EVENTS_H

#include "store/network.h"

/// Queue an event, or count it as lost if the queue is full. Without a queue, do nothing.
void mspringi_events_push(mspring_network *network, mspring_event event);

#endif
