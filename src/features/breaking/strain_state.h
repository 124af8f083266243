/// @file strain_state.h
/// Strains that springs break and are stressed at.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRAIN_STATE_H
#define MSPRINGI_STRAIN_STATE_H

#include "kernels/kernels.h"

/// What springs break and are stressed at, by place; NULL as long as none does.
typedef struct mspringi_strain {
    float *break_strain, *warn_strain;
    float *relax_strain;       ///< MSPRING_RELAX_STRAIN_DEFAULT: the usual fraction of its warn strain
    float *least;              ///< the smaller of the two; NULL as long as break_strain is alone
    uint16_t *stressed;        ///< [places / MSPRINGI_WIDTH] a bit for each place
    mspringi_strain_hit *hits; ///< [places / MSPRINGI_WIDTH] for the pass to write to
    bool breaks, stresses;     ///< a threshold of this kind has been finite: there is something to save
    bool relaxes;              ///< so with a relax strain that is not the default
} mspringi_strain;

#endif
