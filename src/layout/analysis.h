/// @file analysis.h
/// The steps by which a topology is found: graph, bundles, chains, grids, less those of sheets, assigned strips,
/// then the irregular part's list.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ANALYSIS_H
#define MSPRINGI_ANALYSIS_H

#include "layout/topology.h"

/// Sort keys in place by radix; scratch is as long as keys.
void mspringi_sort_keys(uint64_t *keys, uint64_t *scratch, size_t count);

/// Springs by particle: those of particle p are springs[first[p]] ... springs[first[p + 1] - 1], by rising id.
/// Those that lie beside another are left out: they are irregular springs, wherever their particles lie.
typedef struct mspringi_graph {
    const mspring_builder *builder;
    uint32_t *first;      ///< [particles + 1]
    uint32_t *springs;    ///< [2 * springs]
    uint8_t *is_parallel; ///< [springs] 1 of those; NULL if there are none
    uint32_t parallel_count;
    uint32_t *stamp_of, *spring_to; ///< [particles] while it is checked that no springs join the same particles
} mspringi_graph;

/// Chains, laid end to end.
typedef struct mspringi_chains {
    uint32_t *particles; ///< [count] in order along each chain, chain after chain
    uint32_t *springs;   ///< [count] the spring to the next entry, or MSPRING_NONE at a chain's end
    uint32_t count, chain_count, spring_count;
    uint32_t kept;    ///< of count, so far, while some are dropped
    uint8_t *visited; ///< [particles] while chains are looked for
} mspringi_chains;

/// Grids: for each, its particles with their column and row, both from 0.
typedef struct mspringi_grids {
    uint32_t *grid_of;      ///< [particles] number of the grid, or MSPRING_NONE
    uint32_t *column, *row; ///< [particles]
    uint32_t *members;      ///< [member_count] particles, grid after grid
    uint32_t *first_member; ///< [count + 1]
    uint32_t count, member_count;
    uint32_t found_count;                  ///< grids that were found, some of which may have been put side by side
    struct mspringi_grid_finder *finder;   ///< while they are looked for
    struct mspringi_grid_shelver *shelver; ///< while they are put side by side
} mspringi_grids;

static inline mspring_id mspringi_other_end(const mspringi_spring *spring, mspring_id particle) {
    return spring->a == particle ? spring->b : spring->a;
}

