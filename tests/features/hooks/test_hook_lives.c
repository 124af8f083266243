/// @file test_hook_lives.c
/// Hooks that refuse a step, and who owns what a hook points to: retain, release, and the release of tasks.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

#define DT 0.01

static mspring_network *mixed_network(uint32_t workers, mspring_solver solver) {
    recipe made = recipe_mixed(2);
    mspring_network_def def = support_def(-9.8f, 4);
    def.worker_count = workers;
    def.settings.solver = solver;
    def.settings.guard = MSPRING_GUARD_CLAMP;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

/* ----------------------------------------------------------------------------------------------------- refusals */

/// Refuses at its n-th call.
typedef struct refusal {
    uint32_t calls, at;
    mspring_result with;
} refusal;

static void spoil_and_refuse(const mspring_hook_args *args, void *user) {
    refusal *r = user;
    assert_int_equal(*args->result, MSPRING_OK);
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->phase != MSPRING_PHASE_BEFORE_SUBSTEP)
            args->vx[slot] += 1e-3f;
        if (args->force_x)
            args->force_x[slot] += 0.1f;
    }
    if (++r->calls == r->at)
        *args->result = r->with;
}

// The state, forces for the next step and events stay; the step that follows is that of a network in which none was
// refused.
static void check_refusal(mspring_solver solver, mspring_phase phase, uint32_t at) {
    mspring_network *network = mixed_network(1, solver), *calm = mixed_network(1, solver);
    mspring_network *both[] = {network, calm};
    refusal refuses = {.at = at, .with = MSPRING_ERROR_REFUSED}, never = {0};
    mspring_id hook;
    check_ok(support_add_hook(network, phase, spoil_and_refuse, &refuses, &hook));
    check_ok(support_add_hook(calm, phase, spoil_and_refuse, &never, NULL));
    for (int i = 0; i < 2; i++)
        check_ok(mspring_network_apply_force(both[i], 3, 5, -7));
    const uint64_t before = support_hash(network);
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_REFUSED);
    assert_int_equal(refuses.calls >= at, 1);
    assert_true(support_hash(network) == before);
    char part[32];
    (void)snprintf(part, sizeof part, "hook %u", (unsigned)hook);
    check_contains(mspring_network_error(network), part);
    const mspring_step_info info = support_step_info(network);
    assert_int_equal(info.result, MSPRING_ERROR_REFUSED);
    assert_int_equal(info.step_count, 0);
    assert_true(info.time == 0);
    refuses.at = 0;
    for (int i = 0; i < 2; i++)
        support_steps(both[i], 5, DT);
    assert_true(support_hash(network) == support_hash(calm));
    mspring_network_destroy(network);
    mspring_network_destroy(calm);
}

// Results that are none are refusals, too; and one that a guard would act on is none of its own.
static void refused_with_anything(void **state) {
    (void)state;
    const struct {
        int32_t with, given;
    } all[] = {{MSPRING_RESULT_INT, MSPRING_RESULT_INT},
               {INT32_MAX, MSPRING_ERROR_REFUSED},
               {1, MSPRING_ERROR_REFUSED},
               {-777, -777},
               {MSPRING_ERROR_LIMIT, MSPRING_ERROR_LIMIT},
               {MSPRING_ERROR_UNSTABLE, MSPRING_ERROR_UNSTABLE}};
    for (size_t i = 0; i < COUNT_OF(all); i++) {
        mspring_network *network = mixed_network(1, MSPRING_SOLVER_EXPLICIT);
        refusal refuses = {.at = 1, .with = (mspring_result)all[i].with};
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, spoil_and_refuse, &refuses, NULL));
        assert_int_equal(mspring_network_step(network, DT), all[i].given);
        assert_int_equal(refuses.calls, 1);
        mspring_network_destroy(network);
    }
}

static void refused_steps_are_rolled_back(void **state) {
    (void)state;
    for (int phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
        check_refusal(MSPRING_SOLVER_EXPLICIT, (mspring_phase)phase, 1);
        check_refusal(MSPRING_SOLVER_IMPLICIT, (mspring_phase)phase, 1);
        check_refusal(MSPRING_SOLVER_DIRECT, (mspring_phase)phase, 1);
    }
    check_refusal(MSPRING_SOLVER_EXPLICIT, MSPRING_PHASE_BEFORE_SUBSTEP, 3);
    check_refusal(MSPRING_SOLVER_EXPLICIT, MSPRING_PHASE_AFTER_SUBSTEP, 4);
}

