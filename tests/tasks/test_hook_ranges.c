/// @file test_hook_ranges.c
/// Hooks that are called for ranges of slots, at once, on the workers.
///
/// SPDX-License-Identifier: MIT
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

#include "hosts.h"
#include "recipe.h"
#include "support.h"

enum { SLOTS = 20000, WORKERS = 8, SUBSTEPS = 6 };

static const uint32_t worker_counts[] = {1, 2, 3, 8};
static const uint32_t ranges[] = {0, 1, 1000, 1u << 30, UINT32_MAX};

static recipe mixed_recipe(void) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {200, 400}, .damping = {0, 1}, .pinned = 0.01, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 140, 100, 0, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, 30, 150, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 2, end, 30, &stuff, &seed);
    recipe_random_springs(&made, 10, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

static mspring_network *make(const recipe *made, uint32_t worker_count, const mspring_tasks *tasks) {
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.worker_count = worker_count;
    def.tasks = tasks;
    return recipe_network(made, &def);
}

static mspring_hook_def concurrent(mspring_phase phase, mspring_hook_fn fn, void *user, uint32_t range) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = phase;
    def.fn = fn;
    def.user = user;
    def.flags = MSPRING_HOOK_CONCURRENT;
    def.range_slots = range;
    return def;
}

/* ------------------------------------------------------------------------------------------------- the ranges */

/// 64 bytes, so that no two workers write to the same line.
typedef struct storage {
    uint64_t calls, below; ///< ranges; particles found under the floor
    uint64_t unused[6];
} storage;

typedef struct census {
    atomic_uint calls[SLOTS];
    atomic_bool busy[WORKERS];
    atomic_uint wrong;
    uint32_t worker_count, largest_range;
    storage stores[WORKERS];
} census;

// Failures are counted, as a test must not be left on another thread than its own.
static void count_slots(const mspring_hook_args *args, void *user) {
    census *of = user;
    storage *mine = args->storage;
    if (args->worker >= of->worker_count || atomic_exchange(&of->busy[args->worker], true) ||
        mine != &of->stores[args->worker] || args->first_slot % 16 != 0 || args->slot_count % 16 != 0 ||
        args->slot_count == 0 || args->slot_count > of->largest_range) {
        atomic_fetch_add(&of->wrong, 1);
        return;
    }
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        atomic_fetch_add(&of->calls[slot], 1);
    }
    mine->calls++;
    atomic_store(&of->busy[args->worker], false);
}

static void ranges_cover_all_slots(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (size_t w = 0; w < COUNT_OF(worker_counts); w++) {
        mspring_network *network = make(&made, worker_counts[w], NULL);
        mspring_view view = {.struct_size = sizeof view};
        check_ok(mspring_network_get_view(network, &view));
        assert_true(view.slot_count <= SLOTS);
        for (size_t r = 0; r < COUNT_OF(ranges); r++) {
            static census of;
            memset(&of, 0, sizeof of);
            of.worker_count = worker_counts[w];
            of.largest_range = ranges[r] == 0                ? UINT32_MAX
                               : ranges[r] < UINT32_MAX - 15 ? ranges[r] + 15
                                                             : UINT32_MAX;
            mspring_hook_def def = concurrent(MSPRING_PHASE_AFTER_SUBSTEP, count_slots, &of, ranges[r]);
            def.storage = of.stores;
            def.storage_stride = sizeof of.stores[0];
            uint32_t hook;
            check_ok(mspring_network_add_hook(network, &def, &hook));
            check_ok(mspring_network_step(network, 0.01));
            check_ok(mspring_network_remove_hook(network, hook));
            assert_int_equal(atomic_load(&of.wrong), 0);
            uint64_t calls = 0;
            for (uint32_t slot = 0; slot < SLOTS; slot++) {
                assert_int_equal(atomic_load(&of.calls[slot]), slot < view.slot_count ? SUBSTEPS : 0);
            }
            for (uint32_t worker = 0; worker < WORKERS; worker++) {
                calls += of.stores[worker].calls;
            }
            const uint64_t per_substep = calls / SUBSTEPS;
            if (ranges[r] == 0) {
                assert_in_range(per_substep, worker_counts[w] > 1 ? 2 : 1, worker_counts[w]);
            } else {
                const uint64_t range = ranges[r] == 1 ? 16 : ranges[r] == 1000 ? 1008 : view.slot_count;
                assert_int_equal(per_substep, (view.slot_count + range - 1) / range);
            }
        }
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/* --------------------------------------------------------------------------------------------------- same bits */

static void blow(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->vx[slot] += 0.01f;
        args->force_y[slot] += 2;
    }
}

static void drag(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] -= 0.3f * args->vx[slot];
        args->force_y[slot] -= 0.3f * args->vy[slot];
    }
}

