/// @file fractions.h
/// What relative springs are like: fractions of stiffness and damping, of which most networks have a few only, by
/// material. Those are kept once, and for each spring a byte that tells which it has. (8 bytes per spring would be
/// 32 of 116 per particle of a full lattice.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FRACTIONS_H
#define MSPRINGI_FRACTIONS_H

#include "store/network.h"

/// Keep the fractions of the builder's springs, with room for so many in all: those of springs to come are their
/// own.
mspring_result mspringi_fractions_create(mspringi_fractions *fractions, const mspring_builder *builder, size_t room,
                                         mspringi_memory *memory, mspringi_message *message);

/// Give every spring fractions of its own, which mspringi_fractions_set() may then set. Allocates, once.
mspring_result mspringi_fractions_separate(mspring_network *network);

static inline mspringi_relative mspringi_fractions_of(const mspringi_fractions *fractions, mspring_id spring) {
    return fractions->values[fractions->of_spring ? fractions->of_spring[spring] : spring];
}

/// After mspringi_fractions_separate(), unless it is what the spring has.
static inline void mspringi_fractions_set(const mspringi_fractions *fractions, mspring_id spring,
                                          mspringi_relative value) {
    if (fractions->of_spring)
        MSPRINGI_ASSERT(mspringi_fractions_of(fractions, spring).stiffness == value.stiffness &&
                        mspringi_fractions_of(fractions, spring).damping == value.damping);
    else
        fractions->values[spring] = value;
}

/// Where a spring's fractions are: its own after mspringi_fractions_separate(), else not to be written.
static inline mspringi_relative *mspringi_fractions_at(const mspringi_fractions *fractions, mspring_id spring) {
    return &fractions->values[fractions->of_spring ? fractions->of_spring[spring] : spring];
}

#endif
