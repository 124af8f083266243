/// @file noise.c
/// The scene of a noisy image: a lattice of which most cells, chosen at random, are filled.
///
/// SPDX-License-Identifier: MIT
#include "catalogue.h"

#include <stdio.h>
#include <stdlib.h>

/// Of ten cells.
#define FILLED 6u

/// Steps of a generator of 64 bits (Knuth's MMIX), whose high bits are used.
static uint32_t next_random(uint64_t *state) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 33);
}

static mspring_result add_noise(mspring_builder *builder, uint32_t columns, uint32_t rows, uint16_t *cells,
                                const scene_options *options) {
    uint64_t state = 1;
    for (size_t i = 0; i < (size_t)columns * rows; i++) {
        cells[i] = next_random(&state) % 10 < FILLED ? 0 : MSPRING_CELL_EMPTY;
    }
    mspring_material material;
    mspring_lattice_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material);
    if (result == MSPRING_OK) {
        result = mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def);
    }
    if (result != MSPRING_OK) {
        return result;
    }
    material.mass = options->mass;
    material.stiffness = options->stiffness;
    material.damping = options->damping;
    material.spring_flags = MSPRING_SPRING_RELATIVE;
    def.width = columns;
    def.height = rows;
    def.spacing = options->spacing;
    def.cells = cells;
    def.materials = &material;
    return mspring_builder_add_lattice(builder, &def, NULL);
}

bool bench_scene_noise(uint32_t columns, uint32_t rows, const scene_options *options, scene *out,
                       scene_error *error) {
    scene made = {.probe = MSPRING_NONE};
    uint16_t *cells =
        rows > 0 && columns <= MSPRING_MAX_PARTICLES / rows ? malloc((size_t)columns * rows * sizeof *cells) : NULL;
    mspring_result result = cells ? mspring_builder_create(NULL, &made.builder) : MSPRING_ERROR_LIMIT;
    if (result == MSPRING_OK) {
        result = add_noise(made.builder, columns, rows, cells, options);
    }
    free(cells);
    if (result != MSPRING_OK) {
        snprintf(error->text, sizeof error->text, "cannot make a noisy lattice of %ux%u: %s", columns, rows,
                 made.builder ? mspring_builder_error(made.builder) : mspring_result_string(result));
        scene_free(&made);
        return false;
    }
    *out = made;
    return true;
}
