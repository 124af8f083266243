/// @file test_floor_bodies.c
/// Bodies that hit each other on a floor, by the solvers that have both in their linear system.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "support.h"

#include <massspring/massspring.h>

/// What contact mends after a substep may lie below the floor. If the next substep is taken in pieces, the floor
/// must not lift it within one of them: a way of 1 cm in 78 us is 127 m/s.
#define SCENES SAMPLE(30u)
#define STEPS 120

static void add_block(mspring_builder *builder, uint64_t *seed, double y) {
    static const uint16_t cells[21 * 6];
    mspring_material material;
    mspring_lattice_def lattice;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    material.mass = (float)exp(support_random_between(seed, -4.6, 4.6));
    material.stiffness = (float)exp(support_random_between(seed, 4.6, 13.8));
    lattice.width = 2 + (uint32_t)support_random_between(seed, 0, 18);
    lattice.height = 1 + (uint32_t)support_random_between(seed, 0, 5);
    lattice.x = support_random_between(seed, -4, 0), lattice.y = y;
    lattice.cells = cells, lattice.materials = &material, lattice.material_count = 1;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
}

/// Two to four bodies above heights, each thrown another way.
static mspring_network *thrown(mspring_solver solver, uint64_t *seed) {
    mspring_builder *builder = support_builder();
    const uint32_t bodies = 2 + (uint32_t)support_random_between(seed, 0, 3);
    uint32_t firsts[5] = {0};
    for (uint32_t i = 0; i < bodies; i++) {
        add_block(builder, seed, 2 + 7.0 * i);
        firsts[i + 1] = mspring_builder_count(builder, MSPRING_PARTICLES);
    }
    mspring_network_def def = support_def(-9.8f, 1 + (uint32_t)support_random_between(seed, 0, 4));
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    mspring_network *network = support_network(builder, &def);
    for (uint32_t i = 0; i < bodies; i++) {
        const float vx = (float)support_random_between(seed, -9, 9),
                    vy = (float)support_random_between(seed, -9, 0);
        check_ok(mspring_network_set_velocities(network, NULL, firsts[i], firsts[i + 1] - firsts[i], &vx, &vy, 0));
    }
    float heights[16];
    for (int i = 0; i < 16; i++)
        heights[i] = (float)support_random_between(seed, 0, 1.5);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.heights = heights, floor.height_count = 16, floor.heights_x = -10, floor.spacing = 2;
    check_ok(mspring_network_set_floor(network, &floor));
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.3;
    contact.capacity =
        40000; // a particle that two bodies throw at 130 m/s is near all edges, and its neighbours are
    check_ok(mspring_network_set_contact(network, &contact));
    return network;
}

static double energy_of(const mspring_network *network, double *motion) {
    double kinetic, elastic, potential;
    check_ok(support_get_energy(network, &kinetic, &elastic, &potential));
    *motion = fmax(*motion, kinetic + elastic);
    return kinetic + elastic + potential;
}

/// Energy does not rise: 0.3 % of what moved is what test_collisions and the map allow single scenes.
static void no_energy_comes_from_floor_and_contact(void **state) {
    (void)state;
    uint64_t seed = 23;
    for (uint32_t scene = 0; scene < SCENES; scene++) {
        mspring_network *network = thrown(scene % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, &seed);
        const double dt = support_random_between(&seed, 0.004, 0.05);
        double motion = 0, most = 0;
        const double first = energy_of(network, &motion);
        for (uint32_t step = 0; step < STEPS; step++) {
            support_steps(network, 1, dt);
            most = fmax(most, energy_of(network, &motion) - first);
        }
        if (most > 0.003 * motion)
            print_error("scene %u gains %g of %g J\n", (unsigned)scene, most, motion);
        assert_true(most <= 0.003 * motion);
        mspring_network_destroy(network);
    }
}

/// A chain that moves up and down in a slit: each particle is near both planes.
static mspring_network *chain_in_slit(mspring_solver solver, uint32_t count, double width) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < count; i++) {
        support_particle(builder, 0.1 * i, 0.5 * width, 1);
        if (i > 0)
            support_spring(builder, i - 1, i, 1e4f, 10);
    }
    mspring_network_def def = support_def(-9.8f, 2);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    mspring_network *network = support_network(builder, &def);
    const double planes[][4] = {{0, 0, 0, 1}, {0, width, 0, -1}, {-1, 0, 1, 0}};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes[0], floor.plane_count = 3, floor.friction = 0.5f;
    check_ok(mspring_network_set_floor(network, &floor));
    for (uint32_t i = 0; i < count; i++) {
        const float vx = 1, vy = i % 2 ? 3.0f : -3.0f;
        check_ok(mspring_network_set_velocities(network, NULL, i, 1, &vx, &vy, 0));
    }
    return network;
}

/// The list has room for second surfaces of a quarter of the particles: the nearest one holds the others in the
/// system, and the floor keeps them above the second one.
static void slits_hold_more_than_the_list_has_room_for(void **state) {
    (void)state;
    const double width = 0.02;
    for (int i = 0; i < 2; i++) {
        enum { COUNT = 600 };
        double x[COUNT], y[COUNT];
        float vx[COUNT], vy[COUNT];
        mspring_network *network = chain_in_slit(i ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, COUNT, width);
        for (int step = 0; step < 120; step++) {
            check_ok(mspring_network_step(network, 1.0 / 60));
            check_ok(mspring_network_get_positions(network, NULL, 0, COUNT, x, y, 1));
            for (int p = 0; p < COUNT; p++) // a step rounds 60 m to 4e-6 m
                assert_true(y[p] > -1e-5 && y[p] < width + 1e-5);
        }
        check_ok(mspring_network_get_velocities(network, NULL, 0, COUNT, vx, vy, 1));
        for (int p = 0; p < COUNT; p++) { // friction has stopped it: 0.2 s at 0.5 g
            check_near(vx[p], 0, 0.01);
            check_near(vy[p], 0, 0.01);
        }
        mspring_network_destroy(network);
    }
}

