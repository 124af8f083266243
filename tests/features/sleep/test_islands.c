/// @file test_islands.c
/// Islands that sleep one by one: what is awake moves as if nothing slept, what sleeps does not move at all, and
/// each wakes for itself.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "changes.h"
#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/* ------------------------------------------------------------------------------------------- two and a rope */

enum { IN_A = 12, IN_A_SPRING = 50, IN_B = 80 + 12, ROPE = 160, LOOSE = 172 };

/// Two lattices of 20 by 4, a rope from one to the other of which one spring is broken, and a loose particle.
static mspring_network *make_two_guarded(mspring_solver solver, mspring_guard guard, mspring_id *broken) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1000, 1000}, .damping = {3, 3}};
    recipe made = {0};
    recipe_lattice(&made, 20, 4, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 20, 4, 30, 0, 1, &stuff, &seed);
    *broken = made.spring_count + 5;
    recipe_rope(&made, 19, 80, 13, &stuff, &seed);
    assert_int_equal(recipe_particle(&made, 60, 10, 1, 0), LOOSE);
    const uint32_t substeps = guard == MSPRING_GUARD_RETRY ? MSPRING_SUBSTEPS_AUTO : 8;
    mspring_network_def def = support_def(0, solver == MSPRING_SOLVER_EXPLICIT ? substeps : 1);
    def.settings.solver = solver;
    def.settings.guard = guard;
    def.settings.global_damping = 6;
    def.settings.sleep_speed = 0.02f;
    def.settings.sleep_time = 0.25f;
    mspring_network *network = recipe_network(&made, &def);
    check_ok(mspring_network_break_springs(network, broken, 0, 1));
    recipe_free(&made);
    support_fall_asleep(network, DT);
    return network;
}

static mspring_network *make_two(mspring_solver solver, mspring_id *broken) {
    return make_two_guarded(solver, MSPRING_GUARD_GROWTH, broken);
}

static uint32_t slot_of(const mspring_hook_args *args, mspring_id particle) {
    uint32_t slot = 0;
    while (args->particle_of_slot[slot] != particle) {
        slot++;
    }
    return slot;
}

static void move_in_hook(const mspring_hook_args *args, void *user) {
    (void)user;
    args->x[slot_of(args, IN_A)] += 0.001f;
    args->vx[slot_of(args, IN_A)] += 0.1f;
}

static void hook(mspring_network *network) {
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, move_in_hook, NULL, NULL));
}

static void each_wakes_for_itself(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        for (size_t i = 0; i <= CHANGE_COUNT; i++) {
            mspring_id broken;
            mspring_network *network = make_two(solver, &broken);
            const support_point b = support_position(network, IN_B);
            if (i < CHANGE_COUNT) {
                changes[i].make(network, IN_A, IN_A_SPRING);
            } else {
                hook(network);
            }
            support_steps(network, 1, DT);
            if (support_sleeps(network, IN_A) || !support_sleeps(network, IN_B) ||
                !support_sleeps(network, LOOSE) || support_is_asleep(network)) {
                print_error("%s\n", i < CHANGE_COUNT ? changes[i].name : "hook");
                fail();
            }
            support_steps(network, 3, DT);
            check_near(support_position(network, IN_B).x, b.x, 0);
            check_near(support_position(network, IN_B).y, b.y, 0);
            assert_int_equal(support_sleeps(network, IN_B), 1);
            mspring_network_destroy(network);
        }
    }
}

/// Values of all springs, sent by range or by list, wake only those that they are new to.
static void values_of_all_wake_whom_they_change(void **state) {
    (void)state;
    const mspring_property properties[] = {MSPRING_STIFFNESS, MSPRING_DAMPING, MSPRING_REST_LENGTH,
                                           MSPRING_BREAK_STRAIN};
    for (size_t i = 0; i < 3 * COUNT_OF(properties); i++) {
        const mspring_property property = properties[i / 3];
        float values[1024];
        mspring_id broken, ids[1024];
        mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
        const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
        assert_true(count < COUNT_OF(values));
        for (mspring_id s = 0; s < count; s++) {
            ids[s] = count - 1 - s;
            values[s] = 2;
        }
        if (property == MSPRING_BREAK_STRAIN) {
            check_ok(mspring_network_set(network, property, NULL, 0, count, values, 1));
            support_fall_asleep(network, DT);
        }
        check_ok(mspring_network_get(network, property, i % 3 == 2 ? ids : NULL, 0, count, values, 1));
        values[i % 3 == 2 ? count - 1 - IN_A_SPRING : IN_A_SPRING] *= 1.01f;
        for (int again = 0; again <= (int)(i % 3 == 1); again++) { // the second call compares with the first
            check_ok(mspring_network_set(network, property, i % 3 == 2 ? ids : NULL, 0, count, values, 1));
        }
        support_steps(network, 1, DT);
        assert_true(support_sleeps(network, IN_B));
        assert_true(property == MSPRING_BREAK_STRAIN || !support_sleeps(network, IN_A));
        mspring_network_destroy(network);
    }
}

