/// @file test_hooks.c
/// Hooks: when they are called and with what, what they may do, and what is refused inside of them.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

/// A network with rows of every kind, leftover springs and empty slots.
static recipe mixed_recipe(void) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}, .pinned = 0.05, .holes = 0.2};
    recipe made = {0};
    recipe_lattice(&made, 19, 6, 0, 0, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&made, 30, 20, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 2, end, 9, &stuff, &seed);
    recipe_random_springs(&made, 8, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

static mspring_network *mixed_network(uint32_t substeps) {
    recipe made = mixed_recipe();
    mspring_network_def def = support_def(-9.8f, substeps);
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

/* --------------------------------------------------------------------------------------------- call order */

enum { SLOTS = 4096, SUBSTEPS = 3, HOOKS = 6 };

/// Six hooks, two to a phase, in the order of adding. Each slot goes through the same sequence of calls:
///     before step: 0, 1;  then for each substep before: 2, 3;  after: 4, 5.
typedef struct recorder {
    uint32_t calls_seen[SLOTS]; ///< by slot, in this step
    double dt;
    mspring_view view;
} recorder;

typedef struct recorder_hook {
    recorder *to;
    uint32_t number;
} recorder_hook;

static void record(const mspring_hook_args *args, void *user) {
    const recorder_hook *hook = user;
    recorder *to = hook->to;
    assert_int_equal(args->struct_size, sizeof *args);
    assert_int_equal(args->substep_count, SUBSTEPS);
    const mspring_phase phases[HOOKS] = {MSPRING_PHASE_BEFORE_STEP,    MSPRING_PHASE_BEFORE_STEP,
                                         MSPRING_PHASE_BEFORE_SUBSTEP, MSPRING_PHASE_BEFORE_SUBSTEP,
                                         MSPRING_PHASE_AFTER_SUBSTEP,  MSPRING_PHASE_AFTER_SUBSTEP};
    assert_int_equal(args->phase, phases[hook->number]);

    uint32_t expected = hook->number;
    if (args->phase == MSPRING_PHASE_BEFORE_STEP) {
        assert_int_equal(args->substep, 0);
        assert_true(args->dt == to->dt);
    } else {
        expected += 4 * args->substep;
        assert_true(args->substep < SUBSTEPS);
        check_near(args->dt, to->dt / SUBSTEPS, to->dt * 6e-8); // the substep as a float: half an ulp
    }
    assert_int_equal(args->force_x == NULL, args->phase == MSPRING_PHASE_AFTER_SUBSTEP);
    assert_int_equal(args->force_y == NULL, args->phase == MSPRING_PHASE_AFTER_SUBSTEP);

    assert_ptr_equal(args->x, to->view.x);
    assert_ptr_equal(args->vy, to->view.vy);
    assert_ptr_equal(args->inverse_mass, to->view.inverse_mass);
    assert_ptr_equal(args->particle_of_slot, to->view.particle_of_slot);
    assert_ptr_equal(args->slot_of_particle, to->view.slot_of_particle);
    assert_int_equal(mspring_network_count(args->network, MSPRING_PARTICLES), to->view.particle_count);
    assert_true(args->origin_x == to->view.origin_x && args->origin_y == to->view.origin_y);

    assert_true(args->slot_count > 0 && args->first_slot < to->view.slot_count &&
                args->slot_count <= to->view.slot_count - args->first_slot);
    for (uint32_t i = 0; i < args->slot_count; i++) {
        uint32_t slot = args->first_slot + i;
        if (args->particle_of_slot[slot] != MSPRING_NONE) {
            assert_int_equal(to->calls_seen[slot], expected);
            to->calls_seen[slot]++;
        }
    }
}

static void hooks_are_called_in_order_for_every_particle(void **state) {
    (void)state;
    mspring_network *network = mixed_network(SUBSTEPS);
    recorder seen = {.dt = 0.01, .view = {.struct_size = sizeof seen.view}};
    recorder_hook hooks[HOOKS];
    check_ok(mspring_network_get_view(network, &seen.view));
    assert_true(seen.view.slot_count <= SLOTS);
    // Added out of the order of phases: it is the phase that decides, and within it the order of adding.
    const uint32_t order[HOOKS] = {4, 2, 0, 5, 1, 3};
    const mspring_phase phases[] = {MSPRING_PHASE_BEFORE_STEP, MSPRING_PHASE_BEFORE_SUBSTEP,
                                    MSPRING_PHASE_AFTER_SUBSTEP};
    for (uint32_t i = 0; i < HOOKS; i++) {
        hooks[i] = (recorder_hook){.to = &seen, .number = order[i]};
        check_ok(support_add_hook(network, phases[order[i] / 2], record, &hooks[i], NULL));
    }
    for (int step = 0; step < 3; step++) {
        memset(seen.calls_seen, 0, sizeof seen.calls_seen);
        check_ok(mspring_network_step(network, seen.dt));
        for (uint32_t slot = 0; slot < seen.view.slot_count; slot++) {
            bool particle = seen.view.particle_of_slot[slot] != MSPRING_NONE;
            assert_int_equal(seen.calls_seen[slot], particle ? 2 + 4 * SUBSTEPS : 0);
        }
    }
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------- forces */

/// Pulls every particle by what the table says.
typedef struct puller {
    const float *x, *y; ///< by particle
} puller;

static void pull(const mspring_hook_args *args, void *user) {
    const puller *forces = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        mspring_id id = args->particle_of_slot[slot];
        if (id != MSPRING_NONE) {
            args->force_x[slot] += forces->x[id];
            args->force_y[slot] += forces->y[id];
        }
    }
}

static void forces_of_hooks_equal_forces_of_the_host(void **state) {
    (void)state;
    const mspring_phase phases[] = {MSPRING_PHASE_BEFORE_STEP, MSPRING_PHASE_BEFORE_SUBSTEP};
    for (size_t i = 0; i < COUNT_OF(phases); i++) {
        mspring_network *hooked = mixed_network(4), *hosted = mixed_network(4);
        float x[300], y[300];
        const uint32_t count = mspring_network_count(hooked, MSPRING_PARTICLES);
        uint64_t seed = 77;
        assert_true(count <= 300);
        for (uint32_t id = 0; id < count; id++) {
            x[id] = (float)support_random_between(&seed, -20, 20);
            y[id] = (float)support_random_between(&seed, -20, 20);
        }
        puller forces = {x, y};
        check_ok(support_add_hook(hooked, phases[i], pull, &forces, NULL));
        for (int step = 0; step < 25; step++) {
            check_ok(mspring_network_apply_forces(hosted, MSPRING_PUSH_STEP, NULL, 0, count, x, y, 1));
            check_ok(mspring_network_step(hosted, 0.02));
            check_ok(mspring_network_step(hooked, 0.02));
        }
        double moved = 0;
        for (uint32_t id = 0; id < count; id++) {
            support_point a = support_position(hooked, id), b = support_position(hosted, id);
            // The same numbers, possibly added in another order: 100 substeps of half an ulp (1e-6 m) of
            // coordinates below 32 m at most.
            check_near(a.x, b.x, 1e-4);
            check_near(a.y, b.y, 1e-4);
            moved += fabs(support_velocity(hooked, id).x);
        }
        assert_true(moved > count); // m/s: the forces did something
        mspring_network_destroy(hooked);
        mspring_network_destroy(hosted);
    }
}

/// Spoils every slot there is.
static void poison(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->phase == MSPRING_PHASE_AFTER_SUBSTEP) {
            args->x[slot] = NAN;
        } else {
            args->force_x[slot] = NAN;
        }
    }
}

