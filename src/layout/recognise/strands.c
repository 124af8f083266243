/// Ropes and other single strands: particles in a row that have no more than two springs each.
#include "layout/analysis.h"

#define SHORTEST_ATTACHED_STRAND 3

/// Beside herds, strands on the web that have fewer springs cost less as a part of it: its pull at two places of
/// another row costs about as much as so many springs take more at both ends. (Those of our ship with one spring of
/// ten left have 3 on average: 18.7 % of the whole ship's step instead of 19.2.)
#define SHORT_IN_WRECK 16

static uint32_t degree(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

static bool may_be_in_strand(const mspringi_graph *graph, uint32_t particle) {
    return degree(graph, particle) == 1 || degree(graph, particle) == 2;
}

// The spring of particle, other than came_by, that leads on along the strand; MSPRING_NONE at its end.
static uint32_t next_spring(const mspringi_graph *graph, uint32_t particle, uint32_t came_by) {
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i) {
        const uint32_t spring = graph->springs[i];
        if (spring != came_by &&
            may_be_in_strand(graph, mspringi_other_end(&graph->builder->springs[spring], particle)))
            return spring;
    }
    return MSPRING_NONE;
}

// Walk from any particle of a strand to one of its ends. In a ring, end where the walk started.
static uint32_t find_end(const mspringi_graph *graph, uint32_t start) {
    uint32_t at = start, came_by = MSPRING_NONE;
    for (;;) {
        const uint32_t spring = next_spring(graph, at, came_by);
        if (spring == MSPRING_NONE)
            return at;
        at = mspringi_other_end(&graph->builder->springs[spring], at);
        came_by = spring;
        if (at == start)
            return at;
    }
}

// Whether some spring of the particle leads to one that can be in no strand.
static bool is_attached(const mspringi_graph *graph, uint32_t particle) {
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i)
        if (!may_be_in_strand(graph, mspringi_other_end(&graph->builder->springs[graph->springs[i]], particle)))
            return true;
    return false;
}

// Append the strand that begins at end; take it back if it is too short.
static void append_strand(mspringi_strands *strands, const mspringi_graph *graph, uint32_t end, uint8_t *kinds) {
    const uint32_t begin = strands->count;
    uint8_t *visited = strands->visited;
    bool attached = false;
    uint32_t at = end, came_by = MSPRING_NONE;
    for (;;) {
        visited[at] = 1;
        attached = attached || is_attached(graph, at);
        strands->particles[strands->count] = at;
        const uint32_t spring = next_spring(graph, at, came_by);
        const bool leads_on =
            spring != MSPRING_NONE && !visited[mspringi_other_end(&graph->builder->springs[spring], at)];
        strands->springs[strands->count++] = leads_on ? spring : MSPRING_NONE;
        if (!leads_on)
            break;
        at = mspringi_other_end(&graph->builder->springs[spring], at);
        came_by = spring;
    }
    const uint32_t length = strands->count - begin;
    if (attached && length < SHORTEST_ATTACHED_STRAND) {
        strands->count = begin;
        return;
    }
    for (uint32_t i = begin; i < strands->count; ++i)
        kinds[strands->particles[i]] = MSPRINGI_ROW_CHAIN;
    strands->strand_count++;
    strands->spring_count += length - 1;
}

static uint32_t count_candidates(const mspringi_graph *graph) {
    uint32_t count = 0;
    for (uint32_t p = 0; p < graph->builder->particle_count; ++p)
        count += may_be_in_strand(graph, p);
    return count;
}

mspring_result mspringi_strands_find(mspringi_strands *strands, const mspringi_graph *graph, uint8_t *kinds,
                                     mspringi_memory *memory, mspringi_message *message) {
    const uint32_t particles = (uint32_t)graph->builder->particle_count, candidates = count_candidates(graph);
    strands->visited = mspringi_alloc(memory, particles, sizeof *strands->visited);
    strands->particles = mspringi_alloc(memory, candidates, sizeof *strands->particles);
    strands->springs = mspringi_alloc(memory, candidates, sizeof *strands->springs);
    if (!strands->visited || !strands->particles || !strands->springs)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for strands of %u particles", candidates);
    for (uint32_t p = 0; p < particles; ++p)
        if (may_be_in_strand(graph, p) && kinds[p] == MSPRINGI_ROW_LOOSE && !strands->visited[p])
            append_strand(strands, graph, find_end(graph, p), kinds);
    mspringi_free(memory, strands->visited);
    strands->visited = NULL;
    return MSPRING_OK;
}

// Whether some spring of the particle leads to one of the web that has no home.
static bool hangs_on_web(const mspringi_graph *graph, const mspringi_homes *homes, const uint8_t *kinds,
                         uint32_t particle) {
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i) {
        const uint32_t other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], particle);
        if (kinds[other] == MSPRINGI_ROW_LOOSE && homes->home[other] == MSPRING_NONE)
            return true;
    }
    return false;
}

static void drop_strand(mspringi_strands *strands, const mspringi_homes *homes, uint8_t *kinds,
                        mspringi_web_list *list, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
        kinds[strands->particles[i]] = MSPRINGI_ROW_LOOSE;
        list->homed_count += homes->home[strands->particles[i]] != MSPRING_NONE;
    }
    list->count += end - begin;
}

static void keep_strand(mspringi_strands *strands, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
        strands->particles[strands->kept] = strands->particles[i];
        strands->springs[strands->kept++] = strands->springs[i];
    }
    strands->strand_count++;
    strands->spring_count += end - begin - 1;
}

// Strand by strand: what has a home has it as a whole.
void mspringi_strands_drop(mspringi_strands *strands, const mspringi_graph *graph, const mspringi_homes *homes,
                           bool has_herds, uint8_t *kinds, mspringi_web_list *list) {
    const uint32_t homeless = list->count - list->homed_count;
    const bool drops_webbed = homeless >= MSPRINGI_FEWEST_LAYERED && strands->count <= homeless;
    const uint32_t *particles = strands->particles;
    strands->strand_count = strands->spring_count = 0;
    for (uint32_t begin = 0, last; begin < strands->count; begin = last + 1) {
        for (last = begin; strands->springs[last] != MSPRING_NONE;)
            ++last;
        const bool is_homed = homes->home[particles[begin]] != MSPRING_NONE;
        const bool may_drop = drops_webbed || (has_herds && last - begin < SHORT_IN_WRECK);
        const bool is_webbed = may_drop && (hangs_on_web(graph, homes, kinds, particles[begin]) ||
                                            hangs_on_web(graph, homes, kinds, particles[last]));
        if (is_homed || is_webbed)
            drop_strand(strands, homes, kinds, list, begin, last + 1);
        else
            keep_strand(strands, begin, last + 1);
    }
    strands->count = strands->kept;
}

void mspringi_strands_destroy(mspringi_strands *strands, mspringi_memory *memory) {
    mspringi_free(memory, strands->visited);
    mspringi_free(memory, strands->particles);
    mspringi_free(memory, strands->springs);
}
