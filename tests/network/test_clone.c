/// @file test_clone.c
/// A clone goes on as its original would, and neither knows of the other.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

enum { MOST = 400 };

static mspring_settings solver_def(mspring_solver solver, mspring_integrator integrator, uint32_t coarse_period) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = solver;
    def.integrator = integrator;
    def.coarse_period = coarse_period;
    def.substeps = 2;
    return def;
}

static mspring_settings solvers[5];

static int list_solvers(void **state) {
    (void)state;
    solvers[0] = solver_def(MSPRING_SOLVER_EXPLICIT, 0, 0);
    solvers[1] = solver_def(MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, 3);
    solvers[2] = solver_def(MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1);
    solvers[3] = solver_def(MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 2);
    solvers[4] = solver_def(MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_BDF2, 0);
    return 0;
}

/// A hook that uses all that a hook may have.
static void push(const mspring_hook_args *args, void *user) {
    const float *strength = user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->force_x != NULL) {
            args->force_x[slot] += *strength;
        }
    }
    if (args->storage != NULL) {
        *(uint32_t *)args->storage += 1;
    }
}

static void add_hook(mspring_network *network, mspring_phase phase, uint32_t period, float *strength) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = phase;
    def.period = period;
    def.fn = push;
    def.user = strength;
    check_ok(mspring_network_add_hook(network, &def, NULL));
}

/// Have a network hold all that it can.
static void use_everything(mspring_network *network) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    float values[MOST * 2];
    assert_true(springs <= COUNT_OF(values));
    for (uint32_t i = 0; i < springs; i++) {
        values[i] = i % 7 == 0 ? INFINITY : 0.05f + 0.01f * (float)(i % 5);
    }
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, springs, values, 1));
    for (uint32_t i = 0; i < springs; i++) {
        values[i] = 0.01f;
    }
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, springs, values, 1));
    check_ok(mspring_network_reserve_events(network, 64));
    check_ok(mspring_network_update_components(network, NULL, NULL));
    check_ok(support_get_extents(network, values, NULL, NULL, NULL));
    mspring_floor_def floor;
    const double plane[4] = {0, -3, 0.1, 1};
    const float heights[] = {0, 1, 0, 2, 0};
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    floor.heights = heights;
    floor.height_count = COUNT_OF(heights);
    floor.heights_y = -4;
    floor.spacing = 5;
    floor.friction = 0.5f;
    check_ok(mspring_network_set_floor(network, &floor));
}

/// A frame of a game, which does a bit of everything, as a function of the frame's number alone.
static void run_frame(mspring_network *network, uint32_t frame) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    const mspring_id broken[] = {frame * 7 % springs, frame * 13 % springs};
    check_ok(mspring_network_break_springs(network, broken, 0, 2));
    if (frame % 3 == 1) {
        const mspring_id whole[] = {(frame - 1) * 7 % springs};
        check_ok(mspring_network_restore_springs(network, whole, 0, 1, 0.5));
    }
    const float mass = 1 + 0.1f * (float)(frame % 10), scale = frame % 2 == 0 ? 0.5f : 1;
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, frame % particles, 1, &mass, 1));
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, frame * 3 % particles, 1, &scale, 1));
    check_ok(mspring_network_apply_force(network, frame * 11 % particles, 30, 5));
    check_ok(mspring_network_step(network, frame % 6 == 5 ? 0.013 : 0.01));
}

static mspring_network *make(const recipe *made, const mspring_settings *solver,
                             const mspring_allocator *allocator, uint32_t worker_count) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.worker_count = worker_count;
    def.allocator = allocator;
    mspring_network *network = recipe_network(made, &def);
    check_ok(support_set_solver(network, solver));
    return network;
}

static mspring_network *clone_of(const mspring_network *network) {
    mspring_network *clone = NULL;
    check_ok(mspring_network_clone(network, NULL, &clone));
    assert_non_null(clone);
    return clone;
}

static mspring_clone_def clone_def(void) {
    mspring_clone_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
    return def;
}

/* ----------------------------------------------------------------------------------------------- the same bits */