static void what_a_hook_spoils_is_taken_back(void **state) {
    (void)state;
    for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
        for (int forces_of_host = 0; forces_of_host < 2; forces_of_host++) {
            mspring_network *network = mixed_network(2), *clean = mixed_network(2);
            uint32_t hook;
            support_steps(network, 3, 0.01);
            support_steps(clean, 3, 0.01);
            if (forces_of_host) {
                check_ok(mspring_network_apply_force(network, 11, 20, 30));
                check_ok(mspring_network_apply_force(clean, 11, 20, 30));
            }
            check_ok(support_add_hook(network, phase, poison, NULL, &hook));
            check_error(mspring_network_step(network, 0.01), MSPRING_ERROR_UNSTABLE);
            assert_int_equal(support_hash(network), support_hash(clean));
            check_ok(mspring_network_remove_hook(network, hook));
            // Nothing of it is left in any field.
            support_steps(network, 3, 0.01);
            support_steps(clean, 3, 0.01);
            assert_int_equal(support_hash(network), support_hash(clean));
            mspring_network_destroy(network);
            mspring_network_destroy(clean);
        }
    }
}

/* ----------------------------------------------------------------------------------------------- movement */

static void floor_hook(const mspring_hook_args *args, void *user) {
    const double *level = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->inverse_mass[slot] > 0 && args->origin_y + (double)args->y[slot] < *level) {
            args->y[slot] = (float)(*level - args->origin_y);
            args->vy[slot] = 0;
        }
    }
}

