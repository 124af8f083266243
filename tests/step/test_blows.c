/// @file test_blows.c
/// Forces in the first substep of a step: they act as those of a hook which adds them in substep 0 alone, in every
/// solver, and whatever the step does.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "archives.h"
#include "snapshots.h"
#include "support.h"

enum { WIDTH = 17, SUBSTEPS = 6, MOST = 400 };
#define DT (1.0 / 64)

typedef struct blow {
    float x[MOST], y[MOST];
    bool is_due; ///< for the hook: in this step
} blow;

static void strike(const mspring_hook_args *args, void *user) {
    const blow *of = user;
    if (!of->is_due || args->substep > 0)
        return;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        const mspring_id id = args->particle_of_slot[slot];
        if (id != MSPRING_NONE) {
            args->force_x[slot] += of->x[id];
            args->force_y[slot] += of->y[id];
        }
    }
}

/// A lattice and a rope; the lattice stands on a floor, if there is one.
static mspring_network *scene(mspring_solver solver, mspring_integrator integrator, bool has_floor) {
    mspring_builder *builder = support_builder();
    mspring_id ids[2][WIDTH];
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < WIDTH; i++)
            ids[row][i] = support_particle(builder, i, row, 1);
    for (int i = 0; i < WIDTH; i++) {
        (void)support_spring(builder, ids[0][i], ids[1][i], 4000, 4);
        for (int row = 0; i > 0 && row < 2; row++) {
            (void)support_spring(builder, ids[row][i - 1], ids[row][i], 4000, 4);
            (void)support_spring(builder, ids[row][i - 1], ids[1 - row][i], 4000, 4);
        }
    }
    mspring_id last = support_pinned(builder, 30, 3, 1);
    for (int i = 1; i < 20; i++) {
        const mspring_id next = support_particle(builder, 30 + i, 3, 1);
        (void)support_spring(builder, last, next, 3000, 1);
        last = next;
    }
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.spare_particles = 4;
    def.spare_springs = 4;
    mspring_network *network = support_network(builder, &def);
    mspring_settings settings = support_settings(network);
    settings.solver = solver;
    settings.integrator = integrator;
    settings.guard = support_guard_of(solver);
    check_ok(mspring_network_set_settings(network, &settings));
    if (has_floor) {
        mspring_floor_def floor;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        const double plane[4] = {0, -0.1, 0, 1};
        floor.planes = plane;
        floor.plane_count = 1;
        check_ok(mspring_network_set_floor(network, &floor));
    }
    return network;
}

static blow random_blow(uint64_t seed, double size) {
    blow made = {.is_due = false};
    for (int i = 0; i < MOST; i++) {
        made.x[i] = (float)support_random_between(&seed, -size, size);
        made.y[i] = (float)support_random_between(&seed, -size, size);
    }
    return made;
}

static mspring_result push(mspring_network *network, const blow *of) {
    return mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, NULL, 0,
                                        mspring_network_count(network, MSPRING_PARTICLES), of->x, of->y, 1);
}

/// Steps of two networks, of which one is struck by its host and the other by a hook, in every third step.
static void check_equal(mspring_network *struck, mspring_network *hooked, blow *of, uint32_t steps,
                        double tolerance) {
    check_ok(support_add_hook(hooked, MSPRING_PHASE_BEFORE_SUBSTEP, strike, of, NULL));
    for (uint32_t step = 0; step < steps; step++) {
        of->is_due = step % 3 == 0;
        if (of->is_due)
            check_ok(push(struck, of));
        const mspring_result a = mspring_network_step(struck, DT), b = mspring_network_step(hooked, DT);
        assert_int_equal(a, b);
        const double distance = support_distance(struck, hooked);
        if (!(distance <= tolerance))
            fail_msg("step %u: %g m apart", step, distance);
    }
    assert_true(fabs(support_velocity(struck, 5).x) > 0.01);
    mspring_network_destroy(struck);
    mspring_network_destroy(hooked);
}

static const struct {
    mspring_solver solver;
    mspring_integrator integrator;
} solvers[] = {
    {MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_EULER}, {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER},
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2},  {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA},
    {MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER},   {MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA},
};

static void blows_are_as_those_of_a_hook(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++)
        for (int has_floor = 0; has_floor < 2; has_floor++) {
            blow of = random_blow(7 + i, 600);
            check_equal(scene(solvers[i].solver, solvers[i].integrator, has_floor),
                        scene(solvers[i].solver, solvers[i].integrator, has_floor), &of, 60, 1e-4);
        }
}

