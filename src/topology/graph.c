/// Springs by particle.
#include "analysis.h"

mspring_result mspringi_graph_reserve(mspringi_graph *graph, const mspring_builder *builder, bool is_checked,
                                      mspringi_pace *pace, mspringi_memory *memory, mspringi_message *message) {
    const size_t particles = builder->particle_count, springs = builder->spring_count;
    graph->builder = builder;
    graph->first = mspringi_pace_alloc(pace, memory, particles + 2, sizeof *graph->first);
    graph->springs = mspringi_pace_alloc(pace, memory, 2 * springs, sizeof *graph->springs);
    if (!is_checked) {
        graph->stamp_of = mspringi_pace_alloc(pace, memory, particles, sizeof *graph->stamp_of);
        graph->spring_to = mspringi_pace_alloc(pace, memory, particles, sizeof *graph->spring_to);
    }
    if (!graph->first || !graph->springs || (!is_checked && (!graph->stamp_of || !graph->spring_to)))
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the graph of %zu springs", springs);
    return MSPRING_OK;
}

// Counting sort: first[p + 2] counts, then becomes the place to write the next spring of p at, so that in the end
// first[p + 1] is where those of p end.

void mspringi_graph_count(mspringi_graph *graph, mspringi_pace *pace) {
    const mspring_builder *builder = graph->builder;
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)builder->spring_count, 1, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        graph->first[builder->springs[s].a + 2]++;
        graph->first[builder->springs[s].b + 2]++;
    }
}

void mspringi_graph_sum(mspringi_graph *graph, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)graph->builder->particle_count, 1, &first, &end);
    for (size_t p = first; p < end; ++p)
        graph->first[p + 2] += graph->first[p + 1];
}

void mspringi_graph_fill(mspringi_graph *graph, mspringi_pace *pace) {
    const mspring_builder *builder = graph->builder;
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)builder->spring_count, 2, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        graph->springs[graph->first[builder->springs[s].a + 1]++] = s;
        graph->springs[graph->first[builder->springs[s].b + 1]++] = s;
    }
}

// Each particle's neighbours are stamped with the spring that leads there, and a stamp that is there already names
// the first of the two.
mspring_result mspringi_graph_check(mspringi_graph *graph, mspringi_pace *pace, mspringi_memory *memory,
                                    mspringi_message *message) {
    const mspring_builder *builder = graph->builder;
    uint32_t *stamp_of = graph->stamp_of, *spring_to = graph->spring_to, first, end;
    if (!stamp_of)
        return MSPRING_OK;
    mspringi_pace_take(pace, (uint32_t)builder->particle_count, 8, &first, &end);
    for (uint32_t p = first; p < end; ++p) {
        for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
            const uint32_t spring = graph->springs[i];
            const mspring_id other = mspringi_other_end(&builder->springs[spring], p);
            if (stamp_of[other] == p + 1)
                return mspringi_fail(message, MSPRING_ERROR_DUPLICATE,
                                     "springs %u and %u both join particles %u and %u", (unsigned)spring_to[other],
                                     (unsigned)spring, (unsigned)p, (unsigned)other);
            stamp_of[other] = p + 1;
            spring_to[other] = spring;
        }
    }
    if (!pace->is_halfway) {
        mspringi_free(memory, stamp_of);
        mspringi_free(memory, spring_to);
        graph->stamp_of = graph->spring_to = NULL;
    }
    return MSPRING_OK;
}

void mspringi_graph_destroy(mspringi_graph *graph, mspringi_memory *memory) {
    mspringi_free(memory, graph->first);
    mspringi_free(memory, graph->springs);
    mspringi_free(memory, graph->stamp_of);
    mspringi_free(memory, graph->spring_to);
}
