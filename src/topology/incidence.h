/// @file incidence.h
/// The springs of each particle, for edits that start from particles.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_INCIDENCE_H
#define MSPRINGI_INCIDENCE_H

#include "topology.h"

/// The springs of particle p are springs[first[p]] ... springs[first[p + 1] - 1], by rising id. Spare springs are
/// in none of these lists.
typedef struct mspringi_incidence {
    uint32_t *first;   ///< [particles + 1], or NULL: not made yet
    uint32_t *springs; ///< [2 * springs]
} mspringi_incidence;

/// List a topology's springs in arrays that are there, zeroed.
void mspringi_incidence_fill(const mspringi_incidence *incidence, const mspringi_topology *topology);

#endif
