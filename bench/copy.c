/// @file copy.c
/// A builder made of a network, by way of the public interface.
///
/// SPDX-License-Identifier: MIT
#include "copy.h"

#include <stdlib.h>

#include <massspring/massspring.h>

static mspring_result add_particles(const bench_network *from, mspring_builder *builder, mspring_particle_def *defs,
                                    float *mass) {
    mspring_view view = mspring_view_default();
    mspring_result result = mspring_network_get_view(from->network, &view);
    if (result == MSPRING_OK) {
        result = mspring_network_get(from->network, MSPRING_MASS, NULL, 0, from->particle_count, mass, 1);
    }
    for (uint32_t i = 0; result == MSPRING_OK && i < from->particle_count; i++) {
        defs[i] = mspring_particle_def_default();
        defs[i].x = from->start_x[i];
        defs[i].y = from->start_y[i];
        defs[i].mass = mass[i];
        defs[i].flags = view.inverse_mass[view.slot_of_particle[i]] > 0.0f ? 0 : MSPRING_PARTICLE_PINNED;
    }
    return result != MSPRING_OK ? result : mspring_builder_add_particles(builder, defs, from->particle_count, NULL);
}

static mspring_result add_springs(const bench_network *from, mspring_builder *builder, mspring_spring_def *defs) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < from->spring_count; i++) {
        defs[i] = mspring_spring_def_default();
        const mspring_column columns[] = {{MSPRING_END_A, 1, &defs[i].a},
                                          {MSPRING_END_B, 1, &defs[i].b},
                                          {MSPRING_ACTIVE_STIFFNESS, 1, &defs[i].stiffness},
                                          {MSPRING_ACTIVE_DAMPING, 1, &defs[i].damping},
                                          {MSPRING_ACTIVE_REST_LENGTH, 1, &defs[i].rest_length}};
        result = mspring_network_get_columns(from->network, NULL, i, 1, columns, 5);
    }
    return result != MSPRING_OK ? result : mspring_builder_add_springs(builder, defs, from->spring_count, NULL);
}

bool bench_copy_absolute(const bench_network *from, mspring_builder **out, scene_error *error) {
    mspring_builder *builder = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    if (result != MSPRING_OK) {
        bench_library_error(error, "creating a builder", result, "");
        return false;
    }
    float *mass = bench_allocate(from->particle_count, sizeof *mass, error);
    mspring_particle_def *particles = bench_allocate(from->particle_count, sizeof *particles, error);
    mspring_spring_def *springs = bench_allocate(from->spring_count, sizeof *springs, error);
    bool ok = mass != NULL && particles != NULL && springs != NULL;
    if (ok) {
        result = add_particles(from, builder, particles, mass);
        if (result == MSPRING_OK) {
            result = add_springs(from, builder, springs);
        }
        if (result != MSPRING_OK) {
            bench_library_error(error, "copying the network", result, mspring_builder_error(builder));
            ok = false;
        }
    }
    free(mass);
    free(particles);
    free(springs);
    if (!ok) {
        mspring_builder_destroy(builder);
        return false;
    }
    *out = builder;
    return true;
}
