/// Order of the irregular particles.
#include <math.h>
#include <string.h>

#include "layout/analysis.h"

/// Window in which nodes are sorted by degree: wide enough for slices of similar degree, narrow enough to keep
/// neighbours together. The wider one, for tiers, fills 0.97 instead of 0.94 of the slice columns of a random graph
/// of degree 8.
#define WINDOW 256
#define TIERED_WINDOW 512
#define MAX_WINDOW (TIERED_WINDOW / 2 * 3)

/// Larger degrees sort as this one.
#define MAX_DEGREE 0xffffu

/* --------------------------------------------------------------------------------------------------- ordering */

static uint32_t degree_of(const mspringi_graph *graph, uint32_t particle) {
    return graph->first[particle + 1] - graph->first[particle];
}

// Spread the lower 16 bits over the even bits of 32.
static uint32_t spread_bits(uint32_t n) {
    n = (n | n << 8) & 0x00ff00ffu;
    n = (n | n << 4) & 0x0f0f0f0fu;
    n = (n | n << 2) & 0x33333333u;
    return (n | n << 1) & 0x55555555u;
}

// Map a coordinate from [low, high] to 16 bits.
static uint32_t quantise(double value, double low, double high) {
    return high > low ? (uint32_t)((value - low) / (high - low) * 65535.0) : 0;
}

static void order_window_by_degree(uint32_t *particles, uint32_t count, const mspringi_graph *graph) {
    uint64_t keys[MAX_WINDOW], scratch[MAX_WINDOW];
    uint32_t before[MAX_WINDOW];
    for (uint32_t i = 0; i < count; ++i) {
        before[i] = particles[i];
        const uint32_t degree = degree_of(graph, particles[i]);
        const uint32_t missing = degree < MAX_DEGREE ? MAX_DEGREE - degree : 0;
        keys[i] = (uint64_t)missing << 32 | i;
    }
    mspringi_sort_keys(keys, scratch, count);
    for (uint32_t i = 0; i < count; ++i)
        particles[i] = before[(uint32_t)keys[i]];
}

// Size of the window that starts at a particle without an assigned strip. Windows of a tier are about equal, in
// whole slices.
static uint32_t window_from(const uint32_t *particles, uint32_t at, uint32_t end, const mspringi_tiers *tiers) {
    if (tiers->count == 0)
        return end - at < WINDOW ? end - at : WINDOW;
    const uint32_t left = tiers->end[tiers->tier_of[particles[at]]] - at;
    const uint32_t windows = (left + TIERED_WINDOW / 2) / TIERED_WINDOW;
    return windows > 1 ? left / windows / MSPRINGI_WIDTH * MSPRINGI_WIDTH : left;
}

/* ------------------------------------------------------------------------------------------------------ passes */

static bool is_listed(const mspringi_graph *graph, const uint8_t *kinds, uint32_t p) {
    return kinds[p] == MSPRINGI_ROW_LOOSE && degree_of(graph, p) > 0;
}

void mspringi_irregular_list_count(mspringi_irregular_list *list, const mspringi_graph *graph,
                                   const mspringi_strip_assignment *assignment, const uint8_t *kinds) {
    for (uint32_t p = 0; p < graph->builder->particle_count; ++p) {
        if (!is_listed(graph, kinds, p))
            continue;
        list->count++;
        list->assigned_count += assignment->assigned_strip[p] != MSPRING_NONE;
    }
}

mspring_result mspringi_irregular_list_reserve(mspringi_irregular_list *list, const mspringi_bundles *bundles,
                                               mspringi_memory *memory, mspringi_message *message) {
    list->particles = mspringi_alloc(memory, list->count + (size_t)bundles->slice_count * MSPRINGI_WIDTH,
                                     sizeof *list->particles);
    list->keys = mspringi_alloc(memory, list->count, sizeof *list->keys);
    list->scratch = mspringi_alloc(memory, list->count, sizeof *list->scratch);
    list->min_x = list->min_y = INFINITY;
    list->max_x = list->max_y = -INFINITY;
    return list->particles && list->keys && list->scratch
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u irregular particles", list->count);
}

