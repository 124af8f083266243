/// @file test_walls.c
/// Light bodies between a heavy one that comes and colliders, with the implicit and the direct solver: nothing of
/// an outline gets through, or deep into, a wall, a corner of two walls, or a wall that comes towards it.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "support.h"

enum { CELLS = 64, STEPS = 240 };

/// Energy that may be gained, as a share of that at the start.
#define GAINED 1e-3

typedef enum place { A_WALL, A_CORNER, A_WALL_THAT_COMES, PLACES } place;

typedef struct press {
    mspring_network *network;
    mspring_id collider;
    uint32_t count;            ///< particles of all bodies
    bool is_inside[4 * CELLS]; ///< not of the outline, which is all that contact holds
    double thickness, radius, angle, wall, wall_speed, dt;
} press;

static double decades(uint64_t *seed, double low, double high) {
    return low * pow(high / low, support_random_between(seed, 0, 1));
}

static void add_body(mspring_builder *builder, press *p, uint32_t width, uint32_t height, double right, double y,
                     double mass, double stiffness) {
    static const uint16_t cells[CELLS] = {0};
    mspring_material material;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    material.mass = (float)mass;
    material.stiffness = (float)(stiffness * mass);
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    def.width = width;
    def.height = height;
    def.cells = cells;
    def.materials = &material;
    def.material_count = 1;
    def.spacing = 0.5;
    def.x = right - def.spacing * (width - 1);
    def.y = y;
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    for (uint32_t i = 0; i < width * height; i++) {
        const uint32_t column = i % width, row = i / width;
        p->is_inside[p->count++] = column > 0 && column + 1 < width && row > 0 && row + 1 < height;
    }
}

static void add_wall(press *p, double ax, double ay, double bx, double by, uint64_t *seed) {
    const double points[] = {ax, ay, bx, by};
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.points = points;
    def.point_count = 2;
    def.radius = p->radius;
    def.friction = (float)support_random_between(seed, 0, 1);
    check_ok(mspring_network_add_collider(p->network, &def, &p->collider));
}

static press make_press(uint32_t trial, place where) {
    uint64_t seed = 31 + trial;
    mspring_builder *builder = support_builder();
    press p = {.thickness = decades(&seed, 0.03, 0.25), .angle = support_random_between(&seed, 0.4, 1.2)};
    const uint32_t light = 1 + trial / 2 % 3;
    const double ratio = decades(&seed, 10, 1000), k = decades(&seed, 3e3, 1e6), speed = decades(&seed, 3, 60);
    // Corners of light bodies are 1.8 m above and below at most.
    double right = where == A_CORNER ? -(1.8 * cos(p.angle) + 0.6) / sin(p.angle) : -0.3 - 2 * p.thickness;
    p.radius = trial % 3 ? 0 : 0.2;
    right -= p.radius;
    for (uint32_t i = 0; i < light; i++) {
        const uint32_t width = 2 + (uint32_t)support_random_between(&seed, 0, 2),
                       height = 2 + (uint32_t)support_random_between(&seed, 0, 3);
        add_body(builder, &p, width, height, right, support_random_between(&seed, -0.3, 0.3), 1, k);
        right -= 0.5 * (width - 1) + p.thickness + decades(&seed, 0.05, 2);
    }
    const uint32_t first = p.count;
    add_body(builder, &p, 4, 3, right, 0.1, ratio, k);
    mspring_network_def def = support_def(0, 1 + trial % 4);
    def.settings.solver = trial % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
    def.settings.guard = support_guard_of(def.settings.solver);
    p.network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = p.thickness;
    contact.friction = trial % 5 ? 0 : 0.5f;
    check_ok(mspring_network_set_contact(p.network, &contact));
    const double x = where == A_CORNER ? -500 * cos(p.angle) : 0, y = where == A_CORNER ? 500 * sin(p.angle) : 500;
    add_wall(&p, x, -y, 0, where == A_CORNER ? 0 : 500, &seed);
    if (where == A_CORNER)
        add_wall(&p, 0, 0, x, y, &seed);
    else
        p.angle = 0.5 * 3.14159265358979;
    for (mspring_id id = first; id < p.count; id++)
        support_kick(p.network, id, (float)speed);
    // The heavy body has time to come as far as the wall.
    p.dt = fmax(def.settings.substeps * decades(&seed, 3e-4, 6e-3), 8 / (speed * STEPS));
    p.wall_speed = where == A_WALL_THAT_COMES ? -decades(&seed, 0.1, 10) : 0;
    return p;
}

/// How deep the outline is in the walls, as a share of the thickness.
static double depth(const press *p) {
    double most = 0;
    for (mspring_id id = 0; id < p->count; id++) {
        const support_point at = support_position(p->network, id);
        const double x = p->wall - at.x, distance = x * sin(p->angle) - fabs(at.y) * cos(p->angle);
        if (!p->is_inside[id])
            most = fmax(most, (p->thickness + p->radius - distance) / p->thickness);
    }
    return most;
}

