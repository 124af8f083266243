/// @file baseline.c
/// The naive network: filled from one of the library by way of the public interface, and timed as it is.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "network.h"

static bool fill_particles(const bench_network *from, bench_baseline *baseline, scene_error *error) {
    mspring_view view;
    view.struct_size = sizeof view;
    mspring_result result = mspring_network_get_view(from->network, &view);
    uint32_t count = from->particle_count;
    float *mass = bench_allocate(count, sizeof *mass, error);
    if (mass == NULL) {
        return false;
    }
    if (result == MSPRING_OK) {
        result = mspring_network_get(from->network, MSPRING_MASS, NULL, 0, count, mass, 1);
    }
    if (result == MSPRING_OK) {
        baseline->origin_x = view.origin_x;
        baseline->origin_y = view.origin_y;
        for (uint32_t i = 0; i < count; i++) {
            bool pinned = !(view.inverse_mass[view.slot_of_particle[i]] > 0.0f);
            baseline->start[i] = (naive_particle){
                .x = (float)(from->start_x[i] - view.origin_x),
                .y = (float)(from->start_y[i] - view.origin_y),
                .vx = from->start_vx[i],
                .vy = from->start_vy[i],
                .mass = mass[i],
                .inverse_mass = pinned ? 0.0f : 1.0f / mass[i],
            };
        }
    } else {
        bench_library_error(error, "reading particles", result, "");
    }
    free(mass);
    return result == MSPRING_OK;
}

static bool fill_springs(const bench_network *from, bench_baseline *baseline, scene_error *error) {
    mspring_id a, b;
    float stiffness, damping, rest_length;
    const mspring_column columns[] = {{MSPRING_END_A, 1, &a},
                                      {MSPRING_END_B, 1, &b},
                                      {MSPRING_ACTIVE_STIFFNESS, 1, &stiffness},
                                      {MSPRING_ACTIVE_DAMPING, 1, &damping},
                                      {MSPRING_ACTIVE_REST_LENGTH, 1, &rest_length}};
    for (uint32_t i = 0; i < from->spring_count; i++) {
        mspring_result result = mspring_network_get_columns(from->network, NULL, i, 1, columns, 5);
        if (result != MSPRING_OK) {
            bench_library_error(error, "reading springs", result, "");
            return false;
        }
        baseline->network.springs[i] = (naive_spring){
            .a = a,
            .b = b,
            .stiffness = stiffness,
            .damping = damping,
            .rest_length = rest_length,
        };
    }
    return true;
}

static bool reset(void *self, scene_error *error) {
    (void)error;
    bench_baseline *baseline = self;
    memcpy(baseline->network.particles, baseline->start,
           baseline->network.particle_count * sizeof *baseline->start);
    return true;
}

static bool run(void *self, uint32_t steps, scene_error *error) {
    (void)error;
    bench_baseline *baseline = self;
    for (uint32_t i = 0; i < steps; i++) {
        naive_step(&baseline->network, BENCH_DT, baseline->substeps);
    }
    return true;
}

bool bench_baseline_create(bench_network *from, bench_baseline *out, scene_error *error) {
    /* A relative spring has its stiffness only after a step; the origin is that of the reset state. */
    bench_runner runner = bench_network_runner(from);
    if (!runner.run(from, 1, error) || !runner.reset(from, error)) {
        return false;
    }
    mspring_network_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    if (result != MSPRING_OK) {
        bench_library_error(error, "asking for gravity", result, "");
        return false;
    }
    bench_baseline baseline = {
        .network = {.particle_count = from->particle_count,
                    .spring_count = from->spring_count,
                    .gravity_x = def.settings.gravity_x,
                    .gravity_y = def.settings.gravity_y,
                    .global_damping = BENCH_GLOBAL_DAMPING,
                    .lag = (float)(BENCH_DT / from->substeps)}, /* as that of the network, which took a step */
        .substeps = from->substeps,
    };
    naive_network *network = &baseline.network;
    bool ok =
        (network->particles = bench_allocate(from->particle_count, sizeof *network->particles, error)) != NULL &&
        (network->springs = bench_allocate(from->spring_count, sizeof *network->springs, error)) != NULL &&
        (baseline.start = bench_allocate(from->particle_count, sizeof *baseline.start, error)) != NULL &&
        fill_particles(from, &baseline, error) && fill_springs(from, &baseline, error) && reset(&baseline, error);
    if (!ok) {
        bench_baseline_free(&baseline);
        return false;
    }
    *out = baseline;
    return true;
}

void bench_baseline_free(bench_baseline *baseline) {
    free(baseline->network.particles);
    free(baseline->network.springs);
    free(baseline->start);
    free(baseline->place_of);
    memset(baseline, 0, sizeof *baseline);
}

bench_runner bench_baseline_runner(bench_baseline *baseline) {
    return (bench_runner){.self = baseline, .reset = reset, .run = run};
}

bool bench_baseline_check(const bench_baseline *baseline, scene_error *error) {
    const naive_network *network = &baseline->network;
    for (uint32_t i = 0; i < network->particle_count; i++) {
        const naive_particle *p = &network->particles[i];
        if (!isfinite(p->x) || !isfinite(p->y) || !isfinite(p->vx) || !isfinite(p->vy)) {
            snprintf(error->text, sizeof error->text,
                     "the naive state of particle %u is not finite after the run: use more --substeps or less "
                     "--stiffness",
                     i);
            return false;
        }
    }
    return true;
}