// List particles with an assigned strip, then those without. Find the bounding box of the latter.
void mspringi_irregular_list_fill(mspringi_irregular_list *list, const mspringi_graph *graph,
                                  const mspringi_strip_assignment *assignment, uint8_t *kinds) {
    const mspringi_particle *all = graph->builder->particles;
    uint32_t assigned = 0, others = list->assigned_count;
    for (uint32_t p = 0; p < graph->builder->particle_count; ++p) {
        if (!is_listed(graph, kinds, p))
            continue;
        kinds[p] = MSPRINGI_ROW_IRREGULAR;
        if (assignment->assigned_strip[p] != MSPRING_NONE) {
            list->particles[assigned++] = p;
            continue;
        }
        list->particles[others++] = p;
        list->min_x = all[p].x < list->min_x ? all[p].x : list->min_x;
        list->max_x = all[p].x > list->max_x ? all[p].x : list->max_x;
        list->min_y = all[p].y < list->min_y ? all[p].y : list->min_y;
        list->max_y = all[p].y > list->max_y ? all[p].y : list->max_y;
    }
}

// Particles of an archive lie at the negative of the order that they had (archive/archive_write.c).
static uint32_t key_of(const mspringi_irregular_list *list, const mspring_builder *builder, uint32_t p) {
    const mspringi_particle *particle = &builder->particles[p];
    const double place = -particle->x;
    if (builder->archive)
        return place > 0.0 && place < 0x1p32 ? (uint32_t)place : 0; // a forged one may lie anywhere
    return spread_bits(quantise(particle->x, list->min_x, list->max_x)) |
           spread_bits(quantise(particle->y, list->min_y, list->max_y)) << 1;
}

// Sort by assigned strip; the others by the Z-order curve (Morton 1966).
void mspringi_irregular_list_sort(mspringi_irregular_list *list, const mspringi_graph *graph,
                                  const mspringi_strip_assignment *assignment) {
    for (uint32_t i = 0; i < list->count; ++i) {
        const uint32_t p = list->particles[i];
        const uint32_t key =
            i < list->assigned_count ? assignment->assigned_strip[p] : key_of(list, graph->builder, p);
        list->keys[i] = (uint64_t)key << 32 | p;
    }
    mspringi_sort_keys(list->keys, list->scratch, list->assigned_count);
    mspringi_sort_keys(list->keys + list->assigned_count, list->scratch, list->count - list->assigned_count);
    for (uint32_t i = 0; i < list->count; ++i)
        list->particles[i] = (uint32_t)list->keys[i];
}

void mspringi_irregular_list_order_windows(mspringi_irregular_list *list, const mspringi_tiers *tiers,
                                           const mspringi_graph *graph, mspringi_memory *memory) {
    const uint32_t unassigned_count = list->count - list->assigned_count;
    uint32_t *unassigned = list->particles + list->assigned_count;
    for (uint32_t at = 0, count; at < unassigned_count; at += count) {
        count = window_from(unassigned, at, unassigned_count, tiers);
        order_window_by_degree(unassigned + at, count, graph);
    }
    mspringi_free(memory, list->keys);
    mspringi_free(memory, list->scratch);
    list->keys = list->scratch = NULL;
}

void mspringi_irregular_list_append_bundles(mspringi_irregular_list *list, const mspringi_bundles *bundles) {
    const uint32_t count = bundles->slice_count * MSPRINGI_WIDTH;
    list->first_in_bundles = list->count;
    if (count > 0)
        memcpy(list->particles + list->count, bundles->particles, count * sizeof *list->particles);
    list->count += count;
}

void mspringi_irregular_list_destroy(mspringi_irregular_list *list, mspringi_memory *memory) {
    mspringi_free(memory, list->particles);
    mspringi_free(memory, list->keys);
    mspringi_free(memory, list->scratch);
}