static void sea_floor(const mspring_hook_args *args, void *user) {
    storage *mine = args->storage;
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->inverse_mass[slot] > 0 && args->y[slot] < -75) {
            args->y[slot] = -75;
            args->vy[slot] = 0;
            mine->below++;
        }
    }
}

typedef struct outcome {
    uint64_t hash, below;
} outcome;

static outcome run(const recipe *made, uint32_t worker_count, const mspring_tasks *tasks, uint32_t range) {
    mspring_network *network = make(made, worker_count, tasks);
    storage stores[WORKERS];
    memset(stores, 0, sizeof stores);
    mspring_hook_def defs[] = {concurrent(MSPRING_PHASE_BEFORE_STEP, blow, NULL, range),
                               concurrent(MSPRING_PHASE_BEFORE_SUBSTEP, drag, NULL, range),
                               concurrent(MSPRING_PHASE_AFTER_SUBSTEP, sea_floor, NULL, range)};
    defs[1].period = 4;
    defs[2].period = 2;
    defs[2].storage = stores;
    defs[2].storage_stride = sizeof stores[0];
    for (size_t i = 0; i < COUNT_OF(defs); i++) {
        check_ok(mspring_network_add_hook(network, &defs[i], NULL));
    }
    support_steps(network, 2, 0.02);
    outcome out = {.hash = support_hash(network)};
    for (uint32_t worker = 0; worker < WORKERS; worker++) {
        out.below += stores[worker].below;
    }
    mspring_network_destroy(network);
    return out;
}

static void any_number_of_workers_gives_the_same_bits(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    const outcome expected = run(&made, 1, NULL, 0);
    assert_true(expected.below > 0);
    for (size_t w = 0; w < COUNT_OF(worker_counts); w++) {
        for (size_t r = 0; r < COUNT_OF(ranges); r += ROUNDS_ARE_FEW ? 2 : 1) {
            const outcome is = run(&made, worker_counts[w], NULL, ranges[r]);
            assert_int_equal(is.hash, expected.hash);
            assert_int_equal(is.below, expected.below);
        }
        host hosts[HOST_COUNT];
        hosts_fill(hosts, worker_counts[w]);
        for (int h = 0; h < HOST_COUNT; h++) {
            const outcome is = run(&made, 1, &hosts[h].tasks, 1000);
            assert_int_equal(is.hash, expected.hash);
            assert_int_equal(is.below, expected.below);
            assert_true(worker_counts[w] == 1 || hosts[h].runs > 0);
        }
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------- calls from inside */

typedef struct caller {
    mspring_network *network;
    atomic_uint calls, wrong;
} caller;

static void call_from_inside(const mspring_hook_args *args, void *user) {
    caller *inside = user;
    double x, y, energy;
    uint64_t hash;
    bool good = mspring_network_get_positions(inside->network, NULL, args->worker, 1, &x, &y, 1) == MSPRING_OK &&
                support_get_energy(inside->network, &energy, NULL, NULL) == MSPRING_OK &&
                mspring_network_get_state_hash(inside->network, &hash) == MSPRING_OK;
    good = good && mspring_network_step(inside->network, 0.01) == MSPRING_ERROR_BUSY &&
           support_set_gravity(inside->network, 0, 0) == MSPRING_ERROR_BUSY &&
           mspring_network_set_positions(inside->network, NULL, 0, 1, &x, &y, 1) == MSPRING_ERROR_BUSY;
    atomic_fetch_add(&inside->calls, 1);
    atomic_fetch_add(&inside->wrong, !good);
}

static void shared_calls_from_several_threads_work(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_network *network = make(&made, 3, NULL), *clean = make(&made, 1, NULL);
    caller inside = {.network = network};
    for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
        const mspring_hook_def def = concurrent(phase, call_from_inside, &inside, 5000);
        check_ok(mspring_network_add_hook(network, &def, NULL));
    }
    check_ok(mspring_network_step(network, 0.01));
    check_ok(mspring_network_step(clean, 0.01));
    assert_true(atomic_load(&inside.calls) >= 3 * (1 + 2 * SUBSTEPS));
    assert_int_equal(atomic_load(&inside.wrong), 0);
    assert_int_equal(support_hash(network), support_hash(clean));
    check_ok(support_set_gravity(network, 0, 0));
    mspring_network_destroy(network);
    mspring_network_destroy(clean);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_cover_all_slots),
        cmocka_unit_test(any_number_of_workers_gives_the_same_bits),
        cmocka_unit_test(shared_calls_from_several_threads_work),
    };
    return cmocka_run_group_tests_name("hook ranges", tests, NULL, NULL);
}