static void set_result(const mspring_hook_args *args, void *user) {
    *args->result = *(const mspring_result *)user;
}

// A step returns what the hook set. Of several hooks the first counts. What is no error refuses, too.
static void steps_return_what_hooks_set(void **state) {
    (void)state;
    const mspring_result given[] = {MSPRING_ERROR_MEMORY, MSPRING_ERROR_REFUSED, MSPRING_ERROR_LIMIT, (mspring_result)7},
                         got[] = {MSPRING_ERROR_MEMORY, MSPRING_ERROR_REFUSED, MSPRING_ERROR_LIMIT,
                                  MSPRING_ERROR_REFUSED};
    for (size_t i = 0; i < COUNT_OF(given); i++) {
        mspring_network *network = mixed_network(1, MSPRING_SOLVER_EXPLICIT);
        mspring_result mine = given[i], later = MSPRING_ERROR_THREAD;
        mspring_id first, second;
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, set_result, &mine, &first));
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, set_result, &later, &second));
        check_error(mspring_network_step(network, DT), got[i]);
        mine = MSPRING_OK;
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_THREAD);
        check_ok(mspring_network_remove_hook(network, second));
        check_ok(mspring_network_step(network, DT));
        mspring_network_destroy(network);
    }
}

// Refuses in the range of particle 0 alone, or with another result in that of the last one.
static void refuse_by_range(const mspring_hook_args *args, void *user) {
    const uint32_t last = *(const uint32_t *)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] == 0)
            *args->result = MSPRING_ERROR_LIMIT;
        else if (args->particle_of_slot[slot] == last)
            *args->result = MSPRING_ERROR_REFUSED;
    }
}

// Of ranges that refuse, the one with the lowest slots counts, whoever calls when.
static void of_ranges_the_first_counts(void **state) {
    (void)state;
    mspring_result results[2] = {MSPRING_OK, MSPRING_OK};
    for (uint32_t i = 0; i < 6; i++) {
        mspring_network *network = mixed_network(1 + i % 3, MSPRING_SOLVER_EXPLICIT);
        uint32_t last = mspring_network_count(network, MSPRING_PARTICLES) - 1;
        mspring_hook_def def = mspring_hook_def_default();
        def.phase = i < 3 ? MSPRING_PHASE_BEFORE_STEP : MSPRING_PHASE_AFTER_SUBSTEP;
        def.fn = refuse_by_range;
        def.user = &last;
        def.flags = MSPRING_HOOK_CONCURRENT;
        def.range_slots = 16;
        check_ok(mspring_network_add_hook(network, &def, NULL));
        const mspring_result result = mspring_network_step(network, DT);
        assert_int_not_equal(result, MSPRING_OK);
        results[i / 3] = i % 3 == 0 ? result : results[i / 3];
        assert_int_equal(result, results[i / 3]);
        mspring_network_destroy(network);
    }
}

/* ---------------------------------------------------------------------------------------------------- ownership */

/// What a hook points to: counted references.
typedef struct shared {
    int references, retained, released, calls;
} shared;

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ((shared *)user)->calls++;
}

static void *MSPRING_CALL retain(void *user) {
    shared *s = user;
    s->references++;
    s->retained++;
    return s;
}

static void MSPRING_CALL release(void *user) {
    shared *s = user;
    s->references--;
    s->released++;
}

static mspring_id add_shared(mspring_network *network, shared *s, bool is_retained) {
    mspring_id id;
    mspring_hook_def def = mspring_hook_def_default();
    def.fn = count_call;
    def.user = s;
    def.release = release;
    def.retain = is_retained ? retain : NULL;
    check_ok(mspring_network_add_hook(network, &def, &id));
    s->references++;
    return id;
}

