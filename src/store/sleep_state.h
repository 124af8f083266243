/// @file sleep_state.h
/// Islands that sleep.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SLEEP_STATE_H
#define MSPRINGI_SLEEP_STATE_H

#include "layout/topology.h"
#include "store/solver.h"

/// Which islands sleep, and what they were when they fell asleep; no arrays if none ever does. An island is a
/// component of live springs, numbered by its lowest slot.
typedef struct mspringi_sleep {
    uint32_t count;    ///< islands; 0: not looked for yet
    uint32_t sleeping; ///< of these asleep; what follows of slots and blocks is of no use as long as this is 0
    uint32_t *island;  ///< [slots] of each slot, MSPRING_NONE if it has no particle
    uint32_t *lowest;  ///< [particles] the lowest slot of each island
    uint32_t *beside;  ///< [slots] of the lowest one of a sleeper: that of the next in its pile, in a ring
    double *still;     ///< [particles] of each island, for how long it has been still, s; < 0: asleep
    double *kept;      ///< [particles] still before the step, if it woke any
    bool has_kept;
    bool is_mapped;         ///< what follows is up to date
    uint8_t *mark;          ///< [particles] of each island, while all are gone through
    uint32_t *scratch;      ///< [slots]
    uint32_t *block_island; ///< [blocks] the island that all of a block is of, MSPRING_NONE if there are several
    float *active_inverse_mass;    ///< [slots] inverse mass, 0 of what sleeps
    uint16_t *sleepers;            ///< [blocks] a bit for each slot
    uint8_t *swept;                ///< [blocks] 1 where a particle is awake, or springs are of one that is
    uint8_t *share;                ///< [strips] mspringi_strip_sleep
    mspringi_span *runs;           ///< [spans] runs of blocks of a row while that is swept, from its first span on
    bool has_force;                ///< force is not all zero
    double origin_x, origin_y;     ///< that state is relative to, m
    float *state;                  ///< [MSPRINGI_STATE_ARRAYS][slots]
    float *inverse_mass;           ///< [slots]
    float *held;                   ///< [4][slots] positions and their low words, while substeps are taken
    mspringi_field force;          ///< from outside
    mspringi_field in_force;       ///< of the step that is being made; else NULL
    uint64_t masses, links, moved; ///< edits that it has seen; the last is edits.state
    uint64_t piled;                ///< edits.sleep_changes for which piles were found
} mspringi_sleep;

#endif
