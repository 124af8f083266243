/// @file analysis.h
/// Parts of the layout, in order: graph, bundles, chains, grids, grid filter, shelves, assigned strips, list of
/// irregular particles, tiers.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ANALYSIS_H
#define MSPRINGI_ANALYSIS_H

#include "layout/topology.h"

/// Radix-sort keys in place. scratch is as long as keys.
void mspringi_sort_keys(uint64_t *keys, uint64_t *scratch, size_t count);

/// Incident springs: those of particle p are springs[first[p]] ... springs[first[p + 1] - 1], by rising id.
/// Parallel springs are left out: they are always irregular.
typedef struct mspringi_graph {
    const mspring_builder *builder;
    uint32_t *first;      ///< [particles + 1]
    uint32_t *springs;    ///< [2 * springs]
    uint32_t *others;     ///< [2 * springs] other end of each
    uint8_t *is_parallel; ///< [springs] 1 for parallel springs; NULL without any
    uint32_t parallel_count;
    uint32_t *stamp_of; ///< [particles] scratch of the search for parallel springs
} mspringi_graph;

/// Chains, packed end to end.
typedef struct mspringi_chains {
    uint32_t *particles; ///< [count] in order along each chain, chain after chain
    uint32_t *springs;   ///< [count] the spring to the next entry, or MSPRING_NONE at a chain's end
    uint32_t count, chain_count, spring_count;
    uint32_t kept;    ///< entries kept so far, while chains are dropped
    uint8_t *visited; ///< [particles] scratch of the search
} mspringi_chains;

/// Grids, with the column and row of each particle, both from 0.
typedef struct mspringi_grids {
    uint32_t *grid_of;      ///< [particles] number of the grid, or MSPRING_NONE
    uint32_t *column, *row; ///< [particles]
    uint32_t *members;      ///< [member_count] particles, grid after grid
    uint32_t *first_member; ///< [count + 1]
    uint8_t *place;         ///< [springs] where each is in a grid, see mspringi_grids_place_spring()
    uint32_t count, member_count;
    uint32_t found_count;                  ///< grids before shelving
    struct mspringi_grid_finder *finder;   ///< scratch of the search
    struct mspringi_grid_shelver *shelver; ///< scratch of shelving
} mspringi_grids;

static inline mspring_id mspringi_other_end(const mspringi_spring *spring, mspring_id particle) {
    return spring->a == particle ? spring->b : spring->a;
}