/// What can be seen of a network beside its state.
static uint64_t look(mspring_network *network) {
    mspring_event events[64];
    uint32_t count = 0, components = 0, changed = 0;
    uint64_t lost = 0, seen = support_hash(network);
    check_ok(mspring_network_update_components(network, &components, &changed));
    check_ok(mspring_network_read_events(network, events, 64, &count, &lost));
    for (uint32_t i = 0; i < count; i++) {
        seen = seen * 31 + (uint64_t)events[i].kind * 7 + events[i].id;
    }
    return seen * 31 + lost * 7 + components * 3 + changed;
}

static void clones_go_on_as_their_original(void **state) {
    (void)state;
    recipe made = recipe_mixed(11);
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make(&made, &solvers[i], NULL, 1);
        use_everything(network);
        for (uint32_t frame = 0; frame < 7; frame++) {
            run_frame(network, frame);
        }
        check_ok(mspring_network_apply_force(network, 3, 200, 0)); // still to act
        mspring_network *clone = clone_of(network);
        assert_int_equal(support_memory_used(clone), support_memory_used(network));
        const uint64_t at_first = support_hash(network);
        assert_int_equal(support_hash(clone), at_first);

        uint64_t expected[12];
        for (uint32_t frame = 0; frame < COUNT_OF(expected); frame++) {
            run_frame(clone, 7 + frame);
            expected[frame] = look(clone);
            assert_int_equal(support_hash(network), at_first);
        }
        assert_int_not_equal(expected[0], at_first);
        mspring_network_destroy(clone);

        // The original now, and a clone of it on its way that outlives it.
        for (uint32_t frame = 0; frame < 6; frame++) {
            run_frame(network, 7 + frame);
            assert_int_equal(look(network), expected[frame]);
        }
        clone = clone_of(network);
        mspring_network_destroy(network);
        for (uint32_t frame = 6; frame < COUNT_OF(expected); frame++) {
            run_frame(clone, 7 + frame);
            assert_int_equal(look(clone), expected[frame]);
        }
        mspring_network_destroy(clone);
    }
    recipe_free(&made);
}

