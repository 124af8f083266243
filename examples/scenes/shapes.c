/// @file shapes.c
/// Scenes of one simple shape: the bar and the rope.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

static bool add_bar(scene *out, uint32_t columns, uint32_t rows, const scene_options *options, uint16_t *cells,
                    scene_error *error) {
    enum { FREE, PINNED, KINDS };
    mspring_material materials[KINDS];
    for (int i = 0; i < KINDS; i++) {
        materials[i] = mspring_material_default();
        materials[i].mass = options->mass;
        materials[i].stiffness = options->stiffness;
        materials[i].damping = options->damping;
        materials[i].spring_flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
        materials[i].particle_flags = i == PINNED ? MSPRING_PARTICLE_PINNED : 0;
    }
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++)
            cells[(size_t)row * columns + column] = column == 0 ? PINNED : FREE;

    mspring_lattice_def lattice = mspring_lattice_def_default();
    lattice.width = columns;
    lattice.height = rows;
    lattice.spacing = options->spacing;
    lattice.cells = cells;
    lattice.materials = materials;
    lattice.material_count = KINDS;
    mspring_result result = mspring_builder_add_lattice(out->builder, &lattice, NULL);
    if (result != MSPRING_OK)
        return scene_fail_builder(error, "cannot make the bar", out->builder, result);
    out->probe = columns - 1;
    snprintf(out->name, sizeof out->name, "bar_%ux%u", columns, rows);
    return true;
}

bool scene_bar(uint32_t columns, uint32_t rows, const scene_options *options, scene *out, scene_error *error) {
    if (columns < 2 || rows < 1)
        return scene_fail(error, "a bar of %u x %u particles: it needs at least 2 columns and 1 row", columns,
                          rows);
    if ((uint64_t)columns * rows > MSPRING_MAX_PARTICLES)
        return scene_fail(error, "a bar of %u x %u particles: at most %u are possible; take a smaller bar", columns,
                          rows, MSPRING_MAX_PARTICLES);
    if (!scene_options_check(options, false, error))
        return false;
    uint16_t *cells = malloc((size_t)columns * rows * sizeof *cells);
    if (!cells)
        return scene_fail_memory(error, "cannot make the bar");
    bool ok = scene_start(out, error);
    if (ok && !add_bar(out, columns, rows, options, cells, error)) {
        scene_free(out);
        ok = false;
    }
    free(cells);
    return ok;
}

static bool add_hanging_rope(scene *out, uint32_t particles, const scene_options *options, scene_error *error) {
    mspring_material rope_material = mspring_material_default();
    mspring_rope_def rope = mspring_rope_def_default();
    rope.material = &rope_material;
    mspring_id *ends[2] = {&rope.from, &rope.to};
    for (int i = 0; i < 2; i++) {
        mspring_particle_def end = mspring_particle_def_default();
        end.flags = MSPRING_PARTICLE_PINNED;
        end.mass = options->mass;
        end.x = i * options->spacing * (particles - 1);
        mspring_result result = mspring_builder_add_particles(out->builder, &end, 1, ends[i]);
        if (result != MSPRING_OK)
            return scene_fail_builder(error, "cannot make the rope's ends", out->builder, result);
    }
    rope.segment_count = particles - 1;
    rope_material.mass = options->mass;
    rope_material.stiffness = options->stiffness;
    rope_material.damping = options->damping;
    rope_material.spring_flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
    mspring_result result = mspring_builder_add_rope(out->builder, &rope, NULL, NULL);
    if (result != MSPRING_OK)
        return scene_fail_builder(error, "cannot make the rope", out->builder, result);
    out->probe = particles / 2 + 1; // behind the two ends
    snprintf(out->name, sizeof out->name, "rope_%u", particles);
    return true;
}

bool scene_rope(uint32_t particles, const scene_options *options, scene *out, scene_error *error) {
    if (particles < 3 || particles > MSPRING_MAX_PARTICLES)
        return scene_fail(error, "a rope of %u particles: give 3 to %u", particles, MSPRING_MAX_PARTICLES);
    if (!scene_options_check(options, false, error) || !scene_start(out, error))
        return false;
    if (add_hanging_rope(out, particles, options, error))
        return true;
    scene_free(out);
    return false;
}
