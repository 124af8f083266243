/// @file analysis.h
/// The steps by which a topology is found: graph, then strands, then grids, then homes, then the web's list.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ANALYSIS_H
#define MSPRINGI_ANALYSIS_H

#include "topology.h"

/// Springs by particle: those of particle p are springs[first[p]] ... springs[first[p + 1] - 1], by rising id.
typedef struct mspringi_graph {
    const mspring_builder *builder;
    uint32_t *first;   ///< [particles + 1]
    uint32_t *springs; ///< [2 * springs]
} mspringi_graph;

/// Strands, laid end to end.
typedef struct mspringi_strands {
    uint32_t *particles; ///< [count] in order along each strand, strand after strand
    uint32_t *springs;   ///< [count] the spring to the next entry, or MSPRING_NONE at a strand's end
    uint32_t count, strand_count, spring_count;
} mspringi_strands;

/// Grids: for each, its particles with their column and row, both from 0.
typedef struct mspringi_grids {
    uint32_t *grid_of;      ///< [particles] number of the grid, or MSPRING_NONE
    uint32_t *column, *row; ///< [particles]
    uint32_t *members;      ///< [member_count] particles, grid after grid
    uint32_t *first_member; ///< [count + 1]
    uint32_t count, member_count;
    uint32_t found_count; ///< grids that were found, some of which may have been put side by side
} mspringi_grids;

static inline mspring_id mspringi_other_end(const mspringi_spring *spring, mspring_id particle) {
    return spring->a == particle ? spring->b : spring->a;
}

/// Index the springs by particle. Fails with MSPRING_ERROR_DUPLICATE if two springs join the same particles.
mspring_result mspringi_graph_create(mspringi_graph *graph, const mspring_builder *builder, mspringi_memory *memory,
                                     mspringi_message *message);
void mspringi_graph_destroy(mspringi_graph *graph, mspringi_memory *memory);

/// Find the strands: paths of at least three particles that have at most two springs each, and shorter ones that
/// are attached to nothing. Their particles get MSPRINGI_ROW_CHAIN in kinds.
mspring_result mspringi_strands_find(mspringi_strands *strands, const mspringi_graph *graph, uint8_t *kinds,
                                     mspringi_memory *memory, mspringi_message *message);
void mspringi_strands_destroy(mspringi_strands *strands, mspringi_memory *memory);

/// Find the grids among the particles that are loose in kinds: their particles get MSPRINGI_ROW_LATTICE.
mspring_result mspringi_grids_find(mspringi_grids *grids, const mspringi_graph *graph, uint8_t *kinds,
                                   mspringi_memory *memory, mspringi_message *message);
void mspringi_grids_destroy(mspringi_grids *grids, mspringi_memory *memory);

/// Put small grids side by side in the same rows, as one grid. found_count stays.
mspring_result mspringi_grids_shelve(mspringi_grids *grids, mspringi_memory *memory, mspringi_message *message);

/// How a spring lies on a grid.
typedef struct mspringi_lattice_spring {
    mspringi_direction direction;
    uint32_t column, row; ///< the slot whose record it is in
} mspringi_lattice_spring;

/// Find the place of a spring; false if it does not join neighbouring cells of one grid.
bool mspringi_grids_place(const mspringi_grids *grids, const mspringi_spring *spring,
                          mspringi_lattice_spring *found);

/// Largest lag worth having: with more, too few substeps of too many strips share the cache.
#define MSPRINGI_LONGEST_LAG 16

/// Which grids have rows that are swept for several substeps in one pass, and in which strips of these rows the
/// particles that hang on them are swept.
typedef struct mspringi_homes {
    uint32_t *home;       ///< [particles] strip of those that hang on such grids; MSPRING_NONE for all others
    uint32_t *grid_order; ///< [grids] grids, those with such rows first
    uint32_t *first_row;  ///< [grids] number of a grid's first row, all rows in that order
    uint32_t row_count;   ///< such rows
    uint32_t strip_rows;  ///< rows in a strip; the last one may have fewer
    uint32_t lag;         ///< strips that each substep stays behind the one before: ends of leftover springs are
                          ///< no further apart
} mspringi_homes;

mspring_result mspringi_homes_find(mspringi_homes *homes, const mspringi_graph *graph, const mspringi_grids *grids,
                                   const mspringi_strands *strands, uint32_t workers, mspringi_memory *memory,
                                   mspringi_message *message);
void mspringi_homes_destroy(mspringi_homes *homes, mspringi_memory *memory);

/// Drop the strands that have a home: their particles become loose in kinds, for the web.
void mspringi_strands_drop(mspringi_strands *strands, const mspringi_homes *homes, uint8_t *kinds);

/// The particles of the web: those that are loose in kinds and have springs. They get MSPRINGI_ROW_WEB. First
/// those with a home, by home; then those without, in whose list neighbours in space are near each other, and
/// particles with about as many springs side by side.
typedef struct mspringi_web_list {
    uint32_t *particles; ///< [count]
    uint32_t count;
    uint32_t homed_count; ///< of these have a home
} mspringi_web_list;
mspring_result mspringi_web_list_find(mspringi_web_list *list, const mspringi_graph *graph,
                                      const mspringi_homes *homes, uint8_t *kinds, mspringi_memory *memory,
                                      mspringi_message *message);
void mspringi_web_list_destroy(mspringi_web_list *list, mspringi_memory *memory);

/// Sort keys in place by radix; scratch is as long as keys.
void mspringi_sort_keys(uint64_t *keys, uint64_t *scratch, size_t count);

#endif
