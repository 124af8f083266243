/// @file test_floor_bars.c
/// Bars on floors: they lie still, slide to a stop and gain no energy; refused steps, snapshots and compaction keep
/// what they stand on.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "grounds.h"
#include "recipe.h"
#include "support.h"

static const double g = 9.8;

/// The 80x5 bar of the other tests, its lowest row at height y, none of it pinned. Its springs bear 40 substeps in
/// a step of 1 / 64 s.
static mspring_network *bar(double y, uint32_t workers, mspring_simd simd) {
    recipe made = {0};
    uint64_t seed = 1;
    const double mass = 73.3975, h = 1.0 / 64 / 40, k = 0.25 * mass / 2 / (h * h), c = 0.03 * mass / 2 / h;
    const recipe_stuff stuff = {.mass = {mass, mass}, .stiffness = {k, k}, .damping = {c, c}};
    recipe_lattice(&made, 80, 5, 0, y, 1, &stuff, &seed);
    mspring_network_def def = support_def(-9.8f, 40);
    def.worker_count = workers;
    def.simd_level = simd;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static double rms_speed(const mspring_network *network) {
    static float vx[400], vy[400];
    double sum = 0;
    check_ok(mspring_network_get_velocities(network, NULL, 0, 400, vx, vy, 1));
    for (uint32_t i = 0; i < 400; i++)
        sum += (double)vx[i] * vx[i] + (double)vy[i] * vy[i];
    return sqrt(sum / 400);
}

static double centre_x(const mspring_network *network) {
    static double x[400], y[400];
    double sum = 0;
    check_ok(mspring_network_get_positions(network, NULL, 0, 400, x, y, 1));
    for (uint32_t i = 0; i < 400; i++)
        sum += x[i];
    return sum / 400;
}

/// A bar that has fallen by half a metre comes to rest, and does not move on.
static void bars_lie_still(const grounds_way *how, uint32_t seconds) {
    mspring_network *network = bar(0.5, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = grounds_level(0.5f, 0.1f);
    grounds_step_by(network, how);
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(support_set_global_damping(network, 0.2f));
    support_steps(network, 64 * seconds, 1.0 / 64);
    const double before = centre_x(network);
    double most = 0;
    for (uint32_t step = 0; step < 64 * 5; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        most = fmax(most, rms_speed(network));
    }
    // A free bar that rounding alone keeps moving has 0.006 m/s (see test_rest.c).
    if (most > 0.01)
        fail_msg("the bar moves at %g m/s", most);
    check_near(centre_x(network) - before, 0, 1e-3);
    // The floor bears the weight, but for how fast the bar still moves.
    static float impulse_x[400], impulse_y[400];
    double sum = 0;
    check_ok(mspring_network_get_columns(
        network, NULL, 0, 400,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, impulse_x}, {MSPRING_FLOOR_IMPULSE_Y, 1, impulse_y}},
        2));
    for (uint32_t i = 0; i < 400; i++)
        sum += (double)impulse_y[i];
    const double weight = 400 * 73.3975 * g / 64;
    check_near(sum, weight, 0.01 * weight);
    mspring_network_destroy(network);
}

static void bars_lie_still_explicitly(void **state) {
    (void)state;
    bars_lie_still(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 40}, 30);
}

static const grounds_way implicit_ways[] = {
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, 1},
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1},
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1},
    {MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, 1},
};

static void bars_lie_still_implicitly(void **state) {
    (void)state;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i++)
        bars_lie_still(&implicit_ways[i], 8); // which take the bounce out sooner
}

/// A bar that slides comes to a stop as a block does: v^2 / (2 friction g) further on.
static void bars_slide(const grounds_way *how) {
    const double friction = 0.4, speed = 6;
    static float vx[400], vy[400];
    mspring_network *network = bar(0, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = grounds_level((float)friction, 0);
    for (uint32_t i = 0; i < 400; i++)
        vx[i] = (float)speed;
    grounds_step_by(network, how);
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 400, vx, vy, 1));
    const double start = centre_x(network);
    support_steps(network, 64, 1.0 / 64);
    check_ok(mspring_network_get_velocities(network, NULL, 0, 400, vx, vy, 1));
    double mean = 0;
    for (uint32_t i = 0; i < 400; i++)
        mean += (double)vx[i] / 400;
    // It also bounces up and down in itself, so that what lies on the floor at the end of the second is not its
    // weight but within a few per cent of it.
    check_near(mean, speed - friction * g, 0.03 * speed);
    support_steps(network, 64 * 3, 1.0 / 64);
    const double way_to_stop = speed * speed / (2 * friction * g);
    check_near(centre_x(network) - start, way_to_stop, 0.03 * way_to_stop);
    mspring_network_destroy(network);
}