static inline uint32_t mspringi_degree_of(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

/// Index the springs by particle. Unless is_checked, search for parallel springs: MSPRING_ERROR_DUPLICATE for two
/// that act in both directions.
mspring_result mspringi_graph_create(mspringi_graph *graph, const mspring_builder *builder, bool is_checked,
                                     mspringi_memory *memory, mspringi_message *message);
void mspringi_graph_destroy(mspringi_graph *graph, mspringi_memory *memory);

/// Find the chains: paths of at least three particles with at most two springs each, and shorter paths that are
/// attached to nothing. Set their kinds to MSPRINGI_ROW_CHAIN.
mspring_result mspringi_chains_find(mspringi_chains *chains, const mspringi_graph *graph, uint8_t *kinds,
                                    mspringi_memory *memory, mspringi_message *message);
void mspringi_chains_destroy(mspringi_chains *chains, mspringi_memory *memory);

/// Bundles: sixteen equal components side by side.
typedef struct mspringi_bundles {
    /// [slice_count][MSPRINGI_WIDTH] bundle after bundle; a slice is one particle of each component.
    uint32_t *particles;
    uint8_t *is_first; ///< [slice_count] 1 for the first slice of a bundle
    uint32_t slice_count;
    uint32_t spring_count; ///< springs of one component of each bundle
} mspringi_bundles;

/// Search for equal components of at most MSPRINGI_MAX_COMPONENT particles.
typedef struct mspringi_equal_components {
    uint16_t *number;               ///< [particles] 1 + number in the component
    uint32_t count, particle_count; ///< components, and particles in them
    uint32_t *in_order;             ///< [particle_count] particles by component, then by number
    uint32_t *first;                ///< [count + 1] first particle of each component
    uint64_t *keys, *scratch;       ///< [count] hash of the graph, and component
    /// [count] components in bundles, by sixteen of a shape; from the end, the rest of the same shapes.
    uint32_t *chosen;
    uint32_t chosen_count, rest_count, slice_count;
    uint32_t listed, next_key;
} mspringi_equal_components;
struct mspringi_layout_builder;

/// Find equal components, in this order: explore and list visit particles, choose is called again while the cursor
/// says so. Set their kinds to MSPRINGI_ROW_IRREGULAR. Components of the same shapes that fill no bundle are
/// irregular until chains and grids are found, then loose.
mspring_result mspringi_equal_components_begin(mspringi_equal_components *equal, const mspringi_graph *graph,
                                               mspringi_memory *memory, mspringi_message *message);
void mspringi_equal_components_explore(mspringi_equal_components *equal, const mspringi_graph *graph,
                                       const uint8_t *kinds, uint32_t first, uint32_t end);
mspring_result mspringi_equal_components_reserve(mspringi_equal_components *equal, mspringi_memory *memory,
                                                 mspringi_message *message);
void mspringi_equal_components_list(mspringi_equal_components *equal, const mspringi_graph *graph, uint32_t first,
                                    uint32_t end);
mspring_result mspringi_equal_components_choose(struct mspringi_layout_builder *builder);
mspring_result mspringi_equal_components_fill(struct mspringi_layout_builder *builder);
mspring_result mspringi_equal_components_release(struct mspringi_layout_builder *builder);
void mspringi_equal_components_destroy(mspringi_equal_components *equal, mspringi_memory *memory);

/// Find the grids among loose particles and set their kinds to MSPRINGI_ROW_LATTICE. Graph and kinds must outlive
/// the search. For each of MSPRINGI_GRID_SEARCHES: flood, in at most two steps a particle; count the springs of
/// candidates; evaluate the candidates; end the search.
#define MSPRINGI_GRID_SEARCHES 3
mspring_result mspringi_grids_begin(mspringi_grids *grids, const mspringi_graph *graph, uint8_t *kinds,
                                    mspringi_memory *memory, mspringi_message *message);
void mspringi_grids_flood(mspringi_grids *grids, uint32_t first, uint32_t end);
mspring_result mspringi_grids_begin_evaluation(mspringi_grids *grids, mspringi_memory *memory,
                                               mspringi_message *message);
uint32_t mspringi_grids_candidate_count(const mspringi_grids *grids);
uint32_t mspringi_grids_candidate_member_count(const mspringi_grids *grids);
void mspringi_grids_count_springs(mspringi_grids *grids, uint32_t first, uint32_t end);
void mspringi_grids_evaluate(mspringi_grids *grids, uint32_t first, uint32_t end);
void mspringi_grids_end_search(mspringi_grids *grids, mspringi_memory *memory);
void mspringi_grids_destroy(mspringi_grids *grids, mspringi_memory *memory);

/// Particles without an assigned strip from which they get tiers. Fewer fit a fast cache.
#define MSPRINGI_MIN_TIERED 60000

/// Grid filter: drops the grids of components that cost less as irregular parts.
typedef struct mspringi_grid_filter {
    uint32_t inner, outer; ///< springs within grids, and other springs of their particles
    uint32_t *component;   ///< [particles] parent in a disjoint-set forest; NULL if nothing can be dropped
    struct mspringi_grid_cost *sums; ///< [particles] of roots
    uint32_t next_member;            ///< first member of the next grid
    uint32_t kept_grids, kept_members;
} mspringi_grid_filter;
/// Find the places of springs in grids, and drop the grids of components that cost less as irregular parts: set
/// their kinds to loose. Call in this order; ranges are of springs.
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

/// Put small grids side by side in the same rows, as one grid. found_count stays. Call in this order; a range is of
/// narrow grids.
mspring_result mspringi_grids_measure(mspringi_grids *grids, mspringi_memory *memory, mspringi_message *message);
uint32_t mspringi_grids_narrow_count(const mspringi_grids *grids);
void mspringi_grids_shelve(mspringi_grids *grids, uint32_t first, uint32_t end);
void mspringi_grids_number(mspringi_grids *grids, mspringi_memory *memory);
void mspringi_shelver_destroy(struct mspringi_grid_shelver *shelver, mspringi_memory *memory);

/// Place of a spring in a grid: 1 + its direction, and MSPRINGI_FROM_B if that leads from b to a. 0 if it does not
/// join neighbouring cells of one grid.
#define MSPRINGI_FROM_B 8
uint8_t mspringi_grids_place_spring(const mspringi_grids *grids, const mspringi_spring *spring);
static inline mspringi_direction mspringi_direction_at(uint8_t place) {
    return (mspringi_direction)(place % MSPRINGI_FROM_B - 1);
}
/// The end that a spring's direction leads from, and the other one.
static inline mspring_id mspringi_base_at(const mspringi_spring *spring, uint8_t place) {
    return place & MSPRINGI_FROM_B ? spring->b : spring->a;
}
static inline mspring_id mspringi_tip_at(const mspringi_spring *spring, uint8_t place) {
    return place & MSPRINGI_FROM_B ? spring->a : spring->b;
}

/// Largest useful skew. With a larger one, too few substeps of too many strips share the cache.
#define MSPRINGI_MAX_SKEW 16

/// Grids swept for several substeps in one pass, and the strips of the irregular particles connected to them.
typedef struct mspringi_strip_assignment {
    uint32_t *assigned_strip; ///< [particles] strip of irregular particles connected to these grids; MSPRING_NONE
                              ///< for all others
    uint32_t *grid_order;     ///< [grids] grids, these first
    uint32_t *first_row;      ///< [grids] first row of a grid, in that order
    uint32_t row_count;       ///< rows of these grids
    uint32_t all_rows;        ///< rows of all grids
    uint32_t strip_rows;      ///< rows in a strip; the last one may have fewer
    /// Strips by which a substep trails the one before; ends of irregular springs are no further apart.
    uint32_t skew;
    struct mspringi_strip_assignment_finder *finder; ///< scratch of the search
} mspringi_strip_assignment;

/// Assign strips, in this order. All arguments must outlive the search. attach visits members of grids,
/// join_springs visits springs; call try_skews until it returns true.
mspring_result mspringi_strip_assignment_begin(mspringi_strip_assignment *assignment, const mspringi_graph *graph,
                                               const mspringi_grids *grids, const mspringi_chains *chains,
                                               mspringi_memory *memory, mspringi_message *message);
void mspringi_strip_assignment_find_attached(mspringi_strip_assignment *assignment, uint32_t first, uint32_t end);
mspring_result mspringi_strip_assignment_reserve(mspringi_strip_assignment *assignment, uint32_t workers,
                                                 mspringi_memory *memory, mspringi_message *message);
void mspringi_strip_assignment_join_springs(mspringi_strip_assignment *assignment, uint32_t first, uint32_t end);
void mspringi_strip_assignment_choose_grids(mspringi_strip_assignment *assignment);
bool mspringi_strip_assignment_try_skews(mspringi_strip_assignment *assignment);
void mspringi_strip_assignment_end(mspringi_strip_assignment *assignment, mspringi_memory *memory);
void mspringi_strip_assignment_destroy(mspringi_strip_assignment *assignment, mspringi_memory *memory);

/// Irregular particles: loose ones with springs. Their kinds become MSPRINGI_ROW_IRREGULAR. Those with an assigned
/// strip come first, by strip. The others are sorted by position, and particles of similar degree are neighbours.
/// Bundles come last.
typedef struct mspringi_irregular_list {
    uint32_t *particles; ///< [count]
    uint32_t count;
    uint32_t assigned_count; ///< particles with an assigned strip
    uint32_t first_in_bundles;

    // Scratch.
    double min_x, max_x, min_y, max_y; ///< of particles without an assigned strip
    uint64_t *keys, *scratch;          ///< [count]
} mspringi_irregular_list;
/// Make the list, in this order; then find its tiers.
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

/// Drop chains, after the list's particles have been counted: their particles become loose and are counted, too.
/// Chains with an assigned strip are dropped. So are those connected to an irregular part with tiers, unless chains
/// have more particles than that part. In networks with bundles, so are short ones connected to the irregular part.
void mspringi_chains_drop(mspringi_chains *chains, const mspringi_graph *graph,
                          const mspringi_strip_assignment *assignment, bool has_bundles, uint8_t *kinds,
                          mspringi_irregular_list *list);

/// Tiers of the irregular particles without an assigned strip. Springs join particles of one tier or of two
/// consecutive ones.
typedef struct mspringi_tiers {
    uint32_t count;    ///< 0: no tiers
    uint32_t *end;     ///< [count] end of each tier, from the first particle without an assigned strip
    uint32_t *tier_of; ///< [particles] tier of each particle of the network

    // Scratch.
    uint32_t *particles;      ///< list of particles
    uint32_t particle_count;  ///< in it
    uint32_t *queue;          ///< [particle_count] breadth-first order, component after component
    uint32_t component_begin; ///< start of the present search in the queue
    uint32_t head, tail, level_end;
} mspringi_tiers;
/// Find the tiers and sort the list by tier.
mspring_result mspringi_tiers_find(mspringi_tiers *tiers, const mspringi_irregular_list *list,
                                   const mspringi_graph *graph, mspringi_memory *memory, mspringi_message *message);
void mspringi_tiers_destroy(mspringi_tiers *tiers, mspringi_memory *memory);

/// Sort particles by degree within windows; a window lies in one tier.
void mspringi_irregular_list_order_windows(mspringi_irregular_list *list, const mspringi_tiers *tiers,
                                           const mspringi_graph *graph, mspringi_memory *memory);

#endif
