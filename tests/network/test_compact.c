/// @file test_compact.c
/// Compaction: nothing is to be seen of it but cost and slots, and it can be undone.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "look.h"
#include "snapshots.h"
#include "support.h"
#include "wrecks.h"

enum { SEVERAL_FRAMES = 12 };

static void compact(mspring_network *network) {
    check_ok(mspring_network_compact(network));
}

static uint32_t live_count(const mspring_network *network) {
    uint32_t count = 0;
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        count += !(info.flags & MSPRING_SPRING_BROKEN);
    }
    return count;
}

/* -------------------------------------------------------------------------------------- what is to be seen */

static void nothing_changes_but_the_plan(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (wreck kind = 0; kind < WRECKS; kind++) {
        mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
        const float scale = 0.5f;
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 7, 1, &scale, 1));
        support_steps(network, 2, 1.0 / 64);
        wrecks_make(network, &made, kind);
        const uint32_t before = wrecks_swept(network);
        const look seen = look_at(network);
        compact(network);
        check_same_look(seen, look_at(network), network);
        assert_int_equal(wrecks_swept(network), live_count(network));
        assert_true(before > live_count(network));
        // Nothing more to do, and no slot changes by that.
        mspring_view view = {.struct_size = sizeof view}, again = {.struct_size = sizeof again};
        check_ok(mspring_network_get_view(network, &view));
        compact(network);
        check_ok(mspring_network_get_view(network, &again));
        assert_ptr_equal(view.x, again.x);
        const look then = look_at(network);
        check_ok(support_expand(network));
        check_same_look(then, look_at(network), network);
        assert_int_equal(wrecks_swept(network), before);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// The plan is the one that a network of the springs that are left is created with.
