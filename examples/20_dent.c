/// @file 20_dent.c
/// A car is driven into a wall: springs that yield, so that what bends stays bent.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring.h>
#include <stdio.h>

enum { WIDTH = 44, HEIGHT = 14, STEPS = 80 };

/// Bonnet, cabin and boot, top row first; the columns of each row that are metal.
static const int rows[HEIGHT][2] = {{14, 26}, {13, 28}, {12, 29}, {11, 30}, {10, 31}, {1, 42}, {0, 43},
                                    {0, 43},  {0, 43},  {0, 43},  {0, 43},  {0, 43},  {1, 42}, {2, 41}};

int main(int count, char **arguments) {
    static uint16_t cells[HEIGHT][WIDTH];
    const double dt = 1.0 / 64, spacing = 0.1; // s, m
    mspring_material metal = mspring_material_default();
    mspring_material_preset(&metal, MSPRING_PRESET_RUBBER, spacing, dt / 40);
    metal.yield_strain = 0.03f; /* 3 % of strain bends it */
    metal.hardening = 0.3f;
    metal.plastic_limit = 0.6f;
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++)
            cells[row][column] =
                column >= rows[row][0] && column <= rows[row][1] ? 0 : (uint16_t)MSPRING_CELL_EMPTY;
    mspring_lattice_def car = mspring_lattice_def_default();
    car.width = WIDTH, car.height = HEIGHT, car.cells = cells[0], car.materials = &metal;
    car.spacing = spacing, car.y = 0.05;
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 40;

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_builder_add_lattice(builder, &car, NULL);
    result = result ? result : mspring_network_create(builder, &def, &network);
    const double planes[2][4] = {{0, 0, 0, 1}, {WIDTH * spacing + 0.5, 0, -1, 0}}; // the street, and the wall
    mspring_floor_def floor = mspring_floor_def_default();
    floor.plane_count = 2, floor.planes = planes[0], floor.friction = 0.1f;
    result = result ? result : mspring_network_set_floor(network, &floor);
    const float vx = 5, vy = 0; // m/s
    result = result ? result : mspring_network_set_velocities(network, NULL, 0, MSPRING_ALL, &vx, &vy, 0);
    show shown;
    show_begin(&shown, count, arguments, "20_dent", "A car is driven into a wall.", network, 0.3);
    mspring_energy before = mspring_energy_default(), after = mspring_energy_default();
    mspring_body wreck = mspring_body_default();
    result = result ? result : mspring_network_get_energy(network, &before);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, dt);
    result = result ? result : mspring_network_get_energy(network, &after);
    result = result ? result : mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &wreck);
    if (!result)
        printf("%u springs are bent; the car is %.2f m long, which were %.2f m\n"
               "of %.0f J of motion %.0f are left, and %.0f went into dents\n",
               (unsigned)after.bent_springs, wreck.max_x - wreck.min_x, (WIDTH - 1) * spacing, before.kinetic,
               after.kinetic, after.dissipated);
    return show_end(&shown, result, builder, network);
}