static void hooks_are_released_once(void **state) {
    (void)state;
    shared s[3] = {{0}};
    mspring_network *network = mixed_network(1, MSPRING_SOLVER_EXPLICIT);
    mspring_id ids[3];
    for (int i = 0; i < 3; i++)
        ids[i] = add_shared(network, &s[i], i == 1);
    check_ok(mspring_network_step(network, DT));
    check_ok(mspring_network_remove_hook(network, ids[1]));
    assert_int_equal(s[1].released, 1);
    check_error(mspring_network_remove_hook(network, ids[1]), MSPRING_ERROR_ID);
    check_ok(mspring_network_compact(network)); // another layout keeps them
    check_ok(mspring_network_step(network, DT));
    assert_int_equal(s[0].released + s[2].released, 0);
    mspring_network_destroy(network);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(s[i].released, 1);
        assert_int_equal(s[i].references, 0);
        assert_int_equal(s[i].calls, i == 1 ? 1 : 2);
    }
    mspring_hook_def bad = mspring_hook_def_default();
    bad.release = release;
    bad.user = &s[0];
    network = mixed_network(1, MSPRING_SOLVER_EXPLICIT);
    check_error(mspring_network_add_hook(network, &bad, NULL), MSPRING_ERROR_ARGUMENT); // without a function
    mspring_network_destroy(network);
    assert_int_equal(s[0].released, 1);
}

static void clones_retain_or_leave_out(void **state) {
    (void)state;
    shared kept = {0}, left = {0}, plain = {0};
    mspring_network *network = mixed_network(1, MSPRING_SOLVER_EXPLICIT), *clone, *bare;
    (void)add_shared(network, &kept, true);
    (void)add_shared(network, &left, false);
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, count_call, &plain, NULL));
    mspring_clone_def def = mspring_clone_def_default();
    check_ok(mspring_network_clone(network, &def, &bare));
    assert_int_equal(kept.retained, 0); // without hooks
    def.copy_hooks = 1;
    check_ok(mspring_network_clone(network, &def, &clone));
    assert_int_equal(kept.retained, 1);
    check_ok(mspring_network_step(bare, DT));
    assert_int_equal(kept.calls + left.calls + plain.calls, 0);
    check_ok(mspring_network_step(clone, DT));
    assert_true(kept.calls == 1 && left.calls == 0 && plain.calls == 1);
    mspring_network_destroy(bare);
    mspring_network_destroy(network);
    assert_true(kept.references == 1 && left.references == 0);
    check_ok(mspring_network_step(clone, DT));
    assert_int_equal(kept.calls, 2);
    mspring_network_destroy(clone);
    assert_int_equal(kept.references, 0);
}

// A clone that fails for want of memory has retained nothing, or given it back.
static void clones_that_fail_keep_no_reference(void **state) {
    (void)state;
    shared s = {0};
    mspring_network *network = mixed_network(1, MSPRING_SOLVER_EXPLICIT), *clone = NULL;
    (void)add_shared(network, &s, true);
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_clone_def def = mspring_clone_def_default();
    def.copy_hooks = 1;
    def.allocator = &allocator;
    mspring_result result = MSPRING_ERROR_MEMORY;
    for (size_t fail_at = 1; result == MSPRING_ERROR_MEMORY; fail_at++) {
        watched.fail_at = watched.calls + fail_at;
        result = mspring_network_clone(network, &def, &clone);
        assert_int_equal(s.references, result == MSPRING_OK ? 2 : 1);
    }
    check_ok(result);
    mspring_network_destroy(clone);
    check_watched_clean(&watched);
    mspring_network_destroy(network);
    assert_int_equal(s.references, 0);
}

/* -------------------------------------------------------------------------------------------------------- tasks */

static void MSPRING_CALL run_in_order(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    ((shared *)user)->calls++;
    for (uint32_t i = 0; i < count; i++)
        fn(argument, i, 0);
}

static mspring_tasks tasks_of(shared *s) {
    mspring_tasks tasks = mspring_tasks_default();
    tasks.worker_count = 2;
    tasks.run = run_in_order;
    tasks.user = s;
    tasks.release = release;
    s->references++;
    return tasks;
}

