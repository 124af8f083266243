/// @file world.c
/// Networks for problems with known answers.
///
/// SPDX-License-Identifier: MIT
#include "validation/cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/check.h"

bool world_note(world *noted, mspring_result result) {
    if (noted->result == MSPRING_OK)
        noted->result = result;
    return noted->result == MSPRING_OK;
}

world world_begin(void) {
    world made = {.result = MSPRING_OK};
    made.result = mspring_builder_create(NULL, &made.builder);
    return made;
}

void world_make(world *made, double gravity_x, double gravity_y, uint32_t substeps) {
    mspring_network_def def = mspring_network_def_default();
    if (made->result != MSPRING_OK)
        return;
    def.settings.gravity_x = (float)gravity_x;
    def.settings.gravity_y = (float)gravity_y;
    def.settings.substeps = substeps;
    def.settings.max_speed = 1e9f;
    world_note(made, mspring_network_create(made->builder, &def, &made->network));
}

double world_end(world *ended, double value) {
    const char *message =
        ended->network ? mspring_network_error(ended->network) : mspring_builder_error(ended->builder);
    const bool good = check(ended->result, "solve the problem", message);
    mspring_network_destroy(ended->network);
    mspring_builder_destroy(ended->builder);
    return good ? value : (double)NAN;
}

void world_add_plate(world *to, const plate *added) {
    uint16_t *cells = calloc((size_t)added->columns * added->rows, sizeof *cells);
    mspring_material materials[2] = {mspring_material_default(), mspring_material_default()};
    mspring_lattice_def def = mspring_lattice_def_default();
    if (!world_note(to, cells ? MSPRING_OK : MSPRING_ERROR_MEMORY))
        return;
    for (uint32_t row = 0; row < added->rows; row++)
        for (uint32_t column = 0; column < added->columns; column++)
            cells[row * added->columns + column] =
                (added->pinned_column && column == 0) || (added->pinned_row && row == added->rows - 1);
    for (int i = 0; i < 2; i++) {
        materials[i].mass = (float)added->mass;
        materials[i].stiffness = (float)added->stiffness;
        materials[i].particle_flags = i == 1 ? MSPRING_PARTICLE_PINNED : 0;
    }
    def.width = added->columns;
    def.height = added->rows;
    def.x = added->x;
    def.y = added->y;
    def.spacing = added->spacing;
    def.cells = cells;
    def.materials = materials;
    def.material_count = 2;
    def.shear_share = 0.5f;
    mspring_builder_add_lattice(to->builder, &def, NULL);
    free(cells);
}

void turn_counter_add(turn_counter *to, double time, double dt, double value) {
    if (to->before < 0 && value >= 0) {
        const double passed = time - dt * value / (value - to->before);
        if (to->passages++ == 0)
            to->first = passed;
        to->last = passed;
    }
    to->before = value;
}

double turn_counter_period(const turn_counter *counted) {
    return counted->passages < 2 ? (double)NAN : (counted->last - counted->first) / (counted->passages - 1);
}
