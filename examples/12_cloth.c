/// @file 12_cloth.c
/// A cloth is pulled until a slit in it runs on: a cut, springs that break, pinned particles that move.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring.h>

enum { COLUMNS = 20, ROWS = 14, LAST_ROW = (ROWS - 1) * COLUMNS, STEPS = 132, CUT = 64 };

int main(int count, char **arguments) {
    mspring_material thread = mspring_material_default();
    thread.mass = 0.01f, thread.stiffness = 500, thread.damping = 0.1f, thread.break_strain = 0.25f;
    mspring_lattice_def cloth = mspring_lattice_def_default();
    cloth.width = COLUMNS, cloth.height = ROWS, cloth.spacing = 0.06; // m
    cloth.materials = &thread, cloth.shear_share = 0.3f;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_builder_add_lattice(builder, &cloth, NULL);
    result = result ? result : mspring_network_create(builder, NULL, &network);
    const float pinned = 0, vx = 0, vy = -0.25f; // inverse mass scale, m/s
    result =
        result ? result : mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, COLUMNS, &pinned, 0);
    result = result ? result
                    : mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, LAST_ROW, COLUMNS, &pinned, 0);
    result = result ? result : mspring_network_set_velocities(network, NULL, LAST_ROW, COLUMNS, &vx, &vy, 0);
    mspring_id slit[CUT];
    uint32_t cut = 0;
    result = result ? result
                    : mspring_network_springs_across(network, -1, 0.45, 0.45, 0.45, MSPRING_FIND_WHOLE, slit, NULL,
                                                     CUT, &cut);
    result = result ? result : mspring_network_break_springs(network, slit, 0, cut < CUT ? cut : CUT);
    show shown;
    show_begin(&shown, count, arguments, "12_cloth", "A slit in a cloth runs on, 3 times slower.", network, 0.25);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, 0.005);
    return show_end(&shown, result, builder, network);
}
