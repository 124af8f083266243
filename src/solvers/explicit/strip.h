/// @file strip.h
/// One substep of one strip of rows.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRIP_H
#define MSPRINGI_STRIP_H

#include "stability/guard.h"
#include "store/network.h"

/// What one substep works with.
typedef struct mspringi_substep {
    mspringi_sweep sweep;
    mspringi_field base;  ///< forces from outside; x NULL if there are none
    float *gathered;      ///< the irregular part's nodes before the substep
    float *next_gathered; ///< where those of a strip go after it; NULL if nobody will read them there
    uint32_t look;        ///< number of the last look at warm springs in the step
    bool tests, looks;    ///< strips test warm springs, and look which are
} mspringi_substep;

/// Substep i of count that are swept together, with the carry row of that number to itself.
mspringi_substep mspringi_substep_prepare(const mspring_network *network, float h, mspringi_field base, uint32_t i,
                                          uint32_t count, uint32_t carry_number);

/// Set what a sweep has of substep i of those that are swept together.
void mspringi_sweep_set_substep(const mspring_network *network, mspringi_sweep *sweep, uint32_t i);

/// Make one of these, which does not keep or watch anything, another of the count.
void mspringi_substep_reuse(const mspring_network *network, mspringi_substep *substep, uint32_t i, uint32_t count,
                            uint32_t carry_number);

/// Pack the irregular part's nodes that a strip has.
void mspringi_strip_pack(const mspring_network *network, const mspringi_substep *substep,
                         const mspringi_strip *strip);

struct mspringi_halo;

/// Sweep a strip with everything that hangs on it; with a halo (or NULL) above its last row.
void mspringi_strip_sweep(const mspring_network *network, const mspringi_substep *substep,
                          const mspringi_strip *strip, const struct mspringi_halo *halo);

/// Room for what is watched, aligned as vectors need it, wherever it lies.
typedef struct mspringi_extrema_buffer {
    float values[4 * MSPRINGI_WIDTH];
} mspringi_extrema_buffer;

/// The watch in a room of zeros.
mspringi_extrema_lanes *mspringi_extrema_in_buffer(mspringi_extrema_buffer *room);

/// Have the substep copy the state that it finds into the backup: the first of a step.
void mspringi_substep_save_state(const mspring_network *network, mspringi_substep *substep);
/// Have it look at where what it moves comes to, and how fast: the last of a step.
void mspringi_substep_track_extrema(const mspring_network *network, mspringi_substep *substep,
                                    mspringi_extrema_lanes *watch);
/// After the last substep of a strip, while it is in the cache: stop what creeps, and look at what has been moved
/// again since it was swept.
mspringi_extrema mspringi_strip_end(const mspring_network *network, const mspringi_strip *strip);

/// Copy the state of some blocks of a row into the backup; stop what creeps there and look at it.
void mspringi_span_save_state(const mspring_network *network, const mspringi_span *span);
mspringi_extrema mspringi_span_extrema(const mspring_network *network, const mspringi_span *span);

/// Pack the irregular part's nodes of some of a irregular row's blocks for this substep or for the next, or sweep
/// them.
void mspringi_irregular_pack(const mspring_network *network, const mspringi_substep *substep,
                             const mspringi_span *span);
void mspringi_irregular_pack_next(const mspring_network *network, const mspringi_substep *substep,
                                  const mspringi_span *span);
void mspringi_irregular_sweep(const mspring_network *network, const mspringi_substep *substep,
                              const mspringi_span *span);

#endif
