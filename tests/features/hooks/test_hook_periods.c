/// @file test_hook_periods.c
/// Hooks with a period: when they are called, and that their forces hold until the next call.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

/// Rows of every kind; ropes is whether leftover springs pull at lattice rows, too.
static mspring_network *mixed_network(uint32_t substeps, bool ropes) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}, .pinned = 0.05, .holes = 0.2};
    recipe made = {0};
    recipe_lattice(&made, 25, 12, 0, 0, 1, &stuff, &seed);
    if (ropes) {
        mspring_id end = recipe_particle(&made, 30, 20, 1, MSPRING_PARTICLE_PINNED);
        recipe_rope(&made, 2, end, 9, &stuff, &seed);
        recipe_random_springs(&made, 8, &stuff, &seed);
    }
    recipe_disturb(&made, 0.05, 0.5, &seed);
    mspring_network_def def = support_def(-9.8f, substeps);
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static void add(mspring_network *network, mspring_phase phase, uint32_t period, mspring_hook_fn fn, void *user) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = phase;
    def.period = period;
    def.fn = fn;
    def.user = user;
    check_ok(mspring_network_add_hook(network, &def, NULL));
}

/* -------------------------------------------------------------------------------------------------- the calls */

enum { MOST_CALLS = 256, SUBSTEPS = 10 };

typedef struct call {
    mspring_phase phase;
    uint32_t period, substep, group_count;
    double dt;
} call;

typedef struct log_of_calls {
    call calls[MOST_CALLS];
    uint32_t count;
} log_of_calls;

typedef struct logger {
    log_of_calls *to;
    uint32_t period;
} logger;

static void log_call(const mspring_hook_args *args, void *user) {
    const logger *self = user;
    assert_true(self->to->count < MOST_CALLS);
    self->to->calls[self->to->count++] =
        (call){args->phase, self->period, args->substep, args->run_count, args->dt};
}

static void calls_come_once_for_each_group(void **state) {
    (void)state;
    const uint32_t periods[] = {1, 3, 4, 10, 25, UINT32_MAX};
    mspring_network *network = mixed_network(SUBSTEPS, true);
    log_of_calls seen = {.count = 0};
    logger loggers[COUNT_OF(periods)];
    for (size_t i = 0; i < COUNT_OF(periods); i++) {
        loggers[i] = (logger){&seen, periods[i]};
        add(network, MSPRING_PHASE_AFTER_SUBSTEP, periods[i], log_call, &loggers[i]);
        add(network, MSPRING_PHASE_BEFORE_SUBSTEP, periods[i], log_call, &loggers[i]);
    }
    for (int step = 0; step < 2; step++) {
        seen.count = 0;
        check_ok(mspring_network_step(network, 0.01));
        uint32_t at = 0;
        for (uint32_t substep = 0; substep < SUBSTEPS; substep++) {
            for (mspring_phase phase = MSPRING_PHASE_BEFORE_SUBSTEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP;
                 phase++) {
                for (size_t i = 0; i < COUNT_OF(periods); i++) {
                    const uint32_t period = periods[i], first = substep / period * period;
                    const uint32_t last = SUBSTEPS - first > period ? first + period - 1 : SUBSTEPS - 1;
                    if (substep != (phase == MSPRING_PHASE_BEFORE_SUBSTEP ? first : last)) {
                        continue;
                    }
                    const call *is = &seen.calls[at++];
                    assert_int_equal(is->phase, phase);
                    assert_int_equal(is->period, period);
                    assert_int_equal(is->substep, substep);
                    assert_int_equal(is->group_count, last - first + 1);
                    check_near(is->dt, 0.001 * is->group_count, 1e-9 * is->group_count); // h is a float
                }
            }
        }
        assert_int_equal(seen.count, at);
    }
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------- their forces */

enum { SLOTS = 1024 };

/// Pulls each particle against its velocity, as that was at the last call that was due.
typedef struct brake {
    uint32_t period;
    float strength;
    float x[SLOTS], y[SLOTS]; ///< what an unhelped hook has to remember
} brake;

static void brake_hook(const mspring_hook_args *args, void *user) {
    const brake *self = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] += -self->strength * args->vx[slot];
        args->force_y[slot] += -self->strength * args->vy[slot] + 1;
    }
}

/// The same, called before every substep.
static void remembering_brake_hook(const mspring_hook_args *args, void *user) {
    brake *self = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->substep % self->period == 0) {
            self->x[slot] = -self->strength * args->vx[slot];
            self->y[slot] = -self->strength * args->vy[slot] + 1;
        }
        args->force_x[slot] += self->x[slot];
        args->force_y[slot] += self->y[slot];
    }
}

/// Compare count brakes with their remembering kin. Both networks go through the same additions in the same order,
/// so the states are equal bit for bit.
static void check_brakes(const uint32_t *periods, uint32_t count, bool ropes, bool hosted) {
    static brake brakes[3];
    mspring_network *held = mixed_network(SUBSTEPS, ropes), *remembered = mixed_network(SUBSTEPS, ropes);
    mspring_network *without = mixed_network(SUBSTEPS, ropes);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(held, &view));
    assert_true(view.slot_count <= SLOTS);
    for (uint32_t i = 0; i < count; i++) {
        brakes[i] = (brake){.period = periods[i], .strength = 0.3f + 0.1f * (float)i};
        add(held, MSPRING_PHASE_BEFORE_SUBSTEP, periods[i], brake_hook, &brakes[i]);
        add(remembered, MSPRING_PHASE_BEFORE_SUBSTEP, 1, remembering_brake_hook, &brakes[i]);
    }
    for (int step = 0; step < 10; step++) {
        if (hosted) {
            check_ok(mspring_network_apply_force(held, 17, 3, 4));
            check_ok(mspring_network_apply_force(remembered, 17, 3, 4));
        }
        support_steps(held, 1, 0.05);
        support_steps(remembered, 1, 0.05);
        support_steps(without, 1, 0.05);
        assert_int_equal(support_hash(held), support_hash(remembered));
        assert_int_not_equal(support_hash(held), support_hash(without));
    }
    mspring_network_destroy(held);
    mspring_network_destroy(remembered);
    mspring_network_destroy(without);
}

