/// @file 15_torpedo.c
/// A torpedo rams a ship, seen from above: a collider of the host that bounces off with a mass of its own.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>

enum { COLUMNS = 52, ROWS = 9, STEPS = 896 };

typedef struct torpedo {
    mspring_id collider;
    double mass, inertia, x, y, angle, vx, vy, spin; // kg, kg m^2, m, rad, m/s, rad/s
} torpedo;

// The torpedo pushes the ship along its way, and then feels what it got for that.
static mspring_result step_together(mspring_network *network, torpedo *t, double dt) {
    double x = 0, y = 0, angular = 0;
    t->x += dt * t->vx, t->y += dt * t->vy, t->angle += dt * t->spin;
    mspring_result result = mspring_network_move_collider(network, t->collider, t->x, t->y, t->angle);
    result = result ? result : mspring_network_step(network, dt);
    result = result ? result : mspring_network_get_collider_impulse(network, t->collider, &x, &y, &angular);
    t->vx += x / t->mass, t->vy += y / t->mass, t->spin += angular / t->inertia;
    return result;
}

int main(int count, char **arguments) {
    static uint16_t cells[ROWS][COLUMNS];
    static const double hull[] = {-5, -1, 4, -1, 6, 0, 4, 1, -5, 1}; // its nose is on the right
    const double dt = 1.0 / 512; // s, short: in a step nothing slows the torpedo down
    mspring_material rubber = mspring_material_default();
    mspring_material_preset(&rubber, MSPRING_PRESET_RUBBER, 1.0, dt / 5);
    for (int row = 0; row < ROWS; row++) // bow and stern
        for (int i = 0; i < 3 * (row - ROWS / 2) * (row - ROWS / 2) / 4; i++)
            cells[row][COLUMNS - 1 - i] = cells[row][i / 4] = MSPRING_CELL_EMPTY;
    mspring_lattice_def ship = mspring_lattice_def_default();
    ship.width = COLUMNS, ship.height = ROWS, ship.cells = cells[0], ship.materials = &rubber;
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 5, def.settings.gravity_y = 0;
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    mspring_builder_add_lattice(builder, &ship, NULL);
    result = result ? result : mspring_network_create(builder, &def, &network);
    mspring_contact_def contact = mspring_contact_def_default();
    result = result ? result : mspring_network_set_contact(network, &contact);
    torpedo t = {.mass = 20e3, .inertia = 100e3, .x = 11, .y = -14, .angle = 1.28, .vx = 7, .vy = 24};
    mspring_collider_def shape = mspring_collider_def_default();
    shape.points = hull, shape.point_count = 5, shape.flags = MSPRING_COLLIDER_CLOSED;
    shape.x = t.x, shape.y = t.y, shape.angle = t.angle, shape.friction = 0.3f;
    result = result ? result : mspring_network_add_collider(network, &shape, &t.collider);
    show shown;
    show_begin(&shown, count, arguments, "15_torpedo", "A torpedo bounces off a ship.", network, 0.03);
    shown.film.corners = hull, shown.film.corner_count = 5;
    for (int step = 0; !result && step < STEPS; step++) {
        result = step_together(network, &t, dt);
        shown.film.place[0] = t.x, shown.film.place[1] = t.y, shown.film.place[2] = t.angle;
        show_step(&shown, network);
    }
    printf("the torpedo came at %.1f m/s and leaves at %.1f m/s\n", 25.0, hypot(t.vx, t.vy));
    return show_end(&shown, result, builder, network);
}