/// Both that share a vector, when both are moved at once.
static void neighbours_in_a_vector_wake_together(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    // The rope's halves hang on A and B.
    const uint32_t a = view.slot_of_particle[ROPE + 4], b = view.slot_of_particle[ROPE + 5];
    assert_int_equal(a / 16, b / 16);
    support_shift(network, ROPE + 4, 0.01, 0);
    support_shift(network, ROPE + 5, 0.01, 0);
    support_steps(network, 1, DT);
    assert_int_equal(support_sleeps(network, IN_A) + support_sleeps(network, IN_B), 0);
    assert_int_equal(support_sleeps(network, LOOSE), 1);
    mspring_network_destroy(network);
}

/// Though it moves nothing: the spring has its rest length as it is.
static void a_ramp_keeps_its_island_awake(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
    const mspring_id spring = IN_A_SPRING;
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    support_fall_asleep(network, DT);
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 2));
    support_steps(network, 100, DT);
    assert_int_equal(support_sleeps(network, IN_A), 0);
    assert_int_equal(support_sleeps(network, IN_B), 1);
    support_steps(network, 28 + 16 + 1, DT); // to the end of the ramp, and for the time of falling asleep
    assert_int_equal(support_sleeps(network, IN_A), 1);
    mspring_network_destroy(network);
}

/// What wakes has no past: the implicit solver finds nothing of the motion before.
static void what_wakes_was_at_rest(void **state) {
    (void)state;
    for (mspring_integrator integrator = MSPRING_INTEGRATOR_ALPHA; integrator <= MSPRING_INTEGRATOR_EULER;
         integrator++) {
        mspring_builder *builder = support_builder();
        support_particle(builder, 0, 0, 1);
        support_particle(builder, 10, 0, 1);
        mspring_network_def def = support_def(0, 1);
        def.settings.global_damping = 4; // an acceleration to be remembered
        def.settings.sleep_speed = 0.5f;
        def.settings.sleep_time = 0.25f;
        mspring_network *network = support_network(builder, &def);
        mspring_settings solver;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
        solver.solver = MSPRING_SOLVER_IMPLICIT;
        solver.integrator = integrator;
        check_ok(support_set_solver(network, &solver));
        // One is slow enough to fall asleep as it goes, the other never sleeps.
        support_kick(network, 0, 0.4f);
        support_kick(network, 1, 3);
        for (int i = 0; i < 100 && !support_sleeps(network, 0); i++) {
            support_steps(network, 1, DT);
        }
        const support_point at = support_position(network, 0);
        check_ok(mspring_network_wake(network));
        support_steps(network, 1, DT);
        assert_int_equal(support_sleeps(network, 0), 0);
        check_near(support_position(network, 0).x, at.x, 0);
        check_near(support_position(network, 0).y, at.y, 0);
        mspring_network_destroy(network);
    }
}

/// The local origin moves along with what is awake; what sleeps stays where it is in the world, and asleep.
static void the_origin_moves_on_without_waking(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 80, 0, 1);
    support_particle(builder, 200, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.settings.sleep_speed = 0.1f;
    def.settings.sleep_time = 0.25f;
    mspring_network *network = support_network(builder, &def);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    const double origin = view.origin_x;
    support_kick(network, 0, 100);
    support_steps(network, 90, DT); // the origin goes along once it is 64 m from it, and past the other
    check_ok(mspring_network_get_view(network, &view));
    assert_true(view.origin_x > origin + 50);
    support_kick(network, 0, -100);
    support_steps(network, 2, DT);
    assert_int_equal(support_sleeps(network, 1), 1);
    check_near(support_position(network, 1).x, 200, 0);
    mspring_network_destroy(network);
}

