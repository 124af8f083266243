/// @file fractions.h
/// Relative springs: fractions of stiffness and damping. Most networks have a few pairs of them, one for each
/// material. These are stored once, with a byte for each spring. (8 bytes a spring would be 32 of 116 bytes a
/// particle of a full lattice.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FRACTIONS_H
#define MSPRINGI_FRACTIONS_H

#include "store/network.h"

/// Store the fractions of the builder's springs, with room for `room` springs in all. Later springs have fractions
/// of their own.
mspring_result mspringi_fractions_create(mspringi_fractions *fractions, const mspring_builder *builder, size_t room,
                                         mspringi_memory *memory, mspringi_message *message);

/// Give every spring fractions of its own, which mspringi_fractions_set() may then set. Allocates, once.
mspring_result mspringi_fractions_separate(mspring_network *network);

static inline mspringi_relative mspringi_fractions_of(const mspringi_fractions *fractions, mspring_id spring) {
    return fractions->values[fractions->of_spring ? fractions->of_spring[spring] : spring];
}

/// Set the fractions of a spring. A value that changes needs mspringi_fractions_separate() before.
static inline void mspringi_fractions_set(const mspringi_fractions *fractions, mspring_id spring,
                                          mspringi_relative value) {
    if (fractions->of_spring)
        MSPRINGI_ASSERT(mspringi_fractions_of(fractions, spring).stiffness == value.stiffness &&
                        mspringi_fractions_of(fractions, spring).damping == value.damping);
    else
        fractions->values[spring] = value;
}

/// Address of a spring's fractions. Write to it only after mspringi_fractions_separate().
static inline mspringi_relative *mspringi_fractions_at(const mspringi_fractions *fractions, mspring_id spring) {
    return &fractions->values[fractions->of_spring ? fractions->of_spring[spring] : spring];
}

#endif
