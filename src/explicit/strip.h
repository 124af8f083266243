/// @file strip.h
/// One substep of one strip of rows.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRIP_H
#define MSPRINGI_STRIP_H

#include "network/network.h"
#include "stability/guard.h"

/// What one substep works with.
typedef struct mspringi_substep {
    mspringi_sweep sweep;
    mspringi_field base; ///< forces from outside; x NULL if there are none
    float *packed;       ///< the web's nodes before the substep
    float *next_packed;  ///< where those of a strip go after it; NULL if nobody will read them there
} mspringi_substep;

/// Substep i of count that are swept together, with the carry row of that number to itself.
mspringi_substep mspringi_substep_prepare(const mspring_network *network, float h, mspringi_field base, uint32_t i,
                                          uint32_t count, uint32_t carry_number);

/// Pack the web's nodes that a strip has.
void mspringi_strip_pack(const mspring_network *network, const mspringi_substep *substep,
                         const mspringi_strip *strip);

/// Sweep a strip with everything that hangs on it.
void mspringi_strip_sweep(const mspring_network *network, const mspringi_substep *substep,
                          const mspringi_strip *strip);

/// Before a strip's first substep, and after its last, while it is in the cache anyway: copy its state into the
/// backup; stop what creeps and look at it.
void mspringi_strip_keep(const mspring_network *network, const mspringi_strip *strip);
mspringi_sight mspringi_strip_look(const mspring_network *network, const mspringi_strip *strip);

/// The same for some blocks of a row.
void mspringi_span_keep(const mspring_network *network, const mspringi_span *span);
mspringi_sight mspringi_span_look(const mspring_network *network, const mspringi_span *span);

/// Pack the web's nodes of some of a web row's blocks, or sweep them.
void mspringi_web_pack(const mspring_network *network, const mspringi_substep *substep, const mspringi_span *span);
void mspringi_web_sweep(const mspring_network *network, const mspringi_substep *substep, const mspringi_span *span);

#endif