// With other forces on the whole step, and with hooks of any period, whose forces act on.
static void drag(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++)
        if (args->particle_of_slot[slot] != MSPRING_NONE) {
            args->force_x[slot] -= 3 * args->vx[slot];
            args->force_y[slot] -= 3 * args->vy[slot];
        }
}

static void others_act_beside_them(void **state) {
    (void)state;
    for (uint32_t period = 1; period < 5; period++) {
        blow of = random_blow(17 + period, 600), held = random_blow(20, 5);
        mspring_network *networks[2] = {scene(MSPRING_SOLVER_EXPLICIT, 0, false),
                                        scene(MSPRING_SOLVER_EXPLICIT, 0, false)};
        check_ok(support_add_hook(networks[1], MSPRING_PHASE_BEFORE_SUBSTEP, strike, &of, NULL));
        for (int i = 0; i < 2; i++) {
            mspring_hook_def def;
            check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
            def.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
            def.period = period;
            def.fn = drag;
            check_ok(mspring_network_add_hook(networks[i], &def, NULL));
        }
        for (int step = 0; step < 40; step++) {
            of.is_due = step % 2 == 0;
            for (int i = 0; i < 2 && step % 3 == 0; i++)
                check_ok(mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, NULL, 0, WIDTH, held.x,
                                                      held.y, 1));
            if (of.is_due)
                check_ok(push(networks[0], &of));
            support_steps(networks[0], 1, DT);
            support_steps(networks[1], 1, DT);
            assert_true(support_distance(networks[0], networks[1]) < 1e-4);
        }
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
    }
}

// On a free particle: m v = F h, added up, once. (The first explicit substep of all is a half one for velocities,
// so a step comes before.)
static void the_impulse_is_force_times_substep(void **state) {
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        mspring_builder *builder = support_builder();
        const mspring_id p = support_particle(builder, 0, 0, 2);
        mspring_network_def def = support_def(0, 4);
        mspring_network *network = support_network(builder, &def);
        mspring_settings settings = support_settings(network);
        settings.solver = i == 0 ? MSPRING_SOLVER_EXPLICIT : MSPRING_SOLVER_IMPLICIT;
        settings.integrator = MSPRING_INTEGRATOR_EULER; // others spread a force over the next substeps
        check_ok(mspring_network_set_settings(network, &settings));
        const float x = 10, y = -6;
        const mspring_id twice[] = {p, p};
        support_steps(network, 1, 0.5);
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, twice, 0, 2, &x, &y, 0));
        support_steps(network, 1, 0.5);
        check_near(support_velocity(network, p).x, 2 * 10 / 2.0 * 0.125, 1e-6);
        check_near(support_velocity(network, p).y, 2 * -6 / 2.0 * 0.125, 1e-6);
        check_near(support_position(network, p).x, 2 * 10 / 2.0 * 0.125 * 0.5, 1e-6);
        support_steps(network, 3, 0.5);
        check_near(support_velocity(network, p).x, 2 * 10 / 2.0 * 0.125, 1e-6);
        mspring_network_destroy(network);
    }
}

// An attempt that the guard rejects is made again, with shorter substeps, by the fallback or clamped: as with a
// hook.
static void attempts_are_repeated_with_them(void **state) {
    (void)state;
    const mspring_guard guards[] = {MSPRING_GUARD_GROWTH, MSPRING_GUARD_RETRY, MSPRING_GUARD_IMPLICIT,
                                    MSPRING_GUARD_CLAMP, MSPRING_GUARD_CLAMP_BOUNDS};
    for (size_t g = 0; g < COUNT_OF(guards); g++) {
        mspring_network *networks[2];
        blow of = random_blow(91 + g, 30000);
        for (int i = 0; i < 2; i++) {
            networks[i] = scene(MSPRING_SOLVER_EXPLICIT, 0, false);
            mspring_settings settings = support_settings(networks[i]);
            settings.guard = guards[g];
            settings.substeps = 2;
            check_ok(mspring_network_set_settings(networks[i], &settings));
        }
        check_equal(networks[0], networks[1], &of, 12, 1e-2);
    }
}

// A step that fails leaves them for the next one.
static void a_failed_step_keeps_them(void **state) {
    (void)state;
    mspring_network *network = scene(MSPRING_SOLVER_EXPLICIT, 0, false), *other;
    blow of = random_blow(5, 300);
    mspring_clone_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
    check_ok(push(network, &of));
    check_ok(mspring_network_clone(network, &def, &other));
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    support_steps(network, 1, DT);
    support_steps(other, 1, DT);
    assert_int_equal(support_hash(network), support_hash(other));
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}

