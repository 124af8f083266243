/// @file added.c
/// Networks that springs and loose particles are added to while they run.
///
/// SPDX-License-Identifier: MIT
#include "added.h"
#include "machine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// How far from its first particle a spring's second one is, m, and how firm it is: as the other springs are.
#define REACH 2.0
#define STIFFNESS 0.02f
#define DAMPING 0.03f

bool bench_added_create(mspring_builder *builder, mspring_simd level, uint32_t workers, uint32_t substeps,
                        uint32_t spare_particles, uint32_t spare_springs, bench_network *out, scene_error *error) {
    if (!bench_network_create(builder, level, workers, substeps, out, error)) {
        return false;
    }
    mspring_network_def def;
    mspring_network_destroy(out->network);
    out->network = NULL;
    mspring_result result = mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    def.simd_level = level;
    def.worker_count = workers;
    def.settings.substeps = substeps;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    def.settings.global_damping = BENCH_GLOBAL_DAMPING;
    def.spare_particles = spare_particles;
    def.spare_springs = spare_springs;
    if (result == MSPRING_OK) {
        result = mspring_network_create(builder, &def, &out->network);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "making room", result, mspring_builder_error(builder));
        bench_network_free(out);
    }
    return result == MSPRING_OK;
}

bool bench_added_loose(bench_network *network, uint32_t count, double height, double *seconds, scene_error *error) {
    mspring_particle_def *particles = bench_allocate(count, sizeof *particles, error);
    mspring_id *ids = bench_allocate(count, sizeof *ids, error);
    bool ok = particles != NULL && ids != NULL;
    for (uint32_t i = 0; ok && i < count; i++) {
        ok = mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]) == MSPRING_OK;
        particles[i].x = 0.02 * i;
        particles[i].y = height;
    }
    if (ok) {
        const double start = bench_thread_seconds();
        const mspring_result result = mspring_network_add_particles(network->network, particles, count, ids);
        *seconds = bench_thread_seconds() - start;
        ok = result == MSPRING_OK;
        if (!ok) {
            bench_library_error(error, "adding particles", result, mspring_network_error(network->network));
        }
    }
    free(particles);
    free(ids);
    return ok;
}

/// A particle and where it is.
typedef struct place {
    double x, y;
    mspring_id particle;
} place;

static int compare(const void *a, const void *b) {
    const place *one = a, *other = b;
    if (one->y != other->y) {
        return one->y < other->y ? -1 : 1;
    }
    return (one->x > other->x) - (one->x < other->x);
}

/// The place in a row that lies so far to the right of another, or the end of the row.
static uint32_t find(const place *places, uint32_t count, uint32_t from) {
    uint32_t to = from + 1;
    while (to < count && places[to].y == places[from].y && places[to].x < places[from].x + REACH) {
        to++;
    }
    return to < count && places[to].y == places[from].y && places[to].x == places[from].x + REACH ? to : from;
}

bool bench_added_list(const bench_network *network, uint32_t count, mspring_spring_def *springs,
                      scene_error *error) {
    const uint32_t particles = network->particle_count;
    place *places = bench_allocate(particles, sizeof *places, error);
    if (places == NULL) {
        return false;
    }
    for (mspring_id p = 0; p < particles; p++) {
        places[p] = (place){network->start_x[p], network->start_y[p], p};
    }
    qsort(places, particles, sizeof *places, compare);
    uint32_t found = 0, from = 0;
    for (uint32_t i = 0; i < count && from < particles; i++, from++) {
        const uint32_t even = (uint32_t)((uint64_t)i * particles / count);
        from = from > even ? from : even;
        while (from < particles && find(places, particles, from) == from) {
            from++;
        }
        if (from == particles ||
            mspring_init(MSPRING_STRUCT_SPRING_DEF, &springs[i], sizeof springs[i]) != MSPRING_OK) {
            break;
        }
        springs[i].a = places[from].particle;
        springs[i].b = places[find(places, particles, from)].particle;
        springs[i].flags = MSPRING_SPRING_RELATIVE;
        springs[i].stiffness = STIFFNESS;
        springs[i].damping = DAMPING;
        found++;
    }
    if (found < count) {
        snprintf(error->text, sizeof error->text, "there is no place for %u springs more", count);
    }
    free(places);
    return found == count;
}
