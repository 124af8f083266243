/// @file definitions.h
/// Parts that definitions have in common.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DEFINITIONS_H
#define MSPRINGI_DEFINITIONS_H

#include <massspring/massspring.h>

/// Default of mspring_solver_def.most_work.
#define MSPRINGI_MOST_WORK 4u

/// Default of mspring_solver_def.residual.
#define MSPRINGI_RESIDUAL 0.01f

/// Initial settings of a network.
static inline mspring_settings mspringi_settings_of(const mspring_network_def *def) {
    return (mspring_settings){
#define SETTING(name, first, range, is_good, change) .name = def->name,
#include "base/settings.def"
        .struct_size = sizeof(mspring_settings), .guard = def->guard};
}

/// Initial solver of a network.
static inline mspring_solver_def mspringi_solver_of(const mspring_network_def *def) {
    return (mspring_solver_def){.struct_size = sizeof(mspring_solver_def),
                                .solver = def->solver,
                                .substeps = def->substeps,
                                .max_substeps = def->max_substeps,
                                .integrator = def->integrator,
                                .iterations = def->iterations,
                                .tile_size = def->tile_size,
                                .coarse_period = def->coarse_period,
                                .most_work = MSPRINGI_MOST_WORK,
                                .residual = MSPRINGI_RESIDUAL};
}

#endif
