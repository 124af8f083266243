/// @file plan.h
/// How a network is laid out and solved, for mspring_network_describe().
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PLAN_H
#define MSPRINGI_PLAN_H

#include <massspring/massspring.h>

/// The plan: how a network is laid out in memory. Each particle belongs to one kind of row:
///
///   lattice    particles of a grid with 8 neighbours; it may lie at any angle, be oblong, slanted or bent
///   chain      particles of a rope or another single strand
///   irregular  any other graph, and ropes that hang on a lattice
///   loose      particles without springs
///
/// Springs between neighbours in lattice or chain rows need no index. The others are irregular springs and cost
/// more. src/README.md explains how a network is laid out.
typedef struct mspringi_plan {
    uint32_t particle_count, spring_count;
    uint32_t lattice_count; ///< grids
    uint32_t lattice_particles, lattice_springs;
    uint32_t lattice_rows;   ///< rows of the grids
    uint32_t lattice_blocks; ///< blocks of block_width columns in those rows
    uint32_t chain_count;    ///< strands
    uint32_t chain_particles, chain_springs;
    uint32_t irregular_particles; ///< particles of the irregular part: with springs, but in no lattice or chain row
    uint32_t loose_particles;     ///< particles without a spring
    uint32_t irregular_springs;   ///< springs of the irregular part
    uint32_t pass_rows;           ///< lattice rows that are swept for several substeps in one pass
    uint32_t pass_lag;            ///< strips between a substep of a pass and the next; over 1 if ropes need it
    uint32_t pass_substeps;       ///< most substeps in one pass, by cache size, row length and lag
    uint32_t slot_count;          ///< slots of the state, with empty ones
    uint32_t block_width;         ///< slots in a block
    uint32_t has_damping;         ///< 1: a spring has damping, or room for it is reserved; 0: steps have none
    uint32_t has_relative;   ///< 1: a spring is relative, and a change of substep costs a pass over all springs
    mspring_simd simd_level; ///< the instruction set that runs
    mspring_solver solver;
    mspring_integrator integrator; ///< of the implicit or direct solver; 0 for the explicit one
    uint32_t iterations;           ///< this and the next four: of the implicit solver; 0 for others
    uint32_t tile_size;            ///< rows and columns of the cells of wide lattices
    uint32_t tile_count;           ///< tiles, each of three unknowns in the coarse matrix
    uint32_t coarse_values;        ///< numbers in the factor of that matrix
    uint32_t coarse_period;
    uint32_t irregular_layers; ///< with any solver: layers of the irregular part for passes over it; 0: none
    uint64_t factor_values;    ///< of the direct solver: numbers in its factor, which exists in both precisions
    double factor_products;    ///< products that computing that factor takes
    uint32_t pass_workers;     ///< workers that share passes over lattice rows in explicit steps; 1: no sharing
    float residual;            ///< of the implicit solver, see mspring_settings; 0 for others
} mspringi_plan;

#endif
