/// @file 09_jelly.c
/// A block of jelly falls onto a table and wobbles: a material that the library knows, and a floor.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring.h>

enum { COLUMNS = 9, ROWS = 8, SUBSTEPS = 24, STEPS = 66 };
static const double dt = 0.01, spacing = 0.03; // s, m

int main(int count, char **arguments) {
    mspring_material jelly = mspring_material_default();
    mspring_material_preset(&jelly, MSPRING_PRESET_JELLY, spacing, dt / SUBSTEPS);
    mspring_lattice_def block = mspring_lattice_def_default();
    block.width = COLUMNS, block.height = ROWS;
    block.materials = &jelly;
    block.spacing = spacing, block.y = 0.04;      // m above the table
    const float heights[] = {0, 0, 0.012f, 0, 0}; // m: a bump
    mspring_floor_def table = mspring_floor_def_default();
    table.heights = heights, table.height_count = 5, table.spacing = 0.07, table.heights_x = -0.07;
    table.friction = 0.5f;
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = SUBSTEPS;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_builder_add_lattice(builder, &block, NULL); // create returns its failure
    result = result ? result : mspring_network_create(builder, &def, &network);
    result = result ? result : mspring_network_set_floor(network, &table);
    show shown;
    show_begin(&shown, count, arguments, "09_jelly", "A block of jelly falls onto a table, 3 times slower.",
               network, 0.3);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, dt);
    return show_end(&shown, result, builder, network);
}