static inline uint32_t mspringi_degree_of(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

/// Index the springs by particle. If it is not known that no two springs join the same particles, those are looked
/// for: MSPRING_ERROR_DUPLICATE for two that do and act both ways.
mspring_result mspringi_graph_create(mspringi_graph *graph, const mspring_builder *builder, bool is_checked,
                                     mspringi_memory *memory, mspringi_message *message);
void mspringi_graph_destroy(mspringi_graph *graph, mspringi_memory *memory);

/// Find the chains: paths of at least three particles that have at most two springs each, and shorter ones that
/// are attached to nothing. Their particles get MSPRINGI_ROW_CHAIN in kinds.
mspring_result mspringi_chains_find(mspringi_chains *chains, const mspringi_graph *graph, uint8_t *kinds,
                                    mspringi_memory *memory, mspringi_message *message);
void mspringi_chains_destroy(mspringi_chains *chains, mspringi_memory *memory);

/// Equal components, sixteen side by side.
typedef struct mspringi_bundles {
    uint32_t *particles; ///< [slice_count][MSPRINGI_WIDTH] bundle after bundle: those of the same number in each
    uint8_t *is_first;   ///< [slice_count] 1 for the first group of a bundle
    uint32_t slice_count;
    uint32_t spring_count; ///< of one component of each bundle
} mspringi_bundles;

/// Components of at most MSPRINGI_MAX_COMPONENT particles, while those that are equal are looked for.
typedef struct mspringi_equal_components {
    uint16_t *number;               ///< [particles] in its component
    uint32_t count, particle_count; ///< components, and particles in them
    uint32_t *in_order;             ///< [particle_count] component after component, by number
    uint32_t *first;                ///< [count + 1] in these
    uint64_t *keys, *scratch;       ///< [count] hash of the graph, and component
    uint32_t *chosen; ///< [count] components that stand in bundles, sixteen of a shape in turn; from the end on
                      ///< those of the same shapes that fill none
    uint32_t chosen_count, left_count, slice_count;
    uint32_t listed, looked_at;
} mspringi_equal_components;
struct mspringi_layout_builder;

/// Find them, in this order: explore and list look at particles; choose is called until it no
/// longer asks to be called again. Their particles get MSPRINGI_ROW_IRREGULAR in kinds. So do
/// those that are left of their shapes, until grids and chains have been found: they become loose.
mspring_result mspringi_equal_components_begin(mspringi_equal_components *equal, const mspringi_graph *graph,
                                               mspringi_memory *memory, mspringi_message *message);
void mspringi_equal_components_explore(mspringi_equal_components *equal, const mspringi_graph *graph,
                                       const uint8_t *kinds, uint32_t first, uint32_t end);
mspring_result mspringi_equal_components_reserve(mspringi_equal_components *equal, mspringi_memory *memory,
                                                 mspringi_message *message);
void mspringi_equal_components_list(mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t first,
                                    uint32_t end);
mspring_result mspringi_equal_components_choose(struct mspringi_layout_builder *assembly);
mspring_result mspringi_equal_components_fill(struct mspringi_layout_builder *assembly);
mspring_result mspringi_equal_components_release(struct mspringi_layout_builder *assembly);
void mspringi_equal_components_destroy(mspringi_equal_components *equal, mspringi_memory *memory);

/// Find the grids among the particles that are loose in kinds: their particles get MSPRINGI_ROW_LATTICE. The graph
/// and kinds must stay. For each of MSPRINGI_GRID_SEARCHES: flood, in two steps for each particle at most; then
/// judge the candidates, after the springs of their members have been counted; then end the search.
#define MSPRINGI_GRID_SEARCHES 3
mspring_result mspringi_grids_begin(mspringi_grids *grids, const mspringi_graph *graph, uint8_t *kinds,
                                    mspringi_memory *memory, mspringi_message *message);
void mspringi_grids_flood(mspringi_grids *grids, uint32_t first, uint32_t end);
mspring_result mspringi_grids_begin_judging(mspringi_grids *grids, mspringi_memory *memory,
                                            mspringi_message *message);
uint32_t mspringi_grids_candidates(const mspringi_grids *grids);
uint32_t mspringi_grids_candidate_members(const mspringi_grids *grids);
void mspringi_grids_count_springs(mspringi_grids *grids, uint32_t first, uint32_t end);
void mspringi_grids_judge(mspringi_grids *grids, uint32_t first, uint32_t end);
void mspringi_grids_end_search(mspringi_grids *grids, mspringi_memory *memory);
void mspringi_grids_destroy(mspringi_grids *grids, mspringi_memory *memory);

/// Particles of the irregular part without an assigned strip from which it gets layers: with fewer, all of it is in
/// a cache as fast as need be.
#define MSPRINGI_FEWEST_LAYERED 60000

/// Pieces of the network of which the grids that were found are better given up.
typedef struct mspringi_grid_filter {
    uint32_t inner, outer;           ///< springs in all grids, and others that their particles have
    uint32_t *piece;                 ///< [particles] parent in a forest; NULL if nothing is to be given up
    struct mspringi_grid_cost *sums; ///< [particles] of roots
    uint32_t next_member;            ///< of the grid that is looked at
    uint32_t kept_grids, kept_members;
} mspringi_grid_filter;
/// Give up the grids of pieces that cost less as an irregular part: their particles become loose in kinds. In this
/// order; those with a range look at springs.
void mspringi_grid_filter_count(mspringi_grid_filter *filter, const mspringi_graph *graph,
                                const mspringi_grids *grids, const uint8_t *kinds, uint32_t first, uint32_t end);
mspring_result mspringi_grid_filter_reserve(mspringi_grid_filter *filter, const mspringi_graph *graph,
                                            const mspringi_grids *grids, mspringi_memory *memory,
                                            mspringi_message *message);
void mspringi_grid_filter_join(mspringi_grid_filter *filter, const mspringi_graph *graph, uint32_t first,
                               uint32_t end);
void mspringi_grid_filter_count_springs(mspringi_grid_filter *filter, const mspringi_graph *graph,
                                        const mspringi_grids *grids, const uint8_t *kinds, uint32_t first,
                                        uint32_t end);
void mspringi_grid_filter_apply(mspringi_grid_filter *filter, const mspringi_graph *graph, mspringi_grids *grids,
                                uint8_t *kinds, mspringi_memory *memory);
void mspringi_grid_filter_destroy(mspringi_grid_filter *filter, mspringi_memory *memory);

/// Put small grids side by side in the same rows, as one grid. found_count stays. In this order; shelve goes
/// through the narrow ones.
mspring_result mspringi_grids_measure(mspringi_grids *grids, mspringi_memory *memory, mspringi_message *message);
uint32_t mspringi_grids_narrow(const mspringi_grids *grids);
void mspringi_grids_shelve(mspringi_grids *grids, uint32_t first, uint32_t end);
void mspringi_grids_number(mspringi_grids *grids, mspringi_memory *memory);
void mspringi_shelver_destroy(struct mspringi_grid_shelver *shelver, mspringi_memory *memory);

/// How a spring lies on a grid.
typedef struct mspringi_lattice_spring {
    mspringi_direction direction;
    uint32_t column, row; ///< the slot whose record it is in
} mspringi_lattice_spring;

/// Find the place of a spring; false if it does not join neighbouring cells of one grid.
bool mspringi_grids_place(const mspringi_grids *grids, const mspringi_spring *spring,
                          mspringi_lattice_spring *found);

/// The same by id; false if it lies beside another, too.
bool mspringi_graph_place(const mspringi_graph *graph, const mspringi_grids *grids, uint32_t spring,
                          mspringi_lattice_spring *found);

/// Largest skew worth having: with more, too few substeps of too many strips share the cache.
#define MSPRINGI_LONGEST_SKEW 16

/// Which grids have rows that are swept for several substeps in one pass, and in which strips of these rows the
/// particles that hang on them are swept.
typedef struct mspringi_strip_assignment {
    uint32_t *assigned_strip; ///< [particles] strip of those that hang on such grids; MSPRING_NONE for all others
    uint32_t *grid_order;     ///< [grids] grids, those with such rows first
    uint32_t *first_row;      ///< [grids] number of a grid's first row, all rows in that order
    uint32_t row_count;       ///< such rows
    uint32_t strip_rows;      ///< rows in a strip; the last one may have fewer
    uint32_t skew; ///< strips that each substep stays behind the one before: ends of irregular springs are
                   ///< no further apart
    struct mspringi_strip_assignment_finder *finder; ///< while they are looked for
} mspringi_strip_assignment;

/// Find them, in this order; all that they are given must stay. attach goes through the members of grids,
/// join_springs through springs; try_skews is called until it returns true.
mspring_result mspringi_strip_assignment_begin(mspringi_strip_assignment *assignment, const mspringi_graph *graph,
                                               const mspringi_grids *grids, const mspringi_chains *chains,
                                               mspringi_memory *memory, mspringi_message *message);
void mspringi_strip_assignment_attach(mspringi_strip_assignment *assignment, uint32_t first, uint32_t end);
mspring_result mspringi_strip_assignment_prepare(mspringi_strip_assignment *assignment, uint32_t workers,
                                                 mspringi_memory *memory, mspringi_message *message);
void mspringi_strip_assignment_join_springs(mspringi_strip_assignment *assignment, uint32_t first, uint32_t end);
void mspringi_strip_assignment_choose_grids(mspringi_strip_assignment *assignment);
bool mspringi_strip_assignment_try_skews(mspringi_strip_assignment *assignment);
void mspringi_strip_assignment_end(mspringi_strip_assignment *assignment, mspringi_memory *memory);
void mspringi_strip_assignment_destroy(mspringi_strip_assignment *assignment, mspringi_memory *memory);

/// The particles of the irregular part: those that are loose in kinds and have springs. They get
/// MSPRINGI_ROW_IRREGULAR. First those with an assigned strip, by assigned strip; then those without, in whose list
/// neighbours in space are near each other, and particles with about as many springs side by side. Behind those the
/// bundles.
typedef struct mspringi_irregular_list {
    uint32_t *particles; ///< [count]
    uint32_t count;
    uint32_t assigned_count; ///< of these have an assigned strip
    uint32_t first_in_bundles;

    // While it is made.
    double min_x, max_x, min_y, max_y; ///< of those without an assigned strip
    uint64_t *keys, *scratch;          ///< [count]
} mspringi_irregular_list;
/// Find it, in this order, then its layers.
void mspringi_irregular_list_count(mspringi_irregular_list *list, const mspringi_graph *graph,
                                   const mspringi_strip_assignment *assignment, const uint8_t *kinds);
mspring_result mspringi_irregular_list_reserve(mspringi_irregular_list *list, const mspringi_bundles *bundles,
                                               mspringi_memory *memory, mspringi_message *message);
void mspringi_irregular_list_fill(mspringi_irregular_list *list, const mspringi_graph *graph,
                                  const mspringi_strip_assignment *assignment, uint8_t *kinds);
void mspringi_irregular_list_sort(mspringi_irregular_list *list, const mspringi_graph *graph,
                                  const mspringi_strip_assignment *assignment);
void mspringi_irregular_list_append_bundles(mspringi_irregular_list *list, const mspringi_bundles *bundles);
void mspringi_irregular_list_destroy(mspringi_irregular_list *list, mspringi_memory *memory);

/// After the list's particles have been counted: drop the chains that have an assigned strip, those that hang on an
/// irregular part that gets layers, unless there is more of chains than of that, and, if there are bundles, short
/// ones that hang on the irregular part. Their particles become loose in kinds and are counted, too.
void mspringi_chains_drop(mspringi_chains *chains, const mspringi_graph *graph,
                          const mspringi_strip_assignment *assignment, bool has_bundles, uint8_t *kinds,
                          mspringi_irregular_list *list);

/// Layers of the irregular part's particles without an assigned strip, if they are many: springs join particles of
/// one layer or of two that follow each other.
typedef struct mspringi_layers {
    uint32_t count; ///< 0: they have none
    uint32_t *end;  ///< [count] behind the last of each, counted from the first particle without an assigned strip
    uint32_t *layer_of; ///< [particles] of the network

    // While they are found.
    uint32_t *particles;     ///< the list
    uint32_t particle_count; ///< in it
    uint32_t *queue;         ///< [particle_count] of searches, one piece of the irregular part behind the other
    uint32_t piece;          ///< where in it the search under way begins
    uint32_t head, tail, level_end;
} mspringi_layers;
/// Find them and sort the list by layer.
mspring_result mspringi_layers_find(mspringi_layers *layers, const mspringi_irregular_list *list,
                                    const mspringi_graph *graph, mspringi_memory *memory,
                                    mspringi_message *message);
void mspringi_layers_destroy(mspringi_layers *layers, mspringi_memory *memory);

/// Put particles with about as many springs side by side, those of a layer.
void mspringi_irregular_list_order_windows(mspringi_irregular_list *list, const mspringi_layers *layers,
                                           const mspringi_graph *graph, mspringi_memory *memory);

#endif
