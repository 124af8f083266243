/// @file stint.h
/// What one body takes of a pass, and whom it waits for.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STINT_H
#define MSPRINGI_STINT_H

#include "solvers/explicit/shares.h"
#include "tasks/progress.h"

typedef struct mspringi_stint {
    const mspringi_shares *shares;
    mspringi_progress *progress; ///< [workers]; NULL if there is nobody to wait for
    uint32_t body;               ///< number of the body
    uint32_t share;              ///< that it takes or, if is_border, the border
    uint32_t pass;
    bool is_border;  ///< what independent shares have left around a border
    uint32_t passed; ///< what the worker's counter is at when the pass begins
    uint32_t above;  ///< where the counter of the worker above was last
    uint32_t begin[MSPRINGI_DEEPEST_PASS], end[MSPRINGI_DEEPEST_PASS]; ///< its strips in each substep of the pass
} mspringi_stint;

/// Find its strips in the pass.
void mspringi_stint_begin(mspringi_stint *stint);

/// The halo below the first strip of a substep, which is to be kept, and that above the last one, or MSPRING_NONE.
uint32_t mspringi_stint_halo_below(const mspringi_stint *stint, uint32_t substep);
uint32_t mspringi_stint_halo_above(const mspringi_stint *stint, uint32_t substep);

/// The share whose carry rows a stint goes on with.
uint32_t mspringi_stint_carries(const mspringi_stint *stint);

/// Tell the others in how many substeps of a pass this worker has left its lower border behind, and one more at the
/// end of the pass.
void mspringi_stint_say(const mspringi_stint *stint, uint32_t passed);

/// Before a strip, if there is anybody to wait for: wait for the worker above where it and this one read what the
/// other writes.
void mspringi_stint_wait_above(mspringi_stint *stint, uint32_t substep, uint32_t strip);

/// Before a pass: wait for those that had its strips in the last one.
void mspringi_stint_wait_last(const mspringi_stint *stint);

#endif