static void workers_are_the_clones_own(void **state) {
    (void)state;
    // Large enough for steps to be shared.
    recipe made = {0};
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {900, 1000}};
    recipe_lattice(&made, 160, 120, 0, 0, 1, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    mspring_settings solver = solver_def(MSPRING_SOLVER_EXPLICIT, 0, 0);
    solver.substeps = 12;
    for (uint32_t original = 1; original <= 3; original += 2) {
        mspring_network *network = make(&made, &solver, NULL, original);
        support_steps(network, 1, 0.01);
        mspring_network *clones[3];
        for (uint32_t i = 0; i < 3; i++) {
            mspring_clone_def def = clone_def();
            def.worker_count = i + 1;
            check_ok(mspring_network_clone(network, &def, &clones[i]));
            assert_in_range(support_worker_count(clones[i]), 1, i + 1); // 1 where there are no threads
        }
        support_steps(network, 3, 0.01);
        for (uint32_t i = 0; i < 3; i++) {
            support_steps(clones[i], 3, 0.01);
            assert_int_equal(support_hash(clones[i]), support_hash(network));
            // The implicit solver, made by the clone itself.
            solver.solver = MSPRING_SOLVER_IMPLICIT;
            check_ok(support_set_solver(clones[i], &solver));
            support_steps(clones[i], 1, 0.01);
            assert_int_equal(support_hash(clones[i]), support_hash(clones[0]));
            solver.solver = MSPRING_SOLVER_EXPLICIT;
        }
        for (uint32_t i = 0; i < 3; i++) {
            mspring_network_destroy(clones[i]);
        }
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------- nothing in common */

/// The blocks of one user.
typedef struct block_list {
    struct {
        char *memory;
        size_t size;
    } blocks[512];
    size_t count;
} block_list;

static void *listed_alloc(size_t size, size_t alignment, void *user) {
    block_list *list = user;
    assert_true(list->count < COUNT_OF(list->blocks) && alignment <= 64);
    char *memory = support_aligned_alloc(size);
    memset(memory, 0, size); // no words of what it was before
    list->blocks[list->count].memory = memory;
    list->blocks[list->count++].size = size;
    return memory;
}

static void listed_free(void *memory, size_t size, void *user) {
    block_list *list = user;
    size_t i = 0;
    while (i < list->count && list->blocks[i].memory != memory) {
        i++;
    }
    assert_true(i < list->count && list->blocks[i].size == size);
    list->blocks[i] = list->blocks[--list->count];
    support_aligned_free(memory);
}

static mspring_allocator listing(block_list *list) {
    return (mspring_allocator){
        .struct_size = sizeof(mspring_allocator), .alloc = listed_alloc, .free = listed_free, .user = list};
}

/// Words of list's blocks that are addresses in other's. With a complaint for each?
static size_t count_words_into(const block_list *list, const block_list *other, bool complain) {
    size_t count = 0;
    for (size_t i = 0; i < list->count; i++) {
        for (size_t at = 0; at + sizeof(uintptr_t) <= list->blocks[i].size; at += sizeof(uintptr_t)) {
            uintptr_t word;
            memcpy(&word, list->blocks[i].memory + at, sizeof word);
            for (size_t j = 0; j < other->count; j++) {
                const uintptr_t begin = (uintptr_t)other->blocks[j].memory;
                if (word < begin || word >= begin + other->blocks[j].size) {
                    continue;
                }
                count++;
                if (complain) {
                    print_error("a block of %zu bytes leads, at byte %zu, to byte %zu of one of %zu\n",
                                list->blocks[i].size, at, (size_t)(word - begin), other->blocks[j].size);
                }
            }
        }
    }
    return count;
}

static void no_pointer_leads_into_the_original(void **state) {
    (void)state;
    // Where words have 32 bits, numbers may well look like addresses.
    if (sizeof(uintptr_t) < 8) {
        skip();
    }
    recipe made = recipe_mixed(11);
    float strength = 0;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        block_list ours = {.count = 0}, theirs = {.count = 0};
        const mspring_allocator our_allocator = listing(&ours), their_allocator = listing(&theirs);
        mspring_network *network = make(&made, &solvers[i], &our_allocator, 2);
        use_everything(network);
        add_hook(network, MSPRING_PHASE_BEFORE_STEP, 1, &strength);
        add_hook(network, MSPRING_PHASE_BEFORE_SUBSTEP, 2, &strength);
        for (uint32_t frame = 0; frame < 5; frame++) {
            run_frame(network, frame);
        }
        mspring_clone_def def = clone_def();
        def.copy_hooks = 1;
        def.allocator = &their_allocator;
        mspring_network *clone = NULL;
        check_ok(mspring_network_clone(network, &def, &clone));
        assert_true(theirs.count > 20);
        assert_int_equal(count_words_into(&theirs, &ours, true), 0);
        assert_true(count_words_into(&theirs, &theirs, false) > theirs.count); // it can find some
        mspring_network_destroy(network);
        assert_int_equal(ours.count, 0);
        run_frame(clone, 5);
        mspring_network_destroy(clone);
        assert_int_equal(theirs.count, 0);
    }
    recipe_free(&made);
}

static void clones_that_fail_leave_nothing(void **state) {
    (void)state;
    recipe made = recipe_mixed(11);
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make(&made, &solvers[i], NULL, 1);
        use_everything(network);
        run_frame(network, 0);
        const uint64_t hash = support_hash(network);
        const size_t used = support_memory_used(network);
        mspring_result result = MSPRING_ERROR_MEMORY;
        size_t fail_at = 0;
        while (result != MSPRING_OK) {
            fail_at++;
            watched_allocator watched = {.fail_at = fail_at};
            const mspring_allocator allocator = watched_interface(&watched);
            mspring_clone_def def = clone_def();
            def.allocator = &allocator;
            def.worker_count = 3; // which takes memory of its own
            mspring_network *const untouched = (mspring_network *)(uintptr_t)16;
            mspring_network *clone = untouched;
            result = mspring_network_clone(network, &def, &clone);
            if (result == MSPRING_OK) {
                watched.fail_at = 0;
                run_frame(clone, 1);
                mspring_network_destroy(clone);
            } else {
                check_error(result, MSPRING_ERROR_MEMORY);
                assert_ptr_equal(clone, untouched);
            }
            check_watched_clean(&watched);
            assert_int_equal(support_hash(network), hash);
            assert_int_equal(support_memory_used(network), used);
        }
        assert_true(fail_at > 20);
        run_frame(network, 1);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------------- hooks */

static mspring_result in_hook_result;
static mspring_network *in_hook_network;

static void clone_in_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    mspring_network *clone = user;
    in_hook_result = mspring_network_clone(in_hook_network, NULL, &clone);
}

static void hooks_stay_behind_unless_asked_for(void **state) {
    (void)state;
    recipe made = recipe_mixed(11);
    float strength = 100;
    mspring_network *network = make(&made, &solvers[0], NULL, 1), *with_hooks = NULL;
    add_hook(network, MSPRING_PHASE_BEFORE_SUBSTEP, 1, &strength);
    add_hook(network, MSPRING_PHASE_BEFORE_SUBSTEP, 2, &strength);
    mspring_network *without = clone_of(network), *never_had = make(&made, &solvers[0], NULL, 1);
    mspring_clone_def def = clone_def();
    def.copy_hooks = 1;
    check_ok(mspring_network_clone(network, &def, &with_hooks));
    support_steps(network, 3, 0.01);
    support_steps(without, 3, 0.01);
    support_steps(never_had, 3, 0.01);
    support_steps(with_hooks, 3, 0.01);
    assert_int_equal(support_hash(with_hooks), support_hash(network));
    assert_int_equal(support_hash(without), support_hash(never_had));
    assert_int_not_equal(support_hash(without), support_hash(network));
    mspring_network_destroy(without);
    mspring_network_destroy(never_had);
    mspring_network_destroy(with_hooks);

    // Storage has as many places as the original has workers.
    uint32_t calls[16] = {0};
    mspring_hook_def hook;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
    hook.fn = push;
    hook.user = &strength;
    hook.storage = calls;
    hook.storage_stride = sizeof calls[0];
    check_ok(mspring_network_add_hook(network, &hook, NULL));
    def.worker_count = 2;
    check_error(mspring_network_clone(network, &def, &with_hooks), MSPRING_ERROR_ARGUMENT);
    def.worker_count = 1;
    check_ok(mspring_network_clone(network, &def, &with_hooks));
    support_steps(with_hooks, 1, 0.01);
    assert_int_equal(calls[0], 1);
    mspring_network_destroy(with_hooks);

    in_hook_network = network;
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, clone_in_hook, NULL, NULL));
    support_steps(network, 1, 0.01);
    check_error(in_hook_result, MSPRING_ERROR_BUSY);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// What a hook or a pool of threads belongs to: how often it was retained and released.