static void plans_are_those_of_what_is_left(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (wreck kind = 0; kind < WRECKS; kind++) {
        mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
        recipe left = made;
        left.springs = look_array(made.spring_count, sizeof *left.springs);
        left.spring_count = 0;
        for (mspring_id s = 0; s < made.spring_count; s++) {
            if (!wrecks_breaks(&made, kind, s)) {
                left.springs[left.spring_count++] = made.springs[s];
            }
        }
        mspring_network *fresh = wrecks_network(&left, MSPRING_SIMD_AUTO, 1);
        wrecks_make(network, &made, kind);
        compact(network);
        const support_plan a = wrecks_plan(network), b = wrecks_plan(fresh);
        assert_int_equal(a.lattice_particles, b.lattice_particles);
        assert_int_equal(a.lattice_springs, b.lattice_springs);
        assert_int_equal(a.lattice_blocks, b.lattice_blocks);
        assert_int_equal(a.chain_particles, b.chain_particles);
        assert_int_equal(a.irregular_particles, b.irregular_particles);
        assert_int_equal(a.irregular_springs, b.irregular_springs);
        assert_int_equal(a.loose_particles, b.loose_particles);
        free(left.springs);
        mspring_network_destroy(network);
        mspring_network_destroy(fresh);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------- stepping */

static double largest_difference(const mspring_network *a, const mspring_network *b) {
    double largest = 0;
    for (mspring_id p = 0; p < mspring_network_count(a, MSPRING_PARTICLES); p++) {
        const support_point pa = support_position(a, p), pb = support_position(b, p);
        largest = fmax(largest, hypot(pa.x - pb.x, pa.y - pb.y));
    }
    return largest;
}

/// A compact network moves as one that is not, but for rounding (and, if implicit, for tiles, which converge from
/// other sides): some 1e-7 of coordinates of 60 m in each of 40 to 80 substeps, and motion that goes on from there.
/// With an implicit solver, what has lost all its springs flies along parabolas and bounces where it meets the
/// floor once it is in a row of its own. Before, implicit Euler takes it g h^2 / 2 = 1.2 mm off that in a substep,
/// and it comes to lie on the floor at the end of one: at some 5 m/s, up to 0.1 m elsewhere.
static void motion_goes_on(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (int run = 0; run < WRECKS_RUNS; run++) {
        for (wreck kind = 0; kind < WRECKS; kind++) {
            mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
            wrecks_set_up(network, run);
            support_steps(network, 3, 1.0 / 64);
            wrecks_make(network, &made, kind);
            support_steps(network, 1, 1.0 / 64);
            mspring_network *compacted = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
            wrecks_set_up(compacted, run);
            support_steps(compacted, 3, 1.0 / 64);
            wrecks_make(compacted, &made, kind);
            support_steps(compacted, 1, 1.0 / 64);
            assert_int_equal(support_hash(network), support_hash(compacted));
            check_ok(mspring_network_apply_force(network, 40, 300, 100));
            check_ok(mspring_network_apply_force(compacted, 40, 300, 100));
            compact(compacted);
            support_steps(network, 20, 1.0 / 64);
            support_steps(compacted, 20, 1.0 / 64);
            check_near(largest_difference(network, compacted), 0, run < 2 ? 1e-3 : 0.1);
            mspring_network_destroy(network);
            mspring_network_destroy(compacted);
        }
    }
    recipe_free(&made);
}

/// Forth and back between two steps is as if nothing had been, bit for bit.
static void expanding_undoes_compacting(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (int run = 0; run < WRECKS_RUNS; run++) {
        uint64_t hashes[2];
        for (int there = 0; there < 2; there++) {
            mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
            wrecks_set_up(network, run);
            support_steps(network, 3, 1.0 / 64);
            wrecks_make(network, &made, TORN);
            support_steps(network, 3, 1.0 / 64);
            check_ok(mspring_network_apply_force(network, 40, 300, 100));
            if (there) {
                compact(network);
                check_ok(support_expand(network));
            }
            support_steps(network, 5, 1.0 / 64);
            hashes[there] = support_hash(network);
            mspring_network_destroy(network);
        }
        assert_int_equal(hashes[0], hashes[1]);
    }
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------- the same bits */

/// A session in which springs break and are restored while the network is compacted piece by piece.
static uint64_t session_hash(const recipe *made, mspring_simd level, uint32_t workers, int run) {
    mspring_network *network = wrecks_network(made, level, workers);
    wrecks_set_up(network, run);
    mspring_job *job = NULL;
    for (uint32_t frame = 0; frame < SEVERAL_FRAMES; frame++) {
        if (frame == 1) {
            wrecks_make(network, made, TORN);
        }
        if (frame == 9) {
            wrecks_make(network, made, SHATTERED);
        }
        const mspring_id some[] = {frame * 31 % made->spring_count, frame * 57 % made->spring_count};
        check_ok(mspring_network_break_springs(network, some, 0, 2));
        if (frame == 3 || frame == 7) { // once while it is under way, once when it is done
            check_ok(mspring_network_restore_springs(network, some, 0, 2, 0.1));
        }
        support_compact(network, frame < 6 ? 30 : 0, &job);
        support_steps(network, 2, 1.0 / 64);
    }
    assert_null(job);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void bits_are_the_same_everywhere(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (int run = 0; run < WRECKS_RUNS; run += run < 2 ? 1 : 3) {
        const uint64_t expected = session_hash(&made, MSPRING_SIMD_SCALAR, 1, run);
        for (uint32_t i = 0; i < level_count; i++) {
            assert_int_equal(session_hash(&made, levels[i], 1, run), expected);
        }
        assert_int_equal(session_hash(&made, MSPRING_SIMD_AUTO, 3, run), expected);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------------- edits */

static void springs_that_are_left_out_can_be_edited_and_restored(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (int run = 0; run < WRECKS_RUNS; run++) {
        mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1),
                        *plain = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
        mspring_network *const both[] = {network, plain};
        for (int i = 0; i < 2; i++) {
            wrecks_set_up(both[i], run);
            support_steps(both[i], 2, 1.0 / 64);
            wrecks_make(both[i], &made, DISSOLVED);
            if (i == 0) {
                compact(network);
                assert_int_equal(wrecks_swept(network), 0);
            }
            const mspring_id id = 17;
            const float stiffness = 0.07f, rest_length = 1.1f, damping = 0.02f;
            check_ok(mspring_network_set(both[i], MSPRING_STIFFNESS, &id, 0, 1, &stiffness, 1));
            check_ok(mspring_network_set(both[i], MSPRING_DAMPING, &id, 0, 1, &damping, 1));
            check_ok(mspring_network_set(both[i], MSPRING_REST_LENGTH, &id, 0, 1, &rest_length, 1));
            const mspring_id back[] = {id, 18, 300, 4};
            check_ok(mspring_network_restore_springs(both[i], back, 0, 4, 0.2));
            support_steps(both[i], 5, 1.0 / 64);
        }
        // No step was made in between, so there is no difference of rounding either.
        assert_int_equal(wrecks_swept(network), wrecks_swept(plain));
        check_same_look(look_at(network), look_at(plain), network);
        mspring_network_destroy(network);
        mspring_network_destroy(plain);
    }
    recipe_free(&made);
}

static void strains_are_watched_as_before(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    mspring_event events[2][64];
    uint32_t counts[2];
    float *strain = look_array(made.spring_count, sizeof *strain);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        strain[s] = 0.02f + 0.01f * (float)(s % 5);
    }
    for (int compacted = 0; compacted < 2; compacted++) {
        mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
        check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, made.spring_count, strain, 1));
        for (mspring_id s = 0; s < made.spring_count; s++) {
            strain[s] *= 2;
        }
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, strain, 1));
        for (mspring_id s = 0; s < made.spring_count; s++) {
            strain[s] /= 2;
        }
        support_steps(network, 1, 1.0 / 64);
        wrecks_make(network, &made, SHATTERED);
        if (compacted) {
            compact(network);
        }
        check_ok(mspring_network_reserve_events(network, 64));
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_network_read_events(network, events[compacted], 64, &counts[compacted], NULL));
        mspring_network_destroy(network);
    }
    // In the order of the plan, so each is looked for.
    assert_int_equal(counts[0], counts[1]);
    assert_in_range(counts[0], 4, 63);
    for (uint32_t i = 0; i < counts[0]; i++) {
        bool found = false;
        for (uint32_t j = 0; j < counts[1]; j++) {
            found = found || (events[1][j].id == events[0][i].id && events[1][j].kind == events[0][i].kind &&
                              fabsf(events[1][j].strain - events[0][i].strain) < 1e-4f);
        }
        assert_true(found);
    }
    free(strain);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------------- snapshots */