// What is copied, saved or moved before the step has them, too; what is removed has none.
static void copies_have_them(void **state) {
    (void)state;
    mspring_network *network = scene(MSPRING_SOLVER_EXPLICIT, 0, true),
                    *fresh = scene(MSPRING_SOLVER_EXPLICIT, 0, true), *clone;
    blow of = random_blow(6, 300);
    mspring_clone_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
    support_steps(network, 3, DT);
    check_ok(push(network, &of));
    check_ok(mspring_network_clone(network, &def, &clone));
    mspring_network *read = archives_check_same(network, 1);
    saved all = snapshots_save(network, MSPRING_SNAPSHOT_ALL),
          frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    snapshots_load(fresh, &all);
    support_steps(network, 2, DT);
    support_steps(clone, 2, DT);
    support_steps(read, 2, DT);
    support_steps(fresh, 2, DT);
    const uint64_t hash = support_hash(network);
    assert_true(support_hash(clone) == hash && support_hash(read) == hash && support_hash(fresh) == hash);
    snapshots_load(network, &frame);
    support_steps(network, 2, DT);
    assert_int_equal(support_hash(network), hash);
    // A snapshot without such forces takes them away.
    saved none = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    support_steps(clone, 1, DT);
    check_ok(push(network, &of));
    snapshots_load(network, &none);
    support_steps(network, 1, DT);
    assert_int_equal(support_hash(network), support_hash(clone));
    free(none.bytes);
    free(all.bytes);
    free(frame.bytes);
    mspring_network_destroy(read);
    mspring_network_destroy(fresh);
    mspring_network_destroy(clone);
    mspring_network_destroy(network);
}

static void another_layout_has_them(void **state) {
    (void)state;
    mspring_network *network = scene(MSPRING_SOLVER_EXPLICIT, 0, false), *clone;
    blow of = random_blow(8, 300);
    mspring_clone_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    for (mspring_id s = 0; s < springs; s += 5)
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    check_ok(push(network, &of));
    check_ok(mspring_network_clone(network, &def, &clone));
    check_ok(mspring_network_compact(clone));
    support_steps(network, 3, DT);
    support_steps(clone, 3, DT);
    assert_true(support_distance(network, clone) < 1e-4);
    mspring_network_destroy(clone);
    mspring_network_destroy(network);
}

// They wake what sleeps, which then falls asleep again.
static void they_wake(void **state) {
    (void)state;
    mspring_network *network = scene(MSPRING_SOLVER_EXPLICIT, 0, true);
    mspring_settings settings = support_settings(network);
    settings.sleep_speed = 0.5f;
    settings.global_damping = 4;
    check_ok(mspring_network_set_settings(network, &settings));
    support_fall_asleep(network, DT);
    const mspring_id p = 5;
    const float x = 0, y = 20000;
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, &p, 0, 1, &x, &y, 1));
    support_steps(network, 1, DT);
    assert_true(support_velocity(network, p).y > 1);
    support_fall_asleep(network, DT);
    mspring_network_destroy(network);
}

static void bad_ones_are_refused(void **state) {
    (void)state;
    mspring_network *network = scene(MSPRING_SOLVER_EXPLICIT, 0, false);
    const uint64_t hash = support_hash(network);
    const float good = 3e38f, bad[] = {NAN, INFINITY};
    const mspring_id nobody = 100000;
    for (size_t i = 0; i < COUNT_OF(bad); i++)
        check_error(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, NULL, 0, 2, &bad[i], &good, 0),
                    MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, &nobody, 0, 1, &good, &good, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_apply_forces(network, (mspring_push)3, NULL, 0, 1, &good, &good, 1),
                MSPRING_ERROR_ARGUMENT);
    // Sums that are not finite: at once, or with forces of the whole step, in the step.
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, NULL, 0, 1, &good, &good, 1));
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_SUBSTEP, NULL, 0, 1, &good, &good, 1),
                MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 1, &good, &good, 1));
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_hash(network), hash);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blows_are_as_those_of_a_hook),
        cmocka_unit_test(others_act_beside_them),
        cmocka_unit_test(the_impulse_is_force_times_substep),
        cmocka_unit_test(attempts_are_repeated_with_them),
        cmocka_unit_test(a_failed_step_keeps_them),
        cmocka_unit_test(copies_have_them),
        cmocka_unit_test(another_layout_has_them),
        cmocka_unit_test(they_wake),
        cmocka_unit_test(bad_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
