/// Filter of grids that cost more than they save. Some meshes resemble grids: their particles lie near lattice
/// nodes, but have other springs, or lie too far off for one grid. Only parts are recognised, tied together by
/// irregular springs.
///
/// An irregular spring to lattice rows costs about five times as much as one between irregular particles. The
/// latter costs as much as two or three in rows. If there are many, the whole component is cheaper as an irregular
/// part.
#include <string.h>

#include "base/union_find.h"
#include "layout/analysis.h"

/// Fewest members of a component's grids worth a check.
#define MIN_MEMBERS 1000

/// Drop a component's grids if there is an irregular spring for this many within them. (Meshes with 8 to 11 %
/// irregular springs take 0.58 to 0.86 times as long as an irregular part; with 31 to 46 %, 1.3 to 1.65 times.)
#define INNER_PER_OUTER 4

/// Bounds for large components of several grids, whose strips are tied too far apart for passes of several
/// substeps. The second is for springs between grids alone. (A mesh with 10 % irregular springs, few between grids,
/// takes 0.8 times as long as an irregular part. With at least as many, a third of them between grids, it takes 2
/// to 3 times as long.)
#define LARGE_INNER_PER_OUTER 8
#define LARGE_INNER_PER_ACROSS 32

/// Drop grids connected to an irregular part that would get tiers and has more particles for each grid member: the
/// grids have too few strips for it.
#define IRREGULAR_PER_MEMBER 4

/// Sums of a component, at its root.
struct mspringi_grid_cost {
    uint32_t inner;     ///< springs in lattice rows
    uint32_t outer;     ///< other springs of grid members, except to chains
    uint32_t across;    ///< springs of these between grids
    uint32_t members;   ///< particles in grids
    uint32_t irregular; ///< irregular particles
};

typedef enum spring_kind { ELSEWHERE, INNER, OUTER, ACROSS } spring_kind;

static spring_kind kind_of(const mspringi_graph *graph, const mspringi_grids *grids, const uint8_t *kinds,
                           uint32_t s) {
    const mspringi_spring *spring = &graph->builder->springs[s];
    const uint32_t of_a = grids->grid_of[spring->a], of_b = grids->grid_of[spring->b];
    if (grids->place[s] != 0)
        return INNER;
    if ((of_a == MSPRING_NONE && of_b == MSPRING_NONE) || kinds[spring->a] == MSPRINGI_ROW_CHAIN ||
        kinds[spring->b] == MSPRINGI_ROW_CHAIN)
        return ELSEWHERE;
    return of_a != MSPRING_NONE && of_b != MSPRING_NONE && of_a != of_b ? ACROSS : OUTER;
}

void mspringi_grid_filter_count(mspringi_grid_filter *filter, const mspringi_graph *graph,
                                const mspringi_grids *grids, const uint8_t *kinds, uint32_t first, uint32_t end) {
    if (grids->count == 0)
        return;
    for (uint32_t s = first; s < end; ++s) {
        if (!graph->is_parallel || !graph->is_parallel[s])
            grids->place[s] = mspringi_grids_place_spring(grids, &graph->builder->springs[s]);
        const spring_kind kind = kind_of(graph, grids, kinds, s);
        filter->inner += kind == INNER;
        filter->outer += kind > INNER;
    }
}

mspring_result mspringi_grid_filter_reserve(mspringi_grid_filter *filter, const mspringi_graph *graph,
                                            const mspringi_grids *grids, mspringi_memory *memory,
                                            mspringi_message *message) {
    const size_t particles = graph->builder->particle_count;
    const bool has_tied =
        grids->member_count >= MIN_MEMBERS && (uint64_t)filter->outer * LARGE_INNER_PER_ACROSS > filter->inner;
    const bool has_irregular = particles - grids->member_count >= MSPRINGI_MIN_TIERED;
    if (grids->count == 0 || (!has_tied && !has_irregular))
        return MSPRING_OK;
    filter->component = mspringi_alloc(memory, particles, sizeof *filter->component);
    filter->sums = mspringi_alloc(memory, particles, sizeof *filter->sums);
    if (!filter->component || !filter->sums)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles", particles);
    for (uint32_t p = 0; p < particles; ++p)
        filter->component[p] = p;
    return MSPRING_OK;
}

