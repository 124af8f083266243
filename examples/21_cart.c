/// @file 21_cart.c
/// A cart on two axles rolls downhill into boxes. Its wheels and a lamp overlap it: contact groups let them pass
/// through.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <math.h>

#include <massspring/massspring_contact.h>
#include <massspring/massspring_tools.h>

enum { COLUMNS = 17, ROWS = 3, BOX = 4, BOXES = 3, HEIGHTS = 80, STEPS = 288, LINKS = 5 };
enum { PARTS = 2, CHASSIS = 4 }; // contact groups; boxes stay in the default group, 1

static const double spacing = 0.25, left = 1.5, bottom = 2.9, dt = 1.0 / 64; // m, s

static mspring_result add_wood(mspring_builder *builder, uint32_t width, uint32_t height, double x, double y,
                               mspring_id *ids) {
    static const uint16_t cells[COLUMNS * ROWS];
    mspring_material wood;
    mspring_lattice_def lattice;
    mspring_lattice_def_init(&lattice, sizeof lattice);
    lattice.width = width, lattice.height = height, lattice.cells = cells, lattice.spacing = spacing;
    lattice.x = x, lattice.y = y, lattice.materials = &wood, lattice.material_count = 1;
    const mspring_result result =
        mspring_material_preset(&wood, sizeof wood, MSPRING_PRESET_WOOD, spacing, dt / 40);
    return result ? result : mspring_builder_add_lattice(builder, &lattice, ids);
}

// Add a wheel. Its centre is welded to a particle of the chassis, so it turns freely.
static mspring_result add_wheel(mspring_builder *builder, double x, double y, mspring_id axle, mspring_id *centre) {
    mspring_disc_def wheel;
    mspring_spring_def weld;
    mspring_disc_def_init(&wheel, sizeof wheel);
    wheel.x = x, wheel.y = y, wheel.radius = 0.6, wheel.ring_count = 3; // m
    wheel.area_density = 300, wheel.young_modulus = 3e6f;               // kg/m^2, N/m
    wheel.spring_flags = MSPRING_SPRING_DAMPING_RATIO, wheel.damping = 0.05f;
    mspring_result result = mspring_builder_add_disc(builder, &wheel, centre, NULL);
    mspring_spring_def_init(&weld, sizeof weld);
    weld.a = axle, weld.b = *centre, weld.rest_length = 0, weld.stiffness = 5e5f; // m, N/m
    weld.flags = MSPRING_SPRING_DAMPING_RATIO, weld.damping = 0.5f;
    return result ? result : mspring_builder_add_spring(builder, &weld, NULL);
}

// Add a lamp of 8 kg on a chain from the top of the chassis. It swings in front of the chassis.
static mspring_result add_lamp(mspring_builder *builder, double x, double y, mspring_id hook, mspring_id *parts) {
    mspring_particle_def lamp;
    mspring_rope_def chain;
    mspring_particle_def_init(&lamp, sizeof lamp);
    lamp.x = x, lamp.y = y, lamp.mass = 8;
    mspring_result result = mspring_builder_add_particle(builder, &lamp, &parts[0]);
    mspring_rope_def_init(&chain, sizeof chain);
    chain.from = parts[0], chain.to = hook, chain.segment_count = LINKS, chain.mass = 0.2f, chain.stiffness = 2e4f;
    chain.spring_flags = MSPRING_SPRING_DAMPING_RATIO, chain.damping = 0.2f;
    return result ? result : mspring_builder_add_rope(builder, &chain, parts, LINKS + 1, NULL);
}

static mspring_result add_cart(mspring_builder *builder, mspring_id *wheels, mspring_id *lamp) {
    mspring_id cells[ROWS][COLUMNS];
    mspring_result result = add_wood(builder, COLUMNS, ROWS, left, bottom, cells[0]);
    for (int i = 0; !result && i < 2; i++) {
        const int column = i == 0 ? 3 : COLUMNS - 4;
        result = add_wheel(builder, left + spacing * column, bottom, cells[ROWS - 1][column], &wheels[i]);
    }
    const double x = left + spacing * COLUMNS / 2, y = bottom + spacing * (ROWS - 1) - 0.8;
    return result ? result : add_lamp(builder, x, y, cells[0][COLUMNS / 2], lamp);
}

// Let wheels and lamp pass through the chassis, and touch everything else.
static mspring_result set_groups(mspring_network *network, const mspring_id *wheels, uint32_t wheel_size,
                                 const mspring_id *lamp) {
    const uint32_t all = 0xffffffffu;
    mspring_result result = mspring_network_set_contact_groups(network, 0, COLUMNS * ROWS, CHASSIS, all & ~PARTS);
    for (int i = 0; !result && i < 2; i++)
        result = mspring_network_set_contact_groups(network, wheels[i], wheel_size, PARTS, all & ~CHASSIS);
    for (int i = 0; !result && i < LINKS; i++)
        result = mspring_network_set_contact_groups(network, lamp[i], 1, PARTS, all & ~CHASSIS);
    return result;
}

static mspring_result set_hill(mspring_network *network) {
    float heights[HEIGHTS]; // m, every 0.25 m
    mspring_floor_def hill;
    for (int i = 0; i < HEIGHTS; i++)
        heights[i] = (i < 40 ? 0.06f * (float)(40 - i) : 0) + 0.06f * sinf(0.7f * (float)i);
    mspring_floor_def_init(&hill, sizeof hill);
    hill.heights = heights, hill.height_count = HEIGHTS, hill.spacing = 0.25, hill.friction = 0.8f;
    return mspring_network_set_floor(network, &hill);
}

int main(int count, char **arguments) {
    mspring_id wheels[2], lamp[LINKS + 1];
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_contact_def contact;
    mspring_network_def def;
    mspring_network_def_init(&def, sizeof def);
    def.substeps = 40;
    mspring_contact_def_init(&contact, sizeof contact);
    contact.friction = 0.5f;

    mspring_result result = mspring_builder_create(NULL, &builder);
    result = result ? result : add_cart(builder, wheels, lamp);
    for (int i = 0; i < BOXES; i++)
        result = result ? result : add_wood(builder, BOX, BOX, 14, 0.3 + 1.0 * i, NULL);
    result = result ? result : mspring_network_create(builder, &def, &network);
    result = result ? result : set_hill(network);
    result = result ? result : mspring_network_set_contact(network, &contact);
    result = result ? result : set_groups(network, wheels, wheels[1] - wheels[0], lamp);
    show shown;
    show_begin(&shown, count, arguments, "21_cart", "A cart rolls downhill into boxes.", network, 0.05);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, dt);
    return show_end(&shown, result, builder, network);
}
