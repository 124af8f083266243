/// @file check.h
/// Invariants of every network, after any calls.
///
/// SPDX-License-Identifier: MIT
#ifndef FUZZ_CHECK_H
#define FUZZ_CHECK_H

#include <massspring/massspring.h>

#include "fuzz.h"

/// A snapshot.
typedef struct fuzz_saved {
    uint8_t *bytes;
    size_t size;
} fuzz_saved;

fuzz_saved fuzz_save(const mspring_network *network);
/// Check that a network saves these bytes. The message says after what.
void fuzz_check_saves(const mspring_network *network, const fuzz_saved *expected, const char *after);

/// Check that all numbers of a network are finite, and that it takes its own snapshot and saves the same bytes
/// after it.
void fuzz_check_network(mspring_network *network);

/// Step, and check the network. If the step is refused, check that the snapshot is the same, and that calmer steps
/// lead to where they lead a copy that has not tried.
mspring_result fuzz_step(mspring_network *network, double dt);

#endif
