/// @file 21_cart.c
/// A cart on two axles rolls downhill into boxes. Its wheels and a lamp overlap it: layers let them pass through.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <math.h>

#include <massspring/massspring.h>

enum { COLUMNS = 17, ROWS = 3, BOX = 4, BOXES = 3, HEIGHTS = 80, STEPS = 288, LINKS = 5 };
enum { PARTS = 2, CHASSIS = 4 }; // layers of contact; boxes stay on the default one, 1

static const double spacing = 0.25, left = 1.5, bottom = 2.9, dt = 1.0 / 64; // m, s

static void add_wood(mspring_builder *builder, uint32_t width, uint32_t height, double x, double y,
                     mspring_id *ids) {
    mspring_material wood = mspring_material_default();
    mspring_material_preset(&wood, MSPRING_PRESET_WOOD, spacing, dt / 40);
    mspring_lattice_def lattice = mspring_lattice_def_default();
    lattice.width = width, lattice.height = height, lattice.spacing = spacing;
    lattice.x = x, lattice.y = y, lattice.materials = &wood;
    mspring_builder_add_lattice(builder, &lattice, ids);
}

// Add a wheel. Its centre is welded to a particle of the chassis, so it turns freely.
static void add_wheel(mspring_builder *builder, double x, double y, mspring_id axle, mspring_id *centre) {
    mspring_material rubber = mspring_material_default();
    rubber.spring_flags = MSPRING_SPRING_DAMPING_RATIO, rubber.damping = 0.05f;
    mspring_disc_def wheel = mspring_disc_def_default();
    wheel.x = x, wheel.y = y, wheel.radius = 0.6, wheel.ring_count = 3; // m
    wheel.area_density = 300, wheel.young_modulus = 3e6f;               // kg/m^2, N/m
    wheel.material = &rubber;
    mspring_builder_add_disc(builder, &wheel, centre, NULL);
    mspring_spring_def weld = mspring_spring_def_default();
    weld.a = axle, weld.b = *centre, weld.rest_length = 0, weld.stiffness = 5e5f; // m, N/m
    weld.flags = MSPRING_SPRING_DAMPING_RATIO, weld.damping = 0.5f;
    mspring_builder_add_springs(builder, &weld, 1, NULL);
}

// Add a lamp of 8 kg on a chain from the top of the chassis. It swings in front of the chassis.
static void add_lamp(mspring_builder *builder, double x, double y, mspring_id hook, mspring_id *parts) {
    mspring_particle_def lamp = mspring_particle_def_default();
    lamp.x = x, lamp.y = y, lamp.mass = 8;
    mspring_builder_add_particles(builder, &lamp, 1, &parts[0]);
    mspring_material link = mspring_material_default();
    link.mass = 0.2f, link.stiffness = 2e4f;
    link.spring_flags = MSPRING_SPRING_DAMPING_RATIO, link.damping = 0.2f;
    mspring_rope_def chain = mspring_rope_def_default();
    chain.from = parts[0], chain.to = hook, chain.segment_count = LINKS, chain.material = &link;
    mspring_builder_add_rope(builder, &chain, parts, NULL);
}

static void add_cart(mspring_builder *builder, mspring_id *wheels, mspring_id *lamp) {
    mspring_id cells[ROWS][COLUMNS] = {{0}};
    add_wood(builder, COLUMNS, ROWS, left, bottom, cells[0]);
    for (int i = 0; i < 2; i++) {
        const int column = i == 0 ? 3 : COLUMNS - 4;
        add_wheel(builder, left + spacing * column, bottom, cells[ROWS - 1][column], &wheels[i]);
    }
    const double x = left + spacing * COLUMNS / 2, y = bottom + spacing * (ROWS - 1) - 0.8;
    add_lamp(builder, x, y, cells[0][COLUMNS / 2], lamp);
}

static mspring_result set_layer(mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count,
                                uint32_t layer, uint32_t mask) {
    const mspring_result result =
        mspring_network_set_integers(network, MSPRING_LAYERS, ids, first, count, &layer, 0);
    return result ? result : mspring_network_set_integers(network, MSPRING_MASKS, ids, first, count, &mask, 0);
}

// Let wheels and lamp pass through the chassis, and touch everything else.
static mspring_result set_layers(mspring_network *network, const mspring_id *wheels, const mspring_id *lamp) {
    const uint32_t all = 0xffffffffu, wheel_size = wheels[1] - wheels[0];
    mspring_result result = set_layer(network, NULL, 0, COLUMNS * ROWS, CHASSIS, all & ~PARTS);
    result = result ? result : set_layer(network, NULL, wheels[0], 2 * wheel_size, PARTS, all & ~CHASSIS);
    return result ? result : set_layer(network, lamp, 0, LINKS, PARTS, all & ~CHASSIS);
}

static mspring_result set_hill(mspring_network *network) {
    float heights[HEIGHTS]; // m, every 0.25 m
    for (int i = 0; i < HEIGHTS; i++)
        heights[i] = (i < 40 ? 0.06f * (float)(40 - i) : 0) + 0.06f * sinf(0.7f * (float)i);
    mspring_floor_def hill = mspring_floor_def_default();
    hill.heights = heights, hill.height_count = HEIGHTS, hill.spacing = 0.25, hill.friction = 0.8f;
    return mspring_network_set_floor(network, &hill);
}

int main(int count, char **arguments) {
    mspring_id wheels[2] = {0}, lamp[LINKS + 1] = {0};
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_contact_def contact = mspring_contact_def_default();
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 40;
    contact.friction = 0.5f;

    mspring_result result = mspring_builder_create(NULL, &builder);
    add_cart(builder, wheels, lamp);
    for (int i = 0; i < BOXES; i++)
        add_wood(builder, BOX, BOX, 14, 0.3 + 1.0 * i, NULL);
    result = result ? result : mspring_network_create(builder, &def, &network);
    result = result ? result : set_hill(network);
    result = result ? result : mspring_network_set_contact(network, &contact);
    result = result ? result : set_layers(network, wheels, lamp);
    show shown;
    show_begin(&shown, count, arguments, "21_cart", "A cart rolls downhill into boxes.", network, 0.05);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network))
        result = mspring_network_step(network, dt);
    return show_end(&shown, result, builder, network);
}
