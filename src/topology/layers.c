/// Layers: a large web in pieces of which each has springs to the one before and the one behind alone.
///
/// A web that does not fit the cache is read from memory once for each substep, unless several are taken in one
/// pass over its layers, each substep one layer behind the one before (a wave, as over the strips of lattices).
/// Layers are whole levels of a search in breadth, from a particle that is as far away as a first such search could
/// find. A spring or rope from anywhere to anywhere is searched along like any other: there are fewer layers then.
#include <string.h>

#include "analysis.h"

/// Particles in a layer, or more: fewer make more calls, and levels of webs that have so many particles are wider.
#define LAYER_PARTICLES 1024

/// With fewer layers than these a wave is no more than its front.
#define FEWEST_LAYERS 8

/// Instead of a layer's number.
#define IS_UNSEEN (MSPRING_NONE - 1)
#define IS_SEEN (MSPRING_NONE - 2)

mspring_result mspringi_layers_reserve(mspringi_layers *layers, const mspringi_web_list *list,
                                       const mspringi_graph *graph, mspringi_pace *pace, mspringi_memory *memory,
                                       mspringi_message *message) {
    const size_t particles = graph->builder->particle_count;
    layers->particle_count = list->count - list->homed_count;
    layers->particles = list->particles + list->homed_count;
    layers->stage = MSPRINGI_LAYERS_DONE;
    if (layers->particle_count < MSPRINGI_FEWEST_LAYERED)
        return MSPRING_OK;
    layers->layer_of = mspringi_pace_alloc(pace, memory, particles, sizeof *layers->layer_of);
    layers->queue = mspringi_pace_alloc(pace, memory, layers->particle_count, sizeof *layers->queue);
    layers->end =
        mspringi_pace_alloc(pace, memory, layers->particle_count / LAYER_PARTICLES + 2, sizeof *layers->end);
    if (!layers->layer_of || !layers->queue || !layers->end)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the layers of %u particles",
                             (unsigned)layers->particle_count);
    memset(layers->layer_of, 0xff, particles * sizeof *layers->layer_of);
    layers->stage = MSPRINGI_LAYERS_MARKS;
    return MSPRING_OK;
}

static void mark(mspringi_layers *layers) {
    layers->layer_of[layers->particles[layers->sought++]] = IS_UNSEEN;
    if (layers->sought < layers->particle_count)
        return;
    layers->sought = 0;
    layers->stage = MSPRINGI_LAYERS_SEEKS;
}

// Begin a search, with the one particle at the place where the pieces so far end.
static void begin_search(mspringi_layers *layers, uint32_t particle, uint32_t as) {
    layers->queue[layers->piece] = particle;
    layers->layer_of[particle] = as;
    layers->head = layers->piece;
    layers->tail = layers->piece + 1;
}

// A level is complete: with it the layer, if that has enough.
static void end_level(mspringi_layers *layers) {
    layers->level_end = layers->tail;
    if (layers->tail - layers->end[layers->count] < LAYER_PARTICLES)
        return;
    layers->count++;
    layers->end[layers->count] = layers->tail;
}

// Go on to the next particle that no search has come to.
static void seek(mspringi_layers *layers) {
    if (layers->sought == layers->particle_count) {
        layers->count += layers->end[layers->count] < layers->particle_count;
        layers->count = layers->count < FEWEST_LAYERS ? 0 : layers->count;
        layers->sought = 0;
        layers->stage = layers->count > 0 ? MSPRINGI_LAYERS_SORTS : MSPRINGI_LAYERS_DONE;
        return;
    }
    const uint32_t particle = layers->particles[layers->sought++];
    if (layers->layer_of[particle] != IS_UNSEEN)
        return;
    begin_search(layers, particle, IS_SEEN);
    layers->stage = MSPRINGI_LAYERS_SCOUTS;
}

// Queue the neighbours of the queue's first particle that are still what they were before the search.
static void spread(mspringi_layers *layers, const mspringi_graph *graph, uint32_t before, uint32_t as,
                   mspringi_pace *pace) {
    const uint32_t p = layers->queue[layers->head++];
    mspringi_pace_spend(pace, 4 + (uint64_t)4 * (graph->first[p + 1] - graph->first[p]));
    for (uint32_t i = graph->first[p]; i < graph->first[p + 1]; ++i) {
        const uint32_t other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], p);
        if (layers->layer_of[other] != before)
            continue;
        layers->layer_of[other] = as;
        layers->queue[layers->tail++] = other;
    }
}

static void scout(mspringi_layers *layers, const mspringi_graph *graph, mspringi_pace *pace) {
    spread(layers, graph, IS_UNSEEN, IS_SEEN, pace);
    if (layers->head < layers->tail)
        return;
    begin_search(layers, layers->queue[layers->tail - 1], layers->count);
    end_level(layers);
    layers->stage = MSPRINGI_LAYERS_LAYS;
}

static void lay(mspringi_layers *layers, const mspringi_graph *graph, mspringi_pace *pace) {
    spread(layers, graph, IS_SEEN, layers->count, pace);
    if (layers->head == layers->level_end)
        end_level(layers);
    if (layers->head < layers->tail)
        return;
    layers->piece = layers->tail;
    layers->stage = MSPRINGI_LAYERS_SEEKS;
}

// Particles keep their order within a layer. What was each layer's beginning becomes its end.
static void sort(mspringi_layers *layers) {
    const uint32_t particle = layers->particles[layers->sought++];
    layers->queue[layers->end[layers->layer_of[particle]]++] = particle;
    if (layers->sought < layers->particle_count)
        return;
    layers->sought = 0;
    layers->stage = MSPRINGI_LAYERS_COPIES;
}

static void copy(mspringi_layers *layers) {
    layers->particles[layers->sought] = layers->queue[layers->sought];
    if (++layers->sought == layers->particle_count)
        layers->stage = MSPRINGI_LAYERS_DONE;
}

static void go_on(mspringi_layers *layers, const mspringi_graph *graph, mspringi_pace *pace) {
    mspringi_pace_spend(pace, 1);
    switch (layers->stage) {
    case MSPRINGI_LAYERS_MARKS:
        mark(layers);
        break;
    case MSPRINGI_LAYERS_SEEKS:
        seek(layers);
        break;
    case MSPRINGI_LAYERS_SCOUTS:
        scout(layers, graph, pace);
        break;
    case MSPRINGI_LAYERS_LAYS:
        lay(layers, graph, pace);
        break;
    case MSPRINGI_LAYERS_SORTS:
        mspringi_pace_spend(pace, 4);
        sort(layers);
        break;
    default:
        copy(layers);
        break;
    }
}

void mspringi_layers_find(mspringi_layers *layers, const mspringi_graph *graph, mspringi_pace *pace,
                          mspringi_memory *memory) {
    while (layers->stage != MSPRINGI_LAYERS_DONE && pace->left > 0)
        go_on(layers, graph, pace);
    pace->is_halfway = layers->stage != MSPRINGI_LAYERS_DONE;
    if (pace->is_halfway)
        return;
    mspringi_free(memory, layers->queue);
    layers->queue = NULL;
}

void mspringi_layers_destroy(mspringi_layers *layers, mspringi_memory *memory) {
    mspringi_free(memory, layers->layer_of);
    mspringi_free(memory, layers->queue);
    mspringi_free(memory, layers->end);
}
