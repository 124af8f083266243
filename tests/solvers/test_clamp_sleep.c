/// @file test_clamp_sleep.c
/// Steps with strain rates clamped while islands sleep, with any number of workers: what sleeps stays where it is,
/// what is awake moves as if nothing slept and keeps its momentum, and what wakes does so at once.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)
#define GRAVITY (-0.02f) // what falls by it, braked as here, is slow enough to sleep

/// Lattices one above the other, each with a strand, and a graph behind them: islands that share blocks. They hang
/// on their left columns, or nothing pulls at them.
enum { LUMPS = 4, WIDTH = 30, HEIGHT = 6, STRAND = 9, IN_LUMP = WIDTH * HEIGHT + STRAND, IN_GRAPH = 40 };
enum { PARTICLES = LUMPS * IN_LUMP + IN_GRAPH };

static recipe lumps(double stiffness, bool hang) {
    uint64_t seed = 21;
    const double damping = 0.2 * sqrt(stiffness);
    const recipe_stuff stuff = {
        .mass = {1, 3}, .stiffness = {stiffness, 2 * stiffness}, .damping = {damping, damping}};
    recipe made = {0};
    for (uint32_t lump = 0; lump < LUMPS; lump++) {
        const mspring_id first = recipe_lattice(&made, WIDTH, HEIGHT, 0, 9.0 * lump, 1, &stuff, &seed);
        const mspring_id end = recipe_particle(&made, WIDTH + STRAND - 1, 9.0 * lump, 1, 0);
        recipe_rope(&made, first + WIDTH - 1, end, STRAND, &stuff, &seed);
        assert_int_equal(made.particle_count, (lump + 1) * IN_LUMP);
    }
    for (uint32_t i = 0; i < IN_GRAPH; i++) {
        recipe_particle(&made, 60 + i % 7, i / 7, 1 + i % 3, 0);
    }
    for (uint32_t i = 0; i < 3 * IN_GRAPH; i++) {
        static const uint32_t offsets[] = {1, 3, 8};
        const mspring_id a = i % IN_GRAPH, b = (a + offsets[i / IN_GRAPH]) % IN_GRAPH;
        recipe_spring(&made, PARTICLES - IN_GRAPH + a, PARTICLES - IN_GRAPH + b, stiffness, damping, 0);
    }
    assert_int_equal(made.particle_count, PARTICLES);
    for (uint32_t row = 0; hang && row < LUMPS * HEIGHT; row++) {
        made.particles[row / HEIGHT * IN_LUMP + row % HEIGHT * WIDTH].flags = MSPRING_PARTICLE_PINNED;
    }
    made.particles[PARTICLES - IN_GRAPH].flags = hang ? MSPRING_PARTICLE_PINNED : 0;
    recipe_disturb(&made, 0.02, 0.2, &seed);
    return made;
}

static mspring_network *make(const recipe *made, float gravity, uint32_t workers, uint32_t substeps) {
    mspring_network_def def = support_def(gravity, substeps);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.worker_count = workers;
    def.settings.global_damping = 20;
    def.settings.sleep_speed = 0.02f;
    def.settings.sleep_time = 0.1f;
    return recipe_network(made, &def);
}

/// What there is to see of a network.
typedef struct sight {
    double x[PARTICLES], y[PARTICLES];
    float vx[PARTICLES], vy[PARTICLES];
    uint8_t sleeps[PARTICLES];
} sight;

static void look(const mspring_network *network, sight *out) {
    check_ok(mspring_network_get_positions(network, NULL, 0, PARTICLES, out->x, out->y, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 0, PARTICLES, out->vx, out->vy, 1));
    check_ok(support_get_sleepers(network, 0, PARTICLES, out->sleeps, 1));
}

/// Between two sights of a network what slept in both has not moved.
static uint32_t check_sleepers(const sight *before, const sight *after) {
    uint32_t count = 0;
    for (mspring_id p = 0; p < PARTICLES; p++) {
        if (before->sleeps[p] && after->sleeps[p]) {
            assert_true(after->x[p] == before->x[p] && after->y[p] == before->y[p]);
            assert_true(after->vx[p] == 0 && after->vy[p] == 0);
            count++;
        }
    }
    return count;
}

/* ------------------------------------------------------------------------------------------------- as if awake */

