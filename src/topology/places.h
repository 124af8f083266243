/// @file places.h
/// Where each spring lies, by id.
///
/// Ids that follow each other, as a builder gives them to a lattice, a rope or a list of leftover springs, lie in a
/// pattern, and only the pattern is kept: a run of it takes 28 bytes, however long it is. Springs that lie in none
/// are listed one by one, 4 bytes each. (A full lattice of 544 x 68 has 0.3 bytes per particle of places, where
/// an array would have 16; no network has more than 1/32 byte per spring above that.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PLACES_H
#define MSPRINGI_PLACES_H

#include "base/assert.h"
#include "base/memory.h"
#include "web.h"

/// The springs of a lattice slot in column c of row r. East, north and north-east start at the slot; south-east
/// starts one row up, at (c, r + 1), so that all of them reach one column to the right at most and every load is
/// contiguous.
typedef enum mspringi_direction {
    MSPRINGI_EAST = 0,       ///< (c, r)     to (c + 1, r)
    MSPRINGI_NORTH = 1,      ///< (c, r)     to (c, r + 1)
    MSPRINGI_NORTH_EAST = 2, ///< (c, r)     to (c + 1, r + 1)
    MSPRINGI_SOUTH_EAST = 3, ///< (c, r + 1) to (c + 1, r)
    MSPRINGI_DIRECTIONS = 4
} mspringi_direction;

/// Where a spring lies: below lattice_places a lattice record, (block * MSPRINGI_DIRECTIONS + direction) *
/// MSPRINGI_WIDTH + lane; below chain_places a chain record, lattice_places + block * MSPRINGI_WIDTH + lane; above
/// that, chain_places + number among the leftover springs, behind which are those with spare ids (see spare.h) and
/// the parked ones. Block counts from the first of its kind.
typedef uint32_t mspringi_place;

typedef enum mspringi_run_kind {
    MSPRINGI_RUN_LISTED,  ///< start[0] is where in listed
    MSPRINGI_RUN_SPACED,  ///< start[0] is the first one's place, step is to the next
    MSPRINGI_RUN_PATTERN, ///< of lattice places; each time it repeats the slots are further by step
} mspringi_run_kind;

/// Springs of ids that follow each other, up to the first of the next run.
typedef struct mspringi_place_run {
    mspring_id first;
    uint16_t kind, period;               ///< mspringi_run_kind; springs of a pattern
    uint32_t step;                       ///< modulo 2^32
    uint32_t start[MSPRINGI_DIRECTIONS]; ///< of a pattern's springs: lattice slot * MSPRINGI_DIRECTIONS + direction
} mspringi_place_run;

/// Ids of a page: so many that a spring's run is found from its page's first one in a few steps.
#define MSPRINGI_PLACES_PAGE 128

typedef struct mspringi_places {
    mspringi_place_run *runs; ///< [run_count], and one that begins behind the last spring
    uint32_t *run_of_page;    ///< the run that each page of ids begins in
    mspringi_place *listed;
    uint32_t run_count;
} mspringi_places;

/// Keep what of_spring tells of count springs, of which the first so many stay where they are and the others are
/// listed, so that they can be set. False: no memory.
bool mspringi_places_create(mspringi_places *places, const mspringi_place *of_spring, uint32_t count,
                            uint32_t fixed, mspringi_place lattice_places, mspringi_memory *memory);
void mspringi_places_destroy(mspringi_places *places, mspringi_memory *memory);

/// The same in parts: what is gone through, and what is made of it, in arrays that grow.
typedef struct mspringi_packing {
    const mspringi_place *of_spring;
    uint32_t count, all; ///< springs that patterns are looked for in, and with those behind them
    mspringi_place lattice_places;
    mspringi_memory *memory;
    mspringi_place_run *runs;
    mspringi_place *listed;
    size_t run_count, listed_count;
    size_t run_capacity, listed_capacity;
    bool in_list; ///< the last run is one of listed springs
} mspringi_packing;
/// A pass, and what comes after it; false: no memory. What is kept leaves nothing to destroy.
bool mspringi_places_pack(mspringi_packing *packing, mspringi_pace *pace);
bool mspringi_places_keep(mspringi_packing *packing, mspringi_places *places);
void mspringi_packing_destroy(mspringi_packing *packing);

/// Give another place to a spring that is not fixed.
void mspringi_places_set(const mspringi_places *places, mspring_id spring, mspringi_place place);

/// The places of springs first ... first + count - 1: less work for many springs than one by one.
void mspringi_places_read(const mspringi_places *places, mspring_id first, uint32_t count, mspringi_place *out);

/// Reads the places of springs in the order of their ids.
typedef struct mspringi_place_reader {
    const mspringi_places *places;
    mspring_id next;     ///< spring, the first that is not in buffer
    uint32_t at, filled; ///< of the buffer
    mspringi_place buffer[64];
} mspringi_place_reader;

/// Begin with the spring first.
static inline void mspringi_places_begin(mspringi_place_reader *reader, const mspringi_places *places,
                                         mspring_id first) {
    reader->places = places;
    reader->next = first;
    reader->at = reader->filled = 0;
}

void mspringi_places_refill(mspringi_place_reader *reader);

/// The place of the next spring, of which there is one.
static inline mspringi_place mspringi_places_next(mspringi_place_reader *reader) {
    if (reader->at == reader->filled)
        mspringi_places_refill(reader);
    return reader->buffer[reader->at++];
}

/// The lattice place of a direction at a lattice slot, which counts from the first lattice block.
static inline mspringi_place mspringi_lattice_place(uint32_t slot, uint32_t direction) {
    const uint32_t lane = slot % MSPRINGI_WIDTH;
    return (slot - lane) * MSPRINGI_DIRECTIONS + direction * MSPRINGI_WIDTH + lane;
}

/// i / period: a division by what only the run tells takes several times as long.
static inline uint32_t mspringi_turn_of(uint32_t i, uint32_t period) {
    return period == 4 ? i / 4 : period == 3 ? i / 3 : period == 2 ? i / 2 : i;
}

static inline mspringi_place mspringi_places_at(const mspringi_places *places, mspring_id spring) {
    const mspringi_place_run *run = &places->runs[places->run_of_page[spring / MSPRINGI_PLACES_PAGE]];
    while (spring >= run[1].first)
        ++run;
    MSPRINGI_ASSERT(run < places->runs + places->run_count); // there is such a spring
    const uint32_t i = spring - run->first;
    if (run->kind == MSPRINGI_RUN_LISTED)
        return places->listed[run->start[0] + i];
    if (run->kind == MSPRINGI_RUN_SPACED)
        return run->start[0] + i * run->step;
    const uint32_t turn = mspringi_turn_of(i, run->period), code = run->start[i - turn * run->period];
    return mspringi_lattice_place(code / MSPRINGI_DIRECTIONS + turn * run->step, code % MSPRINGI_DIRECTIONS);
}

#endif
