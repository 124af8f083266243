/// @file test_reference.c
/// The library against the plain double-precision reference, 100 substeps, on networks with everything in them.
///
/// The bound on position errors is 1e-3 of the spacing. Single precision gives about 2e-4 on such networks (the
/// state is rounded to 1e-6 of the spacing in each substep, and half-stable springs make a few times more of it in
/// the course of 100); a spring forgotten, doubled or with another's parameters gives 1e-2 and more.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "recipe.h"
#include "reference.h"
#include "support.h"

enum { SUBSTEPS = 100 };

static const double h = 1.0 / 256;

/// Springs of masses around 1 kg, k h^2 / m up to 0.15: a lattice of them is at 0.3 of the explicit limit.
static const double stiff[2] = {2000, 10000};

typedef struct setting {
    double gravity_x, gravity_y, global_damping;
} setting;

/// Step both and compare all positions and velocities.
static void check_against_reference(const char *name, recipe *made, setting with, double spacing) {
    reference exact = reference_of(made, with.gravity_x, with.gravity_y, with.global_damping);
    mspring_network_def def = support_def((float)with.gravity_y, 4);
    def.settings.gravity_x = (float)with.gravity_x;
    def.settings.global_damping = (float)with.global_damping;
    mspring_network *network = recipe_network(made, &def);
    for (int substep = 0; substep < SUBSTEPS; substep++) {
        reference_substep(&exact, h);
    }
    support_steps(network, SUBSTEPS / 4, 4 * h);

    double worst = 0, moved = 0;
    mspring_id worst_id = 0;
    for (mspring_id id = 0; id < made->particle_count; id++) {
        support_point p = support_position(network, id);
        const reference_particle *r = &exact.particles[id];
        double error = hypot(p.x - r->x, p.y - r->y);
        if (!(error <= worst)) {
            worst = error;
            worst_id = id;
        }
        moved = fmax(moved, hypot(r->x - made->particles[id].x, r->y - made->particles[id].y));
    }
    if (!(worst < 1e-3 * spacing)) {
        print_error("%s: particle %u is %g m off\n", name, worst_id, worst);
    }
    assert_true(worst < 1e-3 * spacing);
    // The comparison is worth something: the reference has moved by far more.
    assert_true(moved > 20 * 1e-3 * spacing);
    mspring_network_destroy(network);
    reference_free(&exact);
}

/// Lattice, and whatever else, disturbed; dampers or none; in the order of making and shuffled.
static void check_variants(const char *name, void (*make)(recipe *, const recipe_stuff *, uint64_t *),
                           double spacing) {
    const setting settings[] = {{0, -9.8, 0}, {1.5, -3, 0.7}};
    for (int variant = 0; variant < 8; variant++) {
        uint64_t seed = 100 + variant;
        recipe made = {0};
        recipe_stuff stuff = {.mass = {0.8, 1.6}, .stiffness = {stiff[0], stiff[1]}, .pinned = 0.03, .holes = 0.2};
        if (variant & 1) {
            stuff.damping[1] = 20;
        }
        if (variant & 4) {
            stuff.stiffness[0] = 0.05;
            stuff.stiffness[1] = 0.3;
            stuff.damping[1] *= 0.002;
            stuff.spring_flags = MSPRING_SPRING_RELATIVE;
        }
        make(&made, &stuff, &seed);
        recipe_disturb(&made, 0.05 * spacing, 1, &seed);
        if (variant & 2) {
            recipe_shuffle(&made, &seed, NULL);
        }
        char title[100];
        snprintf(title, sizeof title, "%s, variant %d", name, variant);
        check_against_reference(title, &made, settings[variant & 1], spacing);
        recipe_free(&made);
    }
}

static void make_lattice(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    recipe_lattice(made, 41, 23, -3, 2, 1, stuff, seed);
}

static void lattice_with_holes_and_pins(void **state) {
    (void)state;
    check_variants("lattice", make_lattice, 1);
}

static void make_two_lattices(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    mspring_id a = recipe_lattice(made, 20, 15, 0, 0, 1, stuff, seed);
    mspring_id b = recipe_lattice(made, 17, 9, 25, 3, 0.75, stuff, seed);
    // Tied by a few springs, neither on the one grid nor on the other.
    recipe_spring(made, a + 5, b + 3, 500, 0, 0);
    recipe_spring(made, a + 50, b + 13, 500, 1, 0);
}

static void two_lattices_of_different_spacing(void **state) {
    (void)state;
    check_variants("two lattices", make_two_lattices, 0.75);
}