/// One island after the other is kicked, beside a copy in which nothing sleeps.
static void what_is_awake_moves_as_if_nothing_slept(void **state) {
    (void)state;
    static sight before, after, other;
    static const mspring_id kicked[] = {5, IN_LUMP - 1, 2 * IN_LUMP + 70, PARTICLES - 3};
    recipe made = lumps(1e6, true);
    mspring_network *network = make(&made, GRAVITY, 1, 2);
    for (size_t i = 0; i < COUNT_OF(kicked); i++) {
        mspring_network *awake = NULL;
        support_fall_asleep(network, DT);
        check_ok(mspring_network_clone(network, NULL, &awake));
        support_kick(network, kicked[i], 3);
        support_kick(awake, kicked[i], 3);
        look(network, &before);
        const uint64_t clamped = support_fallback_count(network);
        for (uint32_t step = 0; step < 10; step++) {
            check_ok(mspring_network_wake(awake));
            support_steps(network, 1, DT);
            support_steps(awake, 1, DT);
            look(network, &after);
            look(awake, &other);
            assert_int_equal(check_sleepers(&before, &after),
                             PARTICLES - (kicked[i] < LUMPS * IN_LUMP ? IN_LUMP : IN_GRAPH));
            for (mspring_id p = 0; p < PARTICLES; p++) {
                if (!after.sleeps[p]) {
                    assert_true(after.x[p] == other.x[p] && after.y[p] == other.y[p]);
                    assert_true(after.vx[p] == other.vx[p] && after.vy[p] == other.vy[p]);
                }
            }
            assert_int_equal(after.sleeps[kicked[i]], 0);
        }
        assert_int_equal(support_fallback_count(network), clamped + 10);
        mspring_network_destroy(awake);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Nothing comes to the islands that sleep, and nothing is taken from the one that does not.
static void momentum_stays_where_it_is(void **state) {
    (void)state;
    static sight before, after;
    recipe made = lumps(1e6, false);
    mspring_network *network = make(&made, 0, 1, 1);
    support_fall_asleep(network, DT);
    check_ok(support_set_global_damping(network, 0));
    support_kick(network, IN_LUMP + 40, 50);
    double px = 0, py = 0, turn = 0, px_then = 0, py_then = 0, turn_then = 0;
    check_ok(support_get_momentum(network, &px, &py, &turn));
    assert_true(px > 0 && py > 0);
    look(network, &before);
    support_steps(network, 200, DT);
    look(network, &after);
    assert_int_equal(check_sleepers(&before, &after), PARTICLES - IN_LUMP);
    check_ok(support_get_momentum(network, &px_then, &py_then, &turn_then));
    // As in test_clamp: each impulse is rounded to 6e-8 of a velocity at either end, at random; some ten of them a
    // particle and step. Velocities are 50 m/s at first.
    const double tolerance = 50 * 2 * sqrt(IN_LUMP) * 6e-8 * sqrt(200 * 10);
    check_near(px_then, px, tolerance);
    check_near(py_then, py, tolerance);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------- the same bits */

enum { STEPS = 40 };

typedef struct played {
    uint64_t print;
    uint32_t clamped, plain; ///< steps
    uint32_t asleep;         ///< particles, over all steps
} played;

static void play_step(mspring_network *network, double dt, played *out) {
    static sight before, after;
    const uint64_t clamped = support_fallback_count(network);
    const bool is_idle = support_is_asleep(network);
    look(network, &before);
    support_steps(network, 1, dt);
    look(network, &after);
    const bool is_clamped = support_fallback_count(network) > clamped;
    out->clamped += is_clamped;
    out->plain += !is_clamped && !is_idle;
    out->asleep += check_sleepers(&before, &after);
    for (mspring_id p = 0; p < PARTICLES; p++) {
        out->print = out->print * 3 + after.sleeps[p];
    }
    out->print = out->print * 31 + support_hash(network);
}

/// Clamped steps and such as are taken as they are, in which workers share the substeps, in turn; islands fall
/// asleep, and some are kicked.
static played play(const recipe *made, uint32_t workers) {
    played out = {.print = 1};
    mspring_network *network = make(made, GRAVITY, workers, 160);
    for (uint32_t step = 0; step < STEPS; step++) {
        if (step % 6 == 0) {
            support_kick(network, step / 6 % LUMPS * IN_LUMP + 7 * step, 4);
        }
        if (step == 20) {
            support_kick(network, PARTICLES - 1, 1);
        }
        play_step(network, step >= 16 && step < 34 ? 0.004 : 0.04, &out);
    }
    mspring_network_destroy(network);
    return out;
}

static void workers_make_no_difference(void **state) {
    (void)state;
    recipe made = lumps(2e7, true);
    assert_true(160 * made.spring_count > 400000); // what workers share
    const uint32_t workers[] = {2, 3, 8};
    const played expected = play(&made, 1);
    print_message("%u steps clamped, %u not, %u of %u particles asleep in one\n", (unsigned)expected.clamped,
                  (unsigned)expected.plain, (unsigned)(expected.asleep / STEPS), (unsigned)PARTICLES);
    assert_true(expected.clamped > 18 && expected.plain > 14);
    assert_true(expected.asleep > STEPS * PARTICLES / 5 && expected.asleep < STEPS * PARTICLES * 9 / 10);
    for (size_t i = 0; i < COUNT_OF(workers); i++) {
        const played again = play(&made, workers[i]);
        assert_true(again.print == expected.print);
        assert_int_equal(again.clamped, expected.clamped);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_awake_moves_as_if_nothing_slept),
        cmocka_unit_test(momentum_stays_where_it_is),
        cmocka_unit_test(workers_make_no_difference),
    };
    return cmocka_run_group_tests_name("clamp_sleep", tests, NULL, NULL);
}
