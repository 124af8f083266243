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
    uint32_t count;    ///< islands; 0: not found yet
    uint32_t sleeping; ///< islands asleep; while it is 0, the arrays by slot and block below are stale
    uint32_t *island;  ///< [slots] island of each slot; MSPRING_NONE without a particle
    uint32_t *lowest;  ///< [particles] the lowest slot of each island
    uint32_t *beside;  ///< [slots] piles as rings: by a sleeper's lowest slot, that of the next island in its pile
    double *still;     ///< [islands, at most particles] for how long each has been still, s; < 0: asleep
    double *kept;      ///< [islands] `still` before the step, if it woke any
    bool has_kept;
    bool is_mapped;             ///< the arrays below are up to date
    uint8_t *mark;              ///< [islands] mark during a loop over all
    uint32_t *scratch;          ///< [slots]
    uint32_t *block_island;     ///< [blocks] island of the whole block; MSPRING_NONE if it has several
    float *active_inverse_mass; ///< [slots] inverse mass, 0 for sleepers, 1/kg
    uint16_t *sleepers;         ///< [blocks] a bit for each slot: it sleeps
    uint8_t *swept;             ///< [blocks] 1 if it has an awake particle, or springs of one
    uint8_t *share;             ///< [strips] mspringi_strip_sleep
    mspringi_span *runs;        ///< [spans] runs of swept blocks of a row, during its sweep, from its first span on
    bool has_force;             ///< force is not all zero
    double origin_x, origin_y;  ///< origin of `state`, m
    float *state;               ///< [mspringi_state_arrays()][slots] state when islands fell asleep
    float *inverse_mass;        ///< [slots] then, 1/kg
    float *held;                ///< [4][slots] positions and low words of sleepers during substeps
    mspringi_field force;       ///< from outside when islands fell asleep, N
    uint64_t masses, links, moved; ///< counters of edits at the last update; moved: edits.state
    uint64_t piled;                ///< edits.sleep_changes for which piles were found
} mspringi_sleep;

#endif