static void a_hook_can_be_a_floor(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    // A square with diagonals, tilted, that falls onto y = -5 with one corner first.
    const double corners[4][2] = {{0, 0}, {0.96, 0.28}, {0.68, 1.24}, {-0.28, 0.96}};
    for (int i = 0; i < 4; i++) {
        support_particle(builder, corners[i][0], corners[i][1], 2);
    }
    for (mspring_id a = 0; a < 4; a++) {
        for (mspring_id b = 0; b < a; b++) {
            support_spring(builder, a, b, 5000, 20);
        }
    }
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.global_damping = 2;
    mspring_network *network = support_network(builder, &def);
    double level = -5;
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, floor_hook, &level, NULL));
    double lowest = 0;
    for (int step = 0; step < 640; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        for (mspring_id id = 0; id < 4; id++) {
            support_point p = support_position(network, id);
            // It is put there, but for its low word, and the network's origin is in whole metres.
            assert_true(p.y >= level - 0x1p-22); // half a unit in the last place of 5 m
            lowest = fmin(lowest, p.y);
        }
    }
    check_near(lowest, level, 0x1p-22);
    // It has come to rest on a side: two corners on the floor, two 1 m above it less the weight's compression.
    int down = 0;
    for (mspring_id id = 0; id < 4; id++) {
        check_near(support_velocity(network, id).y, 0, 1e-3); // exp(-2/2 10) of some m/s are left of any swing
        double height = support_position(network, id).y - level;
        const bool lies = fabs(height) <= 0x1p-22;
        down += lies;
        // 4 kg 9.8 m/s^2 on two sides and two diagonals of 5000 N/m and more press it by less than 5 mm.
        assert_true(lies || (height > 0.995 && height < 1));
    }
    assert_int_equal(down, 2);
    mspring_network_destroy(network);
}

static void shift(const mspring_hook_args *args, void *user) {
    const float *by = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->x[slot] += *by;
        args->vx[slot] = *by;
    }
}

static void hooks_before_the_step_and_after_the_substep_may_move(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = support_network(builder, &def);
    float by = 0.5f;
    uint32_t hook;
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, shift, &by, &hook));
    check_ok(mspring_network_step(network, 1));
    assert_true(support_position(network, 0).x == 0.5 + 0.5);
    check_ok(mspring_network_remove_hook(network, hook));
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, shift, &by, NULL));
    check_ok(mspring_network_step(network, 1));
    assert_true(support_position(network, 0).x == 1 + 0.5 + 4 * 0.5);
    mspring_network_destroy(network);
}

typedef struct scribble {
    float value;
    uint32_t empty_slots; ///< written to
} scribble;