static void forces_hold_until_the_next_call(void **state) {
    (void)state;
    const uint32_t one[] = {1}, three[] = {3}, ten[] = {10}, long_one[] = {77};
    const uint32_t mixed[] = {4, 1, 3}, lazy[] = {3, 5, 10};
    for (int kind = 0; kind < 4; kind++) {
        const bool ropes = kind % 2 == 1, hosted = kind / 2 == 1;
        check_brakes(one, 1, ropes, hosted);
        check_brakes(three, 1, ropes, hosted);
        check_brakes(ten, 1, ropes, hosted);
        check_brakes(long_one, 1, ropes, hosted);
        check_brakes(mixed, 3, ropes, hosted);
        check_brakes(lazy, 3, ropes, hosted);
    }
}

static void poison(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] = NAN;
    }
}

static void what_is_held_and_spoilt_is_taken_back(void **state) {
    (void)state;
    for (int ropes = 0; ropes < 2; ropes++) {
        mspring_network *network = mixed_network(SUBSTEPS, ropes), *clean = mixed_network(SUBSTEPS, ropes);
        static brake gentle = {.period = 4, .strength = 0.2f};
        mspring_hook_def def;
        uint32_t hook;
        check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
        def.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
        def.period = 3;
        def.fn = poison;
        add(network, MSPRING_PHASE_BEFORE_SUBSTEP, 4, brake_hook, &gentle);
        add(clean, MSPRING_PHASE_BEFORE_SUBSTEP, 4, brake_hook, &gentle);
        check_ok(mspring_network_add_hook(network, &def, &hook));
        check_error(mspring_network_step(network, 0.01), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_remove_hook(network, hook));
        support_steps(network, 3, 0.01);
        support_steps(clean, 3, 0.01);
        assert_int_equal(support_hash(network), support_hash(clean));
        mspring_network_destroy(network);
        mspring_network_destroy(clean);
    }
}

/* --------------------------------------------------------------------------------------------------- movement */

typedef struct sea_floor {
    uint32_t period; ///< of one that has to see for itself
} sea_floor;

static void floor_hook(const mspring_hook_args *args, void *user) {
    const sea_floor *self = user;
    if ((args->substep + 1) % self->period != 0 && args->substep + 1 != args->substep_count) {
        return;
    }
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->y[slot] < -7) {
            args->y[slot] = -7;
            args->vy[slot] = 0;
        }
    }
}

static void movement_is_called_for_at_the_end_of_a_group(void **state) {
    (void)state;
    const uint32_t periods[] = {1, 2, 4, 10, 11};
    for (size_t i = 0; i < COUNT_OF(periods); i++) {
        sea_floor always = {1}, seldom = {periods[i]};
        mspring_network *grouped = mixed_network(SUBSTEPS, true), *alone = mixed_network(SUBSTEPS, true);
        mspring_network *without = mixed_network(SUBSTEPS, true);
        add(grouped, MSPRING_PHASE_AFTER_SUBSTEP, periods[i], floor_hook, &always);
        add(alone, MSPRING_PHASE_AFTER_SUBSTEP, 1, floor_hook, &seldom);
        support_steps(grouped, 10, 0.05);
        support_steps(alone, 10, 0.05);
        support_steps(without, 10, 0.05);
        assert_int_equal(support_hash(grouped), support_hash(alone));
        assert_int_not_equal(support_hash(grouped), support_hash(without));
        mspring_network_destroy(grouped);
        mspring_network_destroy(alone);
        mspring_network_destroy(without);
    }
}

/* -------------------------------------------------------------------------------------------------- bad input */

static void bad_definitions_are_refused(void **state) {
    (void)state;
    mspring_network *network = mixed_network(1, false);
    uint32_t number = 4711;
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.fn = floor_hook;
    check_error(mspring_network_add_hook(network, NULL, &number), MSPRING_ERROR_ARGUMENT);
    def.period = 0;
    check_error(mspring_network_add_hook(network, &def, &number), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "period is 0");
    def.period = 2;
    check_error(mspring_network_add_hook(network, &def, &number), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "period is 2");
    def.period = 1;
    def.flags = 6;
    check_error(mspring_network_add_hook(network, &def, &number), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "flags are 0x6");
    def.flags = 0;
    def.struct_size++;
    check_error(mspring_network_add_hook(network, &def, &number), MSPRING_ERROR_STRUCT);
    check_contains(mspring_network_error(network), "mspring_hook_def");
    assert_int_equal(number, 4711);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_come_once_for_each_group),
        cmocka_unit_test(forces_hold_until_the_next_call),
        cmocka_unit_test(what_is_held_and_spoilt_is_taken_back),
        cmocka_unit_test(movement_is_called_for_at_the_end_of_a_group),
        cmocka_unit_test(bad_definitions_are_refused),
    };
    return cmocka_run_group_tests_name("hook periods", tests, NULL, NULL);
}