static void bars_slide_explicitly(void **state) {
    (void)state;
    bars_slide(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 40});
}

static void bars_slide_implicitly(void **state) {
    (void)state;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i++)
        bars_slide(&implicit_ways[i]);
}

static double energy(const mspring_network *network) {
    double kinetic, elastic, potential;
    check_ok(support_get_energy(network, &kinetic, &elastic, &potential));
    return kinetic + elastic + potential;
}

/// A bar that falls at an angle, turning, loses energy all the time and never gains any.
static void contact_gives_no_energy(const grounds_way *how, double restitution, double dt, double share) {
    static double x[400], y[400];
    static float vx[400], vy[400];
    mspring_network *network = bar(0, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = grounds_level(0.3f, (float)restitution);
    check_ok(mspring_network_get_positions(network, NULL, 0, 400, x, y, 1));
    for (uint32_t i = 0; i < 400; i++) {
        const double along = x[i], up = y[i];
        x[i] = 0.96 * along - 0.28 * up;
        y[i] = 3 + 0.28 * along + 0.96 * up;
        vx[i] = (float)(2 - 0.5 * (y[i] - 15));
        vy[i] = (float)(-10 + 0.5 * (x[i] - 40));
    }
    grounds_step_by(network, how);
    check_ok(mspring_network_set_positions(network, NULL, 0, 400, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 400, vx, vy, 1));
    check_ok(mspring_network_set_floor(network, &def));
    const double whole = energy(network);
    double least = whole;
    for (double time = 0; time < 10; time += dt) {
        check_ok(mspring_network_step(network, dt));
        const double now = energy(network);
        if (now > least + share * whole || now > (1 + share / 10) * whole)
            fail_msg("solver %d, integrator %d, time %g, restitution %g, dt %g: energy %g J after %g J at the "
                     "least, of %g J",
                     (int)how->solver, (int)how->integrator, time, restitution, dt, now, least, whole);
        least = fmin(least, now);
    }
    assert_true(least < 0.7 * whole);
    mspring_network_destroy(network);
}

static void explicit_contact_gives_no_energy(void **state) {
    (void)state;
    // What leapfrog itself lets energy swing by: about omega h / 2 of what oscillates, which is a part of
    // the whole.
    for (int i = 0; i <= 2; i++)
        contact_gives_no_energy(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 40}, 0.5 * i, 1.0 / 64, 0.02);
}

/// A bar that breaks into squares and single particles, and is compacted in the air and on the floor.
static void compaction_keeps_the_floor(void **state) {
    (void)state;
    static ground grounds[6];
    (void)grounds_make(grounds, 40, 0);
    mspring_floor_def *def = &grounds[4].def;
    def->planes = grounds[4].planes;
    def->heights = grounds[4].heights;
    mspring_network *network = bar(1, 1, MSPRING_SIMD_AUTO);
    check_ok(mspring_network_set_floor(network, def));
    for (uint32_t round = 0; round < 4; round++) {
        const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
        for (mspring_id s = round; s < springs; s += 3)
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        check_ok(mspring_network_compact(network));
        for (uint32_t step = 0; step < 64; step++) {
            static double x[400], y[400];
            check_ok(mspring_network_step(network, 1.0 / 64));
            check_ok(mspring_network_get_positions(network, NULL, 0, 400, x, y, 1));
            for (uint32_t i = 0; i < 400; i++)
                assert_true(grounds_above(def, x[i], y[i]) > -GROUNDS_TOLERANCE);
        }
        if (round == 2)
            check_ok(support_expand(network));
    }
    mspring_network_destroy(network);
}

static void implicit_contact_gives_no_energy(void **state) {
    (void)state;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i += ROUNDS_ARE_FEW ? 3 : 1) {
        contact_gives_no_energy(&implicit_ways[i], 0, 1.0 / 64, 0.01);
        contact_gives_no_energy(&implicit_ways[i], 0.5, 1.0 / 64, 0.01);
    }
    // In steps as long as these, in which the bar turns by 2 degrees, methods of second order gain energy in the
    // air.
    contact_gives_no_energy(&(grounds_way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1}, 0.5, 1.0 / 15,
                            0.05);
    contact_gives_no_energy(&(grounds_way){MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, 1}, 0.5, 1.0 / 15,
                            0.05);
}