/// Masses of what is awake are the new ones at once, though something sleeps beside it.
static void masses_of_what_is_awake_count_at_once(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken), *awake = NULL;
    check_ok(mspring_network_clone(network, NULL, &awake));
    mspring_network *const both[] = {network, awake};
    const float heavy = 20;
    for (int step = 0; step < 8; step++) {
        for (int i = 0; i < 2; i++) {
            if (step == 0) {
                support_kick(both[i], IN_B, 4);
            } else if (step == 4) {
                check_ok(mspring_network_set(both[i], MSPRING_MASS, NULL, IN_B, 1, &heavy, 1));
            }
        }
        check_ok(mspring_network_wake(awake));
        support_steps(network, 1, DT);
        support_steps(awake, 1, DT);
        check_near(support_position(network, IN_B).x, support_position(awake, IN_B).x, 0);
        check_near(support_position(network, IN_B).y, support_position(awake, IN_B).y, 0);
    }
    assert_int_equal(support_sleeps(network, IN_A), 1);
    mspring_network_destroy(network);
    mspring_network_destroy(awake);
}

/// A spring that joins two islands wakes both; from then on they are one.
static void joining_wakes_both(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
    check_ok(mspring_network_restore_springs(network, &broken, 0, 1, 0));
    assert_int_equal(support_sleeps(network, IN_A) + support_sleeps(network, IN_B), 0);
    assert_int_equal(support_sleeps(network, LOOSE), 1);
    support_fall_asleep(network, DT);
    support_kick(network, IN_A, 1);
    support_steps(network, 1, DT);
    assert_int_equal(support_sleeps(network, IN_A) + support_sleeps(network, IN_B), 0);
    // Parted again, each sleeps by itself.
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    support_fall_asleep(network, DT);
    support_kick(network, IN_B, 1);
    support_steps(network, 1, DT);
    assert_int_equal(support_sleeps(network, IN_A), 1);
    assert_int_equal(support_sleeps(network, IN_B), 0);
    mspring_network_destroy(network);
}

/// A hook that gives a sleeper a velocity moves it no further in this step, whatever else is in its vectors.
static void push_in_hook(const mspring_hook_args *args, void *user) {
    bool *once = user;
    if (!*once) {
        *once = true;
        args->vx[slot_of(args, ROPE + 4)] = 5;
    }
}

static void sleepers_stay_until_the_step_is_over(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
    bool once = true;
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, push_in_hook, &once, NULL));
    // The rope's two halves share a vector: the one on B's side moves.
    support_kick(network, ROPE + 5, 1);
    support_steps(network, 1, DT);
    assert_int_equal(support_sleeps(network, ROPE + 4), 1);
    const support_point before = support_position(network, ROPE + 4);
    once = false;
    support_steps(network, 1, DT);
    assert_int_equal(support_sleeps(network, ROPE + 4), 0);
    check_near(support_position(network, ROPE + 4).x, before.x, 0);
    support_steps(network, 1, DT);
    assert_true(support_position(network, ROPE + 4).x > before.x + 0.01);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------- going on elsewhere */

/// Saved, cloned or compacted with one asleep, whatever is about to wake it, it goes on as it would have.
static void snapshots_and_clones_go_on(void **state) {
    (void)state;
    static const change_fn last[] = {NULL, change_push, change_shift, change_write_view, change_fill, change_break};
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
        for (size_t c = 0; c < COUNT_OF(last); c++) {
            mspring_id broken;
            mspring_network *network = make_two(solver, &broken), *other = make_two(solver, &broken), *clone = NULL;
            support_kick(network, IN_B, 4);
            support_steps(network, 3, DT);
            if (last[c]) {
                last[c](network, IN_A, IN_A_SPRING);
            }
            support_bring(network, other, MSPRING_SNAPSHOT_ALL);
            check_ok(mspring_network_clone(network, NULL, &clone));
            mspring_network *const all[] = {network, other, clone};
            uint64_t prints[3] = {0};
            for (int i = 0; i < 3; i++) {
                for (int frame = 0; frame < 100; frame++) {
                    support_steps(all[i], 1, DT);
                    prints[i] = prints[i] * 31 + support_hash(all[i]) + (uint64_t)support_sleeps(all[i], IN_A) +
                                (uint64_t)support_sleeps(all[i], IN_B) * 2;
                }
                mspring_network_destroy(all[i]);
            }
            assert_int_equal(prints[0], prints[1]);
            assert_int_equal(prints[0], prints[2]);
        }
    }
}

static void what_sleeps_sleeps_on_in_another_layout(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
        mspring_id broken;
        mspring_network *network = make_two(solver, &broken);
        support_kick(network, IN_B, 4);
        support_steps(network, 1, DT);
        const uint64_t before = support_hash(network);
        check_ok(mspring_network_compact(network));
        assert_int_equal(support_hash(network), before);
        assert_int_equal(support_sleeps(network, IN_A), 1);
        assert_int_equal(support_sleeps(network, IN_B), 0);
        const support_point a = support_position(network, IN_A), b = support_position(network, IN_B);
        support_steps(network, 5, DT);
        check_near(support_position(network, IN_A).x, a.x, 0);
        assert_true(support_position(network, IN_B).x != b.x);
        assert_int_equal(support_sleeps(network, IN_A), 1);
        check_ok(support_expand(network));
        support_steps(network, 1, DT);
        assert_int_equal(support_sleeps(network, IN_A), 1);
        support_fall_asleep(network, DT);
        mspring_network_destroy(network);
    }
}