typedef struct owner {
    uint32_t retained, released;
} owner;

static void *retain(void *user) {
    ((owner *)user)->retained++;
    return user;
}

static void release(void *user) {
    ((owner *)user)->released++;
}

static void idle(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// Each network releases the hooks that it has once, when they are removed or it is destroyed; compaction does not.
static void hooks_are_retained_and_released(void **state) {
    (void)state;
    owner shared = {0, 0}, lone = {0, 0};
    recipe made = recipe_mixed(11);
    mspring_network *network = make(&made, &solvers[0], NULL, 1), *clone, *without;
    mspring_hook_def hook = mspring_hook_def_default();
    mspring_id ids[2];
    hook.fn = idle;
    hook.release = release;
    hook.user = &lone; // no clone may take it
    check_ok(mspring_network_add_hook(network, &hook, &ids[0]));
    hook.retain = retain;
    hook.user = &shared;
    check_ok(mspring_network_add_hook(network, &hook, &ids[1]));
    hook.period = 0;
    check_error(mspring_network_add_hook(network, &hook, NULL), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_clone(network, NULL, &without));
    mspring_network_destroy(without);
    assert_true(shared.retained == 0 && shared.released == 0 && lone.released == 0);
    mspring_clone_def def = clone_def();
    def.copy_hooks = 1;
    check_ok(mspring_network_clone(network, &def, &clone));
    assert_true(shared.retained == 1 && lone.retained == 0);
    check_error(mspring_network_remove_hook(clone, ids[0]), MSPRING_ERROR_ID);
    const mspring_id broken = 3;
    check_ok(mspring_network_break_springs(clone, &broken, 0, 1));
    check_ok(mspring_network_compact(clone));
    support_steps(clone, 1, 0.01);
    assert_true(shared.released == 0);
    mspring_network_destroy(clone);
    assert_true(shared.released == 1 && lone.released == 0);
    check_ok(mspring_network_remove_hook(network, ids[1]));
    assert_int_equal(shared.released, 2);
    mspring_network_destroy(network);
    assert_true(shared.released == 2 && lone.released == 1);
    recipe_free(&made);
}

static void run_all(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    (void)user;
    for (uint32_t i = 0; i < count; i++)
        fn(argument, i, 0);
}

/// A pool is released once by each network that was made with it, and by none that was not made.
static void tasks_are_released(void **state) {
    (void)state;
    owner pool = {0, 0};
    recipe made = recipe_mixed(11);
    mspring_tasks tasks = mspring_tasks_default();
    tasks.run = run_all;
    tasks.user = &pool;
    tasks.release = release;
    mspring_network_def def = support_def(-9.8f, 1);
    def.tasks = &tasks;
    mspring_builder *empty = support_builder();
    mspring_network *network = NULL, *clone, *without;
    check_error(mspring_network_create(empty, &def, &network), MSPRING_ERROR_ARGUMENT);
    mspring_builder_destroy(empty);
    assert_int_equal(pool.released, 0);
    network = recipe_network(&made, &def);
    mspring_clone_def own = clone_def();
    own.tasks = &tasks;
    check_ok(mspring_network_clone(network, &own, &clone));
    check_ok(mspring_network_clone(network, NULL, &without));
    mspring_network_destroy(without);
    assert_int_equal(pool.released, 0);
    mspring_network_destroy(clone);
    assert_int_equal(pool.released, 1);
    check_ok(mspring_network_compact(network));
    assert_int_equal(pool.released, 1);
    mspring_network_destroy(network);
    assert_int_equal(pool.released, 2);
    recipe_free(&made);
}

static void bad_calls_are_refused(void **state) {
    (void)state;
    recipe made = recipe_mixed(11);
    mspring_network *network = make(&made, &solvers[0], NULL, 1);
    mspring_network *const untouched = (mspring_network *)(uintptr_t)16;
    mspring_network *clone = untouched;
    mspring_clone_def def = clone_def();
    check_error(mspring_init(MSPRING_STRUCT_CLONE_DEF, NULL, sizeof def), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def - 1), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_clone(NULL, NULL, &clone), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_clone(network, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    def.struct_size--;
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_STRUCT);
    def = clone_def();
    def.copy_hooks = 2;
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    def = clone_def();
    def.worker_count = 0;
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    def.worker_count = MSPRING_MAX_WORKERS + 1;
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    def = clone_def();
    const mspring_allocator lacking = {.struct_size = sizeof lacking};
    def.allocator = &lacking;
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    const mspring_tasks none = {.struct_size = sizeof none};
    def = clone_def();
    def.tasks = &none;
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    assert_ptr_equal(clone, untouched);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clones_go_on_as_their_original),     cmocka_unit_test(workers_are_the_clones_own),
        cmocka_unit_test(no_pointer_leads_into_the_original), cmocka_unit_test(clones_that_fail_leave_nothing),
        cmocka_unit_test(hooks_stay_behind_unless_asked_for), cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(hooks_are_retained_and_released),    cmocka_unit_test(tasks_are_released),
    };
    return cmocka_run_group_tests(tests, list_solvers, NULL);
}
