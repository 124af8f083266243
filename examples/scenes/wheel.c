/// @file wheel.c
/// The wheel: a lattice bent into a ring.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <math.h>
#include <stdio.h>

static const double turn = 6.283185307179586;

static mspring_result add_particles(scene *out, uint32_t columns, uint32_t rows, const scene_options *options) {
    mspring_particle_def def = mspring_particle_def_default();
    def.mass = options->mass;
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < columns * rows; i++) {
        const double radius = options->spacing * (columns / turn + i / columns - 0.5 * rows);
        const double angle = turn * (i % columns) / columns;
        def.x = radius * cos(angle);
        def.y = radius * sin(angle);
        def.flags = i < columns ? MSPRING_PARTICLE_PINNED : 0;
        result = mspring_builder_add_particles(out->builder, &def, 1, NULL);
    }
    return result;
}

static mspring_result add_springs(scene *out, uint32_t columns, uint32_t rows, const scene_options *options) {
    mspring_spring_def def = mspring_spring_def_default();
    def.stiffness = options->stiffness;
    def.damping = options->damping;
    def.flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < columns * rows; i++) {
        const uint32_t next = i / columns * columns + (i + 1) % columns;
        const mspring_id ends[4][2] = {{i, next}, {i, i + columns}, {i, next + columns}, {next, i + columns}};
        const int count = i / columns + 1 < rows ? 4 : 1; // none leads out of the outermost row
        for (int k = 0; result == MSPRING_OK && k < count; k++) {
            def.a = ends[k][0];
            def.b = ends[k][1];
            result = mspring_builder_add_springs(out->builder, &def, 1, NULL);
        }
    }
    return result;
}

bool scene_wheel(uint32_t columns, uint32_t rows, const scene_options *options, scene *out, scene_error *error) {
    if (rows < 1 || columns < 8 || rows > columns / 8)
        return scene_fail(error,
                          "a wheel of %u particles around and %u deep: it needs at least 8 around for each row",
                          columns, rows);
    if ((uint64_t)columns * rows > MSPRING_MAX_PARTICLES)
        return scene_fail(error, "a wheel of %u x %u particles: at most %u are possible; take a smaller wheel",
                          columns, rows, MSPRING_MAX_PARTICLES);
    if (!scene_options_check(options, false, error) || !scene_start(out, error))
        return false;
    mspring_result result = add_particles(out, columns, rows, options);
    if (result == MSPRING_OK)
        result = add_springs(out, columns, rows, options);
    if (result != MSPRING_OK) {
        scene_fail_builder(error, "cannot make the wheel", out->builder, result);
        scene_free(out);
        return false;
    }
    out->probe = columns * (rows - 1);
    snprintf(out->name, sizeof out->name, "wheel_%ux%u", columns, rows);
    return true;
}
