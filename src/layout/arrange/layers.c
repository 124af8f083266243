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
#define LAYER_PARTICLES 1024

/// With fewer tiers a wavefront is all front.
#define FEWEST_LAYERS 8

/// Marks in place of a tier's number.
#define IS_UNSEEN (MSPRING_NONE - 1)
#define IS_SEEN (MSPRING_NONE - 2)

static mspring_result reserve(mspringi_layers *layers, size_t particles, mspringi_memory *memory,
                              mspringi_message *message) {
    layers->layer_of = mspringi_alloc(memory, particles, sizeof *layers->layer_of);
    layers->queue = mspringi_alloc(memory, layers->particle_count, sizeof *layers->queue);
    layers->end = mspringi_alloc(memory, layers->particle_count / LAYER_PARTICLES + 2, sizeof *layers->end);
    if (!layers->layer_of || !layers->queue || !layers->end)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the layers of %u particles",
                             (unsigned)layers->particle_count);
    memset(layers->layer_of, 0xff, particles * sizeof *layers->layer_of);
    for (uint32_t i = 0; i < layers->particle_count; ++i)
        layers->layer_of[layers->particles[i]] = IS_UNSEEN;
    return MSPRING_OK;
}

// Begin a search at one particle, behind the components so far.
static void begin_search(mspringi_layers *layers, uint32_t particle, uint32_t as) {
    layers->queue[layers->piece] = particle;
    layers->layer_of[particle] = as;
    layers->head = layers->piece;
    layers->tail = layers->piece + 1;
}

// End a level, and its tier if that is large enough.
static void end_level(mspringi_layers *layers) {
    layers->level_end = layers->tail;
    if (layers->tail - layers->end[layers->count] < LAYER_PARTICLES)
        return;
    layers->count++;
    layers->end[layers->count] = layers->tail;
}

// Queue the neighbours of the queue's first particle that still have the mark `before`.
static void spread(mspringi_layers *layers, const mspringi_graph *graph, uint32_t before, uint32_t as) {
    const uint32_t p = layers->queue[layers->head++];
    for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
        const uint32_t other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], p);
        if (layers->layer_of[other] != before)
            continue;
        layers->layer_of[other] = as;
        layers->queue[layers->tail++] = other;
    }
}

// Find a particle far from this one, and from there the tiers of their component.
static void lay(mspringi_layers *layers, const mspringi_graph *graph, uint32_t particle) {
    begin_search(layers, particle, IS_SEEN);
    while (layers->head < layers->tail)
        spread(layers, graph, IS_UNSEEN, IS_SEEN);
    begin_search(layers, layers->queue[layers->tail - 1], layers->count);
    end_level(layers);
    while (layers->head < layers->tail) {
        spread(layers, graph, IS_SEEN, layers->count);
        if (layers->head == layers->level_end)
            end_level(layers);
    }
    layers->piece = layers->tail;
}

// Sort particles by tier, stably. The begin of each tier becomes its end.
static void sort(mspringi_layers *layers) {
    for (uint32_t i = 0; i < layers->particle_count; ++i)
        layers->queue[layers->end[layers->layer_of[layers->particles[i]]]++] = layers->particles[i];
    memcpy(layers->particles, layers->queue, layers->particle_count * sizeof *layers->particles);
}

mspring_result mspringi_layers_find(mspringi_layers *layers, const mspringi_irregular_list *list,
                                    const mspringi_graph *graph, mspringi_memory *memory,
                                    mspringi_message *message) {
    layers->particle_count = list->count - list->assigned_count;
    layers->particles = list->particles + list->assigned_count;
    if (layers->particle_count < MSPRINGI_FEWEST_LAYERED)
        return MSPRING_OK;
    mspring_result result = reserve(layers, graph->builder->particle_count, memory, message);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < layers->particle_count; ++i)
        if (layers->layer_of[layers->particles[i]] == IS_UNSEEN)
            lay(layers, graph, layers->particles[i]);
    layers->count += layers->end[layers->count] < layers->particle_count;
    if (layers->count < FEWEST_LAYERS)
        layers->count = 0;
    else
        sort(layers);
    mspringi_free(memory, layers->queue);
    layers->queue = NULL;
    return MSPRING_OK;
}

void mspringi_layers_destroy(mspringi_layers *layers, mspringi_memory *memory) {
    mspringi_free(memory, layers->layer_of);
    mspringi_free(memory, layers->queue);
    mspringi_free(memory, layers->end);
}