static void scribble_on_empty_slots(const mspring_hook_args *args, void *user) {
    scribble *with = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] != MSPRING_NONE) {
            continue;
        }
        with->empty_slots++;
        if (args->phase != MSPRING_PHASE_BEFORE_SUBSTEP) {
            args->x[slot] = with->value;
            args->y[slot] = -with->value;
            args->vx[slot] = -with->value;
            args->vy[slot] = with->value;
        }
        if (args->force_x != NULL) {
            args->force_x[slot] += with->value;
            args->force_y[slot] -= with->value;
        }
    }
}

static void what_hooks_write_to_empty_slots_is_ignored(void **state) {
    (void)state;
    const float values[] = {0, 1, -77.5f, 1e6f};
    mspring_network *clean = mixed_network(2);
    support_steps(clean, 20, 0.01);
    for (size_t i = 0; i < COUNT_OF(values); i++) {
        mspring_network *network = mixed_network(2);
        scribble with = {.value = values[i]};
        for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
            check_ok(support_add_hook(network, phase, scribble_on_empty_slots, &with, NULL));
        }
        support_steps(network, 20, 0.01);
        assert_true(with.empty_slots > 0);
        assert_int_equal(support_hash(network), support_hash(clean));
        mspring_network_destroy(network);
    }
    mspring_network_destroy(clean);
}

// A hook that accelerates whatever slot there is, and one that holds the particles: nothing may gather in slots
// without particle until it is out of bounds.
static void accelerate_all_slots(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->vy[slot] -= 40;
    }
}

static void hold_particles(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] != MSPRING_NONE) {
            args->vx[slot] = args->vy[slot] = 0;
        }
    }
}

static void empty_slots_gather_nothing(void **state) {
    (void)state;
    mspring_network *network = mixed_network(2);
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, accelerate_all_slots, NULL, NULL));
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, hold_particles, NULL, NULL));
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    support_steps(network, 30000, 0.01); // 1.2e6 m/s, more than max_speed, if it gathered
    for (uint32_t slot = 0; slot < view.slot_count; slot++) {
        if (view.particle_of_slot[slot] == MSPRING_NONE) {
            assert_true(view.x[slot] == 0 && view.y[slot] == 0 && view.vx[slot] == 0 && view.vy[slot] == 0);
        }
    }
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------- calls from inside */

typedef struct caller {
    mspring_network *network;
    int calls;
} caller;

static void call_from_inside(const mspring_hook_args *args, void *user) {
    caller *inside = user;
    mspring_network *network = inside->network;
    inside->calls++;

    float f[2] = {1, 1};
    double d[2] = {1, 1};
    uint32_t number = 4711;
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    check_error(mspring_network_step(network, 0.01), MSPRING_ERROR_BUSY);
    check_contains(mspring_network_error(network), "hook");
    check_error(support_set_solver(network, &solver), MSPRING_ERROR_BUSY);
    check_error(support_set_gravity(network, 0, 0), MSPRING_ERROR_BUSY);
    check_error(support_set_global_damping(network, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_apply_force(network, 0, 1, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 2, f, f, 1), MSPRING_ERROR_BUSY);
    check_error(support_add_hook(network, args->phase, call_from_inside, user, &number), MSPRING_ERROR_BUSY);
    check_error(mspring_network_remove_hook(network, 0), MSPRING_ERROR_BUSY);
    check_error(mspring_network_set_positions(network, NULL, 0, 2, d, d, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_set_velocities(network, NULL, 0, 2, f, f, 1), MSPRING_ERROR_BUSY);
    assert_int_equal(number, 4711);

    // What is marked shared works.
    mspring_view view = {.struct_size = sizeof view};
    support_plan plan;
    support_spring_info info;
    mspring_id spring;
    uint64_t hash;
    double energy;
    check_ok(mspring_network_get_view(network, &view));
    check_ok(support_get_plan(network, &plan));
    check_ok(support_get_spring(network, 0, &info));
    check_ok(mspring_network_get_positions(network, NULL, 0, 2, d, d, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 0, 2, f, f, 1));
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 2, f, 1));
    check_ok(mspring_network_get(network, MSPRING_STRAIN, NULL, 0, 2, f, 1));
    check_ok(support_get_energy(network, &energy, NULL, NULL));
    check_ok(support_get_momentum(network, &energy, NULL, NULL));
    check_ok(support_get_max_strain(network, NULL, &spring));
    check_ok(mspring_network_get_state_hash(network, &hash));
}