// Tasks are released as the network that they were given to is destroyed; a network that was not made keeps none.
static void tasks_are_released_with_the_network(void **state) {
    (void)state;
    shared s = {0}, of_clone = {0}, unused = {0};
    recipe made = recipe_mixed(2);
    const mspring_tasks tasks = tasks_of(&s), for_clone = tasks_of(&of_clone), for_none = tasks_of(&unused);
    mspring_network_def def = support_def(-9.8f, 4);
    def.tasks = &tasks;
    mspring_network *network = recipe_network(&made, &def), *clone, *plain;
    support_steps(network, 3, DT);
    mspring_clone_def clone_def = mspring_clone_def_default();
    check_ok(mspring_network_clone(network, NULL, &plain)); // has threads of the library
    clone_def.tasks = &for_clone;
    check_ok(mspring_network_clone(network, &clone_def, &clone));
    assert_int_equal(s.released + of_clone.released, 0);
    mspring_network_destroy(network);
    assert_int_equal(s.released, 1);
    support_steps(clone, 3, DT);
    mspring_network_destroy(plain);
    assert_true(s.released == 1 && of_clone.released == 0);
    mspring_network_destroy(clone);
    assert_int_equal(of_clone.released, 1);
    def.tasks = &for_none;
    def.settings.gravity_y = NAN;
    mspring_builder *builder = recipe_builder(&made, NULL);
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(unused.released, 0); // the host's still
    mspring_builder_destroy(builder);
    recipe_free(&made);
}

static void stop(const mspring_hook_args *args, void *user) {
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        float *const v = *(const int *)user == 0 ? args->vx : args->vy;
        v[slot] = 0;
    }
}

/// In a precise network, too, a velocity that a hook writes is all of it: what is stopped stays where it is.
static void what_is_stopped_stands_still(void **state) {
    (void)state;
    for (int axis = 0; axis < 2; axis++) {
        mspring_builder *builder = support_builder();
        for (int i = 0; i < 20; i++) {
            support_particle(builder, i / 7.0, i / 9.0, 1);
        }
        mspring_network_def def = support_def(0.1f, 8);
        def.settings.gravity_x = 0.1f;
        def.flags = MSPRING_NETWORK_PRECISE;
        mspring_network *network = support_network(builder, &def);
        support_steps(network, 50, 1.0 / 60);
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, stop, &axis, NULL));
        check_ok(support_set_gravity(network, axis == 0 ? 0 : 0.1f, axis == 0 ? 0.1f : 0));
        double before[20][2], after[20][2];
        check_ok(mspring_network_get_positions(network, NULL, 0, 20, before[0], before[0] + 1, 2));
        support_steps(network, 10, 1.0 / 60);
        check_ok(mspring_network_get_positions(network, NULL, 0, 20, after[0], after[0] + 1, 2));
        for (int i = 0; i < 20; i++) {
            assert_true(after[i][axis] == before[i][axis] && after[i][1 - axis] > before[i][1 - axis]);
        }
        mspring_network_destroy(network);
    }
}

static void move_and_ask(const mspring_hook_args *args, void *user) {
    float *ratio = user, length = -1;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++)
        if (args->particle_of_slot[slot] == 1)
            args->x[slot] = (float)(3 - args->origin_x);
    check_ok(mspring_network_get(args->network, MSPRING_LENGTH, NULL, 0, 1, &length, 1));
    *ratio = length / 3;
}

/// Lengths are those of now: once there is a hook, and after it has written a position.
static void lengths_are_those_that_hooks_leave(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, 2, 0, 1);
    support_spring(builder, 0, 1, 1, 0);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    float length = -1, ratio = -1;
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, move_and_ask, &ratio, NULL));
    check_ok(mspring_network_get(network, MSPRING_LENGTH, NULL, 0, 1, &length, 1));
    assert_true(length == 2);
    support_steps(network, 1, 0.01);
    assert_true(ratio == 1);
    check_ok(mspring_network_get(network, MSPRING_LENGTH, NULL, 0, 1, &length, 1));
    assert_true(length == 3);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_are_those_that_hooks_leave),
        cmocka_unit_test(refused_steps_are_rolled_back),
        cmocka_unit_test(refused_with_anything),
        cmocka_unit_test(steps_return_what_hooks_set),
        cmocka_unit_test(of_ranges_the_first_counts),
        cmocka_unit_test(hooks_are_released_once),
        cmocka_unit_test(clones_retain_or_leave_out),
        cmocka_unit_test(clones_that_fail_keep_no_reference),
        cmocka_unit_test(tasks_are_released_with_the_network),
        cmocka_unit_test(what_is_stopped_stands_still),
    };
    return cmocka_run_group_tests_name("hook_lives", tests, NULL, NULL);
}