static void snapshots_are_of_one_plan(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (int run = 0; run < WRECKS_RUNS; run++) {
        mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
        wrecks_set_up(network, run);
        support_steps(network, 2, 1.0 / 64);
        wrecks_make(network, &made, TORN);
        saved whole = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        support_steps(network, 4, 1.0 / 64);
        const uint64_t from_whole = support_hash(network);
        compact(network);
        support_steps(network, 1, 1.0 / 64);
        saved compacted = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        support_steps(network, 4, 1.0 / 64);
        const uint64_t from_compacted = support_hash(network);

        check_error(mspring_network_load(network, whole.bytes, whole.size), MSPRING_ERROR_SNAPSHOT);
        assert_int_equal(support_hash(network), from_compacted);
        check_ok(mspring_network_load(network, compacted.bytes, compacted.size));
        support_steps(network, 4, 1.0 / 64);
        assert_int_equal(support_hash(network), from_compacted);

        check_ok(support_expand(network));
        check_error(mspring_network_load(network, compacted.bytes, compacted.size), MSPRING_ERROR_SNAPSHOT);
        check_ok(mspring_network_load(network, whole.bytes, whole.size));
        support_steps(network, 4, 1.0 / 64);
        assert_int_equal(support_hash(network), from_whole);
        free(whole.bytes);
        free(compacted.bytes);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// The solver that takes steps for the explicit one is as it was made, too: it goes by the first rest lengths.
static void steps_taken_for_the_explicit_solver_stay_the_same(void **state) {
    (void)state;
    uint64_t seed = 5;
    const recipe_stuff stiff = {.mass = {1, 1}, .stiffness = {1e7, 1e7}, .damping = {20, 20}};
    recipe made = {0};
    recipe_lattice(&made, 24, 8, 0, 0, 1, &stiff, &seed);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id some = 100;
    check_ok(mspring_network_break_springs(network, &some, 0, 1));
    check_ok(mspring_network_restore_springs(network, &some, 0, 1, 0));
    recipe_disturb(&made, 0.05, 0.5, &seed);
    for (mspring_id p = 0; p < made.particle_count; p++) {
        const mspring_particle_def *particle = &made.particles[p];
        check_ok(mspring_network_set_positions(network, NULL, p, 1, &particle->x, &particle->y, 1));
    }
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    void *snapshot = malloc(size);
    assert_non_null(snapshot);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
    support_steps(network, 5, 1.0 / 64);
    assert_true(support_fallback_count(network) > 0);
    const uint64_t hash = support_hash(network);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        const float rest_length = 3;
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, s, 1, &rest_length, 1));
    }
    check_ok(mspring_network_break_springs(network, &some, 0, 1));
    compact(network);
    check_ok(support_expand(network));
    check_ok(mspring_network_load(network, snapshot, size));
    support_steps(network, 5, 1.0 / 64);
    assert_int_equal(support_hash(network), hash);
    free(snapshot);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ----------------------------------------------------------------------------------------------------- clones */

