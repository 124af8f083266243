/// @file 12_cloth.c
/// A cloth is pulled until a slit in it runs on: a cut, springs that break, pinned particles that move.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring_tools.h>

enum { COLUMNS = 20, ROWS = 14, LAST_ROW = (ROWS - 1) * COLUMNS, STEPS = 132, CUT = 64 };

int main(int count, char **arguments) {
    static const uint16_t cells[ROWS][COLUMNS]; // all of material 0
    mspring_material thread;
    mspring_material_init(&thread, sizeof thread);
    thread.mass = 0.01f, thread.stiffness = 500, thread.damping = 0.1f, thread.break_strain = 0.25f;
    mspring_lattice_def cloth;
    mspring_lattice_def_init(&cloth, sizeof cloth);
    cloth.width = COLUMNS, cloth.height = ROWS, cloth.cells = cells[0], cloth.spacing = 0.06; // m
    cloth.materials = &thread, cloth.material_count = 1, cloth.shear_share = 0.3f;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    result = result ? result : mspring_builder_add_lattice(builder, &cloth, NULL);
    result = result ? result : mspring_network_create(builder, NULL, &network);
    const float pinned = 0, vx = 0, vy = -0.25f; // inverse mass scale, m/s
    result = result ? result : mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, 0, COLUMNS, &pinned, 0);
    result =
        result ? result : mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, LAST_ROW, COLUMNS, &pinned, 0);
    result = result ? result : mspring_network_set_velocities(network, LAST_ROW, COLUMNS, &vx, &vy, 0);
    mspring_id slit[CUT];
    uint32_t cut = 0;
    result = result ? result
                    : mspring_network_springs_across(network, -1, 0.45, 0.45, 0.45, MSPRING_FIND_WHOLE, slit, NULL,
                                                     CUT, &cut);
    result = result ? result : mspring_network_break_springs(network, slit, cut < CUT ? cut : CUT);
    show shown;
    show_begin(&shown, count, arguments, "12_cloth", "A slit in a cloth runs on, 3 times slower.", network, 0.25);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, 0.005);
    return show_end(&shown, result, builder, network);
}