static void exclusive_calls_from_inside_are_refused(void **state) {
    (void)state;
    mspring_network *network = mixed_network(2), *clean = mixed_network(2);
    caller inside = {.network = network};
    for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
        check_ok(support_add_hook(network, phase, call_from_inside, &inside, NULL));
    }
    support_steps(network, 3, 0.01);
    support_steps(clean, 3, 0.01);
    assert_true(inside.calls >= 3 * (1 + 2 + 2));
    assert_int_equal(support_hash(network), support_hash(clean));
    // Outside they work again.
    check_ok(support_set_gravity(network, 0, 0));
    mspring_network_destroy(network);
    mspring_network_destroy(clean);
}

/* ------------------------------------------------------------------------------------------ adding, removing */

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ++*(int *)user;
}

static void removed_hooks_are_not_called(void **state) {
    (void)state;
    mspring_network *network = mixed_network(1);
    int calls[3] = {0, 0, 0};
    uint32_t numbers[6];
    for (int i = 0; i < 3; i++) {
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, count_call, &calls[i], &numbers[i]));
    }
    check_ok(mspring_network_step(network, 0.01));
    assert_true(calls[0] >= 1 && calls[1] == calls[0] && calls[2] == calls[0]);
    const int once = calls[0];
    check_ok(mspring_network_remove_hook(network, numbers[1]));
    check_ok(mspring_network_step(network, 0.01));
    assert_true(calls[0] == 2 * once && calls[1] == once && calls[2] == 2 * once);
    check_error(mspring_network_remove_hook(network, numbers[1]), MSPRING_ERROR_ID);
    check_error(mspring_network_remove_hook(network, 12345), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "12345");
    check_error(mspring_network_remove_hook(NULL, numbers[0]), MSPRING_ERROR_ARGUMENT);

    // Numbers are not used again.
    for (int i = 3; i < 6; i++) {
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, count_call, &calls[1], &numbers[i]));
        for (int j = 0; j < i; j++) {
            assert_int_not_equal(numbers[i], numbers[j]);
        }
        check_ok(mspring_network_remove_hook(network, numbers[i]));
    }
    check_ok(mspring_network_remove_hook(network, numbers[2]));
    check_ok(mspring_network_remove_hook(network, numbers[0]));
    check_ok(mspring_network_step(network, 0.01));
    assert_true(calls[0] == 2 * once && calls[1] == once && calls[2] == 2 * once);

    // And a network that has had hooks moves like one that never had.
    mspring_network *clean = mixed_network(1);
    support_steps(clean, 3, 0.01);
    assert_int_equal(support_hash(network), support_hash(clean));
    mspring_network_destroy(network);
    mspring_network_destroy(clean);
}

static void bad_hooks_are_refused(void **state) {
    (void)state;
    mspring_network *network = mixed_network(1);
    uint32_t number = 4711;
    int calls = 0;
    check_error(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, NULL, NULL, &number), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "NULL");
    check_error(support_add_hook(network, -1, count_call, &calls, &number), MSPRING_ERROR_ARGUMENT);
    check_error(support_add_hook(network, 3, count_call, &calls, &number), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "phase");
    check_error(support_add_hook(NULL, MSPRING_PHASE_BEFORE_STEP, count_call, &calls, &number),
                MSPRING_ERROR_ARGUMENT);
    assert_int_equal(number, 4711);
    check_ok(mspring_network_step(network, 0.01));
    assert_int_equal(calls, 0);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------- spare slots */

/// Drives all that it is given, whether a particle is there or not, and notes how much that is.
static void drive(const mspring_hook_args *args, void *user) {
    uint32_t *slots = user;
    *slots = args->slot_count;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] += 1 + 0.25f * (float)(slot % 3);
    }
}

