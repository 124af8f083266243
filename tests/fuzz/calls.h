/// @file calls.h
/// A call with arguments of any kind, for fuzz_calls.c.
///
/// SPDX-License-Identifier: MIT
#ifndef FUZZ_CALLS_H
#define FUZZ_CALLS_H

#include <stdbool.h>

#include <massspring/massspring.h>

typedef struct call {
    uint8_t kind;
    mspring_id particle, spring, first; ///< ids, now and then one that is not there
    uint32_t count;                     ///< 0 to 2
    float a, b;
    double dt;
    mspring_solver solver;
} call;

/// calls_laws.c: add, change or remove an area or angle springs.
mspring_result call_laws(mspring_network *network, const call *c);
/// True if there is an area or an angle spring.
bool call_has_laws(const mspring_network *network);
/// Make groups and actuators of springs, signal, mark and reset.
mspring_result call_batch(mspring_network *network, const call *c);
/// Mix what areas, angle springs and groups are into a hash, with the function that mixes bytes.
void call_look(const mspring_network *network, uint64_t *look, void (*mix)(uint64_t *, const void *, size_t));

#endif
