/// @file 14_collide.c
/// A block is thrown at a beam that is pinned at both ends: contact between bodies, friction, springs that break.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring.h>
#include <stdio.h>

enum { COLUMNS = 48, ROWS = 5, BLOCK = 10, STEPS = 96 };

int main(int count, char **arguments) {
    static uint16_t cells[ROWS][COLUMNS]; // 0 is wood, 1 is pinned wood
    const double dt = 1.0 / 64;           // s
    mspring_material steel = mspring_material_default(), wood[2];
    mspring_material_preset(&steel, MSPRING_PRESET_STEEL, 1.0, dt / 40);
    wood[0] = mspring_material_default();
    mspring_material_preset(&wood[0], MSPRING_PRESET_WOOD, 1.0, dt / 40);
    wood[0].break_strain = 0.16f;
    wood[1] = wood[0];
    wood[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (int row = 0; row < ROWS; row++)
        cells[row][0] = cells[row][COLUMNS - 1] = 1;
    mspring_lattice_def beam = mspring_lattice_def_default(), block = mspring_lattice_def_default();
    beam.width = COLUMNS, beam.height = ROWS, beam.cells = cells[0], beam.materials = wood, beam.material_count = 2;
    block.width = block.height = BLOCK, block.materials = &steel, block.x = 12, block.y = ROWS + 4; // m
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 40;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_builder_add_lattice(builder, &beam, NULL);
    mspring_builder_add_lattice(builder, &block, NULL);
    result = result ? result : mspring_network_create(builder, &def, &network);
    mspring_contact_def contact = mspring_contact_def_default();
    contact.friction = 0.4f, contact.event_capacity = 1024;
    result = result ? result : mspring_network_set_contact(network, &contact);
    const float vx = 6, vy = -25; // m/s
    result =
        result ? result : mspring_network_set_velocities(network, NULL, COLUMNS * ROWS, BLOCK * BLOCK, &vx, &vy, 0);
    show shown;
    show_begin(&shown, count, arguments, "14_collide", "A block falls onto a beam.", network, 0.15);
    mspring_contact_info info = mspring_contact_info_default();
    mspring_contact_event event = mspring_contact_event_default(), hardest = {.impulse = 0};
    double deepest = 0;
    uint32_t began = 0;
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network)) {
        result = mspring_network_step(network, dt);
        result = result ? result : mspring_network_get_contact_info(network, &info);
        deepest = info.deepest > deepest ? info.deepest : deepest;
        for (uint32_t read = 1; !result && read > 0;) {
            result = mspring_network_read_contact_events(network, &event, 1, &read, NULL);
            began += read > 0 && event.kind == MSPRING_CONTACT_BEGAN;
            hardest = read > 0 && event.impulse > hardest.impulse ? event : hardest;
        }
    }
    printf("%u contacts began, the hardest at (%.1f, %.1f) with %.0f N s\n", (unsigned)began, hardest.x, hardest.y,
           hardest.impulse);
    printf("the bodies keep %.2f m apart, less %.4f m at most\n", 0.5, deepest);
    return show_end(&shown, result, builder, network);
}
