/// @file nearby.c
/// The naive network in the order of places, so that particles near each other are near each other in memory.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "network.h"

/// Where a particle is.
typedef struct place {
    uint32_t band; ///< of the height that has one particle, on the average, in a square
    float x;
    uint32_t particle;
} place;

static int compare_places(const void *left, const void *right) {
    const place *a = left;
    const place *b = right;
    if (a->band != b->band) {
        return a->band < b->band ? -1 : 1;
    }
    if (a->x != b->x) {
        return a->x < b->x ? -1 : 1;
    }
    return (a->particle > b->particle) - (a->particle < b->particle);
}

static uint32_t lower_end(const naive_spring *spring) {
    return spring->a < spring->b ? spring->a : spring->b;
}

static int compare_springs(const void *left, const void *right) {
    const naive_spring *a = left;
    const naive_spring *b = right;
    if (lower_end(a) != lower_end(b)) {
        return lower_end(a) < lower_end(b) ? -1 : 1;
    }
    return (a->a + a->b > b->a + b->b) - (a->a + a->b < b->a + b->b);
}

static void sort_places(const naive_particle *particles, uint32_t count, place *places) {
    float min_x = particles[0].x;
    float max_x = min_x;
    float min_y = particles[0].y;
    float max_y = min_y;
    for (uint32_t i = 0; i < count; i++) {
        min_x = fminf(min_x, particles[i].x);
        max_x = fmaxf(max_x, particles[i].x);
        min_y = fminf(min_y, particles[i].y);
        max_y = fmaxf(max_y, particles[i].y);
    }
    /* That of a network without width would be 0; and there are at most a million bands. */
    const float least = fmaxf((max_y - min_y) * 1e-6f, 1e-6f);
    const float height = fmaxf(sqrtf((max_x - min_x) * (max_y - min_y) / (float)count), least);
    for (uint32_t i = 0; i < count; i++) {
        places[i] = (place){(uint32_t)((particles[i].y - min_y) / height), particles[i].x, i};
    }
    qsort(places, count, sizeof *places, compare_places);
}

bool bench_baseline_sort(bench_baseline *baseline, scene_error *error) {
    naive_network *network = &baseline->network;
    const uint32_t count = network->particle_count;
    place *places = bench_allocate(count, sizeof *places, error);
    uint32_t *place_of = places != NULL ? bench_allocate(count, sizeof *place_of, error) : NULL;
    if (place_of == NULL) {
        free(places);
        return false;
    }
    sort_places(baseline->start, count, places);
    for (uint32_t i = 0; i < count; i++) {
        place_of[places[i].particle] = i;
        network->particles[i] = baseline->start[places[i].particle];
    }
    memcpy(baseline->start, network->particles, count * sizeof *baseline->start);
    for (uint32_t i = 0; i < network->spring_count; i++) {
        naive_spring *spring = &network->springs[i];
        spring->a = place_of[spring->a];
        spring->b = place_of[spring->b];
    }
    qsort(network->springs, network->spring_count, sizeof *network->springs, compare_springs);
    free(places);
    baseline->place_of = place_of;
    return true;
}
