/// Tiers of a large irregular part: each has springs to the one before and the one behind only. Together they form
/// a rooted level structure (George 1971).
///
/// An irregular part larger than the cache is read from memory once a substep, unless a pass over its tiers takes
/// several substeps. Each trails the one before by a tier: a wavefront, as over the strips of lattices. Tiers are
/// whole levels of a breadth-first search. It starts at the farthest particle that a first search finds. Long
/// springs and ropes are followed like all others, so they lead to fewer tiers.
#include <string.h>

#include "layout/analysis.h"

/// Fewest particles in a tier: smaller ones take more calls. Levels of parts that get tiers are wider anyway.
#define MIN_TIER_PARTICLES 1024

/// With fewer tiers a wavefront is all front.
#define MIN_TIERS 8

/// Marks in place of a tier's number.
#define NOT_VISITED (MSPRING_NONE - 1)
#define VISITED (MSPRING_NONE - 2)

static mspring_result reserve(mspringi_tiers *tiers, size_t particles, mspringi_memory *memory,
                              mspringi_message *message) {
    tiers->tier_of = mspringi_alloc(memory, particles, sizeof *tiers->tier_of);
    tiers->queue = mspringi_alloc(memory, tiers->particle_count, sizeof *tiers->queue);
    tiers->end = mspringi_alloc(memory, tiers->particle_count / MIN_TIER_PARTICLES + 2, sizeof *tiers->end);
    if (!tiers->tier_of || !tiers->queue || !tiers->end)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the layers of %u particles",
                             (unsigned)tiers->particle_count);
    memset(tiers->tier_of, 0xff, particles * sizeof *tiers->tier_of);
    for (uint32_t i = 0; i < tiers->particle_count; ++i)
        tiers->tier_of[tiers->particles[i]] = NOT_VISITED;
    return MSPRING_OK;
}

// Begin a search at one particle, behind the components so far.
static void begin_search(mspringi_tiers *tiers, uint32_t particle, uint32_t mark) {
    tiers->queue[tiers->component_begin] = particle;
    tiers->tier_of[particle] = mark;
    tiers->head = tiers->component_begin;
    tiers->tail = tiers->component_begin + 1;
}

// End a level, and its tier if that is large enough.
static void end_level(mspringi_tiers *tiers) {
    tiers->level_end = tiers->tail;
    if (tiers->tail - tiers->end[tiers->count] < MIN_TIER_PARTICLES)
        return;
    tiers->count++;
    tiers->end[tiers->count] = tiers->tail;
}

// Queue the neighbours of the queue's first particle that still have the mark `before`.
static void queue_neighbours(mspringi_tiers *tiers, const mspringi_graph *graph, uint32_t before, uint32_t mark) {
    const uint32_t p = tiers->queue[tiers->head++];
    for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
        const uint32_t other = graph->others[i];
        if (tiers->tier_of[other] != before)
            continue;
        tiers->tier_of[other] = mark;
        tiers->queue[tiers->tail++] = other;
    }
}

// Find a particle far from this one, and from there the tiers of their component.
static void find_component_tiers(mspringi_tiers *tiers, const mspringi_graph *graph, uint32_t particle) {
    begin_search(tiers, particle, VISITED);
    while (tiers->head < tiers->tail)
        queue_neighbours(tiers, graph, NOT_VISITED, VISITED);
    begin_search(tiers, tiers->queue[tiers->tail - 1], tiers->count);
    end_level(tiers);
    while (tiers->head < tiers->tail) {
        queue_neighbours(tiers, graph, VISITED, tiers->count);
        if (tiers->head == tiers->level_end)
            end_level(tiers);
    }
    tiers->component_begin = tiers->tail;
}

// Sort particles by tier, stably. The begin of each tier becomes its end.
static void sort_by_tier(mspringi_tiers *tiers) {
    for (uint32_t i = 0; i < tiers->particle_count; ++i)
        tiers->queue[tiers->end[tiers->tier_of[tiers->particles[i]]]++] = tiers->particles[i];
    memcpy(tiers->particles, tiers->queue, tiers->particle_count * sizeof *tiers->particles);
}

mspring_result mspringi_tiers_find(mspringi_tiers *tiers, const mspringi_irregular_list *list,
                                   const mspringi_graph *graph, mspringi_memory *memory,
                                   mspringi_message *message) {
    tiers->particle_count = list->count - list->assigned_count;
    tiers->particles = list->particles + list->assigned_count;
    if (tiers->particle_count < MSPRINGI_MIN_TIERED)
        return MSPRING_OK;
    mspring_result result = reserve(tiers, graph->builder->particle_count, memory, message);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < tiers->particle_count; ++i)
        if (tiers->tier_of[tiers->particles[i]] == NOT_VISITED)
            find_component_tiers(tiers, graph, tiers->particles[i]);
    tiers->count += tiers->end[tiers->count] < tiers->particle_count;
    if (tiers->count < MIN_TIERS)
        tiers->count = 0;
    else
        sort_by_tier(tiers);
    mspringi_free(memory, tiers->queue);
    tiers->queue = NULL;
    return MSPRING_OK;
}

void mspringi_tiers_destroy(mspringi_tiers *tiers, mspringi_memory *memory) {
    mspringi_free(memory, tiers->tier_of);
    mspringi_free(memory, tiers->queue);
    mspringi_free(memory, tiers->end);
}
