/// @file 14_collide.c
/// A block is thrown at a beam that is pinned at both ends: contact between bodies, friction, springs that break.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring_contact.h>
#include <massspring/massspring_tools.h>
#include <stdio.h>

enum { COLUMNS = 48, ROWS = 5, BLOCK = 10, STEPS = 96 };

int main(int count, char **arguments) {
    static uint16_t cells[ROWS][COLUMNS]; // 0 is wood, 1 is pinned wood
    static const uint16_t steel_cells[BLOCK][BLOCK];
    const double dt = 1.0 / 64; // s
    mspring_material wood[2], steel;
    mspring_result result = mspring_material_preset(&steel, sizeof steel, MSPRING_PRESET_STEEL, 1.0, dt / 40);
    for (int i = 0; i < 2; i++) {
        result =
            result ? result : mspring_material_preset(&wood[i], sizeof wood[i], MSPRING_PRESET_WOOD, 1.0, dt / 40);
        wood[i].break_strain = 0.16f;
    }
    wood[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (int row = 0; row < ROWS; row++)
        cells[row][0] = cells[row][COLUMNS - 1] = 1;
    mspring_lattice_def beam, block;
    mspring_lattice_def_init(&beam, sizeof beam);
    beam.width = COLUMNS, beam.height = ROWS, beam.cells = cells[0], beam.materials = wood, beam.material_count = 2;
    mspring_lattice_def_init(&block, sizeof block);
    block.width = block.height = BLOCK, block.cells = steel_cells[0], block.materials = &steel;
    block.material_count = 1, block.x = 12, block.y = ROWS + 4; // m
    mspring_network_def settings;
    mspring_network_def_init(&settings, sizeof settings);
    settings.substeps = 40;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    result = result ? result : mspring_builder_create(NULL, &builder);
    result = result ? result : mspring_builder_add_lattice(builder, &beam, NULL);
    result = result ? result : mspring_builder_add_lattice(builder, &block, NULL);
    result = result ? result : mspring_network_create(builder, &settings, &network);
    mspring_contact_def contact;
    mspring_contact_def_init(&contact, sizeof contact);
    contact.friction = 0.4f;
    result = result ? result : mspring_network_set_contact(network, &contact);
    result = result ? result : mspring_network_reserve_contact_events(network, 1024);
    const float vx = 6, vy = -25; // m/s
    result = result ? result : mspring_network_set_velocities(network, COLUMNS * ROWS, BLOCK * BLOCK, &vx, &vy, 0);
    show shown;
    show_begin(&shown, count, arguments, "14_collide", "A block falls onto a beam.", network, 0.15);
    mspring_contact_info info = {.struct_size = sizeof info};
    mspring_contact_event event = {.struct_size = sizeof event}, hardest = {.impulse = 0};
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