static void check_bits(const grounds_way *how, const mspring_floor_def *def, uint32_t steps) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    uint64_t first = 0;
    for (uint32_t run = 0; run < level_count + 2; run++) {
        const mspring_simd simd = run < level_count ? levels[run] : MSPRING_SIMD_AUTO;
        mspring_network *network = bar(0.5, run < level_count ? 1 : run - level_count + 2, simd);
        if (how)
            grounds_step_by(network, how);
        check_ok(mspring_network_set_floor(network, def));
        support_steps(network, steps, 1.0 / 64);
        first = run == 0 ? support_hash(network) : first;
        assert_true(support_hash(network) == first);
        mspring_network_destroy(network);
    }
}

static void levels_and_workers_agree(void **state) {
    (void)state;
    static ground grounds[6];
    (void)grounds_make(grounds, 0, 0);
    grounds[4].def.planes = grounds[4].planes;
    grounds[4].def.heights = grounds[4].heights;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i++)
        check_bits(&implicit_ways[i], &grounds[4].def, 60);
    check_bits(NULL, &grounds[4].def, 100);
}

/// A floor that is never reached changes no bit.
static void far_floors_change_nothing(void **state) {
    (void)state;
    mspring_network *with = bar(60, 1, MSPRING_SIMD_AUTO), *without = bar(60, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = grounds_level(1, 1);
    check_ok(mspring_network_set_floor(with, &def));
    support_steps(with, 100, 1.0 / 64);
    support_steps(without, 100, 1.0 / 64);
    assert_true(support_hash(with) == support_hash(without));
    // And one that is taken away is gone.
    check_ok(mspring_network_set_floor(with, NULL));
    support_steps(with, 300, 1.0 / 64);
    support_steps(without, 300, 1.0 / 64);
    assert_true(support_hash(with) == support_hash(without));
    mspring_network_destroy(with);
    mspring_network_destroy(without);
}

/// A step that is refused leaves the impulses of the one before.
static void refused_steps_leave_impulses(void **state) {
    (void)state;
    const grounds_way ways[] = {{MSPRING_SOLVER_EXPLICIT, 0, 40}, {MSPRING_SOLVER_IMPLICIT, 0, 1}};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = bar(0.01, 1, MSPRING_SIMD_AUTO);
        mspring_floor_def def = grounds_level(0.5f, 0);
        static float before[800], after[800];
        float sum = 0;
        grounds_step_by(network, &ways[i]);
        check_ok(mspring_network_set_floor(network, &def));
        support_steps(network, 100, 1.0 / 64);
        check_ok(mspring_network_get_columns(network, NULL, 0, 400,
                                             (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, before},
                                                                      {MSPRING_FLOOR_IMPULSE_Y, 1, before + 400}},
                                             2));
        for (int p = 0; p < 400; p++) {
            sum += before[400 + p];
        }
        assert_true(sum > 0);
        check_ok(mspring_network_apply_force(network, 3, 0, 1e15f));
        check_error(mspring_network_step(network, 1.0 / 64), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_get_columns(network, NULL, 0, 400,
                                             (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, after},
                                                                      {MSPRING_FLOOR_IMPULSE_Y, 1, after + 400}},
                                             2));
        assert_memory_equal(before, after, sizeof before);
        mspring_network_destroy(network);
    }
}

/// The coarse matrix has contacts in it if the snapshot says so, whatever came after it.
static void snapshots_do_not_see_later_contacts(void **state) {
    (void)state;
    mspring_network *network = bar(3, 1, MSPRING_SIMD_AUTO);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    solver.coarse_period = 8;
    check_ok(support_set_solver(network, &solver));
    mspring_floor_def def = grounds_level(0.3f, 0);
    check_ok(mspring_network_set_floor(network, &def));
    support_steps(network, 5, 1.0 / 64);
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    void *snapshot = malloc(size);
    assert_non_null(snapshot);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
    support_steps(network, 3, 1.0 / 64);
    const uint64_t hash = support_hash(network);
    support_steps(network, 300, 1.0 / 64);
    check_ok(mspring_network_load(network, snapshot, size));
    support_steps(network, 3, 1.0 / 64);
    assert_true(support_hash(network) == hash);
    free(snapshot);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bars_lie_still_explicitly),
        cmocka_unit_test(bars_lie_still_implicitly),
        cmocka_unit_test(bars_slide_explicitly),
        cmocka_unit_test(bars_slide_implicitly),
        cmocka_unit_test(explicit_contact_gives_no_energy),
        cmocka_unit_test(implicit_contact_gives_no_energy),
        cmocka_unit_test(compaction_keeps_the_floor),
        cmocka_unit_test(levels_and_workers_agree),
        cmocka_unit_test(far_floors_change_nothing),
        cmocka_unit_test(refused_steps_leave_impulses),
        cmocka_unit_test(snapshots_do_not_see_later_contacts),
    };
    return cmocka_run_group_tests_name("floor_bars", tests, NULL, NULL);
}
