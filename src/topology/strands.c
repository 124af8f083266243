/// Ropes and other single strands: particles in a row that have no more than two springs each.
#include "analysis.h"

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

// Append the strand that begins at end; take it back if it is too short. Returns how many particles it has.
static uint32_t append_strand(mspringi_strands *strands, const mspringi_graph *graph, uint32_t end,
                              uint8_t *kinds) {
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
        return length;
    }
    for (uint32_t i = begin; i < strands->count; ++i)
        kinds[strands->particles[i]] = MSPRINGI_ROW_CHAIN;
    strands->strand_count++;
    strands->spring_count += length - 1;
    return length;
}

void mspringi_strands_count(mspringi_strands *strands, const mspringi_graph *graph, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, (uint32_t)graph->builder->particle_count, 1, &first, &end);
    for (uint32_t p = first; p < end; ++p)
        strands->candidates += may_be_in_strand(graph, p);
}

mspring_result mspringi_strands_reserve(mspringi_strands *strands, const mspringi_graph *graph, mspringi_pace *pace,
                                        mspringi_memory *memory, mspringi_message *message) {
    const uint32_t candidates = strands->candidates;
    strands->visited = mspringi_pace_alloc(pace, memory, graph->builder->particle_count, sizeof *strands->visited);
    strands->particles = mspringi_pace_alloc(pace, memory, candidates, sizeof *strands->particles);
    strands->springs = mspringi_pace_alloc(pace, memory, candidates, sizeof *strands->springs);
    return strands->visited && strands->particles && strands->springs
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for strands of %u particles", candidates);
}

// A strand is found in one go, however long it is.
void mspringi_strands_find(mspringi_strands *strands, const mspringi_graph *graph, uint8_t *kinds,
                           mspringi_pace *pace, mspringi_memory *memory) {
    const uint32_t particles = (uint32_t)graph->builder->particle_count;
    uint32_t p = pace->at;
    for (; p < particles && pace->left > 0; ++p) {
        mspringi_pace_spend(pace, 1);
        if (may_be_in_strand(graph, p) && kinds[p] == MSPRINGI_ROW_LOOSE && !strands->visited[p])
            mspringi_pace_spend(pace, (uint64_t)16 * append_strand(strands, graph, find_end(graph, p), kinds));
    }
    pace->at = p;
    pace->is_halfway = p < particles;
    if (pace->is_halfway)
        return;
    mspringi_free(memory, strands->visited);
    strands->visited = NULL;
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
                           bool has_herds, uint8_t *kinds, mspringi_web_list *list, mspringi_pace *pace) {
    uint32_t begin = pace->at;
    if (begin == 0) {
        const uint32_t homeless = list->count - list->homed_count;
        strands->drops_webbed = homeless >= MSPRINGI_FEWEST_LAYERED && strands->count <= homeless;
        strands->strand_count = strands->spring_count = 0;
    }
    while (begin < strands->count && pace->left > 0) {
        uint32_t last = begin;
        while (strands->springs[last] != MSPRING_NONE)
            ++last;
        const uint32_t *particles = strands->particles;
        const bool is_homed = homes->home[particles[begin]] != MSPRING_NONE;
        const bool may_drop = strands->drops_webbed || (has_herds && last - begin < SHORT_IN_WRECK);
        const bool is_webbed = may_drop && (hangs_on_web(graph, homes, kinds, particles[begin]) ||
                                            hangs_on_web(graph, homes, kinds, particles[last]));
        mspringi_pace_spend(pace, (uint64_t)2 * (last + 1 - begin));
        if (is_homed || is_webbed)
            drop_strand(strands, homes, kinds, list, begin, last + 1);
        else
            keep_strand(strands, begin, last + 1);
        begin = last + 1;
    }
    pace->at = begin;
    pace->is_halfway = begin < strands->count;
    if (!pace->is_halfway)
        strands->count = strands->kept;
}

void mspringi_strands_destroy(mspringi_strands *strands, mspringi_memory *memory) {
    mspringi_free(memory, strands->visited);
    mspringi_free(memory, strands->particles);
    mspringi_free(memory, strands->springs);
}
