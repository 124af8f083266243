/// @file test_loose_throws.c
/// Particles without springs that meet bodies in implicit steps. Beside a floor they fly on their own, past all of
/// it, and get what contact gave them after that. A floor that is far below must not show in how they fly.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bodies.h"

#define DT (1.0 / 64)
#define THICKNESS 0.5

/// A particle that flies at a block.
typedef struct throw {
    mspring_solver solver;
    uint32_t substeps;
    double speed, mass; ///< m/s and kg of the particle; a particle of the block has 1 kg
    float yield_strain; ///< of the block; 0: it does not yield
}
throw;

static mspring_network *thrown(const throw *t, bool has_floor) {
    mspring_builder *builder = support_builder();
    mspring_lattice_def block;
    mspring_material material;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &block, sizeof block));
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    const uint16_t cells[5 * 5] = {0};
    block.width = block.height = 5;
    block.cells = cells;
    block.materials = &material;
    block.material_count = 1;
    material.stiffness = 1e4f;
    material.damping = 10;
    if (t->yield_strain > 0)
        material.yield_strain = t->yield_strain;
    check_ok(mspring_builder_add_lattice(builder, &block, NULL));
    mspring_particle_def ball;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &ball, sizeof ball));
    ball.x = 2.3;
    ball.y = 5.2;
    ball.vx = (float)(0.1 * t->speed);
    ball.vy = (float)-t->speed;
    ball.mass = (float)t->mass;
    check_ok(mspring_builder_add_particles(builder, &ball, 1, NULL));
    mspring_network_def def = support_def(0, t->substeps);
    def.settings.solver = t->solver;
    def.flags = MSPRING_NETWORK_PRECISE;
    mspring_network *network = support_network(builder, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0.5f));
    const double planes[] = {0, -1000, 0, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes;
    floor.plane_count = 1;
    if (has_floor)
        check_ok(mspring_network_set_floor(network, &floor));
    return network;
}

/// Positions are rounded otherwise, and so are velocities.
static void check_throw(const throw *t) {
    mspring_network *with = thrown(t, true), *without = thrown(t, false);
    const mspring_id ball = mspring_network_count(with, MSPRING_PARTICLES) - 1;
    double x, y, turn, x0, y0, turn0;
    check_ok(support_get_momentum(with, &x0, &y0, &turn0));
    const double had = support_energy(with);
    for (int step = 0; step < 24; step++) {
        support_steps(with, 1, DT);
        support_steps(without, 1, DT);
        const support_point at = support_position(with, ball), other = support_position(without, ball);
        check_near(at.x, other.x, 2e-3);
        check_near(at.y, other.y, 2e-3);
        check_ok(support_get_momentum(with, &x, &y, &turn));
        check_near(x, x0, 1e-4 * t->mass * t->speed);
        check_near(y, y0, 1e-4 * t->mass * t->speed);
        assert_true(support_energy(with) <= had * (1 + 1e-5));
    }
    assert_true(support_velocity(with, ball).y > -0.9 * t->speed); // it met the block
    mspring_network_destroy(with);
    mspring_network_destroy(without);
}

/// As many pieces as the substep is taken in. (One that hit a block got what it gave once for each piece in which
/// springs might yield: a random world had 14 times its energy.)
static void a_block_that_yields_throws_once(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++)
        check_throw(&(throw){.solver = i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT,
                             .substeps = 1 + i / 2,
                             .speed = 20,
                             .mass = 2,
                             .yield_strain = 0.01f});
}

/// From the piece on in which it is hit it goes another way. (It went as far as it would have in that piece.)
static void what_is_hit_in_a_piece_goes_its_way(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++)
        check_throw(&(throw){.solver = i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT,
                             .substeps = 1,
                             .speed = 60 + 20 * (i / 2),
                             .mass = 0.1});
}

/// A body of 400 kg falls 0.2 m onto two particles of 1 kg that lie on the ground. As long as constraints of these were
/// solved one by one, it sank into them by 0.23 m.
static void light_ones_carry_a_heavy_body(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        bodies *b = bodies_begin(DT / 40);
        const double lies = -THICKNESS, on_two = THICKNESS + 0.5 + 0.2;
        (void)bodies_add(b, &(bodies_lattice){.width = 9, .height = 1, .y = lies, .spacing = 1, .f = 0.1});
        for (int i = -1; i < 2; i += 2)
            (void)bodies_add(
                b, &(bodies_lattice){.width = 1, .height = 1, .x = 1.2 * i, .spacing = 1, .mass = 1, .f = 0.1});
        (void)bodies_add(
            b, &(bodies_lattice){.width = 4, .height = 2, .y = on_two, .spacing = 1, .mass = 50, .f = 0.5});
        mspring_network_def def = support_def(-9.8f, 2);
        def.settings.solver = (mspring_solver)solver;
        def.settings.guard = support_guard_of(def.settings.solver);
        mspring_network *network = bodies_network(b, &def);
        check_ok(bodies_touch(network, THICKNESS, 0.5f, 0));
        double deepest = 0;
        uint32_t fewer = 0, crossings;
        for (int step = 0; step < 200; step++) {
            support_steps(network, 1, DT);
            fewer += (support_step_flags(network) & MSPRING_STEP_FEWER) != 0;
            (void)bodies_measured(b, network);
            deepest = fmax(deepest, bodies_deepest(b, THICKNESS, &crossings));
            assert_int_equal(crossings, 0);
        }
        if (getenv("CONTACT_REPORT"))
            printf("solver %d: deepest %.4f m, %u steps out of work\n", solver, deepest, (unsigned)fewer);
        assert_true(deepest < 0.05 * THICKNESS);
        assert_true(fewer < 10);
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_that_yields_throws_once),
        cmocka_unit_test(what_is_hit_in_a_piece_goes_its_way),
        cmocka_unit_test(light_ones_carry_a_heavy_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
