/// Incident springs of particles, and parallel springs.
#include "layout/analysis.h"

static mspring_result reserve(mspringi_graph *graph, bool is_checked, mspringi_memory *memory,
                              mspringi_message *message) {
    const size_t particles = graph->builder->particle_count, springs = graph->builder->spring_count;
    graph->first = mspringi_alloc(memory, particles + 2, sizeof *graph->first);
    graph->springs = mspringi_alloc_unset(memory, 2 * springs, sizeof *graph->springs);
    graph->others = mspringi_alloc_unset(memory, 2 * springs, sizeof *graph->others);
    if (!is_checked)
        graph->stamp_of = mspringi_alloc(memory, particles, sizeof *graph->stamp_of);
    if (!graph->first || !graph->springs || !graph->others || (!is_checked && !graph->stamp_of))
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the graph of %zu springs", springs);
    return MSPRING_OK;
}

// Counting sort: first[p + 2] counts, then first[p + 1] is the index of p's next spring, at last the end of p's
// springs.
static void sort_springs(mspringi_graph *graph) {
    const mspring_builder *builder = graph->builder;
    const uint32_t springs = (uint32_t)builder->spring_count;
    uint32_t *first = graph->first, *by_particle = graph->springs, *others = graph->others;
    for (uint32_t s = 0; s < springs; ++s) {
        first[builder->springs[s].a + 2]++;
        first[builder->springs[s].b + 2]++;
    }
    for (size_t p = 0; p < builder->particle_count; ++p)
        first[p + 2] += first[p + 1];
    for (uint32_t s = 0; s < springs; ++s) {
        const mspring_id a = builder->springs[s].a, b = builder->springs[s].b;
        const uint32_t at_a = first[a + 1]++, at_b = first[b + 1]++;
        by_particle[at_a] = by_particle[at_b] = s;
        others[at_a] = b;
        others[at_b] = a;
    }
}

static bool is_one_way(const mspringi_spring *spring) {
    return spring->flags & MSPRINGI_ONE_WAY_FLAGS;
}

// Mark the later of two parallel springs.
static mspring_result mark_parallel(mspringi_graph *graph, uint32_t spring, mspringi_memory *memory,
                                    mspringi_message *message) {
    const size_t springs = graph->builder->spring_count;
    if (!graph->is_parallel)
        graph->is_parallel = mspringi_alloc(memory, springs, sizeof *graph->is_parallel);
    if (!graph->is_parallel)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the graph of %zu springs", springs);
    graph->is_parallel[spring] = 1;
    graph->parallel_count++;
    return MSPRING_OK;
}

// Stamp each particle's neighbours of higher id with the spring to them: 1 + its index, which tells it from those
// of particles before. An existing stamp names a parallel spring, preferably one that acts in both directions.
static mspring_result find_parallel(mspringi_graph *graph, mspringi_memory *memory, mspringi_message *message) {
    const mspring_builder *builder = graph->builder;
    uint32_t *stamp_of = graph->stamp_of;
    for (uint32_t p = 0; p < builder->particle_count; ++p) {
        for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
            const uint32_t spring = graph->springs[i];
            const mspring_id other = graph->others[i];
            if (other < p)
                continue;
            const bool is_repeated = stamp_of[other] > graph->first[p],
                       can_be_parallel = is_repeated && is_one_way(&builder->springs[spring]);
            const uint32_t parallel = is_repeated ? graph->springs[stamp_of[other] - 1] : spring;
            if (is_repeated && !can_be_parallel && !is_one_way(&builder->springs[parallel]))
                return mspringi_fail(message, MSPRING_ERROR_DUPLICATE,
                                     "springs %u and %u both join particles %u and %u", (unsigned)parallel,
                                     (unsigned)spring, (unsigned)p, (unsigned)other);
            const mspring_result result = is_repeated ? mark_parallel(graph, spring, memory, message) : MSPRING_OK;
            if (result != MSPRING_OK)
                return result;
            if (!can_be_parallel)
                stamp_of[other] = i + 1;
        }
    }
    return MSPRING_OK;
}

// Drop parallel springs: grids and chains have one spring between two particles.
static void drop_parallel(mspringi_graph *graph) {
    uint32_t kept = 0, begin = 0;
    for (size_t p = 0; p < graph->builder->particle_count; ++p) {
        const uint32_t end = graph->first[p + 1];
        for (uint32_t i = begin; i < end; ++i)
            if (!graph->is_parallel[graph->springs[i]]) {
                graph->others[kept] = graph->others[i];
                graph->springs[kept++] = graph->springs[i];
            }
        graph->first[p + 1] = kept;
        begin = end;
    }
}

mspring_result mspringi_graph_create(mspringi_graph *graph, const mspring_builder *builder, bool is_checked,
                                     mspringi_memory *memory, mspringi_message *message) {
    graph->builder = builder;
    mspring_result result = reserve(graph, is_checked, memory, message);
    if (result != MSPRING_OK)
        return result;
    sort_springs(graph);
    if (is_checked)
        return MSPRING_OK;
    result = find_parallel(graph, memory, message);
    if (graph->is_parallel)
        drop_parallel(graph);
    mspringi_free(memory, graph->stamp_of);
    graph->stamp_of = NULL;
    return result;
}

void mspringi_graph_destroy(mspringi_graph *graph, mspringi_memory *memory) {
    mspringi_free(memory, graph->first);
    mspringi_free(memory, graph->springs);
    mspringi_free(memory, graph->others);
    mspringi_free(memory, graph->stamp_of);
    mspringi_free(memory, graph->is_parallel);
}
