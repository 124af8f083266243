/// @file pace.h
/// Long work in parts of about the same size.
///
/// Such work is a list of passes, each over some number of things: particles, springs, slots, blocks. A pass does
/// as much as there is effort left for, and goes on from there when it is called again. What a part costs is
/// counted in these things, never in time, so that all machines divide the work alike.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PACE_H
#define MSPRINGI_PACE_H

#include "assert.h"
#include "memory.h"

/// One unit of effort is a particle or spring that is looked at and found in the cache: about 3 ns. Where something
/// is more work than that, its weight says how much more.
typedef struct mspringi_pace {
    uint32_t left;   ///< effort until the next pause
    uint32_t at;     ///< how far the pass that is under way has come; 0 when it begins
    uint32_t pass;   ///< its number
    bool is_halfway; ///< it has not come to its end
} mspringi_pace;

/// Bytes that are set to zero, or copied, for one unit.
#define MSPRINGI_PACE_BYTES 16

/// For work that is not to pause, again and again.
#define MSPRINGI_PACE_ALL UINT32_MAX

static inline void mspringi_pace_spend(mspringi_pace *pace, uint64_t effort) {
    pace->left = effort < pace->left ? pace->left - (uint32_t)effort : 0;
}

/// What a pass over count things of this weight is to do now: those from first to before end. At least one, if
/// there is one left.
static inline void mspringi_pace_take(mspringi_pace *pace, uint32_t count, uint32_t weight, uint32_t *first,
                                      uint32_t *end) {
    const uint64_t most = (uint64_t)pace->left / weight + 1;
    MSPRINGI_ASSERT(pace->at <= count); // a pass goes over as many things as when it began
    *first = pace->at;
    *end = count - *first > most ? *first + (uint32_t)most : count;
    mspringi_pace_spend(pace, (uint64_t)(*end - *first) * weight);
    pace->at = *end;
    pace->is_halfway = *end < count;
}

/// mspringi_alloc(), and the effort of it.
static inline void *mspringi_pace_alloc(mspringi_pace *pace, mspringi_memory *memory, size_t count, size_t size) {
    mspringi_pace_spend(pace, (uint64_t)count * size / MSPRINGI_PACE_BYTES);
    return mspringi_alloc(memory, count, size);
}

#endif
