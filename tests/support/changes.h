/// @file changes.h
/// What a host may do to a network that wakes what sleeps of it.
///
/// SPDX-License-Identifier: MIT
#ifndef CHANGES_H
#define CHANGES_H

#include <massspring/massspring.h>

/// One change: of a particle, or of a spring.
typedef void (*change_fn)(mspring_network *network, mspring_id particle, mspring_id spring);

typedef struct change {
    const char *name;
    change_fn make;
} change;

enum { CHANGE_COUNT = 11 };

/// All there are. Each has its effect in the next step.
extern const change changes[CHANGE_COUNT];

void change_push(mspring_network *network, mspring_id particle, mspring_id spring);
void change_shift(mspring_network *network, mspring_id particle, mspring_id spring);
void change_write_view(mspring_network *network, mspring_id particle, mspring_id spring);
void change_fill(mspring_network *network, mspring_id particle, mspring_id spring);
void change_break(mspring_network *network, mspring_id particle, mspring_id spring);

#endif
