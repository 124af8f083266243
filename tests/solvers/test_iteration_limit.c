/// @file test_iteration_limit.c
/// Tangles of springs, angles and contact: pieces, passes and iterations within iterations have a common bound.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "support.h"

#include "features/contact/contacts.h"
#include "solvers/implicit/implicit.h"

#define PARTICLES 88u
#define ANGLES 30u

/// Iterations of one solution within which the last one of a substep may end: of angles, for all others.
#define LAST 1000u

static mspring_network *tangle(uint64_t seed, mspring_solver solver) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < PARTICLES; i++) {
        mspring_particle_def p;
        check_ok(mspring_particle_def_init(&p, sizeof p));
        p.x = support_random_between(&seed, 0, 3);
        p.y = support_random_between(&seed, 1, 4);
        p.vx = (float)support_random_between(&seed, -12, 12);
        p.vy = (float)support_random_between(&seed, -12, 12);
        check_ok(mspring_builder_add_particle(builder, &p, NULL));
        if (i > 0)
            (void)support_spring(builder, i - 1, i, 2e6f, 0);
    }
    mspring_network_def def = support_def(-9.8f, 1);
    def.solver = solver;
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_contact_def_init(&contact, sizeof contact));
    contact.flags = MSPRING_CONTACT_SELF;
    check_ok(mspring_network_set_contact(network, &contact));
    mspring_angle_def angle;
    check_ok(mspring_angle_def_init(&angle, sizeof angle));
    angle.stiffness = 2e6f;
    for (uint32_t i = 0; i < ANGLES; i++) {
        const mspring_id middle = 1 + (mspring_id)(support_random(&seed) % (PARTICLES - 2));
        check_ok(mspring_network_add_angles(network, &angle, (const mspring_id[]){middle - 1, middle, middle + 1},
                                            1, NULL));
    }
    return network;
}

static void substeps_take_so_many_iterations(void **state) {
    (void)state;
    uint32_t most = 0;
    for (uint64_t seed = 0; seed < 2 * ROUNDS(2); seed++) {
        mspring_network *network = tangle(seed / 2, seed % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT);
        for (uint32_t step = 0; step < 4; step++) {
            const mspring_result result = mspring_network_step(network, 1.0 / 60);
            assert_true(result == MSPRING_OK || result == MSPRING_ERROR_LIMIT); // too crowded
            const mspringi_implicit *n = network->solver.object;
            most = n->solves > most ? n->solves : most;
            // Two pieces in each of 40 and 4 halvings may follow the one that came to the limit, with angles alone.
            const uint32_t limit = MSPRINGI_MOST_SOLVES + MSPRINGI_TIMES_SOLVED * n->iterations;
            assert_true(n->solves <= limit + 40 * 4 * 2 * ANGLES * 4 + LAST);
        }
        mspring_network_destroy(network);
    }
    printf("at most %u iterations in a step\n", (unsigned)most);
}

// The count of iterations goes on from substep to substep of a step.
static void look_at_count(const mspring_hook_args *args, void *user) {
    uint32_t *seen = user;
    const mspringi_implicit *n = args->network->solver.object;
    assert_true(n->solves >= seen[0]);
    seen[0] = n->solves;
    seen[1]++;
}

static void substeps_share_one_limit(void **state) {
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        mspring_network *network = tangle(7, kind ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT);
        uint32_t seen[2] = {0, 0}, hook;
        mspring_solver_def solver;
        check_ok(mspring_solver_def_init(&solver, sizeof solver));
        solver.solver = kind ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
        solver.substeps = 16;
        check_ok(mspring_network_set_solver(network, &solver));
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, look_at_count, seen, &hook));
        const mspring_result result = mspring_network_step(network, 1.0 / 60);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_LIMIT);
        assert_int_equal(seen[1], 16);
        assert_true(seen[0] > 16);
        // They count as work of contact, and end within a solution of its limit: 128 iterations of 300 at most.
        assert_true(network->contacts->work > 1000000);
        assert_true(network->contacts->work <= network->contacts->most_work + 128 * 300);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(substeps_take_so_many_iterations),
        cmocka_unit_test(substeps_share_one_limit),
    };
    return cmocka_run_group_tests_name("iteration_limit", tests, NULL, NULL);
}