static mspring_network *network_with_spare(uint32_t spare) {
    recipe made = recipe_mixed(4);
    mspring_network_def def = support_def(-9.8f, 4);
    def.spare_particles = spare;
    mspring_network *network = recipe_network(&made, &def);
    double min_x, min_y, max_x, max_y;
    check_ok(support_get_bounds(network, &min_x, &min_y, &max_x, &max_y));
    const double plane[4] = {0, min_y - 0.01, 0, 1};
    mspring_floor_def ground;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &ground, sizeof ground));
    ground.planes = plane;
    ground.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &ground));
    recipe_free(&made);
    return network;
}

static void add_some(mspring_network *network) {
    mspring_particle_def added[40];
    mspring_id ids[COUNT_OF(added)];
    for (size_t i = 0; i < COUNT_OF(added); i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &added[i], sizeof added[i]));
        added[i].x = 0.5 * (double)i;
        added[i].y = 20;
    }
    check_ok(mspring_network_add_particles(network, added, COUNT_OF(added), ids));
    check_ok(mspring_network_remove_particles(network, ids + 20, 0, 20));
}

/// Spare particles that are not in use: no hook sees their slots, and no bit is another one, however many there
/// are.
static void spare_slots_make_no_difference(void **state) {
    (void)state;
    enum { NETWORKS = 2, STAGES = 6 };
    const uint32_t spare[NETWORKS] = {128, 5000};
    uint64_t hashes[NETWORKS][STAGES];
    uint32_t slots[NETWORKS][2] = {{0}};
    for (int i = 0; i < NETWORKS; i++) {
        mspring_network *network = network_with_spare(spare[i]);
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, drive, &slots[i][0], NULL));
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_SUBSTEP, drive, &slots[i][1], NULL));
        support_steps(network, 5, 0.004);
        hashes[i][0] = support_hash(network);
        saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        add_some(network);
        support_steps(network, 5, 0.004);
        hashes[i][1] = support_hash(network);
        // A step that is refused.
        const float fast = 1e14f, none = 0;
        check_ok(mspring_network_set_velocities(network, NULL, 3, 1, &fast, &none, 1));
        hashes[i][2] = support_hash(network);
        check_error(mspring_network_step(network, 0.004), MSPRING_ERROR_UNSTABLE);
        assert_int_equal(support_hash(network), hashes[i][2]);
        check_ok(mspring_network_load(network, before.bytes, before.size));
        assert_int_equal(support_hash(network), hashes[i][0]);
        add_some(network);
        support_steps(network, 5, 0.004);
        hashes[i][3] = support_hash(network);
        assert_int_equal(hashes[i][3], hashes[i][1]);
        check_ok(mspring_network_compact(network));
        support_steps(network, 5, 0.004);
        hashes[i][4] = support_hash(network);
        add_some(network);
        support_steps(network, 5, 0.004);
        hashes[i][5] = support_hash(network);
        free(before.bytes);
        mspring_network_destroy(network);
    }
    assert_memory_equal(hashes[0], hashes[1], sizeof hashes[0]);
    assert_memory_equal(slots[0], slots[1], sizeof slots[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hooks_are_called_in_order_for_every_particle),
        cmocka_unit_test(forces_of_hooks_equal_forces_of_the_host),
        cmocka_unit_test(what_a_hook_spoils_is_taken_back),
        cmocka_unit_test(a_hook_can_be_a_floor),
        cmocka_unit_test(hooks_before_the_step_and_after_the_substep_may_move),
        cmocka_unit_test(what_hooks_write_to_empty_slots_is_ignored),
        cmocka_unit_test(empty_slots_gather_nothing),
        cmocka_unit_test(exclusive_calls_from_inside_are_refused),
        cmocka_unit_test(removed_hooks_are_not_called),
        cmocka_unit_test(bad_hooks_are_refused),
        cmocka_unit_test(spare_slots_make_no_difference),
    };
    return cmocka_run_group_tests_name("hooks", tests, NULL, NULL);
}
