/// The order of the web's particles.
#include <math.h>

#include "analysis.h"

/// Nodes are sorted by degree within windows of this many: wide enough that groups hold nodes of like degree,
/// narrow enough that a window's nodes stay near each other.
#define WINDOW 256

/* --------------------------------------------------------------------------------------------------- ordering */

static uint32_t degree_of(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

// Spread the lower 16 bits of a number over the even bits of 32.
static uint32_t spread_bits(uint32_t n) {
    n = (n | n << 8) & 0x00ff00ffu;
    n = (n | n << 4) & 0x0f0f0f0fu;
    n = (n | n << 2) & 0x33333333u;
    return (n | n << 1) & 0x55555555u;
}

// Where in [low, high] a coordinate is, in 65536 steps.
static uint32_t quantise(double value, double low, double high) {
    return high > low ? (uint32_t)((value - low) / (high - low) * 65535.0) : 0;
}

// Sort by place on the Z-order curve (Morton 1966).
static void order_by_place(uint32_t *particles, uint32_t count, const mspring_builder *builder, uint64_t *keys,
                           uint64_t *scratch) {
    const mspringi_particle *all = builder->particles;
    double min_x = INFINITY, max_x = -INFINITY, min_y = INFINITY, max_y = -INFINITY;
    for (uint32_t i = 0; i < count; ++i) {
        const double x = all[particles[i]].x, y = all[particles[i]].y;
        min_x = x < min_x ? x : min_x;
        max_x = x > max_x ? x : max_x;
        min_y = y < min_y ? y : min_y;
        max_y = y > max_y ? y : max_y;
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t x = quantise(all[particles[i]].x, min_x, max_x);
        const uint32_t y = quantise(all[particles[i]].y, min_y, max_y);
        keys[i] = (uint64_t)(spread_bits(x) | spread_bits(y) << 1) << 32 | particles[i];
    }
    mspringi_sort_keys(keys, scratch, count);
    for (uint32_t i = 0; i < count; ++i)
        particles[i] = (uint32_t)keys[i];
}

static void order_by_home(uint32_t *particles, uint32_t count, const mspringi_homes *homes, uint64_t *keys,
                          uint64_t *scratch) {
    for (uint32_t i = 0; i < count; ++i)
        keys[i] = (uint64_t)homes->home[particles[i]] << 32 | particles[i];
    mspringi_sort_keys(keys, scratch, count);
    for (uint32_t i = 0; i < count; ++i)
        particles[i] = (uint32_t)keys[i];
}

static void order_window_by_degree(uint32_t *particles, uint32_t count, const mspringi_graph *graph) {
    uint64_t keys[WINDOW], scratch[WINDOW];
    uint32_t before[WINDOW];
    for (uint32_t i = 0; i < count; ++i) {
        before[i] = particles[i];
        keys[i] = (uint64_t)(UINT32_MAX - degree_of(graph, particles[i])) << 32 | i;
    }
    mspringi_sort_keys(keys, scratch, count);
    for (uint32_t i = 0; i < count; ++i)
        particles[i] = before[(uint32_t)keys[i]];
}

// List the particles with or without home, behind those that are in the list.
static void append(mspringi_web_list *list, const mspringi_graph *graph, const mspringi_homes *homes,
                   uint8_t *kinds, bool with_home) {
    for (uint32_t p = 0; p < graph->builder->particle_count; ++p) {
        if (kinds[p] != MSPRINGI_ROW_LOOSE || degree_of(graph, p) == 0 ||
            (homes->home[p] != MSPRING_NONE) != with_home)
            continue;
        kinds[p] = MSPRINGI_ROW_WEB;
        list->particles[list->count++] = p;
    }
}

mspring_result mspringi_web_list_find(mspringi_web_list *list, const mspringi_graph *graph,
                                      const mspringi_homes *homes, uint8_t *kinds, mspringi_memory *memory,
                                      mspringi_message *message) {
    const uint32_t particles = (uint32_t)graph->builder->particle_count;
    uint32_t count = 0;
    for (uint32_t p = 0; p < particles; ++p)
        count += kinds[p] == MSPRINGI_ROW_LOOSE && degree_of(graph, p) > 0;
    list->particles = mspringi_alloc(memory, count, sizeof *list->particles);
    uint64_t *keys = mspringi_alloc(memory, count, sizeof *keys);
    uint64_t *scratch = mspringi_alloc(memory, count, sizeof *scratch);
    mspring_result result = MSPRING_OK;
    if (!list->particles || !keys || !scratch) {
        result = mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a web of %u particles", count);
    } else {
        append(list, graph, homes, kinds, true);
        list->homed_count = list->count;
        append(list, graph, homes, kinds, false);
        order_by_home(list->particles, list->homed_count, homes, keys, scratch);
        uint32_t *free_ones = list->particles + list->homed_count;
        const uint32_t free_count = count - list->homed_count;
        order_by_place(free_ones, free_count, graph->builder, keys, scratch);
        for (uint32_t i = 0; i < free_count; i += WINDOW)
            order_window_by_degree(free_ones + i, free_count - i < WINDOW ? free_count - i : WINDOW, graph);
    }
    mspringi_free(memory, keys);
    mspringi_free(memory, scratch);
    return result;
}

void mspringi_web_list_destroy(mspringi_web_list *list, mspringi_memory *memory) {
    mspringi_free(memory, list->particles);
}