static void make_ship(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    mspring_id hull = recipe_lattice(made, 35, 12, 0, 0, 1, stuff, seed);
    mspring_id hull_end = made->particle_count;
    mspring_id mast = recipe_particle(made, 17, 30, 1.2, 0);
    mspring_id anchor = recipe_particle(made, -10, -15, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(made, hull, mast, 13, stuff, seed);
    recipe_rope(made, hull_end - 1, mast, 14, stuff, seed);
    recipe_rope(made, hull + 4, anchor, 40, stuff, seed);
    recipe_rope(made, mast, anchor, 1, stuff, seed);
    recipe_random_springs(made, 30, stuff, seed);
}

static void ship_with_ropes_and_leftover_springs(void **state) {
    (void)state;
    check_variants("ship", make_ship, 1);
}

static void make_chains(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    // Strands of many lengths between fixed ends, a closed ring, and strands that meet in one knot.
    for (uint32_t segments = 1; segments <= 40; segments++) {
        mspring_id a = recipe_particle(made, 0, 3.0 * segments, 1, MSPRING_PARTICLE_PINNED);
        mspring_id b = recipe_particle(made, segments, 3.0 * segments + 1, 1, segments % 3 == 0);
        recipe_rope(made, a, b, segments, stuff, seed);
    }
    mspring_id first = made->particle_count;
    for (uint32_t i = 0; i < 20; i++) {
        double angle = 2 * 3.14159265358979 * i / 20;
        recipe_particle(made, -20 + 3 * cos(angle), 3 * sin(angle), 1, 0);
        if (i > 0) {
            recipe_spring(made, first + i - 1, first + i, stuff->stiffness[1], stuff->damping[1],
                          stuff->spring_flags);
        }
    }
    recipe_spring(made, first + 19, first, stuff->stiffness[1], stuff->damping[1], stuff->spring_flags);
    mspring_id knot = recipe_particle(made, -20, 20, 2, 0);
    for (uint32_t i = 0; i < 7; i++) {
        double angle = 2 * 3.14159265358979 * i / 7;
        mspring_id end = recipe_particle(made, -20 + 10 * cos(angle), 20 + 10 * sin(angle), 1, i & 1);
        recipe_rope(made, end, knot, 9, stuff, seed);
    }
}

static void strands_rings_and_knots(void **state) {
    (void)state;
    check_variants("chains", make_chains, 1);
}

static void make_graph(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    for (int i = 0; i < 300; i++) {
        double x = support_random_between(seed, 0, 17), y = support_random_between(seed, 0, 17);
        recipe_particle(made, x, y, support_random_between(seed, stuff->mass[0], stuff->mass[1]), i % 50 == 0);
    }
    recipe_random_springs(made, 500, stuff, seed);
}

static void random_graph(void **state) {
    (void)state;
    check_variants("graph", make_graph, 1);
}

static void make_loose(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    for (int i = 0; i < 100; i++) {
        recipe_particle(made, i, i % 7, support_random_between(seed, stuff->mass[0], stuff->mass[1]), i % 10 == 0);
    }
}

static void particles_without_springs(void **state) {
    (void)state;
    check_variants("loose", make_loose, 1);
}

static void make_turned_lattice(recipe *made, const recipe_stuff *stuff, uint64_t *seed) {
    // On no grid along the axes: rotated by 30 degrees, and one sheared.
    const double matrices[2][4] = {{0.8660254, -0.5, 0.5, 0.8660254}, {1, 0.3, 0, 1}};
    for (int i = 0; i < 2; i++) {
        uint32_t first = made->particle_count;
        recipe_lattice(made, 15, 11, 0, 0, 1, stuff, seed);
        for (uint32_t id = first; id < made->particle_count; id++) {
            mspring_particle_def *p = &made->particles[id];
            double x = p->x, y = p->y;
            p->x = matrices[i][0] * x + matrices[i][1] * y + 40 * i;
            p->y = matrices[i][2] * x + matrices[i][3] * y;
        }
    }
}

static void lattices_off_the_axes(void **state) {
    (void)state;
    check_variants("turned lattices", make_turned_lattice, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lattice_with_holes_and_pins),
        cmocka_unit_test(two_lattices_of_different_spacing),
        cmocka_unit_test(ship_with_ropes_and_leftover_springs),
        cmocka_unit_test(strands_rings_and_knots),
        cmocka_unit_test(random_graph),
        cmocka_unit_test(particles_without_springs),
        cmocka_unit_test(lattices_off_the_axes),
    };
    return cmocka_run_group_tests_name("reference", tests, NULL, NULL);
}
