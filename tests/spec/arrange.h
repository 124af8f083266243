/// @file arrange.h
/// Which springs are summed by rows: see arrange.c and lattices.c.
///
/// SPDX-License-Identifier: MIT
#ifndef SPEC_ARRANGE_H
#define SPEC_ARRANGE_H

#include <stddef.h>

#include "spec.h"

/// Slots in a block of a row.
#define SPEC_BLOCK 16

/// What support_plan tells of the same network.
typedef struct spec_plan {
    uint32_t lattice_particles, lattice_springs, chain_particles, chain_springs, irregular_particles,
        irregular_springs;
} spec_plan;

/// Arrange the springs of a network whose particles begin at these places, world coordinates.
/// @param sums    [particle_count]
/// @param others  [2 * spring_count]
/// @param has_bundles  16 or more components are equal graphs without lattices and chains
spec_plan spec_arrange(const spec_network *network, const double *x, const double *y, spec_sums *sums,
                       uint32_t *others, bool has_bundles);

typedef enum spec_kind { SPEC_LOOSE, SPEC_CHAIN, SPEC_LATTICE } spec_kind;

/// An arrangement while it is made.
typedef struct spec_arrangement {
    const spec_network *network;
    const double *x, *y;
    uint32_t *first, *springs; ///< springs of each particle, by rising number
    spec_kind *kinds;          ///< [particles] SPEC_LOOSE: in no lattice and no chain
    uint8_t *is_in_chain;      ///< [springs] joins neighbours in a chain
    uint32_t *lattice;         ///< [particles] number of the lattice, from 1, or 0
    int32_t *column, *row;     ///< [particles] of a lattice; for a chain its first particle and its length
    uint32_t *queue, *part;    ///< [particles] scratch; parts that springs join
    uint32_t lattice_count;
} spec_arrangement;

/// Allocate zeros, or abort.
void *spec_make(size_t count, size_t size);

uint32_t spec_other_end(const spec_arrangement *a, uint32_t spring, uint32_t p);
int spec_compare_keys(const void *a, const void *b);

/// True if a spring joins neighbouring cells of one lattice.
bool spec_joins_cells(const spec_arrangement *a, uint32_t spring);

/// Find the lattices among the loose particles. lattices.c
void spec_find_lattices(spec_arrangement *a);

#endif
