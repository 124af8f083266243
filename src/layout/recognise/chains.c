/// Ropes and other chains: paths of particles with at most two springs each.
#include "layout/analysis.h"

#define MIN_ATTACHED_CHAIN 3

/// In networks with bundles, shorter chains join the irregular part that they are connected to. As chains, their
/// pull at both ends costs as much as this many springs computed twice. (Our ship with one spring of ten left, 3 in
/// a chain on average: 18.7 % of the whole ship's step instead of 19.2.)
#define MIN_CHAIN_WITH_BUNDLES 16

static uint32_t degree_of(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

static bool can_be_in_chain(const mspringi_graph *graph, uint32_t particle) {
    return degree_of(graph, particle) == 1 || degree_of(graph, particle) == 2;
}

// Next spring of a particle along its chain, after previous_spring; MSPRING_NONE at the end.
static uint32_t next_spring(const mspringi_graph *graph, uint32_t particle, uint32_t previous_spring) {
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i) {
        const uint32_t spring = graph->springs[i];
        if (spring != previous_spring && can_be_in_chain(graph, graph->others[i]))
            return spring;
    }
    return MSPRING_NONE;
}

// Walk from any particle of a chain to one of its ends. In a ring, stop at the start.
static uint32_t find_end(const mspringi_graph *graph, uint32_t start) {
    uint32_t at = start, previous_spring = MSPRING_NONE;
    for (;;) {
        const uint32_t spring = next_spring(graph, at, previous_spring);
        if (spring == MSPRING_NONE)
            return at;
        at = mspringi_other_end(&graph->builder->springs[spring], at);
        previous_spring = spring;
        if (at == start)
            return at;
    }
}

// True if the particle has a spring to one that can be in no chain.
static bool is_attached(const mspringi_graph *graph, uint32_t particle) {
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i)
        if (!can_be_in_chain(graph, graph->others[i]))
            return true;
    return false;
}

// Append the chain that begins at end; drop it if it is too short.
static void append_chain(mspringi_chains *chains, const mspringi_graph *graph, uint32_t end, uint8_t *kinds) {
    const uint32_t begin = chains->count;
    uint8_t *visited = chains->visited;
    bool is_anchored = false;
    uint32_t at = end, previous_spring = MSPRING_NONE;
    for (;;) {
        visited[at] = 1;
        is_anchored = is_anchored || is_attached(graph, at);
        chains->particles[chains->count] = at;
        const uint32_t spring = next_spring(graph, at, previous_spring);
        const bool leads_on =
            spring != MSPRING_NONE && !visited[mspringi_other_end(&graph->builder->springs[spring], at)];
        chains->springs[chains->count++] = leads_on ? spring : MSPRING_NONE;
        if (!leads_on)
            break;
        at = mspringi_other_end(&graph->builder->springs[spring], at);
        previous_spring = spring;
    }
    const uint32_t length = chains->count - begin;
    if (is_anchored && length < MIN_ATTACHED_CHAIN) {
        chains->count = begin;
        return;
    }
    for (uint32_t i = begin; i < chains->count; ++i)
        kinds[chains->particles[i]] = MSPRINGI_ROW_CHAIN;
    chains->chain_count++;
    chains->spring_count += length - 1;
}

static uint32_t count_candidates(const mspringi_graph *graph) {
    uint32_t count = 0;
    for (uint32_t p = 0; p < graph->builder->particle_count; ++p)
        count += can_be_in_chain(graph, p);
    return count;
}

mspring_result mspringi_chains_find(mspringi_chains *chains, const mspringi_graph *graph, uint8_t *kinds,
                                    mspringi_memory *memory, mspringi_message *message) {
    const uint32_t particles = (uint32_t)graph->builder->particle_count, candidates = count_candidates(graph);
    chains->visited = mspringi_alloc(memory, particles, sizeof *chains->visited);
    chains->particles = mspringi_alloc(memory, candidates, sizeof *chains->particles);
    chains->springs = mspringi_alloc(memory, candidates, sizeof *chains->springs);
    if (!chains->visited || !chains->particles || !chains->springs)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for ropes of %u particles", candidates);
    for (uint32_t p = 0; p < particles; ++p)
        if (can_be_in_chain(graph, p) && kinds[p] == MSPRINGI_ROW_LOOSE && !chains->visited[p])
            append_chain(chains, graph, find_end(graph, p), kinds);
    mspringi_free(memory, chains->visited);
    chains->visited = NULL;
    return MSPRING_OK;
}

// True if the particle has a spring to an irregular one without an assigned strip.
static bool is_on_irregular_part(const mspringi_graph *graph, const mspringi_strip_assignment *assignment,
                                 const uint8_t *kinds, uint32_t particle) {
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i) {
        const uint32_t other = graph->others[i];
        if (kinds[other] == MSPRINGI_ROW_LOOSE && assignment->assigned_strip[other] == MSPRING_NONE)
            return true;
    }
    return false;
}

static void drop_chain(mspringi_chains *chains, const mspringi_strip_assignment *assignment, uint8_t *kinds,
                       mspringi_irregular_list *list, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
        kinds[chains->particles[i]] = MSPRINGI_ROW_LOOSE;
        list->assigned_count += assignment->assigned_strip[chains->particles[i]] != MSPRING_NONE;
    }
    list->count += end - begin;
}

static void keep_chain(mspringi_chains *chains, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
        chains->particles[chains->kept] = chains->particles[i];
        chains->springs[chains->kept++] = chains->springs[i];
    }
    chains->chain_count++;
    chains->spring_count += end - begin - 1;
}

// Keep or drop whole chains: all particles of one have an assigned strip, or none.
void mspringi_chains_drop(mspringi_chains *chains, const mspringi_graph *graph,
                          const mspringi_strip_assignment *assignment, bool has_bundles, uint8_t *kinds,
                          mspringi_irregular_list *list) {
    const uint32_t unassigned_count = list->count - list->assigned_count;
    const bool drops_tiered = unassigned_count >= MSPRINGI_MIN_TIERED && chains->count <= unassigned_count;
    const uint32_t *particles = chains->particles;
    chains->chain_count = chains->spring_count = 0;
    for (uint32_t begin = 0, last; begin < chains->count; begin = last + 1) {
        for (last = begin; chains->springs[last] != MSPRING_NONE;)
            ++last;
        const bool is_assigned = assignment->assigned_strip[particles[begin]] != MSPRING_NONE;
        const bool can_drop = drops_tiered || (has_bundles && last - begin < MIN_CHAIN_WITH_BUNDLES);
        const bool is_on_irregular =
            can_drop && (is_on_irregular_part(graph, assignment, kinds, particles[begin]) ||
                         is_on_irregular_part(graph, assignment, kinds, particles[last]));
        if (is_assigned || is_on_irregular)
            drop_chain(chains, assignment, kinds, list, begin, last + 1);
        else
            keep_chain(chains, begin, last + 1);
    }
    chains->count = chains->kept;
}

void mspringi_chains_destroy(mspringi_chains *chains, mspringi_memory *memory) {
    mspringi_free(memory, chains->visited);
    mspringi_free(memory, chains->particles);
    mspringi_free(memory, chains->springs);
}