void mspringi_grid_filter_join(mspringi_grid_filter *filter, const mspringi_graph *graph, uint32_t first,
                               uint32_t end) {
    const mspring_builder *builder = graph->builder;
    if (!filter->component)
        return;
    for (uint32_t s = first; s < end; ++s)
        mspringi_union_find_join(filter->component, builder->springs[s].a, builder->springs[s].b);
}

static struct mspringi_grid_cost *sums_of(const mspringi_grid_filter *filter, uint32_t particle) {
    return &filter->sums[mspringi_union_find_root(filter->component, particle)];
}

void mspringi_grid_filter_count_springs(mspringi_grid_filter *filter, const mspringi_graph *graph,
                                        const mspringi_grids *grids, const uint8_t *kinds, uint32_t first,
                                        uint32_t end) {
    const mspring_builder *builder = graph->builder;
    if (!filter->component)
        return;
    for (uint32_t s = first; s < end; ++s) {
        const spring_kind kind = kind_of(graph, grids, kinds, s);
        struct mspringi_grid_cost *sums = sums_of(filter, builder->springs[s].a);
        sums->inner += kind == INNER;
        sums->outer += kind > INNER;
        sums->across += kind == ACROSS;
    }
}

static void count_particles(mspringi_grid_filter *filter, const mspringi_graph *graph, const mspringi_grids *grids,
                            const uint8_t *kinds) {
    for (uint32_t p = 0; p < graph->builder->particle_count; ++p) {
        struct mspringi_grid_cost *sums = sums_of(filter, p);
        sums->members += grids->grid_of[p] != MSPRING_NONE;
        sums->irregular += kinds[p] == MSPRINGI_ROW_LOOSE;
    }
}

static bool is_tied_together(const struct mspringi_grid_cost *sums) {
    if (sums->members < MIN_MEMBERS)
        return false;
    if (sums->members < MSPRINGI_MIN_TIERED || sums->across == 0)
        return (uint64_t)sums->outer * INNER_PER_OUTER > sums->inner;
    return (uint64_t)sums->outer * LARGE_INNER_PER_OUTER > sums->inner ||
           (uint64_t)sums->across * LARGE_INNER_PER_ACROSS > sums->inner;
}

static bool is_outweighed(const struct mspringi_grid_cost *sums) {
    return sums->irregular >= MSPRINGI_MIN_TIERED &&
           (uint64_t)sums->members * IRREGULAR_PER_MEMBER < sums->irregular;
}

// Drop a grid, so that its particles become loose, or keep it with a new number.
static void move_grid(mspringi_grid_filter *filter, const mspringi_graph *graph, mspringi_grids *grids,
                      uint8_t *kinds, uint32_t end) {
    const struct mspringi_grid_cost *sums = sums_of(filter, grids->members[filter->next_member]);
    const bool is_dropped = is_tied_together(sums) || is_outweighed(sums);
    for (uint32_t m = filter->next_member; m < end; ++m) {
        const uint32_t p = grids->members[m];
        grids->grid_of[p] = is_dropped ? MSPRING_NONE : filter->kept_grids;
        for (uint32_t i = graph->first[p]; is_dropped && i < graph->first[p + 1]; ++i)
            grids->place[graph->springs[i]] = 0;
        if (is_dropped)
            kinds[p] = MSPRINGI_ROW_LOOSE;
        else
            grids->members[filter->kept_members++] = p;
    }
    filter->next_member = end;
    if (!is_dropped)
        grids->first_member[++filter->kept_grids] = filter->kept_members;
}

void mspringi_grid_filter_apply(mspringi_grid_filter *filter, const mspringi_graph *graph, mspringi_grids *grids,
                                uint8_t *kinds, mspringi_memory *memory) {
    if (!filter->component)
        return;
    count_particles(filter, graph, grids, kinds);
    for (uint32_t grid = 0; grid < grids->count; ++grid)
        move_grid(filter, graph, grids, kinds, grids->first_member[grid + 1]);
    grids->count = grids->found_count = filter->kept_grids;
    grids->member_count = filter->kept_members;
    mspringi_grid_filter_destroy(filter, memory);
}

void mspringi_grid_filter_destroy(mspringi_grid_filter *filter, mspringi_memory *memory) {
    mspringi_free(memory, filter->component);
    mspringi_free(memory, filter->sums);
    filter->component = NULL;
    filter->sums = NULL;
}
