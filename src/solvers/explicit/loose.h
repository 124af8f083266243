/// @file loose.h
/// Motion of particles without springs in explicit steps.
///
/// Such particles take all substeps at once, but one by one where a floor is near (16,384 of them of which one is
/// near: 43 instead of 345 us for 40 substeps at AVX-512 on a Zen 4). Both differ in rounding. So they also go one
/// by one if hooks may cut the step: bits must not depend on what was thought to be within reach.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LOOSE_H
#define MSPRINGI_LOOSE_H

#include "store/network.h"

/// Substeps of the particles of a strip.
typedef struct mspringi_loose {
    const mspring_network *network;
    const mspringi_sweep *sweep;
    const mspringi_strip *strip;
    mspringi_free_motion all; ///< motion in all of them
    uint32_t count;
} mspringi_loose;

/// Plan the first count of the substeps that are taken now.
mspringi_loose mspringi_loose_prepare(const mspring_network *network, const mspringi_sweep *sweep,
                                      const mspringi_strip *strip, uint32_t count);

/// Take them with the particles of a span, floor included.
void mspringi_loose_sweep(const mspringi_loose *loose, const mspringi_span *span);

#endif
