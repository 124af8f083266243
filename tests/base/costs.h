/// @file costs.h
/// Cost of a series of calls: instructions, or processor time where the system counts none, and peak memory.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_COSTS_H
#define TEST_COSTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <massspring/massspring.h>

/// Costs of the stretch between costs_begin() and costs_end().
typedef struct costs {
    mspring_allocator allocator; ///< for what the stretch makes
    double work;                 ///< instructions, or seconds
    double bytes;                ///< largest size of all blocks at one time
    size_t live, most;
    double start;
} costs;

/// Begin to count all blocks of an allocator.
void costs_open(costs *c);

void costs_begin(costs *c);
void costs_end(costs *c);

/// True if instructions are counted.
bool costs_are_instructions(void);

#endif