/* -------------------------------------------------------------------------------------- a ball and a bar of two */

enum { BALL, LEFT, RIGHT };

/// One of them lies on the floor, the other comes down on it.
typedef struct landing {
    bool is_ball_below;
    float ball, bar; ///< masses, kg
    float speed, friction;
} landing;

static mspring_network *ball_and_bar(mspring_solver solver, const landing *how) {
    mspring_builder *builder = support_builder();
    const float down = -how->speed;
    const double ball = how->is_ball_below ? 0 : 1.5, bar = 1.5 - ball;
    (void)support_particle(builder, 0.05, ball, how->ball);
    (void)support_particle(builder, -0.4, bar, how->bar / 2);
    (void)support_particle(builder, 0.4, bar, how->bar / 2);
    (void)support_join(builder, LEFT, RIGHT, 1e4f * how->bar, 0.8f, 0);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = solver;
    mspring_network *network = support_network(builder, &def);
    for (mspring_id p = how->is_ball_below ? LEFT : BALL; p <= (how->is_ball_below ? RIGHT : BALL); p++) {
        const float still = 0;
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &still, &down, 1));
    }
    const double plane[] = {0, 0, 0, 1};
    mspring_floor_def floor;
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    floor.friction = how->friction;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.1;
    check_ok(mspring_network_set_contact(network, &contact));
    return network;
}

/// Both stay above the floor, and apart. Nothing is thrown back: it has no restitution.
static void check_landing(mspring_solver solver, const landing *how, double closest) {
    mspring_network *network = ball_and_bar(solver, how);
    for (int step = 0; step < 180; step++) {
        support_steps(network, 1, 1.0 / 60);
        const support_point ball = support_position(network, BALL), left = support_position(network, LEFT),
                            right = support_position(network, RIGHT);
        const double share = (ball.x - left.x) / (right.x - left.x),
                     bar = left.y + share * (right.y - left.y), apart = how->is_ball_below ? bar - ball.y : ball.y - bar;
        assert_true(fmin(ball.y, fmin(left.y, right.y)) > -1e-5);
        assert_true(share < 0.01 || share > 0.99 || apart > closest);
        assert_true(step < 60 || fmax(ball.y, fmax(left.y, right.y)) < 0.3);
    }
    mspring_network_destroy(network);
}

/// A loose particle on the floor is held by it as what has springs is. (Each interval of contact pressed it into the
/// floor, and the floor moved it without what pressed: bars fell through it.)
static void a_loose_particle_on_the_floor_carries_a_bar(void **state) {
    (void)state;
    static const float masses[] = {0.3f, 1, 3, 10, 100};
    for (size_t i = 0; i < 2 * COUNT_OF(masses); i++)
        for (int fast = 0; fast < 2; fast++) {
            const landing how = {.is_ball_below = true, .ball = 1, .bar = masses[i / 2], .speed = 10.0f * (float)fast};
            check_landing(i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, &how, 0.08);
        }
}

/// One that lands on a bar is stopped by that, or by the floor, and not by both: it flew up again as fast.
static void a_loose_particle_lands_on_a_bar(void **state) {
    (void)state;
    static const float masses[] = {0.3f, 1, 10, 30};
    for (size_t i = 0; i < 2 * COUNT_OF(masses); i++)
        for (int speed = 2; speed < 60; speed += 14) {
            const landing how = {.ball = masses[i / 2], .bar = 2, .speed = (float)speed};
            check_landing(i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, &how, 0.07);
        }
}

static void MSPRING_CALL push_without_end(const mspring_hook_args *args, void *user) {
    const uint32_t slot = args->slot_of_particle[BALL];
    if (slot >= args->first_slot && slot < args->first_slot + args->slot_count)
        args->force_x[slot] = *(const float *)user;
}

/// A step that is refused because numbers overflow leaves no trace of them, where contact acts by impulses, either.
static void a_refused_force_leaves_no_trace(void **state) {
    (void)state;
    for (int trial = 0; trial < 60; trial++) {
        const landing how = {.ball = 1, .bar = 0.4f + 0.2f * (float)trial, .speed = 1, .friction = 1};
        mspring_network *network = ball_and_bar(trial % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, &how);
        float force = trial % 4 < 2 ? INFINITY : -INFINITY;
        mspring_network *twin;
        mspring_hook_def def;
        mspring_id hook;
        check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
        def.fn = push_without_end;
        def.user = &force;
        support_steps(network, trial, 1.0 / 60);
        check_ok(mspring_network_clone(network, NULL, &twin));
        check_ok(mspring_network_add_hook(network, &def, &hook));
        check_error(mspring_network_step(network, 1.0 / 60), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_remove_hook(network, hook));
        support_steps(network, 3, 1.0 / 60);
        support_steps(twin, 3, 1.0 / 60);
        assert_int_equal(support_hash(network), support_hash(twin));
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_energy_comes_from_floor_and_contact),
                                       cmocka_unit_test(slits_hold_more_than_the_list_has_room_for),
                                       cmocka_unit_test(a_loose_particle_on_the_floor_carries_a_bar),
                                       cmocka_unit_test(a_loose_particle_lands_on_a_bar),
                                       cmocka_unit_test(a_refused_force_leaves_no_trace)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
