/// @file ready_car.c
/// A car that is driven into a wall: the scene in which things bend.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "lab/ready.h"
#include "scenes/internal.h"

#include <massspring/massspring.h>

enum { WIDTH = 44, HEIGHT = 14, SUBSTEPS = 40 };

// Bonnet, cabin and boot, top row first; the columns of each row that are metal.
static const int rows[HEIGHT][2] = {{14, 26}, {13, 28}, {12, 29}, {11, 30}, {10, 31}, {1, 42}, {0, 43},
                                    {0, 43},  {0, 43},  {0, 43},  {0, 43},  {0, 43},  {1, 42}, {2, 41}};
static const double spacing = 0.1, gap = 0.6; // m
static const float speed = 7;                 // m/s

static mspring_result add_car(mspring_builder *builder, bool relative) {
    uint16_t cells[HEIGHT][WIDTH];
    mspring_material metal = mspring_material_default();
    mspring_lattice_def car = mspring_lattice_def_default();
    const float substep = 1.0f / 64 / SUBSTEPS; // s
    const mspring_result result = mspring_material_preset(&metal, MSPRING_PRESET_RUBBER, spacing, substep);
    if (result != MSPRING_OK)
        return result;
    metal.yield_strain = 0.03f;
    metal.hardening = 0.3f;
    metal.plastic_limit = 0.6f;
    if (!relative) { // in N/m: dents are the same with any number of substeps
        metal.stiffness *= 0.5f * metal.mass / (substep * substep);
        metal.spring_flags &= ~(uint32_t)MSPRING_SPRING_RELATIVE;
    }
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++)
            cells[row][column] =
                column >= rows[row][0] && column <= rows[row][1] ? 0 : (uint16_t)MSPRING_CELL_EMPTY;
    car.width = WIDTH, car.height = HEIGHT, car.cells = cells[0], car.materials = &metal;
    car.spacing = spacing;
    return mspring_builder_add_lattice(builder, &car, NULL);
}

bool ready_car(lab_stage *made, bool relative, scene_error *error) {
    if (!scene_start(&made->made, error))
        return false;
    mspring_builder *builder = made->made.builder;
    const mspring_result result = add_car(builder, relative);
    if (result != MSPRING_OK) {
        scene_fail_builder(error, "car", builder, result);
        scene_free(&made->made);
        return false;
    }
    snprintf(made->made.name, sizeof made->made.name, "car");
    const uint32_t count = mspring_builder_count(builder, MSPRING_PARTICLES);
    made->made.velocity = calloc(2 * (size_t)count, sizeof *made->made.velocity);
    if (!made->made.velocity) {
        scene_free(&made->made);
        return scene_fail_memory(error, "cannot drive the car");
    }
    for (uint32_t i = 0; i < count; i++)
        made->made.velocity[2 * i] = speed;
    made->substeps = SUBSTEPS;
    made->has_wall = true;
    made->wall_x = (WIDTH - 1) * spacing + gap;
    return true;
}