static double energy_of(const press *p) {
    mspring_energy energy = mspring_energy_default();
    check_ok(mspring_network_get_energy(p->network, &energy));
    return energy.kinetic + energy.elastic;
}

static void run(uint32_t trial, place where) {
    press p = make_press(trial, where);
    const double start = energy_of(&p);
    double least = start;
    for (uint32_t step = 0; step < STEPS; step++) {
        p.wall += p.wall_speed * p.dt;
        if (where == A_WALL_THAT_COMES)
            check_ok(mspring_network_move_collider(p.network, p.collider, p.wall, 0, 0));
        check_ok(mspring_network_step(p.network, p.dt));
        const double deep = depth(&p);
        // A point that none expected at the wall may come 0.1 deep before the substep is taken in halves, and that
        // of another body, too.
        if (!(deep < 0.3))
            fail_msg("place %d, trial %u, step %u: %g of the thickness deep", (int)where, trial, step, deep);
        const double energy = energy_of(&p);
        if (where != A_WALL_THAT_COMES && !(energy - least < GAINED * start))
            fail_msg("place %d, trial %u, step %u: %g J gained of %g", (int)where, trial, step, energy - least, start);
        least = fmin(least, energy);
    }
    mspring_network_destroy(p.network);
}

static void nothing_is_pressed_through_a_wall(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < ROUNDS(40); trial++)
        run(trial, A_WALL);
}

static void nothing_is_pressed_through_a_corner(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < ROUNDS(40); trial++)
        run(1000 + trial, A_CORNER);
}

static void nothing_is_pressed_through_a_wall_that_comes(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < ROUNDS(40); trial++)
        run(2000 + trial, A_WALL_THAT_COMES);
}

/// A plate presses a block of 8 x 4 down onto pinned particles, with springs or without, by 0.4 m in a second. Return
/// how deep the block is in it at the end, as a share of the thickness.
static double press_onto_pins(mspring_solver solver, bool are_loose, double stiffness) {
    const double thickness = 0.25, sides[] = {-8, 0, 8, 0};
    press p = {.thickness = thickness, .dt = 1.0 / 64, .wall = 4.82};
    mspring_builder *builder = support_builder();
    add_body(builder, &p, 8, 4, 1.75, 3.05, 1, stiffness);
    for (uint32_t i = 0; i < 8; i++)
        (void)support_pinned(builder, -1.75 + 0.5 * i, 2.78, 1);
    for (uint32_t i = 0; i < 7 && !are_loose; i++)
        (void)support_spring(builder, p.count + i, p.count + i + 1, 1e4F, 0);
    mspring_network_def def = support_def(0, 2);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(solver);
    p.network = support_network(builder, &def);
    mspring_contact_def contact = mspring_contact_def_default();
    contact.thickness = thickness;
    check_ok(mspring_network_set_contact(p.network, &contact));
    mspring_collider_def plate = mspring_collider_def_default();
    plate.points = sides;
    plate.point_count = 2;
    plate.y = p.wall;
    check_ok(mspring_network_add_collider(p.network, &plate, &p.collider));
    for (uint32_t step = 0; step < 64; step++) {
        p.wall -= 0.4 * p.dt;
        check_ok(mspring_network_move_collider(p.network, p.collider, 0, p.wall, 0));
        check_ok(mspring_network_step(p.network, p.dt));
    }
    double top = 0;
    for (mspring_id id = 0; id < p.count; id++)
        top = fmax(top, support_position(p.network, id).y);
    mspring_network_destroy(p.network);
    return (thickness - (p.wall - top)) / thickness;
}

/// Pins hold a body without a change of its momentum, as much as the plate presses. (The plate came through by more
/// than half the thickness while its work was taken to be no more than the momentum of the body, and by 0.3 of it
/// through a stiff block while what it did against springs did not count.)
static void a_plate_holds_what_lies_on_pins(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++) {
        const double stiffness = i < 4 ? 3e3 : 2e5;
        const double deep =
            press_onto_pins(i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, i / 2 % 2 == 0, stiffness);
        // A block that is squeezed out is not at the plate any more.
        if (!(fabs(deep) < 0.05))
            fail_msg("solver %d, %s, %g N/m: %g of the thickness deep", i % 2,
                     i / 2 % 2 == 0 ? "loose pins" : "a pinned rope", stiffness, deep);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_pressed_through_a_wall),
                                       cmocka_unit_test(nothing_is_pressed_through_a_corner),
                                       cmocka_unit_test(nothing_is_pressed_through_a_wall_that_comes),
                                       cmocka_unit_test(a_plate_holds_what_lies_on_pins)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