/// A force under which it fell asleep, and masses set for others, are no news in another layout.
static void forces_and_masses_are_those_of_before(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
    const float none = 0, mass = 5;
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, 1, &none, 1)); // A's corner is held
    for (int i = 0; i < 3000 && !support_is_asleep(network); i++) {
        check_ok(mspring_network_apply_force(network, IN_A, 10, 0));
        support_steps(network, 1, DT);
    }
    assert_int_equal(support_is_asleep(network), 1);
    check_ok(mspring_network_compact(network));
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, IN_B, 1, &mass, 1));
    check_ok(mspring_network_apply_force(network, IN_A, 10, 0));
    support_steps(network, 1, DT);
    assert_int_equal(support_sleeps(network, IN_A), 1);
    assert_int_equal(support_sleeps(network, IN_B), 0);
    support_steps(network, 1, DT); // without the force
    assert_int_equal(support_sleeps(network, IN_A), 0);
    mspring_network_destroy(network);
}

/// A step that goes wrong for one wakes nobody, and leaves all where they were.
static void a_step_that_goes_wrong_wakes_nobody(void **state) {
    (void)state;
    for (int hooked = 0; hooked < 2; hooked++) {
        mspring_id broken;
        mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken);
        bool once = true;
        if (hooked) {
            check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, push_in_hook, &once, NULL));
        }
        support_kick(network, IN_B, 1);
        support_steps(network, 2, DT);
        const uint64_t before = support_hash(network);
        check_ok(mspring_network_apply_force(network, LOOSE, 0, 1e30f));
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
        assert_int_equal(support_hash(network), before);
        assert_int_equal(support_sleeps(network, LOOSE) + support_sleeps(network, IN_A), 2);
        check_ok(mspring_network_apply_force(network, LOOSE, 0, -1e30f));
        support_steps(network, 1, DT);
        assert_int_equal(support_sleeps(network, LOOSE) + support_sleeps(network, IN_A), 2);
        mspring_network_destroy(network);
    }
}

/// What was about to wake is that still after a step that is refused, before it is taken or after, however often it
/// was tried: the network goes on as one that was not asked.
static void check_refused_step(mspring_guard guard, change_fn disturb, double dt, bool one_is_awake) {
    mspring_id broken;
    mspring_network *network = make_two_guarded(MSPRING_SOLVER_EXPLICIT, guard, &broken), *other = NULL;
    check_ok(support_set_global_damping(network, 0)); // over such times all would come to rest
    if (one_is_awake) {
        support_kick(network, LOOSE, 1);
        support_steps(network, 1, DT);
    }
    disturb(network, IN_A, IN_A_SPRING);
    check_ok(mspring_network_clone(network, NULL, &other));
    const uint64_t before = support_hash(network);
    const uint32_t whole = support_is_asleep(network);
    const uint8_t a = support_sleeps(network, IN_A);
    const bool taken = mspring_network_step(network, dt) == MSPRING_OK;
    assert_true(!taken || guard >= MSPRING_GUARD_IMPLICIT);
    if (!taken) {
        assert_int_equal(support_hash(network), before);
        assert_int_equal(support_is_asleep(network), whole);
        assert_int_equal(support_sleeps(network, IN_A), a);
    }
    for (int step = 0; step < 3 && !taken; step++) {
        support_steps(network, 1, DT);
        support_steps(other, 1, DT);
        assert_int_equal(support_sleeps(network, IN_A), 0);
        assert_int_equal(support_sleeps(network, IN_B), 1);
        assert_int_equal(support_hash(network), support_hash(other));
    }
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

static void a_refused_step_leaves_no_trace(void **state) {
    (void)state;
    for (mspring_guard guard = MSPRING_GUARD_GROWTH; guard <= MSPRING_GUARD_CLAMP_BOUNDS; guard++) {
        for (size_t i = 0; i < CHANGE_COUNT; i++) {
            // Substeps that are no normal float, and some that throw everything beyond all bounds.
            check_refused_step(guard, changes[i].make, 1e-40, false);
            check_refused_step(guard, changes[i].make, 1e30, false);
            check_refused_step(guard, changes[i].make, 1e30, true);
        }
    }
}

/// Strain of what sleeps is not looked at, and nothing is missed by that.
static void events_are_those_of_what_is_awake(void **state) {
    (void)state;
    mspring_id broken;
    mspring_network *network = make_two(MSPRING_SOLVER_EXPLICIT, &broken), *awake = NULL;
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    check_ok(mspring_network_reserve_events(network, 1000));
    for (mspring_id s = 0; s < springs; s++) {
        const float stress = 0.02f, breaking = 0.3f;
        check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, s, 1, &stress, 1));
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, s, 1, &breaking, 1));
    }
    support_fall_asleep(network, DT);
    check_ok(mspring_network_clone(network, NULL, &awake));
    support_kick(network, IN_B, 30);
    support_kick(awake, IN_B, 30);
    uint32_t total = 0;
    for (int i = 0; i < 60; i++) {
        check_ok(mspring_network_wake(awake));
        support_steps(network, 1, DT);
        support_steps(awake, 1, DT);
        mspring_event a[1000], b[1000];
        uint32_t count_a, count_b;
        check_ok(mspring_network_read_events(network, a, COUNT_OF(a), &count_a, NULL));
        check_ok(mspring_network_read_events(awake, b, COUNT_OF(b), &count_b, NULL));
        assert_int_equal(count_a, count_b);
        for (uint32_t e = 0; e < count_a; e++) {
            assert_int_equal(a[e].kind, b[e].kind);
            assert_int_equal(a[e].id, b[e].id);
        }
        total += count_a;
    }
    assert_int_equal(support_sleeps(network, IN_A), 1);
    assert_true(total > 0);
    mspring_network_destroy(network);
    mspring_network_destroy(awake);
}

