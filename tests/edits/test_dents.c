/// @file test_dents.c
/// Rest lengths that a host sends in each frame, and signals, leave dents as they are.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "support.h"

#define DT (1.0 / 64)
enum { SPRINGS = 30 };

// A chain that is pulled apart, or a strip of a lattice.
static mspring_network *make(mspring_solver solver, uint32_t height) {
    mspring_builder *builder = support_builder();
    const uint32_t width = 10;
    for (uint32_t i = 0; i < width * height; i++) {
        mspring_particle_def def;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
        def.x = i % width;
        def.y = i / width;
        def.vx = i % width < width / 2 ? -2 : 2;
        check_ok(mspring_builder_add_particles(builder, &def, 1, NULL));
    }
    for (mspring_id i = 0; i < width * height; i++)
        for (int way = 0; way < 2; way++) {
            mspring_spring_def def;
            check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
            def.a = i;
            def.b = way ? i + width : i + 1;
            def.stiffness = 1000;
            def.yield_strain = 0.02f;
            if (way ? i + width < width * height : i % width + 1 < width)
                check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
        }
    mspring_network_def def = support_def(0, 8);
    def.settings.solver = solver;
    return support_network(builder, &def);
}

typedef enum host { IDLE, SENDS_ALL, SENDS_LIST, SIGNALS } host;

static uint64_t hash_after(mspring_solver solver, uint32_t height, host how) {
    mspring_network *network = make(solver, height);
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    float lengths[SPRINGS], read[SPRINGS], strains[SPRINGS], active[SPRINGS], one = 1;
    mspring_id ids[SPRINGS];
    double bent = 0;
    check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 0, count, lengths, 1));
    for (mspring_id s = 0; s < count; s++)
        ids[s] = s;
    if (how == SIGNALS)
        check_ok(mspring_network_set_actuators(network, ids, count, 4));
    for (int step = 0; step < 40; step++) {
        if (how == SENDS_ALL)
            check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, count, lengths, 1));
        if (how == SENDS_LIST)
            check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, ids, 0, count, lengths, 1));
        if (how == SIGNALS)
            check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, count, &one, 0));
        support_steps(network, 1, DT);
    }
    check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 0, count, read, 1));
    check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, count, strains, 1));
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, 0, count, active, 1));
    for (mspring_id s = 0; s < count; s++) {
        assert_true(read[s] == lengths[s]);
        // Both strain and length are rounded once.
        check_near((double)active[s], (double)lengths[s] * (1 + (double)strains[s]), 3e-7);
        bent += fabs((double)strains[s]);
    }
    assert_true(bent > 0.05);
    // Other lengths leave strains, but for rounding.
    for (mspring_id s = 0; s < count; s++)
        lengths[s] *= 1.5f;
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, count, lengths, 1));
    check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, count, read, 1));
    for (mspring_id s = 0; s < count; s++)
        check_near((double)read[s], (double)strains[s], 3e-7);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void dents_stay(void **state) {
    static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT,
                                             MSPRING_SOLVER_DIRECT};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++)
        for (uint32_t height = 1; height <= 2; height++) {
            const uint64_t alone = hash_after(solvers[i], height, IDLE);
            for (int how = SENDS_ALL; how <= SIGNALS; how++)
                assert_true(hash_after(solvers[i], height, (host)how) == alone);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(dents_stay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
