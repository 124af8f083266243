/// Springs by particle.
#include "analysis.h"

// Refuse two springs between the same particles: each particle's neighbours are stamped with the spring that
// leads there, and a stamp that is there already names the first of the two.
static mspring_result check_duplicates(const mspringi_graph *graph, uint32_t *stamp_of, uint32_t *spring_to,
                                       mspringi_message *message) {
    const mspring_builder *builder = graph->builder;
    for (uint32_t p = 0; p < builder->particle_count; ++p) {
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
    return MSPRING_OK;
}

mspring_result mspringi_graph_create(mspringi_graph *graph, const mspring_builder *builder, mspringi_memory *memory,
                                     mspringi_message *message) {
    const size_t particles = builder->particle_count, springs = builder->spring_count;
    graph->builder = builder;
    graph->first = mspringi_alloc(memory, particles + 2, sizeof *graph->first);
    graph->springs = mspringi_alloc(memory, 2 * springs, sizeof *graph->springs);
    uint32_t *stamp_of = mspringi_alloc(memory, particles, sizeof *stamp_of);
    uint32_t *spring_to = mspringi_alloc(memory, particles, sizeof *spring_to);
    mspring_result result = MSPRING_OK;
    if (!graph->first || !graph->springs || !stamp_of || !spring_to) {
        result = mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the graph of %zu springs", springs);
    } else {
        // Counting sort: first[p + 2] counts, then becomes the place to write the next spring of p at, so that
        // in the end first[p + 1] is where those of p end.
        for (size_t s = 0; s < springs; ++s) {
            graph->first[builder->springs[s].a + 2]++;
            graph->first[builder->springs[s].b + 2]++;
        }
        for (size_t p = 2; p < particles + 2; ++p)
            graph->first[p] += graph->first[p - 1];
        for (size_t s = 0; s < springs; ++s) {
            graph->springs[graph->first[builder->springs[s].a + 1]++] = (uint32_t)s;
            graph->springs[graph->first[builder->springs[s].b + 1]++] = (uint32_t)s;
        }
        result = check_duplicates(graph, stamp_of, spring_to, message);
    }
    mspringi_free(memory, stamp_of);
    mspringi_free(memory, spring_to);
    return result;
}

void mspringi_graph_destroy(mspringi_graph *graph, mspringi_memory *memory) {
    mspringi_free(memory, graph->first);
    mspringi_free(memory, graph->springs);
}