/* ------------------------------------------------------------------------------------------------ the floor */

/// Wrecks that sleep on a floor are borne by it while a stone falls beside them.
static void the_floor_bears_sleepers(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
        mspring_id broken;
        mspring_network *network = make_two_guarded(solver, MSPRING_GUARD_GROWTH, &broken);
        const double level[4] = {0, -0.5, 0, 1};
        mspring_floor_def def;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
        def.planes = level;
        def.plane_count = 1;
        def.friction = 1;
        check_ok(mspring_network_set_floor(network, &def));
        check_ok(support_set_gravity(network, 0, -9.8f));
        for (int i = 0; i < 1500 && !(support_sleeps(network, IN_A) && support_sleeps(network, IN_B)); i++) {
            support_steps(network, 1, DT);
        }
        const double high = 100, there = 60;
        check_ok(mspring_network_set_positions(network, NULL, LOOSE, 1, &there, &high, 1));
        support_steps(network, 1, DT);
        float x[160], y[160];
        double sum = 0, weight = 0;
        for (int i = 0; i < 10; i++) {
            support_steps(network, 1, DT);
            assert_int_equal(support_sleeps(network, IN_A), 1);
            assert_int_equal(support_sleeps(network, LOOSE), 0);
            check_ok(mspring_network_get_columns(
                network, NULL, 0, 160,
                (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
            sum = weight = 0;
            for (mspring_id p = 0; p < 160; p++) {
                float mass;
                check_ok(mspring_network_get(network, MSPRING_MASS, NULL, p, 1, &mass, 1));
                sum += (double)y[p];
                weight += 9.8 * DT * (double)mass;
            }
            // The rope between them lies on it for itself, all but its ends.
            check_near(sum, weight, 0.1 * weight);
        }
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_wakes_for_itself),
        cmocka_unit_test(values_of_all_wake_whom_they_change),
        cmocka_unit_test(neighbours_in_a_vector_wake_together),
        cmocka_unit_test(a_ramp_keeps_its_island_awake),
        cmocka_unit_test(what_wakes_was_at_rest),
        cmocka_unit_test(the_origin_moves_on_without_waking),
        cmocka_unit_test(masses_of_what_is_awake_count_at_once),
        cmocka_unit_test(joining_wakes_both),
        cmocka_unit_test(sleepers_stay_until_the_step_is_over),
        cmocka_unit_test(snapshots_and_clones_go_on),
        cmocka_unit_test(what_sleeps_sleeps_on_in_another_layout),
        cmocka_unit_test(forces_and_masses_are_those_of_before),
        cmocka_unit_test(a_step_that_goes_wrong_wakes_nobody),
        cmocka_unit_test(a_refused_step_leaves_no_trace),
        cmocka_unit_test(events_are_those_of_what_is_awake),
        cmocka_unit_test(the_floor_bears_sleepers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