static void clones_are_compact_too(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (uint32_t pieces = 1; pieces < 120; pieces += 12) {
        mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1), *clone = NULL;
        mspring_job *job = NULL;
        wrecks_make(network, &made, TORN);
        support_compact(network, pieces, &job);
        check_ok(mspring_network_clone(network, NULL, &clone));
        assert_int_equal(wrecks_swept(network), wrecks_swept(clone));
        support_steps(network, 3, 1.0 / 64);
        support_steps(clone, 3, 1.0 / 64);
        assert_int_equal(support_hash(network), support_hash(clone));
        // What was under way is not cloned, so the clone begins anew; then it is at the same place.
        mspring_job_destroy(job);
        compact(network);
        mspring_network_destroy(network);
        compact(clone);
        check_ok(support_expand(clone));
        support_steps(clone, 3, 1.0 / 64);
        mspring_network_destroy(clone);
    }
    recipe_free(&made);
}

/* ----------------------------------------------------------------------------------------------------- errors */

static mspring_result compact_all(mspring_network *network) {
    return mspring_network_compact(network);
}

/// A call that may be out of memory, with an allocator that fails once: then the network is as it was, and the call
/// can be made again.
static void check_survives(mspring_network *network, watched_allocator *watched, size_t fail_at,
                           mspring_result (*call)(mspring_network *), bool *failed) {
    const uint64_t hash = support_hash(network);
    const uint32_t before = wrecks_swept(network);
    watched->fail_at = watched->calls + fail_at;
    mspring_result result = call(network);
    *failed = result != MSPRING_OK;
    watched->fail_at = 0;
    if (*failed) {
        check_error(result, MSPRING_ERROR_MEMORY);
        if (call == compact_all) // a job that fails has its own message
            check_contains(mspring_network_error(network), "memory");
        assert_int_equal(support_hash(network), hash);
        assert_int_equal(wrecks_swept(network), before);
        check_ok(call(network));
    }
    assert_int_equal(support_hash(network), hash);
}

static void every_failure_leaves_the_network_as_it_was(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    float *strain = look_array(made.spring_count, sizeof *strain);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        strain[s] = 10;
    }
    uint64_t expected = 0;
    bool failed = true;
    size_t fail_at = 1;
    for (; failed; fail_at += ROUNDS_ARE_FEW ? 3 : 1) {
        watched_allocator watched = {.fail_at = 0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        bool compacting_failed, expanding_failed;
        mspring_network *network = recipe_network(&made, &def);
        wrecks_set_up(network, 3);
        check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, made.spring_count, strain, 1));
        check_ok(mspring_network_update_components(network, NULL, NULL));
        wrecks_make(network, &made, TORN);
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_network_apply_force(network, 3, 1, 2));
        check_survives(network, &watched, fail_at, compact_all, &compacting_failed);
        support_steps(network, 1, 1.0 / 64);
        check_survives(network, &watched, fail_at, support_expand, &expanding_failed);
        support_steps(network, 1, 1.0 / 64);
        expected = fail_at == 1 ? support_hash(network) : expected;
        assert_int_equal(support_hash(network), expected);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
        failed = compacting_failed || expanding_failed;
    }
    assert_true(fail_at > 50); // topology, state, records, solver
    free(strain);
    recipe_free(&made);
}

static void compact_in_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    check_error(mspring_network_compact(user), MSPRING_ERROR_BUSY);
    check_error(support_expand(user), MSPRING_ERROR_BUSY);
    mspring_job *job = NULL;
    check_error(mspring_job_begin(user, MSPRING_LAYOUT_COMPACT, &job), MSPRING_ERROR_BUSY);
    check_error(mspring_job_finish(user, NULL), MSPRING_ERROR_BUSY);
}

static void misuse_is_refused(void **state) {
    (void)state;
    check_error(mspring_network_compact(NULL), MSPRING_ERROR_ARGUMENT);
    check_error(support_expand(NULL), MSPRING_ERROR_ARGUMENT);
    recipe made = wrecks_recipe();
    mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
    check_ok(support_expand(network)); // nothing to undo
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, compact_in_hook, network, NULL));
    support_steps(network, 1, 1.0 / 64);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_changes_but_the_plan),
        cmocka_unit_test(plans_are_those_of_what_is_left),
        cmocka_unit_test(motion_goes_on),
        cmocka_unit_test(expanding_undoes_compacting),
        cmocka_unit_test(bits_are_the_same_everywhere),
        cmocka_unit_test(springs_that_are_left_out_can_be_edited_and_restored),
        cmocka_unit_test(strains_are_watched_as_before),
        cmocka_unit_test(snapshots_are_of_one_plan),
        cmocka_unit_test(steps_taken_for_the_explicit_solver_stay_the_same),
        cmocka_unit_test(clones_are_compact_too),
        cmocka_unit_test(every_failure_leaves_the_network_as_it_was),
        cmocka_unit_test(misuse_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
